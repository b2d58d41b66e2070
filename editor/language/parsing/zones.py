"""Zones that a script draws: `ctx.zone("z1", [(0, 0), (3, 0), (3, 2)], rule="keep out", name="Wet floor")`."""

from __future__ import annotations

import ast
from collections.abc import Mapping

from editor.language.expressions.nodes import Point, Zone
from editor.language.expressions.printing import quote
from editor.language.expressions.values import is_number
from editor.language.parsing.expressions import parse_point, parse_scalar
from editor.language.parsing.scope import Binding, Refused, Scope, quoted
from editor.language.tree.zones import FEWEST_CORNERS, MOST_CORNERS, RULES, SMALLEST_AREA_M2, Rule, area_m2, rule_text

_FORM = 'Write ctx.zone("wet floor", [(1, 2), (4, 2), (4, 5)], rule="keep out").'
_RULES = {rule_text(rule): rule for rule in RULES.values()}
_WRITE_RULE = f"Write one of: {', '.join(map(quote, _RULES))}."
_GIVEN = frozenset({"rule", "speed", "door", "name"})


def parse_zone(call: ast.Call, scope: Scope) -> Binding:
    """Return the zone that a line of run draws, or only names: `ctx.zone("z1")`.

    Raises:
        Refused: it is no zone that a document can hold, one of this id is drawn already, or the form is another.
    """
    given = {keyword.arg or "": keyword for keyword in call.keywords}
    for name, keyword in given.items():
        if name not in _GIVEN:
            raise Refused(keyword, quoted(keyword), f"A zone takes rule, door, speed and name. {_FORM}")
    match call.args:
        case [ast.Constant(value=str() as zone_id)] if zone_id and not given:
            return Binding("zone", zone_id)
        case [ast.Constant(value=str() as zone_id), corners] if zone_id:
            if zone_id in scope.drawn_zones:
                raise Refused(call.args[0], f"A second zone {quote(zone_id)}", "Write another text here for this zone.")
            points, rule = _corners(corners), _rule(call, given)
            name, door = _name(given) or zone_id, _door(call, given, rule)
            scope.drawn_zones[zone_id] = Zone(zone_id, name, rule, points, _speed(given), door)
            return Binding("zone", zone_id)
    raise Refused(call, quoted(call), _FORM)


def _corners(node: ast.expr) -> tuple[Point, ...]:
    if not isinstance(node, ast.List):
        raise Refused(node, quoted(node), "Write the corners as a list of points: [(1, 2), (4, 2), (4, 5)].")
    points = tuple(parse_point(each) for each in node.elts)
    if len(points) < FEWEST_CORNERS:
        raise Refused(node, quoted(node), f"A zone has at least {FEWEST_CORNERS} corners.")
    if len(points) > MOST_CORNERS:
        first = node.elts[MOST_CORNERS]
        raise Refused(first, quoted(first), f"A zone has at most {MOST_CORNERS} corners.")
    if area_m2(points) < SMALLEST_AREA_M2:
        raise Refused(node, quoted(node), "These corners enclose no area. Move one of them off the line of the others.")
    return points


def _rule(call: ast.Call, given: Mapping[str, ast.keyword]) -> Rule:
    if "rule" not in given:
        raise Refused(call, "A zone without a rule", f'Add what robots do there: rule="keep out". {_WRITE_RULE}')
    node = given["rule"].value
    rule = parse_scalar(node)
    known = _RULES.get(rule_text(rule)) if isinstance(rule, str) else None
    if known is None:
        raise Refused(node, quoted(node), _WRITE_RULE)
    return known


def _speed(given: Mapping[str, ast.keyword]) -> float | None:
    if "speed" not in given:
        return None
    node = given["speed"].value
    speed = parse_scalar(node)
    if not is_number(speed) or speed <= 0:
        raise Refused(node, quoted(node), "Write the speed in m/s, above 0: speed=0.3.")
    return float(speed)


def _door(call: ast.Call, given: Mapping[str, ast.keyword], rule: Rule) -> str:
    """Return the device that is opened, by its id; an empty text where it is still to be chosen."""
    if "door" not in given:
        if rule == "door":
            raise Refused(call, "A passage without a door", 'Add the id of the device that opens: door="gate01".')
        return ""
    node = given["door"].value
    if rule != "door":
        raise Refused(node, quoted(node), 'Only a passage has a door: rule="door".')
    if isinstance(node, ast.Constant) and node.value is None:
        return ""  # still to be chosen
    door = parse_scalar(node)
    if not isinstance(door, str) or not door:
        raise Refused(node, quoted(node), 'Write the id of the device that opens: door="gate01".')
    return door


def _name(given: Mapping[str, ast.keyword]) -> str:
    if "name" not in given:
        return ""
    node = given["name"].value
    name = parse_scalar(node)
    if not isinstance(name, str) or not name:
        raise Refused(node, quoted(node), 'Write what people call the zone: name="Wet floor".')
    return name


def zones_given(scope: Scope) -> tuple[tuple[Zone, ...], frozenset[str]]:
    """Return the zones that a script draws, by id, and the ids of those that it only names."""
    drawn = scope.drawn_zones
    named = frozenset(binding.id for binding in scope.bindings.values() if binding.kind == "zone")
    return tuple(drawn[each] for each in sorted(drawn)), named - drawn.keys()

"""The names that can be used in a value of one line: those of the script, without `self.`."""

from __future__ import annotations

import ast
import keyword
import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from itertools import pairwise

from editor.language.constructs.table import fields_by_kind
from editor.language.document.catches import catches_of
from editor.language.document.outline import Params, mapping
from editor.language.expressions.declarations import normal_type
from editor.language.expressions.names import unique_name
from editor.language.expressions.nodes import MISSING, OF_PROBLEM, Expression, Located
from editor.language.expressions.value_types import TEXT, ValueType, plain_type
from editor.language.parsing.scope import Binding, Scope
from editor.language.reading.document import read_document
from editor.language.site.surroundings import Surroundings
from editor.language.tree.robots import with_crew

_SETTERS = fields_by_kind("variable")
"""The kinds of steps that set a variable, with the parameter that names it."""
_GIVEN = re.compile(r"^\s+self\.(\w+) = ctx\.(get|place|zone)\((\"(?:[^\"\\]|\\.)*\")")


@dataclass(slots=True)
class LineScope:
    """What the names of one line mean, both ways."""

    scope: Scope
    names: dict[str, str] = field(default_factory=dict)
    """Parameters and variables: the name in the document → the name in the line."""
    types: dict[str, ValueType] = field(default_factory=dict)
    """What is known of parameters, by the name in the line."""
    roles: dict[str, Expression] = field(default_factory=dict)
    """What stands for the robot of a role, by the role's id."""
    role_ids: dict[str, str] = field(default_factory=dict)
    things: dict[tuple[str, str], str] = field(default_factory=dict)
    """Names of devices, places and zones, by (`get`, `place` or `zone`, id)."""

    def robot_of(self, role: str) -> Expression:
        """Return what stands for the robot of a role."""
        return self.roles.get(role, MISSING)

    def known_names(self) -> list[str]:
        """Return all names that can stand in the line."""
        return [*self.names.values(), *self.role_ids, *self.things.values()]

    def thing(self, kind: str, thing_id: str) -> str:
        """Return the name of a device, a place or a zone; one that does not exist any more goes by its id."""
        if (kind, thing_id) not in self.things:
            self.name_thing(kind, thing_id, thing_id)
        return self.things[kind, thing_id]

    def name_thing(self, kind: str, thing_id: str, wanted: str, *, exact: bool = False) -> None:
        """Give a device, a place or a zone its name."""
        taken = self.known_names()
        name = wanted if exact and wanted not in taken else unique_name(wanted, taken)
        self.things[kind, thing_id] = name
        self.scope.bindings[name] = Binding(kind, thing_id)  # type: ignore[arg-type]  # get, place or zone


def make_line_scope(
    document: Mapping[str, object], surroundings: Surroundings, script: str, step: str = ""
) -> LineScope:  # fmt: skip
    """Return the names that a value of a step can use; `script` is the printed document, whose names are kept."""
    line = LineScope(Scope(surroundings))
    _name_variables(line, document, step)
    _name_roles(line, document)
    for name, kind, thing_id in _names_in(script):
        if name not in line.role_ids:
            line.name_thing(kind, thing_id, name, exact=True)
    for kind, thing_id, wanted in _things(document, surroundings):
        if (kind, thing_id) not in line.things:
            line.name_thing(kind, thing_id, wanted)
    line.scope.variables = frozenset(line.names.values())
    robots = frozenset(line.role_ids)
    line.scope.robots = lambda: robots
    return line


def _names_in(script: str) -> Iterator[tuple[str, str, str]]:
    """Yield name, kind and id of what the script's `run` gives to the task."""
    for text in script.splitlines():
        found = _GIVEN.match(text)
        if found is not None:
            yield found[1], found[2], str(ast.literal_eval(found[3]))


def _things(document: Mapping[str, object], surroundings: Surroundings) -> Iterator[tuple[str, str, str]]:
    devices = ((device_id, facts.description.name) for device_id, facts in surroundings.devices.items())
    yield from (("get", device_id, name) for device_id, name in sorted(devices))
    yield from (("place", place.id, place.name) for _, place in sorted(surroundings.places.items()))
    for zone, body in sorted(mapping(document.get("zones")).items()):
        name = mapping(body).get("name")
        yield "zone", zone, name if isinstance(name, str) and name else zone


def _name_roles(line: LineScope, document: Mapping[str, object]) -> None:
    for key, body in mapping(document.get("roles")).items():
        device = mapping(body).get("device")
        if isinstance(device, str) and device:
            line.roles[key] = Located(device=device)
    roles = read_document(document).tree.roles
    line.scope.surroundings = with_crew(line.scope.surroundings, roles)
    for role in roles:
        line.roles[role.id or role.name] = Located(role=role.name)
        line.role_ids[role.name] = role.id or role.name


def _name_variables(line: LineScope, document: Mapping[str, object], step: str) -> None:
    for name, body in _visible(document, step):
        if name in OF_PROBLEM:
            line.scope.locals |= {name}
            line.names[name], line.types[name] = name, TEXT
        elif name and name not in line.names:
            line.names[name] = _variable_name(name, line.names.values())
            kind, unit = normal_type(body.get("type"), body.get("unit"))
            if kind:
                line.types[line.names[name]] = ValueType(plain_type(kind), unit)


def _variable_name(wanted: str, taken: Collection[str]) -> str:
    """Return a variable's name in the line; in a line also a function's name will do, as a call looks otherwise."""
    plain = wanted.isascii() and wanted.isidentifier() and not keyword.iskeyword(wanted)
    return wanted if plain and wanted not in {"self", *taken} else unique_name(wanted, {"self", *taken})


def _visible(document: Mapping[str, object], step: str) -> Iterator[tuple[str, Params]]:
    """Yield the names that a step can see, the nearest first, with what is declared of them."""
    steps = mapping(document.get("steps"))
    above = list(_above(steps, step))
    root = above[-1] if above else ""
    for inner, name in pairwise([step, *above[:-1]]):
        params = mapping(mapping(steps.get(name)).get("params"))
        kind, place = mapping(steps.get(name)).get("kind"), mapping(steps.get(inner)).get("place")
        if kind == "for_each":
            yield _text(params.get("index")), {"type": "number"}
            yield _text(params.get("variable")), {}
        elif kind == "try" and isinstance(place, list | tuple) and len(place) > 1 and place[1] in catches_of(params):
            yield from ((part, {}) for part in OF_PROBLEM)
    function = mapping(mapping(document.get("functions")).get(root))
    listed = function.get("parameters")
    for item in listed if isinstance(listed, list | tuple) else ():
        yield _text(mapping(item).get("name")), mapping(item)
    for key, item in sorted(mapping(document.get("parameters")).items()):
        yield _text(mapping(item).get("name")) or key, mapping(item)
    yield from ((name, {}) for name in _variables(steps, {root, "program", ""}))


def _variables(steps: Mapping[str, object], roots: Iterable[str]) -> list[str]:
    """Return the names that steps of the program, or of the function, set."""
    found: dict[str, None] = {}
    wanted = frozenset(roots)
    for step in sorted(steps):
        body = mapping(steps[step])
        params = mapping(body.get("params"))
        name = params.get(_SETTERS.get(str(body.get("kind")), ""))
        if isinstance(name, str) and name and ([*_above(steps, step)] or [""])[-1] in wanted:
            found[name] = None
    return list(found)


def _above(steps: Mapping[str, object], step: str) -> Iterator[str]:
    """Yield what a step stands in, the innermost first; the last one is no step."""
    seen: set[str] = set()
    while step and step not in seen:
        seen.add(step)
        place = mapping(steps.get(step)).get("place")
        step = str(place[0]) if isinstance(place, list | tuple) and place else ""
        if step:
            yield step


def _text(value: object) -> str:
    return value if isinstance(value, str) else ""

"""What a document that is drawn anew keeps of the one before: everything that the script did not change."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from editor.language.document.outline import PROGRAM, mapping
from editor.language.document.references import with_role_ids
from editor.language.expressions.names import attribute_name
from editor.language.expressions.nodes import Zone
from editor.language.expressions.values import write_value
from editor.language.tree.program import Function, Parameter, Role, Tree
from editor.language.tree.zones import read_zones

Plain = Mapping[str, object]
Names = Mapping[str, str]
"""Names in the script → names in the document."""
_DEFAULT_ROLE = "robot"


def merge_values(raw: Plain, said: Plain, says: Plain) -> dict[str, object]:
    """Return parameters where only what the script says differently is new.

    `raw` is what the document holds, `said` what the script said of it, `says` what the script says now.
    """
    kept = {name: value for name, value in raw.items() if name not in said or _same(said[name], says.get(name))}
    for name, value in says.items():
        if name not in said or not _same(said[name], value):
            kept[name] = _merge_inside(raw.get(name), said.get(name), value) if name == "args" else value
    return kept


def _merge_inside(raw: object, said: object, says: object) -> object:
    return merge_values(mapping(raw), mapping(said), mapping(says))


def without_unknown_names(raw: Plain, said: Plain) -> dict[str, object]:
    """Return parameters without those that name a parameter or variable and of which the script said nothing.

    One that the script needs and says nothing in, such as what is waited for, becomes as empty as it is there.
    """
    known: dict[str, object] = {}
    for name, value in raw.items():
        if '"param"' not in json.dumps(value) or said.get(name) or (name == "args" and name in said):
            known[name] = value
        elif name in said:
            known[name] = said[name]
    inner = {"args": without_unknown_names(mapping(raw["args"]), mapping(said.get("args")))} if "args" in known else {}
    return {**known, **inner}


def _same(first: object, second: object) -> bool:
    return json.dumps(first, sort_keys=True) == json.dumps(second, sort_keys=True)


def document_names(given: object, parameters: Sequence[Parameter]) -> dict[str, str]:
    """Return what the document calls the parameters that a tree has read from it."""
    listed = sorted(given.items()) if isinstance(given, Mapping) else [("", item) for item in _list(given)]
    wanted = dict.fromkeys(_text(mapping(item).get("name")) or str(key) for key, item in listed)
    return {p.name: name for p, name in zip(parameters, filter(None, wanted), strict=False)}


def _list(value: object) -> list[object]:
    return list(value) if isinstance(value, list | tuple) else []


def _text(value: object) -> str:
    return value if isinstance(value, str) else ""


def merge_roles(tree: Tree, before: Tree, old: Plain) -> tuple[dict[str, object], dict[str, str]]:
    """Return the document's roles, and the id of each role by its name in the script; unused roles stay."""
    roles: dict[str, object] = dict(old)
    ids: dict[str, str] = {}
    used = {role.id: role for role in before.roles if role.id}
    resting = {attribute_name(_role_name(key, old), ()): key for key in sorted(old, reverse=True) if key not in used}
    for role in tree.roles:
        former = used.get(role.id) if _may_be_called(role) and role.name not in resting else None
        key = former.id if former else resting.get(role.name) or _free(role.name, {*old, *roles})
        ids[role.name] = key
        if former is None or _choice_of(former) != _choice_of(role):
            same = former.name == role.name if former else key in resting.values()
            binding: dict[str, object] = {"can": list(role.can)} if role.device is None else {"device": role.device}
            if role.where is not None:
                binding["where"] = with_role_ids(write_value(role.where), {"": key})
            roles[key] = {"name": _role_name(key, old) if same else role.name, **binding}
    return roles, ids


def _choice_of(role: Role) -> object:
    """Return all that the document says of a role."""
    return role.name, role.device, role.can, repr(role.where)


def _role_name(key: str, old: Plain) -> str:
    return key if key == _DEFAULT_ROLE else _text(mapping(old.get(key)).get("name")) or key


def _may_be_called(role: Role) -> bool:
    """The default role keeps its name always; under another name it is another role."""
    return (role.id == _DEFAULT_ROLE) == (role.name == _DEFAULT_ROLE)


def _free(wanted: str, taken: set[str]) -> str:
    while wanted in taken:
        wanted = f"{wanted}_"
    return wanted


@dataclass(frozen=True, slots=True)
class Functions:
    """The document's functions; their ids and the names of their parameters by method."""

    document: dict[str, object]
    ids: Mapping[str, str]
    names: Mapping[str, Names]


def merge_functions(tree: Tree, before: Tree, old: Plain, taken: set[str]) -> Functions:
    """Return the functions of a tree as the document has them."""
    functions: dict[str, object] = {}
    ids: dict[str, str] = {}
    names: dict[str, Names] = {}
    for function in tree.functions:
        former = next((item for item in before.functions if item.id and item.id == function.id), None)
        key = function.id if former else _free(function.method, {*functions, *old, *taken, PROGRAM})
        raw = mapping(old.get(key)) if former else {}
        known = document_names(raw.get("parameters"), former.parameters) if former else {}
        ids[function.method] = key
        names[function.method] = known
        functions[key] = _function(function, former, raw, known)
    return Functions(functions, ids, names)


def _function(function: Function, former: Function | None, raw: Plain, known: Names) -> dict[str, object]:
    changed = dict(raw)
    if former is None or former.method != function.method:
        changed["name"] = function.name or function.method
    if former is None or repr(former.parameters) != repr(function.parameters):
        by_name = {_text(mapping(item).get("name")): mapping(item) for item in _list(raw.get("parameters"))}
        old = {p.name: p for p in former.parameters} if former else {}
        changed["parameters"] = [
            _parameter(p, old.get(p.name), by_name.get(known.get(p.name, ""), {})) for p in function.parameters
        ]
    result = (function.result_type, function.result_unit)
    if former is None or (former.result_type, former.result_unit) != result:
        changed.pop("result", None)
        changed.update({"result": {"type": result[0], "unit": result[1]}} if result[0] else {})
    return changed


def merge_parameters(tree: Tree, before: Tree, old: Plain) -> tuple[dict[str, object], Names]:
    """Return the program's parameters as the document has them, and their names there."""
    known = document_names(old, before.parameters)
    former = {p.name: p for p in before.parameters}
    keys: dict[object, str] = {}
    for key, item in sorted(old.items()):
        keys.setdefault(_text(mapping(item).get("name")) or key, key)
    parameters: dict[str, object] = {}
    for parameter in tree.parameters:
        key = keys.get(known.get(parameter.name, ""), parameter.name)
        parameters[key] = _parameter(parameter, former.get(parameter.name), mapping(old.get(key)))
    return parameters, known


def _parameter(parameter: Parameter, former: Parameter | None, raw: Plain) -> dict[str, object]:
    """Return a parameter's definition, which stays as it is where the script says the same of it."""
    if former is not None and _facts(former) == _facts(parameter):
        return dict(raw)
    given = {key: value for key, value in raw.items() if key != "default"}
    body: dict[str, object] = {"name": parameter.name, **given, "type": parameter.type, "unit": parameter.unit}
    return body if parameter.default is None else {**body, "default": parameter.default}


def _facts(parameter: Parameter) -> tuple[str, str, str]:
    return repr(parameter.default), parameter.type, parameter.unit


def merge_zones(zones: Sequence[Zone], old: Plain) -> dict[str, object]:
    """Return the zones of a document; those that no script can draw, and what no script says of others, stay."""
    before = {zone.id: zone for zone in read_zones({"zones": old})}
    now = {zone.id: zone for zone in zones}
    kept = {str(key): body for key, body in old.items() if str(key) not in before or str(key) in now}
    changed = {key: _drawn_zone(zone, mapping(old.get(key))) for key, zone in now.items() if before.get(key) != zone}
    return {**kept, **changed}


def _drawn_zone(zone: Zone, raw: Plain) -> dict[str, object]:
    body = {**raw, "name": zone.name, "rule": zone.rule, "points": [list(point) for point in zone.points]}
    for name in ("speed_m_s", "door"):
        body.pop(name, None)
    speed = {} if zone.speed_m_s is None else {"speed_m_s": zone.speed_m_s}
    return {**body, **speed, **({"door": zone.door} if zone.door else {})}


def with_named_zones(tree: Tree, old: Plain) -> Tree:
    """Return a tree in which the zones that its script only names are those of a document."""
    if not tree.named_zones:
        return tree
    known = {zone.id: zone for zone in read_zones(old) if zone.id in tree.named_zones}
    known.update({zone.id: zone for zone in tree.zones})
    return replace(tree, zones=tuple(known[key] for key in sorted(known)), named_zones=frozenset())

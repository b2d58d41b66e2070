"""A program's document bound to another site: devices and places by what was chosen, the rest as marked holes. Pure.

A hole is a value that is not there, which the checks name at its step. Points, zones and bends of lines are of the map
that they were drawn on: they are holes, or left out, wherever the program goes.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from editor.language.document.outline import mapping
from editor.language.signatures.needs import default_of, find_needs

Chosen = Mapping[str, str | None]
"""What stands for each device and place of before, by its id; None: nothing does."""
Spot = tuple[float, float]


class _Hole:
    """Where nothing stands."""


HOLE: Final = _Hole()
_OF_THE_MAP: Final = ("point", "zone")


def bind_document(
    document: Mapping[str, Any], chosen: Chosen, before: Mapping[str, Spot], after: Mapping[str, Spot]
) -> dict[str, Any]:
    """Return the document for the other site.

    `before` and `after` have where the devices and places of either site are, metres: chips go along with what they
    stand at, and all others as those do on the whole.
    """
    methods = {need.device: need.methods for need in find_needs(document, {}) if need.of == "robot"}
    roles = {name: _role(mapping(role), chosen, methods) for name, role in mapping(document.get("roles")).items()}
    steps = {name: _step(mapping(step), chosen) for name, step in mapping(document.get("steps")).items()}
    bound = {**_bound_parameters(document, chosen), "roles": roles, "steps": steps}
    moved = _shifts(document, chosen, before, after)
    for name, step in steps.items():
        if step.get("pos") is not None:
            step["pos"] = _moved(step["pos"], moved.get(name, moved[""]))
    start = document.get("start_pos")
    return {**document, **bound, "zones": {}, "start_pos": None if start is None else _moved(start, moved[""])}


def _bound_parameters(document: Mapping[str, Any], chosen: Chosen) -> dict[str, Any]:
    """Return the functions and the program's parameters, with defaults of the other site or none."""
    functions = _filled_members(document.get("functions"), chosen)
    for function in functions.values():
        listed = mapping(function).get("parameters")
        if isinstance(listed, list):
            function["parameters"] = [_parameter(each, chosen) for each in listed]
    parameters = _filled_members(document.get("parameters"), chosen)
    return {"functions": functions, "parameters": {name: _parameter(each, chosen) for name, each in parameters.items()}}


def _filled_members(members: Any, chosen: Chosen) -> dict[str, Any]:
    """Return what people have named as they like, each for itself: a parameter called “zone” is no zone."""
    filled = {name: _filled(each, chosen) for name, each in mapping(members).items()}
    return {name: each for name, each in filled.items() if each is not HOLE}


def _parameter(parameter: Any, chosen: Chosen) -> Any:
    """Return a parameter whose default, if it is a device or place, is who was chosen; without one where nobody was."""
    default = default_of(mapping(parameter), "device", "place")
    if default not in chosen:
        return parameter
    other = chosen[default]
    rest = {key: value for key, value in parameter.items() if key != "default"}
    return rest if other is None else {**rest, "default": other}


def _role(role: Mapping[str, Any], chosen: Chosen, methods: Mapping[str, tuple[str, ...]]) -> dict[str, Any]:
    """Return the role bound to who was chosen; where nobody was, for any robot that can what its steps need."""
    device = role.get("device")
    if not isinstance(device, str):
        return dict(role)
    other = chosen.get(device)
    named = {key: value for key, value in role.items() if key != "device"}
    return {**named, "device": other} if other else {**named, "can": list(methods.get(device, ()))}


def _step(step: Mapping[str, Any], chosen: Chosen) -> dict[str, Any]:
    params = {key: value for key, value in mapping(step.get("params")).items() if key != "route"}
    if step.get("kind") == "cover":
        params.pop("zone", None)
    return {**step, "params": _filled(params, chosen)}


def _filled(value: Any, chosen: Chosen) -> Any:
    """Return a value of the other site: an operation with a hole in it is one as a whole, a list goes on without it."""
    if isinstance(value, list):
        return [each for each in (_filled(each, chosen) for each in value) if each is not HOLE]
    if not isinstance(value, Mapping):
        return value
    named = _named(value, chosen)
    if named is not None:
        return named
    if "op" in value and isinstance(value.get("args"), list):
        arguments = [_filled(each, chosen) for each in value["args"]]
        return HOLE if HOLE in arguments else {**value, "args": arguments}
    inner = {key: _filled(each, chosen) for key, each in value.items()}
    if set(value) == {"at"} and inner["at"] is HOLE:
        return HOLE
    return {key: each for key, each in inner.items() if each is not HOLE}


def _named(value: Mapping[str, Any], chosen: Chosen) -> Any:
    """Return what stands for a value that names something of the site before; None where it names nothing."""
    if len(value) == 1 and any(key in value for key in _OF_THE_MAP):
        return HOLE
    for key in ("device", "place"):
        if isinstance(value.get(key), str) and value[key] in chosen:
            other = chosen[value[key]]
            return HOLE if other is None else {**value, key: other}
    reading = value.get("property")
    if isinstance(reading, list) and len(reading) == 2 and isinstance(reading[0], str) and reading[0] in chosen:
        other = chosen[reading[0]]
        return HOLE if other is None else {**value, "property": [other, reading[1]]}
    return None


def _shifts(
    document: Mapping[str, Any], chosen: Chosen, before: Mapping[str, Spot], after: Mapping[str, Spot]
) -> dict[str, Spot]:
    """Return by how much each step's chip moves that stands at something; under no name what all others do."""
    found: dict[str, Spot] = {}
    for name, step in mapping(document.get("steps")).items():
        for key in ("device", "to", "at", "target", "source"):
            at = mapping(mapping(mapping(step).get("params")).get(key))
            here = at.get("device") or at.get("place")
            there = chosen.get(here) if isinstance(here, str) else None
            old, new = before.get(str(here)), after.get(str(there))
            if old is not None and new is not None:
                found[name] = (new[0] - old[0], new[1] - old[1])
                break
    count = len(found) or 1
    whole = (sum(x for x, _ in found.values()) / count, sum(y for _, y in found.values()) / count)
    return {**found, "": whole}


def _moved(pos: Any, by: Spot) -> list[float]:
    return [round(pos[0] + by[0], 2), round(pos[1] + by[1], 2)]

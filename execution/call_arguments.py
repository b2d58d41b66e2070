"""Whether arguments fit what a device says of its method; pure."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from math import isfinite
from typing import Any

from vipo_device.protocol.description import Description, MethodSpec, ParameterSpec

MOST_CHARACTERS = 256
MOST_METRES = 1e6


def find_misfits(
    description: Description, name: str, arguments: Mapping[str, Any], devices: Collection[str], places: Collection[str]
) -> tuple[str, ...]:
    """Return what does not fit, one sentence each; `devices` and `places` are the ids that the site has."""
    method = description.method(name)
    if method is None:
        known = ", ".join(m.name for m in description.methods) or "nothing"
        return (f"{description.name} has no method {name[:64]!r}. It can: {known}.",)
    return tuple(_misfits(method, arguments, {"device": devices, "place": places}))


def _misfits(method: MethodSpec, arguments: Mapping[str, Any], known: Mapping[str, Collection[str]]) -> Iterator[str]:
    for given in arguments:
        if method.parameter(given) is None:
            takes = ", ".join(p.name for p in method.parameters) or "none"
            yield f"{method.name} takes no argument {given[:64]!r}. It takes: {takes}."
    for spec in method.parameters:
        value = arguments.get(spec.name)
        if value is None and spec.required:
            yield f"{spec.name}: give a value, {method.name} needs it."
        elif value is not None and (wrong := _misfit(spec, value, known)):
            yield f"{spec.name}: {wrong}"


def _misfit(spec: ParameterSpec, value: Any, known: Mapping[str, Collection[str]]) -> str:
    match spec.type:
        case "number":
            return _number_misfit(spec, value)
        case "boolean":
            return "" if isinstance(value, bool) else "give true or false."
        case "location":
            return _location_misfit(value)
    if not isinstance(value, str) or not 0 < len(value) <= MOST_CHARACTERS or not value.isprintable():
        return f"give a text of 1 to {MOST_CHARACTERS} characters in one line."
    if spec.options and value not in spec.options:
        return f"choose one of {', '.join(spec.options)}."
    if spec.type in known and value not in known[spec.type]:
        return f"this site has no {spec.type} {value[:64]!r}. Give the id of one that it has."
    return ""


def _number_misfit(spec: ParameterSpec, value: Any) -> str:
    if not _is_number(value):
        return "give a number."
    below = spec.minimum is not None and value < spec.minimum
    above = spec.maximum is not None and value > spec.maximum
    if not below and not above:
        return ""
    unit = f" {spec.unit}" if spec.unit else ""
    if spec.minimum is not None and spec.maximum is not None:
        return f"give a number from {spec.minimum:g} to {spec.maximum:g}{unit}, not {value:g}."
    if below:
        return f"give a number of at least {spec.minimum:g}{unit}, not {value:g}."
    return f"give a number of at most {spec.maximum:g}{unit}, not {value:g}."


def _location_misfit(value: Any) -> str:
    fits = isinstance(value, list) and len(value) in (2, 3, 4) and all(_is_number(v) for v in value)
    if fits and all(abs(v) <= MOST_METRES for v in value):
        return ""
    return "give [x, y] in metres, with z and theta if they matter."


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value)

"""Whether a command's arguments fit its method: as a device refuses them, and as a caller is told before; pure."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from math import isfinite
from typing import Any, Literal, TypeGuard

from vipo_device.protocol.description import Description, MethodSpec, ParameterSpec
from vipo_device.protocol.texts import find_unfit
from vipo_device.protocol.units import UNITS, unit_code

MOST_CHARACTERS = 256
MOST_METRES = 1e6
MOST_WHOLE = 2**53
"""Whole numbers beyond are not the same to every reader of JSON."""
Misfit = Literal["", "number", "low", "high", "boolean", "text", "option"]


def is_number(value: object) -> TypeGuard[int | float]:
    """Tell whether the value is a finite number, no whole one that is too large for JSON, and no truth value."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    return isfinite(value) if isinstance(value, float) else abs(value) <= MOST_WHOLE


def lasting_s(spec: ParameterSpec, value: object) -> float | None:
    """Return how many seconds of work a parameter's value stands for; None where it does not say.

    That is a number in a unit of time, and one called `time` without a unit, which is in minutes.
    """
    unit = UNITS.get(unit_code(spec.unit) if spec.unit or spec.name != "time" else "MIN")
    if unit is None or unit.dimension != "time" or not is_number(value):
        return None
    return max(0.0, value * unit.factor)


def refusal_of_arguments(method: MethodSpec, arguments: Mapping[str, object]) -> str:
    """Return why a device does not take the arguments, or an empty text; those that it does not know are ignored."""
    for spec, value in _given(method, arguments):
        if value is None:
            return f"{method.name} needs a value for {spec.name}."
        if misfit := _misfit(spec, value):
            return f"{method.name}: {spec.name} {_must(spec, value, misfit)}."
    return ""


def find_misfits(
    description: Description, name: str, arguments: Mapping[str, Any], devices: Collection[str], places: Collection[str]
) -> tuple[str, ...]:
    """Return what a caller has to mend, one sentence each; `devices` and `places` are the ids that the site has."""
    method = description.method(name)
    if method is None:
        known = ", ".join(m.name for m in description.methods) or "nothing"
        return (f"{description.name} has no method {name[:64]!r}. It can: {known}.",)
    return tuple(_faults_of_call(method, arguments, {"device": devices, "place": places}))


def _given(method: MethodSpec, arguments: Mapping[str, object]) -> Iterator[tuple[ParameterSpec, object]]:
    """Yield the parameters that have a value, and with None those that need one and have none."""
    for spec in method.parameters:
        value = arguments.get(spec.name)
        if value is not None or spec.required:
            yield spec, value


def _misfit(spec: ParameterSpec, value: object) -> Misfit:
    """Return in what a value does not fit; a place and a location may be anything here, as devices read them."""
    if spec.type == "number":
        return _number_misfit(spec, value)
    if spec.type == "boolean":
        return "" if isinstance(value, bool) else "boolean"
    if spec.type in {"text", "object", "device"} and not isinstance(value, str):
        return "text"
    return "option" if spec.options and value not in spec.options else ""


def _number_misfit(spec: ParameterSpec, value: object) -> Misfit:
    if not is_number(value):
        return "number"
    if spec.minimum is not None and value < spec.minimum:
        return "low"
    return "high" if spec.maximum is not None and value > spec.maximum else ""


def _must(spec: ParameterSpec, value: object, misfit: Misfit) -> str:
    """Return what a device says of a value that does not fit."""
    match misfit:
        case "low":
            return f"must be at least {spec.minimum:.15g}, not {value:.15g}"
        case "high":
            return f"must be at most {spec.maximum:.15g}, not {value:.15g}"
        case "boolean":
            return "must be true or false"
        case "option":
            return f"must be one of {', '.join(spec.options)}"
    return f"must be a {misfit}"


def _faults_of_call(
    method: MethodSpec, arguments: Mapping[str, Any], known: Mapping[str, Collection[str]]
) -> Iterator[str]:
    for given in arguments:
        if method.parameter(given) is None:
            takes = ", ".join(p.name for p in method.parameters) or "none"
            yield f"{method.name} takes no argument {given[:64]!r}. It takes: {takes}."
    for spec, value in _given(method, arguments):
        if value is None:
            yield f"{spec.name}: give a value, {method.name} needs it."
        elif wrong := _mend(spec, value, known):
            yield f"{spec.name}: {wrong}"


def _mend(spec: ParameterSpec, value: Any, known: Mapping[str, Collection[str]]) -> str:
    """Return what a caller is told of a value that does not fit; empty when it does."""
    if spec.type == "location":
        return "" if _is_location(value) else "give [x, y] in metres, with z and theta if they matter."
    if spec.type not in {"number", "boolean"} and not _is_line(value):
        return f"give a text of 1 to {MOST_CHARACTERS} characters in one line."
    match _misfit(spec, value):
        case "":
            is_known = spec.type not in known or value in known[spec.type]
            return "" if is_known else f"this site has no {spec.type} {value[:64]!r}. Give the id of one that it has."
        case "number":
            return f"give a number{f' in {spec.unit}' if spec.unit else ''}."
        case "boolean":
            return "give true or false."
        case "option":
            return f"choose one of {', '.join(spec.options)}."
    return f"give a number {_range(spec)}, not {value:.15g}."


def _range(spec: ParameterSpec) -> str:
    unit = f" {spec.unit}" if spec.unit else ""
    if spec.minimum is not None and spec.maximum is not None:
        return f"from {spec.minimum:.15g} to {spec.maximum:.15g}{unit}"
    if spec.minimum is not None:
        return f"of at least {spec.minimum:.15g}{unit}"
    return f"of at most {spec.maximum:.15g}{unit}"


def _is_line(value: object) -> bool:
    return isinstance(value, str) and 0 < len(value) <= MOST_CHARACTERS and not find_unfit(value, is_line=True)


def _is_location(value: object) -> bool:
    fits = isinstance(value, list) and len(value) in (2, 3, 4) and all(is_number(v) for v in value)
    return fits and all(abs(v) <= MOST_METRES for v in value)  # type: ignore[attr-defined]

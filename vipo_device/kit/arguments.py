"""Do a command's arguments fit what the device says it can do?"""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite

from vipo_device.protocol.description import MethodSpec, ParameterSpec

SECONDS = {"MIN": 60.0, "SEC": 1.0, "S": 1.0, "HR": 3600.0, "MilliSEC": 0.001, "": 60.0}
DEFAULT_DURATION_S = 2.0
CountedObject = tuple[str, int]


def is_number(value: object) -> bool:
    """Tell whether the value is a finite number and not a truth value."""
    return isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value)


def refusal_of_arguments(method: MethodSpec, arguments: Mapping[str, object]) -> str:
    """Return why the arguments do not fit, or an empty text; arguments that the method does not name are ignored."""
    for parameter in method.parameters:
        value = arguments.get(parameter.name)
        if value is None:
            if parameter.required:
                return f"{method.name} needs a value for {parameter.name}."
            continue
        if why := _misfit(parameter, value):
            return f"{method.name}: {parameter.name} {why}."
    return ""


def _misfit(parameter: ParameterSpec, value: object) -> str:
    if parameter.type == "number":
        return _number_misfit(parameter, value)
    if parameter.type == "boolean":
        return "" if isinstance(value, bool) else "must be true or false"
    if parameter.type in {"text", "object", "device"} and not isinstance(value, str):
        return "must be a text"
    if parameter.options and value not in parameter.options:
        return f"must be one of {', '.join(parameter.options)}"
    return ""


def _number_misfit(parameter: ParameterSpec, value: object) -> str:
    if not isinstance(value, int | float) or not is_number(value):
        return "must be a number"
    if parameter.minimum is not None and value < parameter.minimum:
        return f"must be at least {parameter.minimum:g}, not {value:g}"
    if parameter.maximum is not None and value > parameter.maximum:
        return f"must be at most {parameter.maximum:g}, not {value:g}"
    return ""


def duration_s(method: MethodSpec, arguments: Mapping[str, object]) -> float:
    """Return how long the method takes: its argument `time` (minutes unless it says otherwise), else 2 s."""
    for parameter in method.parameters:
        value = arguments.get(parameter.name)
        lasts = parameter.name == "time" or (bool(parameter.unit) and parameter.unit in SECONDS)
        if lasts and isinstance(value, int | float) and is_number(value):
            return max(0.0, float(value)) * SECONDS.get(parameter.unit, 60.0)
    return DEFAULT_DURATION_S


def counted_object(arguments: Mapping[str, object]) -> CountedObject | str:
    """Read `object` and `value` (1 if absent); a text says why they cannot be read."""
    name, count = arguments.get("object"), arguments.get("value", 1)
    if not isinstance(name, str) or not name:
        return "An object must be named."
    if not isinstance(count, int | float) or not is_number(count) or count != int(count) or count < 1:
        return "The quantity must be a whole number of at least 1."
    return name, int(count)


def read_path(arguments: Mapping[str, object]) -> list[tuple[float, float]] | str:
    """Read `path` of a move in metres; a text says why it cannot be read."""
    path = arguments.get("path")
    if not isinstance(path, list | tuple) or not path:
        return "move needs a path: a list of [x, y] in metres."
    points = []
    for point in path:
        if not isinstance(point, list | tuple) or len(point) != 2 or not all(is_number(c) for c in point):
            return "Each point of a path must be [x, y] in metres."
        points.append((float(point[0]), float(point[1])))
    return points

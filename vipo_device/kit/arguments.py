"""Reading the arguments of the commands that many devices have: a move, objects to handle, and how long work takes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import hypot

from vipo_device.protocol.arguments import is_number, lasting_s
from vipo_device.protocol.description import MethodSpec

ASTRAY_M = 0.6
"""How far from the end of its path a robot's next move may begin."""
CountedObject = tuple[str, int]
Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Move:
    """A path in metres, how to face at its end (rad), how fast to drive at most (m/s), and where it has to begin.

    None leaves it to the robot.
    """

    path: tuple[Point, ...]
    theta: float | None
    speed_m_s: float | None
    begin: Point | None


def read_move(arguments: Mapping[str, object]) -> Move | str:
    """Read a move's arguments; a text says why they cannot be read."""
    path = read_path(arguments)
    if isinstance(path, str):
        return path
    theta, speed, begin = (arguments.get(name) for name in ("theta", "speed", "from"))
    if theta is not None and not is_number(theta):
        return "theta must be a number in radians."
    if speed is not None and not (is_number(speed) and speed > 0):
        return "speed must be a number above 0, in metres a second."
    first = [] if begin is None else read_path({"path": [begin]})
    if isinstance(first, str):
        return "from must be a point [x, y] in metres."
    heading, limit = (float(n) if is_number(n) else None for n in (theta, speed))
    return Move(tuple(path), heading, limit, next(iter(first), None))


def read_path(arguments: Mapping[str, object]) -> list[Point] | str:
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


def why_astray(name: str, begin: Point | None, here: Point | None) -> str:
    """Return why a path that begins elsewhere is not driven: to get there straight on may lead through walls."""
    if begin is None:
        return ""
    if here is None:
        return f"{name} does not know where it is."
    away_m = hypot(begin[0] - here[0], begin[1] - here[1])
    return f"The way begins {away_m:.1f} m from where {name} will be." if away_m > ASTRAY_M else ""


def duration_s(method: MethodSpec, arguments: Mapping[str, object]) -> float | None:
    """Return how many seconds a call's arguments say that it takes: what the first says that says so; None if none."""
    said = (lasting_s(spec, arguments.get(spec.name)) for spec in method.parameters)
    return next((seconds for seconds in said if seconds is not None), None)


def counted_object(arguments: Mapping[str, object]) -> CountedObject | str:
    """Read `object` and `value` (1 if absent); a text says why they cannot be read."""
    name, count = arguments.get("object"), arguments.get("value", 1)
    if not isinstance(name, str) or not name:
        return "An object must be named."
    if not is_number(count) or count != int(count) or count < 1:
        return "The quantity must be a whole number of at least 1."
    return name, int(count)

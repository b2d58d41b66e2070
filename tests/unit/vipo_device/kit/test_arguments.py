"""Reading the arguments of commands."""

from __future__ import annotations

from typing import Any

import pytest

from vipo_device.kit.arguments import Move, counted_object, duration_s, read_move, why_astray
from vipo_device.protocol.description import MethodSpec, ParameterSpec


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        ({"path": [[1, 2]]}, Move(((1.0, 2.0),), None, None, None)),
        (
            {"path": [[0, 0], [1, 2]], "theta": 3, "speed": 0.5, "from": [0, 1]},
            Move(((0.0, 0.0), (1.0, 2.0)), 3.0, 0.5, (0.0, 1.0)),
        ),
        ({}, "move needs a path: a list of [x, y] in metres."),
        ({"path": [[1, True]]}, "Each point of a path must be [x, y] in metres."),
        ({"path": [[1, float("inf")]]}, "Each point of a path must be [x, y] in metres."),
        ({"path": [[1, 2]], "theta": "north"}, "theta must be a number in radians."),
        ({"path": [[1, 2]], "speed": 0}, "speed must be a number above 0, in metres a second."),
        ({"path": [[1, 2]], "from": [1]}, "from must be a point [x, y] in metres."),
    ],
)
def test_a_move_is_read_or_refused(arguments: dict[str, Any], expected: Move | str) -> None:
    assert read_move(arguments) == expected


def test_a_path_has_to_begin_where_the_robot_will_be() -> None:
    assert why_astray("Robo", None, None) == ""
    assert why_astray("Robo", (0.0, 0.0), (0.6, 0.0)) == ""
    assert why_astray("Robo", (0.0, 0.0), (3.0, 4.0)) == "The way begins 5.0 m from where Robo will be."
    assert why_astray("Robo", (0.0, 0.0), None) == "Robo does not know where it is."


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        ({"object": "box"}, ("box", 1)),
        ({"object": "box", "value": 2.0}, ("box", 2)),
        ({"object": ""}, "An object must be named."),
        ({"object": "box", "value": 1.5}, "The quantity must be a whole number of at least 1."),
        ({"object": "box", "value": True}, "The quantity must be a whole number of at least 1."),
    ],
)
def test_objects_are_counted(arguments: dict[str, Any], expected: tuple[str, int] | str) -> None:
    assert counted_object(arguments) == expected


@pytest.mark.parametrize(
    ("name", "unit", "value", "expected"),
    [
        ("time", "MIN", 2, 120.0),
        ("time", "", 2, 120.0),
        ("cure", "", 2, None),
        ("cure", "SEC", 7, 7.0),
        ("cure", "MilliSEC", 7, 0.007),
        ("time", "DAY", 2, 172_800.0),
        ("cure", "d", 2, 172_800.0),
        ("cure", "DEG_C", 7, None),
        ("time", "DEG_C", 7, None),
        ("time", "MIN", -2, 0.0),
        ("time", "MIN", "2", None),
    ],
)
def test_a_duration_is_the_time_that_a_method_is_given(
    name: str, unit: str, value: float, expected: float | None
) -> None:
    method = MethodSpec("m", "topic", "", "", (ParameterSpec(name, "number", unit),))
    assert duration_s(method, {name: value}) == expected

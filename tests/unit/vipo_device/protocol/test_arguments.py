"""The same arguments, as a device refuses them and as a caller is told before."""

from __future__ import annotations

from typing import Any

import pytest

from vipo_device.protocol.arguments import find_misfits, refusal_of_arguments
from vipo_device.protocol.description import Description, MethodSpec, ParameterSpec, Pose, Size

METHOD = MethodSpec(
    "paint",
    "topic",
    "",
    "Paint",
    (
        ParameterSpec("time", "number", "MIN", 1.0, 30.0),
        ParameterSpec("least", "number", minimum=1.0, required=False),
        ParameterSpec("most", "number", "BAR", maximum=2.0, required=False),
        ParameterSpec("colour", "text", options=("red", "green"), required=False),
        ParameterSpec("dry", "boolean", required=False),
        ParameterSpec("from", "device", required=False),
        ParameterSpec("to", "location", required=False),
    ),
)
BOOTH = Description("booth", "Booth", "machine", "booth", Pose(0, 0), Size(1, 1, 1), methods=(METHOD,))


@pytest.mark.parametrize(
    ("arguments", "refusal", "misfit"),
    [
        ({"time": 2}, "", ""),
        ({}, "paint needs a value for time.", "time: give a value, paint needs it."),
        ({"time": "2"}, "paint: time must be a number.", "time: give a number in MIN."),
        (
            {"time": 0.5},
            "paint: time must be at least 1, not 0.5.",
            "time: give a number from 1 to 30 MIN, not 0.5.",
        ),
        ({"time": 31}, "paint: time must be at most 30, not 31.", "time: give a number from 1 to 30 MIN, not 31."),
        (
            {"time": 1234567.5},
            "paint: time must be at most 30, not 1234567.5.",
            "time: give a number from 1 to 30 MIN, not 1234567.5.",
        ),
        (
            {"time": 2, "least": 0},
            "paint: least must be at least 1, not 0.",
            "least: give a number of at least 1, not 0.",
        ),
        (
            {"time": 2, "most": 3},
            "paint: most must be at most 2, not 3.",
            "most: give a number of at most 2 BAR, not 3.",
        ),
        ({"time": 2, "dry": 1}, "paint: dry must be true or false.", "dry: give true or false."),
        (
            {"time": 2, "colour": 3},
            "paint: colour must be a text.",
            "colour: give a text of 1 to 256 characters in one line.",
        ),
        (
            {"time": 2, "colour": "blue"},
            "paint: colour must be one of red, green.",
            "colour: choose one of red, green.",
        ),
        ({"time": 2, "from": "shelf"}, "", ""),
        (
            {"time": 2, "from": "nowhere"},
            "",
            "from: this site has no device 'nowhere'. Give the id of one that it has.",
        ),
        ({"time": 2, "to": [1, 2]}, "", ""),
        ({"time": 2, "to": "there"}, "", "to: give [x, y] in metres, with z and theta if they matter."),
        (
            {"time": 2, "speed": 1},
            "",
            "paint takes no argument 'speed'. It takes: time, least, most, colour, dry, from, to.",
        ),
    ],
)
def test_arguments_are_refused_by_the_device_and_mended_by_the_caller(
    arguments: dict[str, Any], refusal: str, misfit: str
) -> None:
    assert refusal_of_arguments(METHOD, arguments) == refusal
    assert find_misfits(BOOTH, "paint", arguments, ["shelf"], []) == ((misfit,) if misfit else ())


def test_a_method_that_a_device_does_not_have_is_named_with_those_it_has() -> None:
    assert find_misfits(BOOTH, "fly", {}, [], []) == ("Booth has no method 'fly'. It can: paint.",)

"""What a device is doing, in a code with arguments and in English."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from registry.devices.activity import Activity, Seen, activity_of
from vipo_device.protocol.description import Description, Pose, Size

MIXER = Description("mixer", "Mixer", "machine", "mixer", Pose(0, 0), Size(1, 1, 1), gives=("box",))
SHELF = replace(MIXER, gives=("pot", "vase"))
ROBOT = replace(MIXER, kind="robot", gives=())


@pytest.mark.parametrize(
    ("device", "facts", "expected"),
    [
        (MIXER, {"readings": {"error": "Lid open"}}, Activity("said", "Lid open", {"text": "Lid open"})),
        (
            ROBOT,
            {"carrying": {"can": 2, "box": 1}},
            Activity("carrying", "Carrying 1 box, 2 cans", {"box": 1, "can": 2}),
        ),
        (
            MIXER,
            {"done": False, "readings": {"jobStatus": 74.6}},
            Activity("working_percent", "Working, 75 %", {"percent": 75}),
        ),
        (MIXER, {"done": False}, Activity("working", "Working")),
        (ROBOT, {"done": False}, Activity("driving", "Driving")),
        (MIXER, {"readings": {"stock": 3}}, Activity("stock", "3 boxes", {"count": 3, "object": "box"})),
        (SHELF, {"readings": {"stock": 12}}, Activity("objects", "12 objects", {"count": 12})),
        (ROBOT, {"readings": {"stock": 1}}, Activity("objects", "1 object", {"count": 1})),
        (MIXER, {"readings": {"freeSlots": 2}}, Activity("slots", "2 slots free", {"count": 2})),
        (MIXER, {}, Activity("ready", "Ready")),
    ],
)
def test_what_a_device_is_doing(device: Description, facts: dict[str, Any], expected: Activity) -> None:
    seen = Seen(**{"description": device, "readings": {}, "carrying": {}, "done": True, **facts})
    assert activity_of(seen) == expected

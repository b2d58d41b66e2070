"""What of a device's readings a rehearsal begins with."""

from __future__ import annotations

from dataclasses import replace

import pytest

from execution.rehearsals.beginnings import beginning_readings
from registry.devices.views import DeviceView
from tests.kit import demo_floor
from vipo_device.protocol.description import PropertySpec

SHOWN = {"battery": 41, "load": "box:1", "state": "driving", "speed": 0.4, "motor": 55.0}
DESCRIBED = (
    PropertySpec("battery", "number", "PERCENT", 0, 100),
    PropertySpec("load", "text"),
    PropertySpec("state", "text", options=("idle", "driving")),
    PropertySpec("speed", "number", "M-PER-SEC"),
    PropertySpec("motor", "number", "DEG_F"),
)


@pytest.mark.parametrize(("done", "kept"), [(True, SHOWN.keys()), (False, {"battery", "load", "motor"})])
def test_a_robot_at_work_begins_with_what_stays_when_its_work_is_over(done: bool, kept: set[str]) -> None:
    like = next(device for device in demo_floor.devices() if device.kind == "robot")
    robot = replace(like, properties=DESCRIBED)
    view = DeviceView(robot.id, "hall", robot, "approved", online=True, done=done, command="", boot=1, readings=SHOWN)
    assert beginning_readings(view) == {name: SHOWN[name] for name in kept}

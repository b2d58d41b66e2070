"""What may be written behind the names of a line: the readings of devices, and of robots that roles may have."""

from dataclasses import replace

import pytest

from editor.programs.one_line import read_expression
from editor.services import create_program
from registry import services as registry
from registry.models import Device, Site
from tests.kit import demo_floor
from vipo_device.protocol.description import PropertySpec, description_to_json

pytestmark = pytest.mark.django_db
CHARGE = PropertySpec("battery", "number", "PERCENT", 0, 100)
SLIP = PropertySpec("wheel slip", "number"), PropertySpec("wheelSlip", "number")


def test_behind_a_role_stands_what_the_robots_report_that_may_have_it() -> None:
    registry.create_site(name="Hall", slug="line-hall")
    site = Site.objects.get(slug="line-hall")
    reported = {"robot01": (CHARGE,), "robot02": (CHARGE, *SLIP)}
    for device in demo_floor.devices():
        if device.id in reported:
            said = description_to_json(replace(device, properties=reported[device.id]))
            Device.objects.create(id=device.id, site=site, lifecycle="approved", description=said, online=True)
    step = {"kind": "move", "place": ["program", "body", "1"], "pos": [0, 0], "params": {"role": "robot"}}
    document = {"format": 2, "start_pos": [0, 0], "steps": {"s": step}}
    program = create_program(site="line-hall", name="Robots", document=document)
    view = read_expression(program_id=program.id, text="robot.battery", names=True)
    assert (view.value, view.type, view.unit) == ({"property": [{"role": "robot"}, "battery"]}, "number", "PERCENT")
    (robot,) = (each for each in view.names if each.kind == "robot")
    assert [(each.name, each.written) for each in robot.properties] == [
        ("battery", "battery"),
        ("wheel slip", 'read("wheel slip")'),
        ("wheelSlip", 'read("wheelSlip")'),
    ]

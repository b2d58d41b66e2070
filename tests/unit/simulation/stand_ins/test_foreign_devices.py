"""Stand-ins of devices that are not the demo's: of sites from the field, and of whatever a description can say."""

from __future__ import annotations

import json
from dataclasses import fields
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given, settings

from simulation.stand_ins.shared_connection import SharedConnection
from simulation.stand_ins.stand_in import StandIn, StandInFacts
from tests.kit.files import ROOT
from tests.unit.simulation.stand_ins.test_stand_in import Broker, kinematic
from tests.unit.vipo_device.descriptions.examples import descriptions
from vipo_device.protocol.description import Description, description_from_json

NAMES = {field.name for field in fields(Description)}
SITES = {
    path.stem: [
        description_from_json({name: value for name, value in each.items() if name in NAMES})
        for each in json.loads(path.read_text())["devices"]
    ]
    for path in sorted((ROOT / "examples" / "field").glob("*.json"))
    if "devices" in json.loads(path.read_text())
}
ARGUMENTS = {"time": 1, "object": "box", "value": 1, "path": [[0.0, 0.0], [0.5, 0.0]]}


def play(device: Description, others: list[Description], folder: Path) -> Broker:
    """Tell a stand-in each of its device's methods in turn, and let time pass."""
    machines = [each for each in others if each.kind == "machine" and each.id != device.id]
    broker, now = Broker(), 1.0
    connection = SharedConnection(broker)
    stand_in = StandIn(StandInFacts(device.site, device, machines), connection, kinematic, folder / "memory.json", 60.0)
    stand_in.connect(now)
    for number, method in enumerate(device.methods):
        body = json.dumps({"id": f"c{number}", "v": ARGUMENTS, "ttl_s": 60}).encode()
        connection.hear(f"vipo/v1/sim/{device.id}/down/{method.name}", body, retained=False)
        for _ in range(10):
            now += 0.2
            stand_in.advance(now)
    stand_in.leave()
    return broker


@pytest.mark.parametrize("site", SITES)
def test_every_device_of_a_site_from_the_field_is_there_and_answers(site: str, tmp_path: Path) -> None:
    for number, device in enumerate(SITES[site]):
        (tmp_path / str(number)).mkdir()
        broker = play(device, SITES[site], tmp_path / str(number))
        assert broker.state()["boot"] == 0
        for each in range(len(device.methods)):
            assert broker.answers(f"c{each}"), f"{device.id} says nothing to {device.methods[each].name}"


@settings(max_examples=60, deadline=None)
@given(descriptions())
def test_whatever_describes_itself_can_be_played(device: Description) -> None:
    with TemporaryDirectory() as folder:
        assert play(device, [], Path(folder)).said

"""What the connector takes in, and how it is started."""

from __future__ import annotations

from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest
from django.core.management.base import CommandError

from connectors.management.commands.vda5050 import make_fleet, read_origin, vehicle_client
from connectors.vda5050.control import VehicleControl
from connectors.vda5050.coordinates import Frame
from connectors.vda5050.fleet import MOST_VEHICLES, MOST_WAITING_EACH, STRANGERS, Fleet, VehicleMessage
from connectors.vda5050.messages import VehicleName
from connectors.vda5050.vehicle_device import Setting
from tests.unit.connectors.vehicle import HEADER, NAME, STATE, make_vehicle, payload
from vipo_device.kit.connection import CommandReceived
from vipo_device.protocol.messages import AckMessage, DeviceCommand
from vipo_device.protocol.mqtt_client import MISSES_TOLD, MqttClient


@pytest.fixture
def fleet(tmp_path: Path) -> Fleet:
    """Return a connector that is not connected to anything."""
    never: Callable[..., Any] = lambda *_: None  # noqa: E731 - nothing is to connect
    at = datetime(2026, 1, 1, tzinfo=UTC)
    setting = Setting("hall", Frame(), "floor", tmp_path, never, lambda plain: plain, lambda: "id", lambda: at)
    client = MqttClient(host="127.0.0.1", port=1, username="", password="", client_id="fleet")
    return Fleet(client, "uagv", setting)


def connection(name: VehicleName) -> VehicleMessage:
    header = {**HEADER, "manufacturer": name.manufacturer, "serialNumber": name.serial_number}
    return VehicleMessage(name, "connection", payload(header, connectionState="ONLINE"))


def test_strangers_are_heard_only_when_they_say_that_they_are_connected(fleet: Fleet) -> None:
    fleet._take(VehicleMessage(NAME, "state", b"{}"), 0.0)
    fleet._take(VehicleMessage(NAME, "connection", b"{}"), 0.0)
    assert (dict(fleet.refused), fleet._devices) == ({STRANGERS: 1}, {})
    fleet._take(connection(NAME), 0.0)
    fleet._take(VehicleMessage(NAME, "state", b"{}"), 0.0)
    assert (dict(fleet.refused), list(fleet._devices)) == ({STRANGERS: 1, "Acme-1": 1}, ["Acme-1"])


def test_the_log_names_a_stranger_that_is_not_understood(fleet: Fleet, caplog: pytest.LogCaptureFixture) -> None:
    old = payload({**HEADER, "version": "1.1.0"}, connectionState="ONLINE")
    fleet._take(VehicleMessage(NAME, "connection", old), 0.0)
    assert caplog.messages == ["strangers, here 'Acme/1': connection/version must be 2.0 or 2.1. (1 refused so far)"]


def test_who_has_been_a_device_is_known_by_its_state(fleet: Fleet, tmp_path: Path) -> None:
    (tmp_path / "Acme-1.json").write_text("{}")
    fleet._take(VehicleMessage(NAME, "visualization", payload(STATE)), 0.0)
    fleet._take(VehicleMessage(NAME, "state", b"{}"), 0.0)
    fleet._take(VehicleMessage(VehicleName("Acme", "2"), "state", payload(STATE, serialNumber="2")), 0.0)
    assert (dict(fleet.refused), fleet._devices) == ({STRANGERS: 1}, {})
    fleet._take(VehicleMessage(NAME, "state", payload(STATE)), 0.0)
    assert list(fleet._devices) == ["Acme-1"]


def test_a_connector_serves_two_hundred_vehicles(fleet: Fleet) -> None:
    for number in range(MOST_VEHICLES + 5):
        fleet._take(connection(VehicleName("Acme", f"{number}")), 0.0)
    assert len(fleet._devices) == MOST_VEHICLES
    assert dict(fleet.refused) == {STRANGERS: 5}


def test_a_vehicle_that_says_too_much_is_not_heard_at_the_others_expense(fleet: Fleet) -> None:
    for _ in range(MOST_WAITING_EACH + 300):
        fleet._hear("uagv/v2/Acme/1/state", b"{}", False)
    fleet._hear("uagv/v2/Acme/2/state", b"{}", False)
    assert fleet._inbox.qsize() == MOST_WAITING_EACH + 1
    for _ in range(MOST_WAITING_EACH):
        fleet._take(fleet._inbox.get(), 0.0)
    fleet._hear("uagv/v2/Acme/1/state", b"{}", False)
    assert fleet._inbox.qsize() == 2


def test_names_that_cannot_be_names_are_not_heard(fleet: Fleet) -> None:
    for name in ("", "a" * 65, "$SYS", "a\x00b"):
        fleet._hear(f"uagv/v2/Acme/{name}/state", b"{}", False)
    assert fleet._inbox.qsize() == 0


def test_the_command_says_what_cannot_be() -> None:
    assert read_origin("1,-2.5,0.1") == Frame(1.0, -2.5, 0.1)
    with pytest.raises(CommandError, match=r"^--origin '1,2' is not x,y,theta"):
        read_origin("1,2")
    with pytest.raises(CommandError, match=r"^--origin 'nan,0,0' is not x,y,theta"):
        read_origin("nan,0,0")
    with pytest.raises(CommandError, match=r"^--broker 'mqtt://host:abc' is not the vehicles' broker"):
        vehicle_client("mqtt://host:abc", "", "id")
    with pytest.raises(CommandError, match=r"^--broker '' is not the vehicles' broker; say mqtt://host:1883"):
        vehicle_client("", "", "id")
    with pytest.raises(CommandError, match=r"^--site and --interface must be words"):
        make_fleet({"site": "a/b", "interface": "uagv"})


def test_the_log_says_once_that_a_broker_is_not_reached(caplog: pytest.LogCaptureFixture) -> None:
    client = vehicle_client("mqtt://127.0.0.1:9", "", "vipo-hall")
    for _ in range(MISSES_TOLD + 2):
        client._missed(client._paho, None)
    assert caplog.messages == ["vipo-hall does not reach the MQTT broker at 127.0.0.1:9; it goes on trying."]


def test_a_fault_with_one_call_rejects_it_and_ends_nobody(
    fleet: Fleet, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    fleet._take(connection(NAME), 0.0)
    device = fleet._devices["Acme-1"]
    device.control = VehicleControl(make_vehicle(), lambda: "id")
    monkeypatch.setattr(device.control, "_take_on", lambda _: 1 / 0)
    fleet._take(CommandReceived("Acme-1", DeviceCommand("c1", "noop", {})), 1.0)
    (answer,) = (each for each in device.control.out if isinstance(each, AckMessage))
    assert (answer.command, answer.status) == ("c1", "REJECTED")
    assert caplog.messages == ["Acme-1: the call of noop failed in the connector."]

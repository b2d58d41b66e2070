"""One vehicle as it comes, goes and comes back."""

from __future__ import annotations

import json
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest

from connectors.vda5050.connection_state import ASK_S, PATIENCE_S
from connectors.vda5050.control import Send
from connectors.vda5050.coordinates import Frame
from connectors.vda5050.vehicle_device import Setting, VehicleDevice
from tests.integration.connectors.factsheet import FACTSHEET
from tests.unit.connectors.vehicle import HEADER, NAME, STATE, payload
from vipo_device.kit.connection import Will, leave
from vipo_device.protocol.messages import BadMessage
from vipo_device.protocol.mqtt_client import MqttClient


def away(device: str, will: Will) -> MqttClient:
    """Return a connection to a broker that is not there."""
    return MqttClient(host="127.0.0.1", port=1, username=device, password="", client_id=device, will=will)


@pytest.fixture
def asked() -> list[tuple[str, Any]]:
    """Return what the vehicle is sent: topic and message."""
    return []


@pytest.fixture
def setting(tmp_path: Path) -> Setting:
    at = datetime(2026, 1, 1, tzinfo=UTC)
    return Setting("hall", Frame(), "floor", tmp_path, away, lambda plain: plain, lambda: "id", lambda: at)


@pytest.fixture
def member(setting: Setting, asked: list[tuple[str, Any]]) -> Iterator[VehicleDevice]:
    member = VehicleDevice(
        NAME, setting, lambda _, topic, body: asked.append((topic, json.loads(body))), lambda _: None
    )
    yield member
    leave([member.connection] if member.connection else [])


def say(member: VehicleDevice, subtopic: str, now_s: float, **body: Any) -> None:
    member.hear(subtopic, payload(HEADER, **body), now_s)


def come(member: VehicleDevice, now_s: float) -> None:
    say(member, "connection", now_s, connectionState="ONLINE")
    say(member, "factsheet", now_s, **FACTSHEET)
    say(member, "state", now_s, **STATE)
    assert member.control is not None


def test_a_vehicle_that_says_again_and_again_that_it_is_connected_stays_online(member: VehicleDevice) -> None:
    come(member, 100.0)
    say(member, "connection", 101.0, connectionState="ONLINE")
    assert member.control is not None
    assert member.control.online
    say(member, "connection", 102.0, connectionState="CONNECTIONBROKEN")
    assert not member.control.online


def test_a_vehicle_that_starts_anew_with_a_clock_that_is_not_set_is_heard(member: VehicleDevice) -> None:
    come(member, 100.0)
    early = {"headerId": 0, "timestamp": "1970-01-01T00:00:05.00Z"}
    say(member, "state", 101.0, **{**STATE, **early, "operatingMode": "MANUAL"})
    assert member.control is not None
    assert member.control.state is not None
    assert member.control.state.mode == "AUTOMATIC", "what was overtaken is ignored"
    say(member, "connection", 102.0, connectionState="CONNECTIONBROKEN")
    say(member, "connection", 103.0, connectionState="ONLINE")
    say(member, "state", 104.0, **{**STATE, **early, "operatingMode": "MANUAL"})
    assert (member.control.state.mode, member.control.online) == ("MANUAL", True)


def test_the_log_says_why_a_vehicle_is_not_on_the_map(member: VehicleDevice, caplog: pytest.LogCaptureFixture) -> None:
    say(member, "connection", 100.0, connectionState="ONLINE")
    member.tick(100.1)
    assert caplog.messages == []
    member.tick(101.0 + PATIENCE_S)
    member.tick(102.0 + PATIENCE_S)
    say(member, "factsheet", 103.0 + PATIENCE_S, **FACTSHEET)
    say(member, "state", 103.0 + PATIENCE_S, **{**STATE, "agvPosition": None})
    member.tick(104.0 + PATIENCE_S)
    assert caplog.messages == [
        "Acme-1 is connected, but not on the map yet: it has not told its factsheet.",
        "Acme-1 is connected, but not on the map yet: it does not know where it is.",
    ]


def test_the_log_says_why_a_factsheet_was_refused_and_not_that_there_is_none(
    member: VehicleDevice, caplog: pytest.LogCaptureFixture
) -> None:
    say(member, "connection", 0.0, connectionState="ONLINE")
    with pytest.raises(BadMessage):
        say(member, "factsheet", 0.0, **{**FACTSHEET, "physicalParameters": {"length": 0.8}})
    member.tick(PATIENCE_S)
    assert caplog.messages == [
        "Acme-1 is connected, but not on the map yet: its factsheet was refused (factsheet/physicalParameters/width "
        "must be a number)."
    ]


def test_the_log_says_why_a_factsheet_makes_no_device_however_often_it_is_told(
    member: VehicleDevice, caplog: pytest.LogCaptureFixture
) -> None:
    sheet = {**FACTSHEET, "physicalParameters": {**FACTSHEET["physicalParameters"], "length": 1400, "width": 800}}
    say(member, "connection", 0.0, connectionState="ONLINE")
    say(member, "factsheet", 0.0, **sheet)
    with pytest.raises(BadMessage):
        say(member, "state", 0.0, **STATE)
    say(member, "factsheet", 1.0, **sheet)
    member.tick(PATIENCE_S)
    assert len(caplog.messages) == 1
    assert "not on the map yet: its factsheet was refused (factsheet: " in caplog.messages[0]
    say(member, "factsheet", 1.0 + PATIENCE_S, **FACTSHEET)
    assert member.control is not None


def test_the_number_of_a_question_is_kept_before_it_is_asked(
    member: VehicleDevice, setting: Setting, tmp_path: Path
) -> None:
    come(member, 100.0)
    (memory,) = tmp_path.glob("*.json")
    kept: list[dict[str, int]] = []
    again = VehicleDevice(
        NAME, setting, lambda *_: kept.append(json.loads(memory.read_text())["headers"]), lambda _: None
    )
    say(again, "connection", 200.0, connectionState="ONLINE")
    again.tick(201.0 + ASK_S)
    assert [each["instantActions"] for each in kept] == [1, 1]


def test_a_last_will_that_comes_late_does_not_keep_a_vehicle_away(member: VehicleDevice) -> None:
    come(member, 100.0)
    say(member, "connection", 101.0, connectionState="CONNECTIONBROKEN")
    assert member.control is not None
    heard = []
    for number in (2, 3):
        say(member, "state", 101.0 + number, **{**STATE, "headerId": number})
        heard.append(member.control.online)
    assert heard == [False, True]
    say(member, "connection", 105.0, connectionState="OFFLINE")
    for number in (4, 5):
        say(member, "state", 102.0 + number, **{**STATE, "headerId": number})
        assert not member.control.online, "it said goodbye"


def test_nothing_is_known_of_vehicles_while_their_broker_is_not_reached(member: VehicleDevice) -> None:
    come(member, 100.0)
    assert member.control is not None
    member.tick(101.0, is_reached=False)
    assert not member.control.online
    member.tick(102.0)
    assert not member.control.online, "what it was before may have changed"
    say(member, "state", 103.0, **{**STATE, "headerId": 2})
    assert member.control.online


def test_a_vehicle_whose_connection_is_forgotten_is_asked_who_it_is(member: VehicleDevice, asked: list[Any]) -> None:
    for number in (1, 2):
        say(member, "state", 100.0 + number, **{**STATE, "headerId": number})
    member.tick(104.0)
    assert [(topic, body["actions"][0]["actionType"]) for topic, body in asked] == [
        ("instantActions", "factsheetRequest")
    ]
    say(member, "factsheet", 105.0, **FACTSHEET)
    member.tick(106.0)
    assert member.control is not None
    assert member.control.online


def test_a_vehicle_that_is_known_by_its_state_alone_is_spoken_to_in_the_version_of_that(
    member: VehicleDevice, asked: list[Any]
) -> None:
    for number in (1, 2):
        say(member, "state", 100.0 + number, **{**STATE, "headerId": number, "version": "2.1.0"})
    member.tick(104.0)
    assert [(body["version"], "instantActions" in body) for _, body in asked] == [("2.1.0", False)]


def test_no_two_messages_that_go_out_together_have_the_same_number(member: VehicleDevice, asked: list[Any]) -> None:
    come(member, 100.0)
    assert member.control is not None
    member.control.out = [Send("instantActions", {"actionType": kind}) for kind in ("cancelOrder", "startPause")]
    member.speak(101.0)
    assert [body["headerId"] for _, body in asked] == [0, 1]

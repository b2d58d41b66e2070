"""With which key a device comes again after it was refused, and what it does when none is left."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from vipo_device.kit.enrolment import Enrolment, EnrolmentDesk, device_connections, take_new_keys
from vipo_device.kit.keyring import KeyRing, RotatingKeyRing
from vipo_device.protocol.mqtt_client import MqttClient

BROKER = {"host": "127.0.0.1", "port": 9, "tls": False, "ca": ""}
NEW_KEY = "a-new-key-of-the-oven-0001"


def client(name: str) -> MqttClient:
    return MqttClient(host="127.0.0.1", port=9, username=name, password="", client_id=name)


def refuse(device: MqttClient) -> str:
    """Refuse a device, and return the key with which it will come again."""
    device._refused(device._paho, "Not authorized")
    return device._password


class Desk(EnrolmentDesk):
    """Remembers what is brought, and brings it nowhere."""

    def __init__(self) -> None:
        super().__init__("hall", lambda: client("join:hall"))
        self.brought: list[tuple[str, str]] = []

    def bring(self, device: str, key: str) -> None:
        self.brought.append((device, key))


def test_a_device_tries_the_key_that_was_written_meanwhile(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    by_hand = tmp_path / "devices.json"
    ring = KeyRing(by_hand, tmp_path / "own.json")
    vehicle = client("Acme-1")
    Enrolment("Acme-1", vehicle, ring, None, ring.first_key("Acme-1"))
    for _ in range(2):
        assert refuse(vehicle) == ring.first_key("Acme-1")
    by_hand.write_text(json.dumps({"Acme-1": "the new key"}))
    assert refuse(vehicle) == "the new key"
    assert caplog.messages == [
        "The MQTT broker refused Acme-1: Not authorized.",
        "Acme-1 has no key that is known: write one into secrets/devices.json, or name an enrolment key.",
    ]


def test_a_device_without_a_known_key_brings_the_one_it_has(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    ring, desk, vehicle = KeyRing(tmp_path / "devices.json", tmp_path / "own.json"), Desk(), client("Acme-1")
    own = ring.first_key("Acme-1")
    Enrolment("Acme-1", vehicle, ring, desk, own)
    assert [refuse(vehicle), refuse(vehicle)] == [own, own]
    assert desk.brought == [("Acme-1", own)] * 2
    assert caplog.messages[1:] == [
        "Acme-1 is not let in at hall: it brings a key of its own, and waits for an admin, or was refused: "
        "the site's What was done says why. "
        "A key that it was given belongs into secrets/devices.json."
    ]


def test_a_device_whose_keys_rotate_tries_both_and_then_brings_a_fresh_one(tmp_path: Path) -> None:
    current, spares = tmp_path / "devices.json", tmp_path / "devices-spare.json"
    current.write_text('{"oven": "first"}')
    spares.write_text('{"oven": "before"}')
    ring, desk, oven = RotatingKeyRing(current, spares), Desk(), client("oven")
    Enrolment("oven", oven, ring, desk, ring.first_key("oven"))
    assert (refuse(oven), desk.brought) == ("before", [])
    fresh = refuse(oven)
    assert fresh not in {"first", "before"}
    assert desk.brought == [("oven", fresh)]
    assert [refuse(oven), refuse(oven)] == ["first", fresh]
    assert json.loads(current.read_text()) == {"oven": "first"}
    for accepted in oven._connected_callbacks:
        accepted()
    assert (ring.keys("oven"), refuse(oven)) == ([fresh, "first"], "first")


def test_a_device_whose_keys_cannot_be_read_keeps_the_one_it_has(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    current = tmp_path / "devices.json"
    current.write_text('{"oven": "first"}')
    ring, oven = RotatingKeyRing(current, tmp_path / "spare.json"), client("oven")
    Enrolment("oven", oven, ring, Desk(), ring.first_key("oven"))
    current.write_text("[")
    assert refuse(oven) == ""
    assert caplog.messages[1].startswith("The keys of oven cannot be read or kept: ")


def test_only_rotating_keys_hear_of_new_ones(tmp_path: Path) -> None:
    files = tmp_path / "devices.json", tmp_path / "other.json"
    will = ("topic", b"", 1, True)
    heard = [
        [subscription.topic for subscription in device_connections("hall", BROKER, ring)("oven", will)._subscriptions]
        for ring in (KeyRing(*files), RotatingKeyRing(*files))
    ]
    assert heard == [[], ["vipo/v1/dev/oven/down/credential"]]


def test_a_device_begins_with_the_enrolment_key_where_it_has_none(tmp_path: Path) -> None:
    ring = RotatingKeyRing(tmp_path / "devices.json", tmp_path / "spare.json")
    connect = device_connections("hall", BROKER, ring, "the site's")
    assert connect("oven", ("topic", b"", 1, True))._password == "the site's"
    ring.replace("oven", "its own")
    assert connect("oven", ("topic", b"", 1, True))._password == "its own"


@pytest.mark.parametrize(
    ("payload", "retained", "kept", "answer"),
    [
        (json.dumps({"id": "k1", "v": {"credential": NEW_KEY}}), False, [NEW_KEY], {"id": "k1", "st": "DONE"}),
        (json.dumps({"id": "k1", "v": {"credential": NEW_KEY}}), True, [], None),
        (json.dumps({"id": "k1", "v": {"credential": "short"}}), False, [], None),
        ("{", False, [], None),
    ],
)
def test_a_new_key_is_kept_before_it_is_answered(
    payload: str, retained: bool, kept: list[str], answer: dict[str, str] | None
) -> None:
    oven, found = client("oven"), list[str]()
    take_new_keys("oven", oven, found.append)
    hear = oven._subscriptions[0].plain
    assert hear is not None
    hear("vipo/v1/dev/oven/down/credential", payload.encode(), retained)
    assert (found, oven._password) == (kept, kept[0] if kept else "")
    said = [json.loads(message[1]) for message in oven._early]
    assert said == ([] if answer is None else [{**answer, "why": "", "result": {}}])


def test_a_key_that_cannot_be_kept_is_not_used() -> None:
    def keep(_: str) -> None:
        raise OSError("no room")

    oven = client("oven")
    take_new_keys("oven", oven, keep)
    hear = oven._subscriptions[0].plain
    assert hear is not None
    hear("vipo/v1/dev/oven/down/credential", json.dumps({"id": "k1", "v": {"credential": NEW_KEY}}).encode(), False)
    assert oven._password == ""
    said = [json.loads(message[1]) for message in oven._early]
    assert said == [{"id": "k1", "st": "FAILED", "why": "The key cannot be kept: no room", "result": {}}]

"""Keys and accounts on both brokers: what the registry decides holds there at once."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest
from django.conf import LazySettings

from execution.gateway.gateway import Gateway
from registry import services
from registry.models import AuditLine
from tests.integration.wire.bus import JOIN, SITE, Bus
from tests.kit.files import MIXER_TEXT
from tests.kit.waiting import wait_for
from vipo_device.kit.enrolment import take_new_keys
from vipo_device.kit.keyring import KeyFile

pytestmark = pytest.mark.servers
KEY = "first-key-of-the-mixer-0001"


def lifecycle(device: str) -> str:
    view = services.find_device(device_id=device)
    return view.lifecycle if view else ""


def decide(what: Callable[..., Any], device: str) -> Any:
    return what(site=SITE, device_id=device, by=None, at=datetime.now(UTC))


def test_an_id_that_can_be_none_is_told_to_the_admins_of_the_site(bus: Bus, gateway: Gateway) -> None:
    door = bus.client(f"join:{SITE}", JOIN)
    for device in ("oven 1", "ö" * 100):
        door.publish(f"vipo/v1/join/{SITE}/{device}", json.dumps({"key": KEY}).encode())
    door.start()
    lines = AuditLine.objects.filter(site__slug=SITE, code="device_turned_away").order_by("pk")
    wait_for("both in the record", lambda: lines.count() == 2)
    door.stop()
    assert [line.facts for line in lines] == [
        {"device": "oven 1", "because": "device_id"},
        {"device": "ö" * 64, "because": "device_id"},
    ]


def test_a_device_of_the_name_of_a_gateway_throws_nobody_out(
    bus: Bus, gateway: Gateway, settings: LazySettings
) -> None:
    named, other = settings.VIPO_GATEWAY, "oven01"
    at = datetime.now(UTC)
    for device in (named, other):
        services.enrol_device(site=SITE, device_id=device, payload=json.dumps({"key": KEY}).encode(), at=at)
    ends: list[None] = []
    gateway._client.on_connected(lambda: ends.append(None))  # comes in again
    clients = {device: bus.client(device, KEY) for device in (named, other)}
    clients[named].on_connected(lambda: ends.append(None))
    for device, client in clients.items():
        client.start()
        assert client.wait_connected(20), client.refusal
        client.publish(f"vipo/v1/dev/{device}/up/desc", MIXER_TEXT.replace("paintMixer03", device).encode())
    wait_for("both descriptions", lambda: [lifecycle(device) for device in (named, other)] == ["pending", "pending"])
    time.sleep(1.5)  # who is thrown out comes again after a second
    assert len(ends) == 1, "the device, once"
    assert gateway._client.connected
    for client in clients.values():
        assert client.connected
        client.stop()


def test_a_stranger_joins_by_its_description_and_the_join_key_alone(bus: Bus, gateway: Gateway, tmp_path: Path) -> None:
    assert not bus.lets_in("new01", KEY)
    door = bus.client(f"join:{SITE}", JOIN)
    door.publish(f"vipo/v1/join/{SITE}/new01", json.dumps({"key": KEY}).encode())
    door.publish("vipo/v1/dev/new01/up/desc", b"forbidden here")
    door.start()
    wait_for("the account", lambda: services.list_broker_hashes().get("new01") and bus.lets_in("new01", KEY))
    door.stop()
    assert lifecycle("new01") == ""

    device = bus.client("new01", KEY)
    keys = KeyFile(tmp_path / "keys.json")
    take_new_keys("new01", device, lambda key: keys.keep("new01", key))
    device.subscribe("vipo/v1/dev/new01/down/#", 1, lambda *_: None)  # amqtt then says it each command twice
    connections: list[None] = []
    device.on_connected(lambda: connections.append(None))
    device.publish("vipo/v1/dev/new01/up/desc", MIXER_TEXT.replace("paintMixer03", "new01").encode(), retain=True)
    device.publish("vipo/v1/dev/new01/up/presence", b'{"s": "online", "boot": 1}', retain=True)
    device.start()
    wait_for("the newcomer", lambda: lifecycle("new01") == "pending" and services.find_device(device_id="new01").online)

    decided = decide(services.approve_device, "new01")
    assert decided.taken
    assert json.loads((tmp_path / "keys.json").read_text()) == {"new01": decided.credential}
    wait_for("the device with its new key", lambda: len(connections) > 1 and device.connected)
    assert not bus.lets_in("new01", KEY)

    decide(services.revoke_credential, "new01")
    wait_for("the end of the connection", lambda: not device.connected)
    wait_for("the refusal", lambda: device.refusal)
    assert not bus.lets_in("new01", decided.credential)
    device.stop()


def test_a_retired_device_is_thrown_out_and_others_stay(bus: Bus, gateway: Gateway) -> None:
    clients = {}
    for name in ("mixer01", "mixer02"):
        door = bus.client(f"join:{SITE}", JOIN)
        door.publish(f"vipo/v1/join/{SITE}/{name}", json.dumps({"key": KEY}).encode())
        door.start()
        wait_for("the account", lambda n=name: services.list_broker_hashes().get(n) and bus.lets_in(n, KEY))
        door.stop()
        clients[name] = bus.client(name, KEY)
        description = MIXER_TEXT.replace("paintMixer03", name).encode()
        clients[name].publish(f"vipo/v1/dev/{name}/up/desc", description, retain=True)
        clients[name].start()
        wait_for("the newcomer", lambda n=name: lifecycle(n) == "pending")
        decide(services.approve_device, name)
    decide(services.retire_device, "mixer01")
    wait_for("the end of the connection", lambda: not clients["mixer01"].connected)
    wait_for("the refusal", lambda: clients["mixer01"].refusal)
    assert clients["mixer02"].connected
    for client in clients.values():
        client.stop()

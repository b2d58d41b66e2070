"""Everything that must not hurt the registry, sent through both brokers while another device works on."""

from __future__ import annotations

import json
import socket
from contextlib import suppress
from datetime import UTC, datetime

import pytest

from execution.gateway.gateway import Gateway
from registry import services
from registry.models import DeviceEvent
from tests.integration.wire.bus import JOIN, SITE, Bus
from tests.kit.files import MIXER_TEXT
from tests.kit.waiting import wait_for
from vipo_device.descriptions.forms import ANY_FORM
from vipo_device.protocol.fault_texts import SENTENCES
from vipo_device.protocol.mqtt_client import MqttClient

pytestmark = pytest.mark.servers
KEYS = {"loud01": "the-key-of-the-loud-one-1", "calm01": "the-key-of-the-calm-one-1"}
THING = {"@context": "https://www.w3.org/2022/wot/td/v1.1", "id": "urn:vipo:device:loud01", "title": "Loud"}
ENTITIES = "".join(f'<!ENTITY e{n} "{f"&e{n - 1};" * 10}">' for n in range(1, 9))
DESCRIPTIONS = {
    "RDF/XML with entities": f'<!DOCTYPE r [<!ENTITY e0 "a">{ENTITIES}]><rdf:RDF>&e8;</rdf:RDF>'.encode(),
    "a context that would be fetched": json.dumps({"@context": "http://127.0.0.1:9/context", "@id": "x"}).encode(),
    "a context in a file": json.dumps({"@context": "file:///etc/passwd", "@id": "x"}).encode(),
    "another device's id": MIXER_TEXT.replace("paintMixer03", "calm01").encode(),
    "another device's topic": MIXER_TEXT.replace("paintMixer03", "loud01")
    .replace("dev/loud01/down/", "dev/calm01/down/")
    .encode(),
    "NUL": MIXER_TEXT.replace("paintMixer03", "loud01").replace("Mix", "Mi\0x").encode(),
    "half a surrogate pair": json.dumps({**THING, "description": "\ud800"}).encode(),
    "a key that comes twice": b'{"@context": "https://www.w3.org/2022/wot/td/v1.1", "title": "a", "title": "b"}',
    "deep": b'{"@context":' + b"[" * 3000 + b"]" * 3000 + b"}",
    "too many methods": json.dumps({**THING, "actions": {f"m{n}": {} for n in range(65)}}).encode(),
    "no text": b"\xff\xfe\x00",
}
STATES = {
    "NaN": b'{"boot": 9, "seq": 1, "done": true, "props": {"a": NaN}}',
    "infinity": b'{"boot": 9, "seq": 1, "done": true, "loc": [1e999, 0, 0, 0]}',
    "a key that comes twice": b'{"boot": 9, "boot": 1, "seq": 1, "done": true}',
    "half a surrogate pair": b'{"boot": 9, "seq": 1, "done": true, "props": {"a": "\\ud800"}}',
    "NUL": b'{"boot": 9, "seq": 1, "done": true, "props": {"a": "\\u0000"}}',
    "too many properties": json.dumps(
        {"boot": 9, "seq": 1, "done": True, "props": {f"p{n}": n for n in range(65)}}
    ).encode(),
    "deep": b"[" * 5000 + b"]" * 5000,
    "no JSON": b"\x00\x01",
}


def join(bus: Bus, name: str) -> MqttClient:
    """Let a device in with its key and its description; it is approved."""
    services.enrol_device(
        site=SITE, device_id=name, payload=json.dumps({"key": KEYS[name]}).encode(), at=datetime.now(UTC)
    )
    client = bus.client(name, KEYS[name])
    client.publish(f"vipo/v1/dev/{name}/up/desc", MIXER_TEXT.replace("paintMixer03", name).encode(), retain=True)
    client.start()
    wait_for("its description", lambda: services.find_device(device_id=name))
    services.approve_device(site=SITE, device_id=name, by=None, at=datetime.now(UTC))
    client.publish(f"vipo/v1/dev/{name}/up/presence", b'{"s": "online", "boot": 5}', retain=True)
    wait_for("its presence", lambda: services.get_device(site=SITE, device_id=name).online)
    return client


def say(client: MqttClient, name: str, seq: int, value: float) -> None:
    body = {"boot": 5, "seq": seq, "done": True, "props": {"jobStatus": value}}
    client.publish(f"vipo/v1/dev/{name}/up/state", json.dumps(body).encode(), retain=True)


def problems(name: str) -> list[str]:
    return list(DeviceEvent.objects.filter(device_id=name, kind="problem").values_list("text", flat=True))


def reading(name: str) -> object:
    return services.get_device(site=SITE, device_id=name).readings.get("jobStatus")


def test_hostile_messages_harm_nobody_and_are_counted(bus: Bus, gateway: Gateway) -> None:
    calm, loud = join(bus, "calm01"), join(bus, "loud01")
    say(loud, "loud01", 7, 1.0)
    wait_for("the loud one's state", lambda: reading("loud01") == 1.0)
    before = services.get_device(site=SITE, device_id="loud01")
    hostile = [("desc", payload) for payload in DESCRIPTIONS.values()]
    hostile += [("state", payload) for payload in STATES.values()]
    hostile.append(("presence", b'{"s": "maybe", "boot": 5}'))
    for number, (kind, payload) in enumerate(hostile, 1):
        loud.publish(f"vipo/v1/dev/loud01/up/{kind}", payload, retain=True)
        wait_for(f"the refusal of {payload[:60]!r}", lambda n=number: gateway.complaints.counts.total() == n)
    loud.publish("vipo/v1/dev/loud01/up/presence", b'{"s": "offline", "boot": 4}')
    say(loud, "loud01", 7, 99.0)
    loud.publish("vipo/v1/dev/loud01/up/state", b'{"boot": 4, "seq": 900, "done": true, "props": {"jobStatus": 98}}')
    say(calm, "calm01", 1, 42.0)
    wait_for("the calm one's state", lambda: reading("calm01") == 42.0)
    wait_for("the count", lambda: services.get_device(site=SITE, device_id="loud01").dropped == len(hostile))
    after = services.get_device(site=SITE, device_id="loud01")
    assert (after.canonical, after.online, dict(after.readings)) == (
        before.canonical,
        True,
        dict(before.readings),
    )
    assert problems("loud01")[0].startswith("desc: ")
    assert problems("calm01") == []
    assert services.get_device(site=SITE, device_id="calm01").dropped == 0
    calm.stop()
    loud.stop()


def test_who_mends_one_thing_hears_of_the_next(bus: Bus, gateway: Gateway) -> None:
    loud = join(bus, "loud01")
    for number, payload in enumerate(DESCRIPTIONS.values(), 1):
        loud.publish("vipo/v1/dev/loud01/up/desc", payload, retain=True)
        wait_for("the refusal", lambda n=number: gateway.complaints.counts.total() == n)
    wait_for("the notes", lambda: len(problems("loud01")) == 6)
    assert problems("loud01")[:-3:-1] == [
        f"desc: {SENTENCES['markup'].format(accepted=ANY_FORM)}",
        "desc: The description's context 'http://127.0.0.1:9/context' is not known here. Use 'urn:vipo:context', or "
        "write its prefixes out.",
    ]
    loud.stop()


def test_a_device_that_counts_its_starts_wrongly_is_told_so(bus: Bus, gateway: Gateway) -> None:
    """Its clock was lost, or it begins every start as the same one: it would be away for ever, and nobody knew why."""
    loud = join(bus, "loud01")
    say(loud, "loud01", 7, 1.0)
    wait_for("its state", lambda: reading("loud01") == 1.0)
    loud.publish("vipo/v1/dev/loud01/up/presence", b'{"s": "offline", "boot": 5}', retain=True)
    wait_for("its leaving", lambda: not services.get_device(site=SITE, device_id="loud01").online)
    loud.publish("vipo/v1/dev/loud01/up/presence", b'{"s": "online", "boot": 3}', retain=True)
    wait_for("the note", lambda: any("comes as start 3" in text for text in problems("loud01")))
    say(loud, "loud01", 1, 2.0)
    wait_for("the note", lambda: any("state 1 of start 5, but state 7" in text for text in problems("loud01")))
    loud.stop()


def test_a_flood_is_held_back_and_counted(bus: Bus, gateway: Gateway) -> None:
    calm, loud = join(bus, "calm01"), join(bus, "loud01")
    say(calm, "calm01", 1, 1.0)
    wait_for("the calm one's state", lambda: reading("calm01") == 1.0)
    filler = "x" * 12_000
    for number in range(2000):
        loud.publish("vipo/v1/dev/loud01/up/state", json.dumps({"seq": number, "filler": filler}).encode(), qos=0)
        if number % 500 == 0:
            say(calm, "calm01", 2 + number, float(number))
    say(calm, "calm01", 5000, 77.0)
    wait_for("the calm one's last state", lambda: reading("calm01") == 77.0, 60)
    wait_for("the count", lambda: services.get_device(site=SITE, device_id="loud01").dropped >= 500, 60)
    assert any("too many messages" in text or "state: " in text for text in problems("loud01"))
    calm.stop()
    loud.stop()


def test_a_flood_of_knocks_is_the_doors_and_no_devices(
    bus: Bus, gateway: Gateway, caplog: pytest.LogCaptureFixture
) -> None:
    calm, door = join(bus, "calm01"), bus.client(f"join:{SITE}", JOIN)
    door.start()
    for number in range(220):
        name = f"new{number}" if number < 100 else "calm01"
        door.publish(f"vipo/v1/join/{SITE}/{name}", json.dumps({"key": "k" * 30}).encode())
    wait_for("the flood", lambda: gateway.complaints.counts["too many messages"] >= 150, 60)
    say(calm, "calm01", 1, 77.0)
    wait_for("the calm one's state", lambda: reading("calm01") == 77.0, 60)
    assert [line for line in caplog.messages if "too many" in line] == [
        f"Device join:{SITE}: too many messages: some were dropped"
    ]
    door.stop()
    calm.stop()


def test_a_packet_that_is_too_large_ends_that_connection_only(bus: Bus, gateway: Gateway) -> None:
    calm, loud = join(bus, "calm01"), join(bus, "loud01")
    gone: list[str] = []
    loud.on_connected(lambda: gone.append("back"))
    loud.publish("vipo/v1/dev/loud01/up/state", b"x" * 20_000, qos=0)
    wait_for("the loud one thrown out and back", lambda: gone)
    assert calm.connected
    say(calm, "calm01", 1, 3.0)
    wait_for("the calm one's state", lambda: reading("calm01") == 3.0)
    with socket.create_connection(("127.0.0.1", bus.device_port)) as raw:
        raw.sendall(b"\x10\xff\xff\xff\x7f" + b"\0" * 1000)
        raw.settimeout(20)
        with suppress(ConnectionResetError):
            assert raw.recv(16) == b""
    calm.stop()
    loud.stop()

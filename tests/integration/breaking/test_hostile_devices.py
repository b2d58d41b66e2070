"""What strangers and broken devices send over MQTT harms nobody else."""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator
from contextlib import contextmanager

import paho.mqtt.client as paho
from paho.mqtt.enums import CallbackAPIVersion

from tests.integration.breaking.site import Factory
from tests.kit.files import MIXER_TEXT
from tests.kit.waiting import wait_for

BOMB = b'<?xml version="1.0"?><!DOCTYPE r [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;&a;&a;">]><rdf:RDF>&b;</rdf:RDF>'
FLOOD, MOST_WAITING = 3000, 1000  # the broker itself keeps so many for one who reads slowly, and no more
STATES = {
    "NaN": b'{"boot": 1, "seq": NaN, "done": true}',
    "key twice": b'{"boot": 1, "boot": 2, "seq": 1, "done": true}',
    "deep": b"[" * 5000 + b"]" * 5000,
    "not JSON": b"\xff\x00\x01",
}


@contextmanager
def device(port: int, name: str, password: str) -> Iterator[tuple[paho.Client, list[str]]]:
    """Connect as a device; yields the client and the topics that it hears."""
    client = paho.Client(CallbackAPIVersion.VERSION2, client_id=name)
    client.username_pw_set(name, password)
    heard: list[str] = []
    there = threading.Event()
    client.on_connect = lambda _c, _d, _f, reason, _p: there.set() if not reason.is_failure else None
    client.on_message = lambda _c, _d, message: heard.append(message.topic)
    client.connect("127.0.0.1", port)
    client.loop_start()
    try:
        assert there.wait(15), f"{name} was not let in"
        yield client, heard
    finally:
        client.disconnect()
        client.loop_stop()


def test_a_new_device_that_talks_nonsense_is_noted_and_others_keep_working(factory: Factory) -> None:
    join = (factory.demo.state / "secrets" / "join").read_text().strip()
    text = MIXER_TEXT.replace("paintMixer03", "loud01").encode()
    wait_for("robot02 at home, whatever another test had for it", lambda: factory.device("robot02")["status"] == "idle")
    before = factory.device("robot02")
    with device(factory.mqtt_port, "loud01", join) as (client, heard):
        up = "vipo/v1/dev/loud01/up"
        client.publish(f"{up}/desc", text, qos=1)
        wait_for("loud01 as a new device", lambda: factory.device("loud01").get("status") == "pending", 20)
        for topic in ("vipo/v1/dev/+/up/#", "#", "vipo/v1/dev/robot02/down/#"):
            client.subscribe(topic, 1)
        client.publish("vipo/v1/dev/robot02/up/presence", json.dumps({"s": "offline", "boot": 9**9}), qos=1)
        client.publish("vipo/v1/site/painting-factory/stop", b'{"active": true}', qos=1, retain=True)
        for payload in (b"not RDF", BOMB, text.replace(b"loud01", b"robot02"), b"x" * 16_000):
            client.publish(f"{up}/desc", payload, qos=1)
        for payload in STATES.values():
            client.publish(f"{up}/state", payload, qos=1)
        wait_for("a line of history", lambda: any("desc: " in line for line in factory.history("loud01")), 20)
        for number in range(FLOOD):
            client.publish(f"{up}/state", json.dumps({"boot": 1, "seq": number, "done": "maybe"}), qos=0)
        wait_for("the count of what was not taken", lambda: factory.device("loud01")["dropped"] >= MOST_WAITING // 2)
        assert heard == []
    after = factory.device("robot02")
    assert (after["status"], after["name"]) == (before["status"], before["name"])
    assert factory.admin.get("/api/sites/painting-factory").json()["stop"]["active"] is False
    assert factory.admin.get("/health").status_code == 200


def test_a_stranger_is_not_let_in(factory: Factory) -> None:
    for name, password in (("robot01", "guess"), ("server", ""), ("", "")):
        client = paho.Client(CallbackAPIVersion.VERSION2, client_id=name or "nobody")
        client.username_pw_set(name, password)
        answers: list[bool] = []
        client.on_connect = lambda _c, _d, _f, reason, _p, answers=answers: answers.append(reason.is_failure)
        client.connect("127.0.0.1", factory.mqtt_port)
        wait_for("an answer", lambda c=client, a=answers: c.loop(0.1) or a)
        assert answers == [True]

"""A legacy topic on both brokers: only the device that it was confirmed for hears it, and only while that holds."""

from __future__ import annotations

import itertools
import json
from datetime import UTC, datetime
from uuid import UUID

import pytest

from execution import services as execution
from execution.errors import NotPossibleNow
from execution.gateway.gateway import Gateway
from registry import services
from registry.broker.accounts import Account, accounts
from tests.integration.wire.bus import SERVER_WORD, SITE, Bus
from tests.kit.files import MIXER_TEXT
from tests.kit.mqtt import Ear
from tests.kit.waiting import wait_for
from vipo_device.descriptions.reader import read_description, write_description
from vipo_device.protocol.description import MOST_METHODS
from vipo_device.protocol.messages import down_topic, up_topic
from vipo_device.protocol.mqtt_client import MqttClient
from vipo_device.protocol.topics import MOST_CHARACTERS

pytestmark = pytest.mark.servers
TOPIC = "plant/mixer01/start"


def test_a_confirmed_topic_is_heard_by_its_device_alone(bus: Bus) -> None:
    now = datetime.now(UTC)
    heard: dict[str, list[bytes]] = {"mixer01": [], "mixer02": []}
    clients, numbers = {}, itertools.count()
    for name in heard:
        text = write_description(read_description(MIXER_TEXT.replace("paintMixer03", name).encode()))
        if name == "mixer01":
            text = text.replace("vipo/v1/dev/mixer01/down/mixPaint", TOPIC)
        services.ingest_description(device_id=name, payload=text.encode(), at=now)
        key = str(services.approve_device(site=SITE, device_id=name, by=None, at=now).credential)
        clients[name] = bus.client(name, key)
        clients[name].subscribe(TOPIC, 1, lambda _t, payload, _r, name=name: heard[name].append(payload))
        clients[name].subscribe(down_topic("mixer01", "mark"), 1, lambda _t, p, _r, name=name: heard[name].append(p))
        clients[name].publish(TOPIC, b"a device says nothing there")
        clients[name].start()
        assert clients[name].wait_subscribed(20)
    server = MqttClient(
        host="127.0.0.1", port=bus.server_port, username="server", password=SERVER_WORD, client_id="a-server"
    )
    server.start()

    def reaches(text: bytes) -> bool:
        """Say something on the legacy topic, and then a mark on the device's own, which it hears in any case."""
        mark = b"mark %d" % next(numbers)
        server.publish(TOPIC, text)

        def marked() -> bool:
            server.publish("vipo/v1/dev/mixer01/down/mark", mark)  # again: one is lost while it connects anew
            return mark in heard["mixer01"] or not clients["mixer01"].connected

        wait_for("the mark", marked, every_s=0.1)
        return text in heard["mixer01"]

    assert not reaches(b"too early")
    services.confirm_topic(site=SITE, device_id="mixer01", topic=TOPIC, by=None, at=now)
    wait_for("the confirmed device", lambda: reaches(b"now"))
    services.withdraw_topic(site=SITE, device_id="mixer01", topic=TOPIC, by=None, at=now)
    wait_for("the end of it", lambda: not reaches(b"late %d" % next(numbers)) and clients["mixer01"].connected)
    assert heard["mixer02"] == []
    assert not {b"too early", b"a device says nothing there"} & {*heard["mixer01"], *heard["mixer02"]}
    for client in (*clients.values(), server):
        client.stop()


@pytest.mark.parametrize("bus", ["mosquitto"], indirect=True)
def test_a_device_hears_all_of_as_many_and_as_long_topics_as_there_may_be(bus: Bus) -> None:
    key = "the-key-of-mixer01-00000001"
    topics = tuple(f"plant/{number:02}/".ljust(MOST_CHARACTERS, "x") for number in range(MOST_METHODS))
    for _ in range(2):  # the second time it has its role already
        accounts().put(Account("mixer01", key, topics, SITE))
    heard: list[str] = []
    device = bus.client("mixer01", key)
    for topic in topics:
        device.subscribe(topic, 1, lambda topic, _payload, _retained: heard.append(topic))
    device.start()

    def hears() -> list[str]:
        """Say something on each topic, and return where the device hears it until then."""
        heard.clear()
        assert device.wait_subscribed(20)
        for topic in topics:
            ear.client.publish(topic, b"")
        ear.client.publish(down_topic("mixer01", "mark"), b"")
        wait_for("the mark", lambda: "mark" in heard)
        return heard[:-1]

    device.subscribe(down_topic("mixer01", "mark"), 1, lambda *_: heard.append("mark"))
    with Ear(bus.server_port, SERVER_WORD) as ear:
        assert hears() == list(topics)
        for allowed in (topics[:1], topics):
            connections: list[None] = []
            device.on_connected(lambda made=connections: made.append(None))
            accounts().allow("mixer01", SITE, allowed)
            wait_for("the new connection", lambda made=connections: made)
            assert hears() == list(allowed)
    device.stop()


def test_a_device_that_enrols_again_with_its_key_goes_on_hearing_its_confirmed_topic(bus: Bus) -> None:
    now, key, heard = datetime.now(UTC), "k" * 32, list[bytes]()
    text = write_description(read_description(MIXER_TEXT.replace("paintMixer03", "mixer01").encode()))
    hello = {"site": SITE, "device_id": "mixer01", "payload": json.dumps({"key": key}).encode(), "at": now}
    services.enrol_device(**hello)
    text = text.replace(down_topic("mixer01", "mixPaint"), TOPIC)
    services.ingest_description(device_id="mixer01", payload=text.encode(), at=now)
    assert services.approve_device(site=SITE, device_id="mixer01", by=None, at=now).credential is None
    services.confirm_topic(site=SITE, device_id="mixer01", topic=TOPIC, by=None, at=now)
    assert not services.enrol_device(**hello)
    device = bus.client("mixer01", key)
    device.subscribe(TOPIC, 1, lambda _t, payload, _r: heard.append(payload))
    device.start()
    assert device.wait_subscribed(20)
    with Ear(bus.server_port, SERVER_WORD) as ear:
        ear.say(TOPIC, {"time": 5})
        wait_for("the call", lambda: heard)
    device.stop()
    assert [json.loads(payload) for payload in heard] == [{"time": 5}]


def test_a_command_reaches_its_device_on_the_confirmed_topic_and_is_refused_afterwards(
    bus: Bus, gateway: Gateway
) -> None:
    now = datetime.now(UTC)
    text = write_description(read_description(MIXER_TEXT.replace("paintMixer03", "mixer01").encode()))
    text = text.replace(down_topic("mixer01", "mixPaint"), TOPIC)
    services.ingest_description(device_id="mixer01", payload=text.encode(), at=now)
    key = str(services.approve_device(site=SITE, device_id="mixer01", by=None, at=now).credential)
    device, told = bus.client("mixer01", key), []

    def hear(topic: str, payload: bytes, _retained: bool) -> None:
        told.append((topic, json.loads(payload)))
        device.publish(up_topic("mixer01", "ack"), json.dumps({"id": told[-1][1]["id"], "st": "DONE"}).encode())

    for topic in (TOPIC, down_topic("mixer01", "#")):
        device.subscribe(topic, 1, hear)
    device.publish(up_topic("mixer01", "presence"), b'{"s": "online", "boot": 1}', retain=True)
    device.start()

    def call() -> UUID:
        made = execution.call_method(site=SITE, device_id="mixer01", method="mixPaint", arguments={"time": 5}, by="Ada")
        return made.id

    wait_for("the device", lambda: services.get_device(site=SITE, device_id="mixer01").online)
    with pytest.raises(NotPossibleNow):
        call()
    services.confirm_topic(site=SITE, device_id="mixer01", topic=TOPIC, by=None, at=now)
    command = call()
    wait_for("the answer", lambda: execution.get_call(site=SITE, call_id=command).status == "done")
    assert {(topic, body["id"], body["v"]["time"]) for topic, body in told} == {(TOPIC, str(command), 5)}
    services.withdraw_topic(site=SITE, device_id="mixer01", topic=TOPIC, by=None, at=now)
    with pytest.raises(NotPossibleNow):
        call()
    device.stop()

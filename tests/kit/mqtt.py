"""The server's side of an MQTT bus for tests: what is heard and how it is waited for, and talks with one device."""

from __future__ import annotations

import ctypes
import json
import os
import socket
import threading
import time
from collections.abc import Callable
from contextlib import closing, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self
from urllib.parse import urlsplit

import paho.mqtt.client as paho
from paho.mqtt.enums import CallbackAPIVersion

from tests.kit.waiting import PATIENCE_S
from vipo_device.protocol.mqtt_client import MqttClient


@dataclass(frozen=True)
class Heard:
    """One message."""

    topic: str
    payload: bytes
    retained: bool
    at: float

    @property
    def json(self) -> Any:
        return json.loads(self.payload)


class Ear:
    """The server's account on a bus: hears a topic filter, says what it is told, waits for what shall come."""

    def __init__(self, port: int, password: str, topic: str = "vipo/v1/dev/+/up/#", **more: Any) -> None:
        self.heard: list[Heard] = []
        self._changed = threading.Condition()
        self.client = MqttClient(
            host="127.0.0.1", port=port, username="server", password=password, client_id="ear", **more
        )
        self.client.subscribe(topic, 1, self._take)

    def __enter__(self) -> Ear:
        self.client.start()
        assert self.client.wait_subscribed(20), f"the ear did not connect: {self.client.refusal}"
        return self

    def __exit__(self, *_: object) -> None:
        self.client.stop()

    def _take(self, topic: str, payload: bytes, retained: bool) -> None:
        with self._changed:
            self.heard.append(Heard(topic, payload, retained, time.monotonic()))
            self._changed.notify_all()

    def say(self, topic: str, body: Any, **more: Any) -> None:
        self.client.publish(topic, body if isinstance(body, bytes) else json.dumps(body).encode(), **more)

    def tell(self, device: str, method: str, command: str, /, **values: Any) -> None:
        """Tell a device to do something, as the server does."""
        self.say(f"vipo/v1/dev/{device}/down/{method}", {"id": command, "v": values, "ttl_s": 30})

    def wait(self, wanted: Callable[[Heard], bool], timeout_s: float = PATIENCE_S) -> Heard:
        """Return the first message heard so far or from now on that is wanted."""
        with self._changed:
            found = self._changed.wait_for(lambda: next((h for h in self.heard if wanted(h)), None), timeout_s)
        assert found, f"not heard within {timeout_s} s; heard were {[(h.topic, h.payload[:120]) for h in self.heard]}"
        return found

    def forget(self) -> None:
        with self._changed:
            self.heard.clear()

    def all(self, kind: str) -> list[Heard]:
        """Return what was heard on topics that end so."""
        with self._changed:
            return [h for h in self.heard if h.topic.endswith(kind)]


PIDFD_GETFD = 438
"""The number of Linux's call that copies another process's file; Python has no name for it."""


def sends_at_once(pid: int, port: int) -> list[bool]:
    """Tell of each TCP connection of a process from or to a port whether Nagle's algorithm is off."""
    found = []
    with closing(os.fdopen(os.pidfd_open(pid))) as process:
        for file in Path(f"/proc/{pid}/fd").iterdir():
            copied = ctypes.CDLL(None, use_errno=True).syscall(PIDFD_GETFD, process.fileno(), int(file.name), 0)
            if copied < 0:
                continue
            with suppress(OSError), socket.socket(fileno=copied) as one:  # one that is no connection has no peer
                is_tcp = one.family in (socket.AF_INET, socket.AF_INET6) and one.type == socket.SOCK_STREAM
                if is_tcp and port in (one.getsockname()[1], one.getpeername()[1]):
                    found.append(bool(one.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY)))
    return found


@dataclass
class ServerSide:
    """The server's side of one device: tells commands, waits for answers and states."""

    ear: Ear
    device: str

    def tell(self, method: str, command: str, /, **values: Any) -> None:
        self.ear.tell(self.device, method, command, **values)

    def up(self, kind: str) -> str:
        return f"vipo/v1/dev/{self.device}/up/{kind}"

    def wait_ack(self, command: str, *status: str) -> dict[str, Any]:
        def fits(heard: Heard) -> bool:
            if heard.topic != self.up("ack") or heard.json["id"] != command:
                return False
            return heard.json["st"] in (status or ("DONE", "FAILED", "REJECTED", "CANCELED"))

        found: dict[str, Any] = self.ear.wait(fits, PATIENCE_S).json
        return found

    def wait_presence(self, said: str) -> None:
        self.ear.wait(lambda h: h.topic == self.up("presence") and h.json["s"] == said, PATIENCE_S)

    def wait_state(self, **wanted: Any) -> dict[str, Any]:
        def fits(heard: Heard) -> bool:
            if heard.topic != self.up("state"):
                return False
            body = {**heard.json["props"], **heard.json}
            return all(body.get(key) == value for key, value in wanted.items())

        found: dict[str, Any] = self.ear.wait(fits, PATIENCE_S).json
        return found

    def states(self) -> list[dict[str, Any]]:
        return [h.json for h in self.ear.all("/state") if h.topic == self.up("state")]

    def acks(self, command: str) -> list[str]:
        said = [h.json for h in self.ear.all("/ack") if h.topic == self.up("ack")]
        return [body["st"] for body in said if body["id"] == command]


class PlainDevice:
    """A device on a client that nobody here wrote (paho), with the key that the server told for it; it hears nothing.

    `setup` is the server's answer for a new device; it is connected until the block ends.
    """

    def __init__(self, setup: dict[str, str]) -> None:
        broker = urlsplit(setup["broker"])
        self.id = setup["id"]
        self._client = paho.Client(CallbackAPIVersion.VERSION2, self.id)
        self._client.username_pw_set(self.id, setup["credential"])
        self._client.will_set(f"vipo/v1/dev/{self.id}/up/presence", '{"s": "offline", "boot": 1}', 1, retain=True)
        self._client.connect(broker.hostname or "", broker.port or 1883)

    def __enter__(self) -> Self:
        self._client.loop_start()
        return self

    def __exit__(self, *error: object) -> None:
        self._client.disconnect()
        self._client.loop_stop()

    def say(self, topic: str, payload: str) -> None:
        """Publish below the device's topics, and wait until the broker has it."""
        self._client.publish(f"vipo/v1/dev/{self.id}/up/{topic}", payload, 1, retain=True).wait_for_publish(PATIENCE_S)

    def introduce(self, description: str, **state: Any) -> None:
        """Describe itself, and say that it is there and how it is."""
        self.say("desc", description)
        self.say("presence", '{"s": "online", "boot": 1}')
        self.say("state", json.dumps({"boot": 1, "seq": 1, "done": True, **state}))

"""The robot's connection to VIPO's broker, over paho 1.5 or later."""

from __future__ import annotations

import logging
import socket
import ssl
import time
from typing import Any, Callable

import paho.mqtt.client as mqtt

from vipo_agent.config import Config
from vipo_agent.messages import Stop, Told, read_command, read_stop, write

log = logging.getLogger("vipo_agent")
KEEPALIVE_S = 15
PATIENCE_S = 10.0
"""So long the broker may be away before the log says so."""
GOODBYE_S = 5.0
SERVER_STATUS = "vipo/v1/srv/status"


class Link:
    """One connection that comes back by itself. What comes in is passed on at once, on the network's thread."""

    def __init__(self, config: Config, boot: int) -> None:
        self.told: Callable[[Told], None] = _ignore
        self.stopped: Callable[[Stop], None] = _ignore
        self.came_in: Callable[[], None] = lambda: None
        self._config, self._boot = config, boot
        self._server = b""
        self.is_refused = False
        self._refusal = self._complaint = ""
        self._away_s = time.monotonic()
        self._client = make_client(config, config.id, config.password)
        self._client.will_set(self._up("presence"), self._presence("offline"), 1, True)
        self._client.reconnect_delay_set(1, 10)
        self._client.on_connect = self._connected
        self._client.on_message = self._heard

    def start(self) -> None:
        """Begin to connect; a broker that is not there is tried again."""
        self._client.connect_async(self._config.host, self._config.port, KEEPALIVE_S)
        self._client.loop_start()

    def stop(self) -> None:
        """Say that the robot leaves, and end the connection."""
        if self._client.is_connected():
            said = self.say("presence", self._presence("offline"), retain=True)
            wait_until(said.is_published, GOODBYE_S)
        self._client.disconnect()
        self._client.loop_stop()

    def watch(self, now_s: float) -> None:
        """Tell in the log, once for each outage and reason, that the broker is away or lets the robot not in."""
        if self._client.is_connected():
            self._away_s, self._complaint, self._refusal = now_s, "", ""
        elif now_s - self._away_s > PATIENCE_S:
            where = f"The broker at {self._config.host}:{self._config.port}"
            why = f"does not let {self._config.id} in ({self._refusal})" if self._refusal else "is not reached"
            if why != self._complaint:
                self._complaint = why
                log.warning("%s %s; the robot goes on trying.", where, why)

    def say_online(self, description: bytes) -> None:
        """Say who the robot is and that it is here."""
        self.say("desc", description, retain=True)
        self.say("presence", self._presence("online"), retain=True)

    def say(self, kind: str, payload: bytes, *, retain: bool = False) -> Any:
        """Publish on one of the robot's own topics."""
        return self._client.publish(self._up(kind), payload, 1, retain)

    @property
    def is_connected(self) -> bool:
        """True while the broker has accepted this connection."""
        return bool(self._client.is_connected())

    def _up(self, kind: str) -> str:
        return f"vipo/v1/dev/{self._config.id}/up/{kind}"

    def _presence(self, said: str) -> bytes:
        return write({"s": said, "boot": self._boot})

    def _connected(self, client: Any, _data: Any, _flags: Any, reason: Any, _properties: Any | None = None) -> None:
        self.is_refused = bool(getattr(reason, "is_failure", reason != 0))
        if self.is_refused:
            self._refusal = str(reason) if version_of_callbacks() else mqtt.connack_string(reason)
            return
        topics = [f"vipo/v1/dev/{self._config.id}/down/#", f"vipo/v1/site/{self._config.site}/stop", SERVER_STATUS]
        client.subscribe([(topic, 1) for topic in topics])
        self.came_in()

    def _heard(self, _client: Any, _data: Any, message: Any) -> None:
        if message.topic.endswith("/stop"):
            self.stopped(read_stop(message.payload))
        elif message.topic == SERVER_STATUS:
            # A birth that is heard as it happens counts also when it is the first one.
            if not message.retain or (self._server and message.payload != self._server):
                self.came_in()
            self._server = message.payload
        elif not message.retain:
            told = read_command(message.topic.rsplit("/", 1)[1], message.payload)
            if told is not None:
                self.told(told)


def make_client(config: Config, name: str, key: str) -> Any:
    """Return a client for MQTT 3.1.1 of whichever paho there is."""
    version = version_of_callbacks()
    client = mqtt.Client(version.VERSION2, client_id=name) if version else mqtt.Client(client_id=name)
    client.username_pw_set(name, key)
    if config.ca:
        client.tls_set_context(ssl.create_default_context(cafile=config.ca))
    client.on_socket_open = _send_at_once
    return client


def _send_at_once(_client: Any, _data: Any, opened: Any) -> None:
    """Switch Nagle's algorithm off: with it an answer waits up to 40 ms for the broker's delayed acknowledgement."""
    opened.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)


def version_of_callbacks() -> Any:
    """Return paho's choice of callbacks; None before version 2, which has but one."""
    return getattr(mqtt, "CallbackAPIVersion", None)


def wait_until(is_so: Callable[[], bool], limit_s: float) -> bool:
    """Wait for something of paho's; False when it did not come within the time, or the connection broke."""
    end_s = time.monotonic() + limit_s
    while time.monotonic() < end_s:
        try:
            if is_so():
                return True
        except (RuntimeError, ValueError):  # paho's way to say that a message was lost
            return False
        time.sleep(0.02)
    return False


def _ignore(_said: Any) -> None:
    return

"""What VIPO's processes share that hear the broker by an account of their own: the connection, its inbox, the loop."""

from __future__ import annotations

import logging
import secrets
import threading
import time
from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from queue import Empty, SimpleQueue
from typing import Any, NamedTuple

from django.db import DatabaseError, InterfaceError, close_old_connections

from registry import services as registry
from registry.services import Outage
from vipo_device.protocol.credentials import own_key
from vipo_device.protocol.mqtt_client import MqttClient

log = logging.getLogger(__name__)
MOST_WAITING = 20_000
MOST_AT_ONCE = 500


class Arrival(NamedTuple):
    """A message, with the moment of its arrival by this process's steady clock."""

    at: float
    topic: str
    payload: bytes
    retained: bool


class Listener(ABC):
    """Hears `filters` as the user `account`, and takes turns at what has come; it waits for a database that is away."""

    account: str
    filters: Sequence[str]
    without_database: str
    """What does not happen while the database is away, for the log."""

    def __init__(self, settings: Any, heartbeat: registry.HeartbeatWriter | None = None, *, speed: float = 1.0) -> None:
        broker: Mapping[str, Any] = settings.VIPO_MQTT
        own = {**broker, "username": self.account, "password": own_key(self.account, str(broker["password"]))}
        self._name = f"{self.account.removesuffix(':')}-{secrets.token_hex(6)}"
        self._client = MqttClient.from_settings(own, client_id=self._name)
        self._heartbeat, self._speed = heartbeat, speed
        self._inbox: SimpleQueue[Arrival] = SimpleQueue()
        self._new_line = threading.Event()
        self._outage = Outage("The database", self.without_database)

    def run_forever(self, stopping: threading.Event) -> None:
        """Serve until `stopping` is set."""
        for topic in self.filters:
            self._client.subscribe(topic, 1, self._arrived)
        self._client.on_connected(self._new_line.set)
        self._client.start()
        try:
            while not stopping.is_set():
                if self._heartbeat is not None:
                    self._heartbeat.beat("works" if self._client.connected else "broker_away")
                try:
                    self._turn(stopping)
                    self._outage.end()
                except (DatabaseError, InterfaceError) as error:
                    self._outage.begin(error)
                    close_old_connections()
                    stopping.wait(1.0)
        finally:
            self._leave()
            self._client.stop()
            close_old_connections()

    @abstractmethod
    def _turn(self, stopping: threading.Event) -> None:
        """Do what is due, and work through what has come."""

    @abstractmethod
    def _give_up(self, device: str) -> None:
        """Forget a device with which something went wrong that nobody foresaw."""

    def _leave(self) -> None:
        """Say what is to be said before the connection ends."""
        log.debug("%s leaves.", self._name)

    @contextmanager
    def _alone(self, device: str) -> Iterator[None]:
        """Let what goes wrong with one device end nothing of the others."""
        try:
            yield
        except (DatabaseError, InterfaceError):
            raise
        except Exception:
            log.exception("%s: %s is given up, and begun anew when it is needed.", self._name, device)
            self._give_up(device)

    def _heard(self, rest_s: float) -> Iterator[Arrival]:
        """Wait for a message for so long, and give what has come one by one: the rest waits where one goes wrong."""
        with suppress(Empty):
            yield self._inbox.get(timeout=rest_s)
            for _ in range(MOST_AT_ONCE):
                yield self._inbox.get_nowait()

    def _forget_heard(self) -> None:
        with suppress(Empty):
            while True:
                self._inbox.get_nowait()

    def _arrived(self, topic: str, payload: bytes, retained: bool) -> None:
        """Keep a message; on the network's thread."""
        if self._inbox.qsize() < MOST_WAITING:
            self._inbox.put(Arrival(time.monotonic(), topic, payload, retained))

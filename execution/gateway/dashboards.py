"""What dashboards hear at the broker: how the Things of each site are of which a token may hear, topic by topic.

The registry says what holds; of each topic only what is another than before is published, retained, at most twice a
second. So a dashboard hears no device, and costs devices nothing: what it does not read is the broker's to drop. One
gateway does this at a time; every one of them sees to it that no account outlives its token (docs/protocol.md).
"""

from __future__ import annotations

import logging
import secrets
import threading
import time
from collections import defaultdict
from collections.abc import Mapping
from datetime import datetime
from typing import Any

from django.db import DatabaseError, InterfaceError, connection

from execution import database
from execution.job_lease import JobLease
from registry import services as registry
from vipo_device.protocol.errors import VipoError
from vipo_device.protocol.mqtt_client import MqttClient
from vipo_device.protocol.topics import things_prefix

log = logging.getLogger(__name__)
EVERY_S = 0.5
ENDS_EVERY_S = 1.0
ALL_EVERY_S = 30.0
"""So often everything is looked at, whatever was heard of changes."""
KEPT_LIMIT_S, QUIET_S = 10.0, 0.3
MOST_TOPICS = 10_000
"""The embedded broker keeps 20,000 messages in all, stops and descriptions among them."""
KEPT = things_prefix("+") + "#"
SITE_LEVEL, DEVICE_LEVEL = 3, 5
Key = tuple[str, str]
Told = Mapping[str, bytes]


class BrokerSilent(VipoError):
    """The broker does not answer what it is asked."""

    code = "broker_silent"
    status = 503


class Dashboards:
    """Tells how Things are, as long as it is the one that does; runs in a thread of a gateway."""

    def __init__(self, client: MqttClient, settings: Any) -> None:
        self._client, self._mqtt = client, settings.VIPO_MQTT
        self._lease = JobLease("dashboards", settings.VIPO_GATEWAY)
        self._told: dict[Key, Told] = {}
        self._count = 0
        self._is_known = False
        self._sites: frozenset[str] = frozenset()
        self._changed: defaultdict[str, set[str]] = defaultdict(set)
        self._guard = threading.Lock()
        self._accounts: frozenset[str] | None = None
        self._ends_at = self._all_at = float("-inf")
        self._is_full = False

    def run_until(self, stopping: threading.Event) -> None:
        """Tell until `stopping` is set."""
        stop = registry.listen(self._hear)
        try:
            while not stopping.wait(EVERY_S):
                try:
                    self._turn(database.now())
                except (DatabaseError, InterfaceError) as error:
                    log.warning("What dashboards hear waits for the database: %s", error)
                    self._forget()
                    connection.close()
                except VipoError as error:
                    log.warning("What dashboards hear waits for the broker: %s", error.detail)
                except Exception:  # the edge of the thread: without it tokens would not end at the broker
                    log.exception("Telling dashboards failed; it goes on.")
                    self._forget()
        finally:
            stop()
            connection.close()

    def forget_broker(self) -> None:
        """Take in that the connection is a new one: the broker may have another memory, and other accounts."""
        self._is_known, self._accounts = False, None

    def _forget(self) -> None:
        self._is_known = False

    def _hear(self, site: str, message: registry.Message) -> None:
        """Take in what is news; called on a foreign thread for every live message."""
        kind, device = message.get("type"), message.get("device")
        with self._guard:
            if kind == "device" and isinstance(device, Mapping):
                self._changed[site].add(str(device.get("id")))
            elif kind == "device_removed":
                self._changed[site].add(str(message.get("id")))
            elif kind == "members":
                self._accounts = None
            elif kind == "hello":
                self._all_at = float("-inf")

    def _turn(self, now: datetime) -> None:
        if not self._client.connected:
            return
        if time.monotonic() - self._ends_at >= ENDS_EVERY_S:
            self._ends_at = time.monotonic()
            self._accounts = registry.end_readers(known=self._accounts, now=now)
        with self._guard:
            changed, self._changed = self._changed, defaultdict(set)
        if not self._lease.hold(now):
            self._is_known = False
        elif self._is_known:
            self._tell(changed, registry.list_heard_sites(now=now))
        else:
            self._told = _read_kept(self._mqtt)
            self._count = sum(map(len, self._told.values()))
            self._is_known, self._all_at = True, float("-inf")

    def _tell(self, changed: Mapping[str, set[str]], sites: frozenset[str]) -> None:
        is_all = time.monotonic() - self._all_at >= ALL_EVERY_S
        if is_all:
            self._all_at, self._accounts = time.monotonic(), None
        for site, device in list(self._told):
            if site not in sites:
                self._say((site, device), {})
        for site in sites:
            if is_all or site not in self._sites:
                here = {device for other, device in self._told if other == site}
                self._say_all(site, here, registry.read_told(site=site))
            elif ids := changed.get(site):
                self._say_all(site, ids, registry.read_told(site=site, ids=ids))
        self._sites = sites

    def _say_all(self, site: str, devices: set[str], told: Mapping[str, Told]) -> None:
        """Say how these devices are; of those of which there is nothing to tell what was kept is taken away."""
        for device in devices | told.keys():
            self._say((site, device), told.get(device, {}))

    def _say(self, key: Key, told: Told) -> None:
        before = self._told.pop(key, {})
        if self._count - len(before) + len(told) > MOST_TOPICS:
            self._complain(key)
            told = {}
        self._count += len(told) - len(before)
        for topic in before.keys() - told.keys():
            self._client.publish(topic, b"", qos=0, retain=True)
        for topic, message in told.items():
            if before.get(topic) != message:
                self._client.publish(topic, message, qos=0, retain=True)
        if told:
            self._told[key] = told

    def _complain(self, key: Key) -> None:
        if not self._is_full:
            log.warning("Dashboards hear no more than %d topics; %s of %s is not told.", MOST_TOPICS, key[1], key[0])
        self._is_full = True


def _read_kept(mqtt: Mapping[str, Any]) -> dict[Key, Told]:
    """Return what the broker has kept of what was told before: what does not hold any more is to be taken away.

    Raises BrokerSilent.
    """
    kept: defaultdict[Key, dict[str, bytes]] = defaultdict(dict)
    heard = threading.Event()

    def hear(topic: str, message: bytes, retained: bool) -> None:
        levels = topic.split("/")
        if retained and len(levels) > DEVICE_LEVEL:
            kept[levels[SITE_LEVEL], levels[DEVICE_LEVEL]][topic] = message
        heard.set()

    client = MqttClient.from_settings(mqtt, client_id=f"kept-{secrets.token_hex(6)}")
    client.subscribe(KEPT, 0, hear)
    client.start()
    try:
        if not client.wait_subscribed(KEPT_LIMIT_S):
            raise BrokerSilent("The MQTT broker does not say what it has kept.")
        while heard.wait(QUIET_S):
            heard.clear()
    finally:
        client.stop()
    return dict(kept)

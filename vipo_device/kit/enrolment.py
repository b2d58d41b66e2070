"""How a device is let in by VIPO's broker: with a key that is known there, or by enrolling with a key of its own.

A device that has enrolled is pending until an admin of its site decides about it.
"""

from __future__ import annotations

import json
import logging
import random
import threading
import time
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from vipo_device.kit.connection import ConnectionMaker, broker_client
from vipo_device.kit.keyring import KeyRing, RotatingKeyRing
from vipo_device.protocol.credentials import is_strong
from vipo_device.protocol.messages import AckMessage, ack_payload, down_topic, read_command, up_topic
from vipo_device.protocol.mqtt_client import MqttClient, Will

log = logging.getLogger(__name__)
PATIENCE_S = 5.0
PAUSE_S = (5.0, 30.0)
"""So long a device waits before it brings its key again."""
UNKNOWN = "%s has no key that is known: write one into secrets/devices.json, or name an enrolment key."
PENDING = (
    "%s is not let in at %s: it brings a key of its own, and waits for an admin, or was refused: "
    "the site's What was done says why. %s"
)
GIVEN_KEYS = "A key that it was given belongs into secrets/devices.json."


def device_connections(site: str, broker: Mapping[str, Any], ring: KeyRing, enrolment_key: str = "") -> ConnectionMaker:
    """Return what connects each device of a site by its own key; with the site's enrolment key they can enrol.

    A device whose keys rotate takes those that the server gives it.
    """
    desk = EnrolmentDesk(site, lambda: broker_client(broker, f"join:{site}", enrolment_key)) if enrolment_key else None

    def connect(device: str, will: Will) -> MqttClient:
        key = ring.first_key(device)
        client = broker_client(broker, device, key or enrolment_key, will)
        enrolment = Enrolment(device, client, ring, desk, key)
        if isinstance(ring, RotatingKeyRing):
            take_new_keys(device, client, partial(_keep_new, ring, enrolment))
        return client

    return connect


def _keep_new(ring: RotatingKeyRing, enrolment: Enrolment, key: str) -> None:
    ring.replace(enrolment.device, key)
    enrolment.offered = key


class EnrolmentDesk:
    """Where the devices of a site bring their keys, one after the other.

    `connect` makes a connection with the site's enrolment key, as which all its pending devices are one client.
    """

    def __init__(self, site: str, connect: Callable[[], MqttClient]) -> None:
        self.site, self._connect = site, connect
        self._one_at_a_time = threading.Lock()
        self._next_s: dict[str, float] = {}

    def bring(self, device: str, key: str) -> None:
        """Bring a device's key in a thread of its own, unless it was brought 5 to 30 s ago; returns at once."""
        if time.monotonic() < self._next_s.get(device, 0.0):
            return
        # As all pending devices of a site are one client there, they must not come in step.
        self._next_s[device] = time.monotonic() + random.uniform(*PAUSE_S)  # noqa: S311 - not a secret
        threading.Thread(target=self._bring, args=(device, key), name=f"enrol-{device}", daemon=True).start()

    def _bring(self, device: str, key: str) -> None:
        with self._one_at_a_time:
            client = self._connect()
            client.start()
            if client.wait_connected(PATIENCE_S):
                client.publish(f"vipo/v1/join/{self.site}/{device}", json.dumps({"key": key}).encode())
            else:
                why = client.refusal or "the broker does not answer"
                log.warning("%s cannot bring its key to %s: %s.", device, self.site, why)
            client.stop()


class Enrolment:
    """How one device is let in: after each refusal it comes with another key, and enrols when none is left.

    `offered` is the key with which it comes next.
    """

    def __init__(self, device: str, client: MqttClient, ring: KeyRing, desk: EnrolmentDesk | None, key: str) -> None:
        self.device, self._client, self._ring, self._desk = device, client, ring, desk
        self.offered = key
        self._refused_keys: set[str] = set()
        self._has_complained = False
        client.on_refused(self._refused)
        client.on_connected(self._accepted)

    def _accepted(self) -> None:
        self._refused_keys.clear()
        self._has_complained = False
        try:
            if self.offered:
                self._ring.accept(self.device, self.offered)
        except (OSError, ValueError) as error:
            log.warning("%s: the key with which it came in cannot be kept: %s", self.device, error)

    def _refused(self) -> None:
        self._refused_keys.add(self.offered)
        try:
            known = self._ring.keys(self.device)
            following = next((key for key in known if key not in self._refused_keys), "") or self._enrol(known)
        except (OSError, ValueError) as error:
            log.warning("The keys of %s cannot be read or kept: %s", self.device, error)
            return
        if following:
            self.offered = following
            self._client.change_password(following)

    def _enrol(self, known: list[str]) -> str:
        """Bring a key to the site, and return the one to go on with: all that are known have been refused."""
        self._refused_keys.clear()
        self._complain()
        if self._desk is None:
            return known[0] if known else ""
        key = self._ring.key_to_enrol(self.device)
        self._desk.bring(self.device, key)
        return key

    def _complain(self) -> None:
        """Say in the log, once until it is let in, what will become of the device."""
        if self._has_complained:
            return
        self._has_complained = True
        if self._desk is None:
            log.warning(UNKNOWN, self.device)
        else:
            log.warning(PENDING, self.device, self._desk.site, GIVEN_KEYS)


def take_new_keys(device: str, client: MqttClient, keep: Callable[[str], None]) -> None:
    """Let a device's connection hear `down/credential`, and answer; `keep` may raise OSError and ValueError."""

    def hear(_topic: str, payload: bytes, retained: bool) -> None:
        command = None if retained else read_command("credential", payload)
        key = command.arguments.get("credential") if command else None
        if command is None or not isinstance(key, str) or not is_strong(key):
            log.warning("%s: a message on down/credential brings no key; it was ignored.", device)
            return
        try:
            keep(key)
        except (OSError, ValueError) as error:
            _answer(client, device, AckMessage(command.id, "FAILED", f"The key cannot be kept: {error}"[:256]))
            return
        client.change_password(key)
        _answer(client, device, AckMessage(command.id, "DONE"))

    client.subscribe(down_topic(device, "credential"), 1, hear)


def _answer(client: MqttClient, device: str, ack: AckMessage) -> None:
    client.publish(up_topic(device, "ack"), ack_payload(ack))

"""How a virtual device comes in after people have decided about it: by each key that may be right, or by knocking.

Two keys are kept of a device: the one with which it came in last, and a spare one, which is the one before, or one that
was made for a knock. Neither is given up for one that the broker has not let the device in with.
"""

from __future__ import annotations

import json
import logging
import random
import threading
import time
from collections.abc import Callable

from vipo_device.kit.keyring import KeyFile
from vipo_device.protocol.credentials import make_credential
from vipo_device.protocol.mqtt_client import MqttClient

log = logging.getLogger(__name__)
PATIENCE_S = 5.0
PAUSE_S = (5.0, 30.0)


class Door:
    """A site's door, at which the devices of a twin knock one after the other.

    `open_door` makes a connection as the newcomers of the site, with its join key.
    """

    def __init__(self, site: str, open_door: Callable[[], MqttClient]) -> None:
        self._site, self._open_door = site, open_door
        self._one_at_a_time = threading.Lock()
        self._next_s: dict[str, float] = {}

    def knock(self, device: str, key: str) -> None:
        """Knock in a thread of its own, unless the device has done so 5 to 30 s ago; returns at once."""
        if time.monotonic() < self._next_s.get(device, 0.0):
            return
        # As all newcomers of a site are one client there, they must not knock in step.
        self._next_s[device] = time.monotonic() + random.uniform(*PAUSE_S)  # noqa: S311 - not a secret
        threading.Thread(target=self._knock, args=(device, key), name=f"door-{device}", daemon=True).start()

    def _knock(self, device: str, key: str) -> None:
        with self._one_at_a_time:
            client = self._open_door()
            client.start()
            if client.wait_connected(PATIENCE_S):
                client.publish(f"vipo/v1/join/{self._site}/{device}", json.dumps({"key": key}).encode())
            else:
                log.warning("%s cannot knock: %s", device, client.refusal or "the broker does not answer.")
            client.stop()


class Entrance:
    """The keys of one device; `keys` and `spares` are files, which people may write into, too."""

    def __init__(self, device: str, client: MqttClient, keys: KeyFile, spares: KeyFile, door: Door | None) -> None:
        self._device, self._client = device, client
        self._keys, self._spares, self._door = keys, spares, door
        self._offered = keys.find(device)
        self._tried: set[str] = set()
        self._made = ""
        client.on_refused(self._refused)
        client.on_connected(self._came_in)

    def keep(self, device: str, key: str) -> None:
        """Keep a new key that the server gave, and the one before as the spare one. Raises OSError, ValueError."""
        before = self._keys.find(device)
        self._keys.keep(device, key)
        self._offered = key
        if before:
            self._spares.keep(device, before)

    def _came_in(self) -> None:
        """Learn with which key the device was let in: that one stays, the other one is spare."""
        self._tried.clear()
        self._made = ""
        try:
            if self._offered and self._offered != self._keys.find(self._device):
                self.keep(self._device, self._offered)
        except (OSError, ValueError) as error:
            log.warning("%s: the key with which it came in cannot be kept: %s", self._device, error)

    def _refused(self) -> None:
        """Try another key the next time; when none is left, make one and knock with it."""
        self._tried.add(self._offered)
        try:
            known = [key for key in (self._keys.find(self._device), self._spares.find(self._device)) if key]
            following = next((key for key in known if key not in self._tried), "") or self._knock(known)
        except (OSError, ValueError) as error:
            log.warning("The keys of %s cannot be read or kept: %s", self._device, error)
            return
        if following:
            self._offered = following
            self._client.change_password(following)

    def _knock(self, known: list[str]) -> str:
        """Return the key to go on with once all have been refused."""
        self._tried.clear()
        if self._door is None:
            return known[0] if known else ""
        if not self._made:
            self._made = make_credential()
            self._spares.keep(self._device, self._made)
        self._door.knock(self._device, self._made)
        return self._made

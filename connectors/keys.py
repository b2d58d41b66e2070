"""The keys with which devices of other worlds come in, and the knocking by which a newcomer brings its own."""

from __future__ import annotations

import fcntl
import json
import logging
import os
import secrets
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from vipo_device.protocol.mqtt_client import MqttClient

log = logging.getLogger(__name__)
PATIENCE_S = 2.0
KEY_BYTES = 24
NEW_KEY = "A key that it was given belongs into secrets/devices.json."
LEAST_PAUSE_S, MOST_PAUSE_S = 5, 30


class KeyRing:
    """Keys by device: those that people wrote into `by_hand`, and those that were made here, kept in `own`."""

    def __init__(self, by_hand: Path, own: Path) -> None:
        self._by_hand, self._own = by_hand, own

    def key(self, device: str) -> str:
        """Return a device's key; one that has none gets one, which is kept for this user's eyes only."""
        with _alone(self._own):
            own = _read(self._own)
            found = _read(self._by_hand).get(device) or own.get(device)
            if found is None:
                found = secrets.token_urlsafe(KEY_BYTES)
                _write(self._own, {**own, device: found})
            return found


@contextmanager
def _alone(path: Path) -> Iterator[None]:
    """Keep others out meanwhile, since several connectors of a site may share a file of keys."""
    path.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
    with path.with_suffix(".lock").open("a") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def _read(path: Path) -> dict[str, str]:
    try:
        body = json.loads(path.read_text())
    except FileNotFoundError:
        return {}
    except (OSError, ValueError) as error:
        log.warning("%s cannot be read (%s); its keys are not used.", path, error)
        return {}
    return {str(name): str(key) for name, key in body.items()} if isinstance(body, dict) else {}


def _write(path: Path, keys: dict[str, str]) -> None:
    draft = path.with_suffix(".new")
    draft.touch(mode=0o600)
    draft.write_text(json.dumps(keys))
    os.replace(draft, path)  # noqa: PTH105 - the atomic rename is what matters here


class Doorstep:
    """What a device does that is not let in: it tries the key that people wrote meanwhile, or knocks, again and again.

    `open_door` makes a connection as the newcomers of the site, with its join key; None where there is no such key.
    """

    def __init__(self, site: str, ring: KeyRing, open_door: Callable[[], MqttClient] | None) -> None:
        self._site, self._ring, self._open_door = site, ring, open_door
        self._one_at_a_time = threading.Lock()
        self._next_s: dict[str, float] = {}
        self._told: set[str] = set()

    def watch(self, device: str, key: str, client: MqttClient) -> None:
        """Follow how a device is let in, for as long as its connection is wanted."""
        offered = [key]
        client.on_refused(lambda: self._refused(device, offered, client))
        client.on_connected(lambda: self._told.discard(device))

    def _refused(self, device: str, offered: list[str], client: MqttClient) -> None:
        key = self._ring.key(device)
        if key != offered[-1]:
            offered[:] = [key]
            client.change_password(key)
            return
        self._tell(device)
        open_door = self._open_door
        if open_door is not None and time.monotonic() >= self._next_s.get(device, 0.0):
            # As all newcomers of a site are one client there, they must not knock in step.
            pause_s = LEAST_PAUSE_S + secrets.randbelow(MOST_PAUSE_S - LEAST_PAUSE_S)
            self._next_s[device] = time.monotonic() + pause_s
            told = (device, key, open_door)
            threading.Thread(target=self._knock, args=told, name=f"door-{device}", daemon=True).start()

    def _tell(self, device: str) -> None:
        """Say in the log, once until it is let in, what will become of a device."""
        if device in self._told:
            return
        self._told.add(device)
        if self._open_door is None:
            log.warning("%s has no key that is known: write one into secrets/devices.json, or name a join key.", device)
        else:
            log.warning("%s is not let in at %s: it knocks, and waits for an admin. %s", device, self._site, NEW_KEY)

    def _knock(self, device: str, key: str, open_door: Callable[[], MqttClient]) -> None:
        with self._one_at_a_time:
            door = open_door()
            door.start()
            if door.wait_connected(PATIENCE_S):
                door.publish(f"vipo/v1/join/{self._site}/{device}", json.dumps({"key": key}).encode())
            else:
                log.warning("%s cannot knock at %s: %s.", device, self._site, door.refusal or "the broker is away")
            door.stop()

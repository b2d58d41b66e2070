"""The keys with which devices of other worlds come in, and the knocking by which a newcomer brings its own."""

from __future__ import annotations

import fcntl
import json
import logging
import os
import secrets
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from registry.mqtt import MqttClient

log = logging.getLogger(__name__)
PATIENCE_S = 2.0
KEY_BYTES = 24
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
    """Knocks for devices that are refused, one at a time, until each is let in as itself.

    `open_door` makes a connection as the newcomers of the site, with its join key.
    """

    def __init__(self, site: str, open_door: Callable[[], MqttClient]) -> None:
        self._site, self._open_door = site, open_door
        self._one_at_a_time = threading.Lock()

    def wait(self, device: str, key: str, client: MqttClient) -> None:
        """Follow a device's first attempts to come in, in a thread of their own."""
        threading.Thread(target=self._wait, args=(device, key, client), name=f"door-{device}", daemon=True).start()

    def _wait(self, device: str, key: str, client: MqttClient) -> None:
        pause, has_knocked = threading.Event(), False
        while not client.wait_connected(PATIENCE_S):
            if client.refusal:
                if not has_knocked:
                    log.warning("%s is not known at %s; it knocks, and waits for an admin.", device, self._site)
                has_knocked = True
                self._knock(device, key)
                # As all newcomers of a site are one client there, they must not knock in step.
                pause.wait(LEAST_PAUSE_S + secrets.randbelow(MOST_PAUSE_S - LEAST_PAUSE_S))

    def _knock(self, device: str, key: str) -> None:
        with self._one_at_a_time:
            door = self._open_door()
            door.start()
            if door.wait_connected(PATIENCE_S):
                door.publish(f"vipo/v1/join/{self._site}/{device}", json.dumps({"key": key}).encode())
            else:
                log.warning("%s cannot knock at %s: %s.", device, self._site, door.refusal or "the broker is away")
            door.stop()

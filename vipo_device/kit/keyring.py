"""Virtual devices take a new key that the server gives them, as real ones do: kept first, used from then on."""

from __future__ import annotations

import json
import logging
import os
import threading
from pathlib import Path
from typing import Protocol

from vipo_device.protocol.credentials import is_strong
from vipo_device.protocol.messages import AckMessage, ack_payload, down_topic, read_command, up_topic
from vipo_device.protocol.mqtt_client import MqttClient

log = logging.getLogger(__name__)


class Keeper(Protocol):
    """What keeps the new keys of devices."""

    def keep(self, device: str, key: str) -> None:
        """Keep a device's new key. Raises OSError, ValueError."""


class KeyFile:
    """The devices' keys by id, in a file that only its owner may read."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._guard = threading.Lock()

    def keep(self, device: str, key: str) -> None:
        """Replace a device's key; the file is written whole or not at all. Raises OSError."""
        with self._guard:
            keys = self._read()
            part = self._path.with_name(self._path.name + ".new")
            part.unlink(missing_ok=True)
            with os.fdopen(os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w") as file:
                json.dump({**keys, device: key}, file, indent=1)
            part.replace(self._path)

    def find(self, device: str) -> str:
        """Return a device's key, empty where there is none. Raises OSError, ValueError."""
        with self._guard:
            return str(self._read().get(device, ""))

    def _read(self) -> dict[str, str]:
        keys: object = json.loads(self._path.read_text()) if self._path.exists() else {}
        if not isinstance(keys, dict):
            raise ValueError(f"{self._path.name} is no JSON object of keys by device.")  # noqa: TRY004 - a bad text
        return keys


def take_new_keys(device: str, client: MqttClient, keeper: Keeper) -> None:
    """Let a device's connection hear `down/credential`, keep what comes, and answer."""

    def hear(_topic: str, payload: bytes, retained: bool) -> None:
        told = None if retained else read_command("credential", payload)
        key = told.arguments.get("credential") if told else None
        if told is None or not isinstance(key, str) or not is_strong(key):
            log.warning("%s: a message on down/credential brings no key; it was ignored.", device)
            return
        try:
            keeper.keep(device, key)
        except (OSError, ValueError) as error:
            _answer(client, device, AckMessage(told.command, "FAILED", f"The key cannot be kept: {error}"[:256]))
            return
        client.change_password(key)
        _answer(client, device, AckMessage(told.command, "DONE"))

    client.subscribe(down_topic(device, "credential"), 1, hear)


def _answer(client: MqttClient, device: str, ack: AckMessage) -> None:
    client.publish(up_topic(device, "ack"), ack_payload(ack))

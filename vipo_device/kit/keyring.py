"""The keys of devices, in files that only their owner may read, and which of them a device comes in with next."""

from __future__ import annotations

import json
import logging
from itertools import count
from pathlib import Path

from vipo_device.kit.atomic_file import locked, write_file
from vipo_device.protocol.credentials import make_credential

log = logging.getLogger(__name__)


class KeyFile:
    """Keys by device, as one JSON object; people may write into it, too, and processes may share it."""

    def __init__(self, path: Path) -> None:
        self._path = path

    def find(self, device: str) -> str:
        """Return a device's key, empty where there is none. Raises OSError, ValueError."""
        return self._read().get(device, "")

    def keep(self, device: str, key: str) -> None:
        """Replace a device's key. Raises OSError, ValueError."""
        with locked(self._path):
            self._write({**self._read(), device: key})

    def find_readable(self, device: str) -> str:
        """Return a device's key; a file that cannot be read has none, and the log says so."""
        return self._read_readable().get(device, "")

    def devices(self) -> frozenset[str]:
        """Return who has a key. Raises ValueError, which names the file."""
        try:
            return frozenset(device for device, key in self._read().items() if key)
        except (OSError, ValueError) as error:
            raise ValueError(f"{self._path} cannot be read ({error}).") from error

    def find_or_make(self, device: str) -> str:
        """Return a device's key; one that has none gets one. Raises OSError.

        A file that cannot be read begins anew; what stood in it is kept beside it, for people to mend.
        """
        with locked(self._path):
            try:
                keys = self._read()
            except (OSError, ValueError) as error:
                keys, kept = {}, self._put_aside()
                log.warning("%s cannot be read (%s); it begins anew, and is kept as %s.", self._path, error, kept.name)
            if device not in keys:
                keys[device] = make_credential()
                self._write(keys)
            return keys[device]

    def _put_aside(self) -> Path:
        names = (self._path.with_name(f"{self._path.name}.damaged{number or ''}") for number in count())
        return self._path.rename(next(name for name in names if not name.exists()))

    def _read(self) -> dict[str, str]:
        try:
            keys: object = json.loads(self._path.read_text())
        except FileNotFoundError:
            return {}
        if not isinstance(keys, dict):
            raise ValueError(f"{self._path.name} is no JSON object of keys by device.")  # noqa: TRY004 - a bad text
        return {str(device): str(key) for device, key in keys.items()}

    def _read_readable(self) -> dict[str, str]:
        try:
            return self._read()
        except (OSError, ValueError) as error:
            log.warning("%s cannot be read (%s); its keys are not used.", self._path, error)
            return {}

    def _write(self, keys: dict[str, str]) -> None:
        write_file(self._path, json.dumps(keys, indent=1), private=True)


class KeyRing:
    """The keys of a site's devices: those that people wrote, which go first, and those that were made here."""

    def __init__(self, given: Path, own: Path) -> None:
        self._given, self._own = KeyFile(given), KeyFile(own)

    def first_key(self, device: str) -> str:
        """Return the key to begin with, empty where none is known. Raises OSError."""
        return self._given.find_readable(device) or self._own.find_or_make(device)

    def devices(self) -> frozenset[str]:
        """Return who has a key, whatever has become of it. Raises ValueError, which names the file."""
        return self._given.devices() | self._own.devices()

    def keys(self, device: str) -> list[str]:
        """Return the keys that may be right now, the likeliest first. Raises OSError, ValueError."""
        return [self.first_key(device)]

    def key_to_enrol(self, device: str) -> str:
        """Return the key with which a device asks to be let in. Raises OSError, ValueError."""
        return self.first_key(device)

    def accept(self, device: str, key: str) -> None:
        """Learn with which key a device was let in. Raises OSError, ValueError."""


class RotatingKeyRing(KeyRing):
    """Keys that the server may replace: the one with which a device came in last, and a spare one.

    The spare one is the one before, or one that was made to enrol with. Neither is given up for one that the broker has
    not let the device in with.
    """

    def __init__(self, current: Path, spares: Path) -> None:
        super().__init__(current, spares)
        self._made: dict[str, str] = {}

    def first_key(self, device: str) -> str:
        """Return the key with which the device came in last, empty where it never did. Raises OSError, ValueError."""
        return self._given.find(device)

    def keys(self, device: str) -> list[str]:
        """Return the key with which the device came in last, and the spare one. Raises OSError, ValueError."""
        return [key for key in (self._given.find(device), self._own.find(device)) if key]

    def key_to_enrol(self, device: str) -> str:
        """Return a fresh key, the same one until the device is let in. Raises OSError, ValueError."""
        if device not in self._made:
            made = make_credential()
            self._own.keep(device, made)
            self._made[device] = made
        return self._made[device]

    def accept(self, device: str, key: str) -> None:
        """Keep the key with which a device was let in; the other one is spare. Raises OSError, ValueError."""
        self._made.pop(device, None)
        if key != self._given.find(device):
            self.replace(device, key)

    def replace(self, device: str, key: str) -> None:
        """Keep a device's new key, and the one before as the spare one. Raises OSError, ValueError."""
        before = self._given.find(device)
        self._given.keep(device, key)
        if before:
            self._own.keep(device, before)

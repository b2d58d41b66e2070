"""Commands of the server as a device reads them, and what it remembers of those it has answered."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite

from registry.errors import RegistryError
from registry.wire import AckMessage, is_device_id, parse_json

REMEMBERED = 16
OPEN = frozenset({"ACCEPTED", "RUNNING"})


@dataclass(frozen=True, slots=True)
class Told:
    """A command: its id, the method, and the arguments by name."""

    command: str
    method: str
    arguments: Mapping[str, object]


def read_command(method: str, payload: bytes) -> Told | None:
    """Read `{"id", "v", "ttl_s"}`; None when it is no command."""
    try:
        body = parse_json(payload)
    except RegistryError:
        return None
    command, arguments = (body.get("id"), body.get("v", {})) if isinstance(body, dict) else (None, None)
    if not isinstance(command, str) or not 0 < len(command) <= 64 or not is_device_id(method):
        return None
    return Told(command, method, arguments) if isinstance(arguments, dict) else None


def read_stop(payload: bytes) -> bool:
    """Read a site's stop; what cannot be read stops, what is empty does not."""
    if not payload:
        return False
    try:
        body = json.loads(payload)
    except (ValueError, RecursionError):
        return True
    return not (isinstance(body, dict) and body.get("active") is False)


def is_number(value: object) -> bool:
    """Tell whether a value is a finite number and not a truth value."""
    return isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value)


class Answers:
    """The last word about each open command, and about the last 16 that are over."""

    def __init__(self, over: tuple[AckMessage, ...] = (), under_way: tuple[AckMessage, ...] = ()) -> None:
        self._over = {ack.command: ack for ack in over}
        self._under_way = {ack.command: ack for ack in under_way}

    def find(self, command: str) -> AckMessage | None:
        """Return the last word about a command, None when nothing was said."""
        return self._under_way.get(command) or self._over.get(command)

    def note(self, ack: AckMessage) -> None:
        """Keep what is said; a final answer closes the command and pushes the oldest one out."""
        if ack.status in OPEN:
            self._under_way[ack.command] = ack
            return
        self._under_way.pop(ack.command, None)
        self._over[ack.command] = ack
        while len(self._over) > REMEMBERED:
            del self._over[next(iter(self._over))]

    def over(self) -> tuple[AckMessage, ...]:
        """Return the final answers that are remembered, the oldest first."""
        return tuple(self._over.values())

    def under_way(self) -> tuple[AckMessage, ...]:
        """Return the last words about what is not over."""
        return tuple(self._under_way.values())

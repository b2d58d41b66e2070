"""What the server tells a device, as the device reads it: commands, and the stop of its site."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass

from registry.errors import RegistryError
from registry.wire import is_device_id, parse_json


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

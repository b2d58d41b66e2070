"""The JSON of VIPO's protocol, as a robot reads and writes it (docs/protocol.md)."""

from __future__ import annotations

import base64
import json
import re
import zlib
from typing import Any, Iterator, NamedTuple

MAX_BYTES = 16 * 1024
MAX_WHY = 256
PART_BYTES = 9000
LARGEST = 1e300
MAX_FENCE = 2**53
METHOD = re.compile(r"[A-Za-z_][A-Za-z0-9_]{0,63}")


class Told(NamedTuple):
    """A command: its id, the method, the arguments by name, and the fence under which it was sent, if there is one."""

    command: str
    method: str
    arguments: dict[str, Any]
    fence: int | None = None


class Stop(NamedTuple):
    """A site's stop, and the fence that it raised, if there is one."""

    active: bool
    fence: int | None = None


class Grid(NamedTuple):
    """An occupancy grid as ROS has it: cells row by row from the bottom, -1 unknown, 0 to 100 occupied; metres."""

    width: int
    height: int
    resolution_m: float
    origin: tuple[float, float, float]
    cells: bytes


def read_command(method: str, payload: bytes) -> Told | None:
    """Read `{"id", "v", "ttl_s", "fence"?}`; None when it is no command."""
    body = read_object(payload)
    if body is None or METHOD.fullmatch(method) is None:
        return None
    command, arguments = body.get("id"), body.get("v", {})
    if not isinstance(command, str) or not 0 < len(command) <= 64 or not isinstance(arguments, dict):
        return None
    return Told(command, method, arguments, _fence(body))


def read_stop(payload: bytes) -> Stop:
    """Read a site's stop; what cannot be read stops, what is empty does not."""
    if not payload:
        return Stop(False)
    body = read_object(payload)
    return Stop(True) if body is None else Stop(body.get("active") is not False, _fence(body))


def _fence(body: dict[str, Any]) -> int | None:
    said = body.get("fence")
    return said if isinstance(said, int) and not isinstance(said, bool) and 0 <= said <= MAX_FENCE else None


def read_object(payload: bytes) -> dict[str, Any] | None:
    """Return a JSON object; None for anything else."""
    if len(payload) > MAX_BYTES:
        return None
    try:
        body = json.loads(payload.decode("utf-8"), parse_constant=_refuse)
    except (ValueError, RecursionError):
        return None
    return body if isinstance(body, dict) else None


def _refuse(name: str) -> Any:
    raise ValueError(f"{name} is not a number of JSON")


def write(body: dict[str, Any]) -> bytes:
    """Write a message."""
    return json.dumps(body, ensure_ascii=False, separators=(",", ":"), allow_nan=False).encode()


def is_number(value: object) -> bool:
    """Tell whether a value is a finite number and not a truth value."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) <= LARGEST


def read_path(value: object) -> list[tuple[float, float]] | None:
    """Read a list of 1 to 200 points [x, y]; None when it is none."""
    if not isinstance(value, list) or not 1 <= len(value) <= 200:
        return None
    if not all(isinstance(p, list) and len(p) == 2 and all(is_number(c) for c in p) for p in value):
        return None
    return [(float(x), float(y)) for x, y in value]


def write_grid(grid: Grid, boot: int, number: int) -> Iterator[bytes]:
    """Write a map as the messages of `up/map`, none of them over the packet limit."""
    known = grid.cells.translate(_CELLS)
    packed = zlib.compress(known, 9)
    parts = max(1, -(-len(packed) // PART_BYTES))
    for part in range(parts):
        chunk = packed[part * PART_BYTES : (part + 1) * PART_BYTES]
        yield write(
            {
                "boot": boot,
                "map": number,
                "part": part,
                "parts": parts,
                "size": [grid.width, grid.height],
                "resolution": grid.resolution_m,
                "origin": list(grid.origin),
                "cells": base64.b64encode(chunk).decode(),
            }
        )


_CELLS = bytes(value if value <= 100 else 255 for value in range(256))
"""ROS writes unknown as -1, which is the byte 255; what lies above 100 means nothing."""

"""A robot's map on `up/map`: written as parts in JSON, and put together again with suspicion (docs/protocol.md)."""

from __future__ import annotations

import base64
import binascii
import json
import zlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from math import isfinite
from typing import Any

from registry.floorplan.plan import FREE, OCCUPIED, UNKNOWN, Grid
from vipo_device.protocol.faults import fault
from vipo_device.protocol.messages import MAX_METRES, MESSAGE, BadMessage, parse_json

MAX_CELLS = 16_000_000
MAX_SIDE = 8192
MAX_PARTS = 400
PART_BYTES = 9000
_KNOWN = bytes([*range(101), 255])
FREE_BELOW, OCCUPIED_ABOVE = 20, 65
_KINDS = bytes(
    FREE if cell < FREE_BELOW else OCCUPIED if OCCUPIED_ABOVE < cell <= 100 else UNKNOWN for cell in range(256)
)


@dataclass(frozen=True, slots=True)
class GridPart:
    """One message: part `part` of `parts` of the map `number` of a boot; `origin` is x, y (m) and theta (rad)."""

    boot: int
    number: int
    part: int
    parts: int
    width: int
    height: int
    resolution_m: float
    origin: tuple[float, float, float]
    packed: bytes


def write_grid(grid: Grid, boot: int, number: int) -> Iterator[bytes]:
    """Write a map as the messages of `up/map`, none of them over the packet limit."""
    packed = zlib.compress(grid.cells, 9)
    parts = -(-len(packed) // PART_BYTES)
    head = {"boot": boot, "map": number, "parts": parts, "size": [grid.width, grid.height]}
    place = {"resolution": grid.resolution_m, "origin": [grid.origin_x_m, grid.origin_y_m, 0]}
    for part in range(parts):
        cells = base64.b64encode(packed[part * PART_BYTES : (part + 1) * PART_BYTES]).decode()
        yield json.dumps({**head, "part": part, **place, "cells": cells}, separators=(",", ":")).encode()


def belong_together(first: GridPart, other: GridPart) -> bool:
    """Tell whether two parts of the same map say the same of its size, place and number of parts."""
    return _head(first) == _head(other)


def join_parts(parts: Iterable[GridPart]) -> Grid:
    """Put all parts of a map together, in whatever order they are given; cells 0 to 100, or 255. Raises BadMessage."""
    by_number = {part.part: part for part in parts}
    first = next(iter(by_number.values()))
    if not all(belong_together(first, part) for part in by_number.values()):
        raise BadMessage(fault("map_parts_differ"))
    if len(by_number) < first.parts:
        raise BadMessage(fault("map_parts_missing", count=len(by_number), parts=first.parts))
    return unpack_grid(first, b"".join(by_number[number].packed for number in range(first.parts)))


def plain_grid(grid: Grid) -> Grid:
    """Return a robot's grid with the three kinds of cells that maps have here, by map_server's usual thresholds."""
    return replace(grid, cells=grid.cells.translate(_KINDS))


def read_grid_part(payload: bytes) -> GridPart:
    """Read one message of `up/map`. Raises BadMessage."""
    body = parse_json(payload)
    if not isinstance(body, dict):
        raise BadMessage(fault("no_object", it=MESSAGE))
    parts = _whole(body, "parts", 1, MAX_PARTS)
    width, height = _size(body.get("size"))
    return GridPart(
        boot=_whole(body, "boot", 0, 2**53),
        number=_whole(body, "map", 0, 2**53),
        part=_whole(body, "part", 0, parts - 1),
        parts=parts,
        width=width,
        height=height,
        resolution_m=_resolution(body.get("resolution")),
        origin=_origin(body.get("origin")),
        packed=_packed(body.get("cells")),
    )


def _head(part: GridPart) -> tuple[Any, ...]:
    return part.parts, part.width, part.height, part.resolution_m, part.origin


def unpack_grid(part: GridPart, packed: bytes) -> Grid:
    """Return the map of which one part and all packed cells are given; never unpacks more. Raises BadMessage."""
    if abs(part.origin[2]) > 1e-6:
        raise BadMessage(fault("map_turned"))
    wanted = part.width * part.height
    unpacker = zlib.decompressobj()
    try:
        cells = unpacker.decompress(packed, wanted + 1)
    except zlib.error:
        raise BadMessage(fault("map_not_packed")) from None
    if len(cells) != wanted or not unpacker.eof or unpacker.unused_data:
        raise BadMessage(fault("map_cell_count", wanted=wanted))
    if cells.translate(None, _KNOWN):
        raise BadMessage(fault("map_cell"))
    return Grid(part.width, part.height, part.resolution_m, part.origin[0], part.origin[1], cells)


def _whole(body: dict[str, Any], name: str, least: int, most: int) -> int:
    value = body.get(name)
    if not isinstance(value, int) or isinstance(value, bool) or not least <= value <= most:
        raise BadMessage(fault("map_whole", key=name, least=least, most=most))
    return value


def _size(value: Any) -> tuple[int, int]:
    if not isinstance(value, list) or len(value) != 2 or not all(type(v) is int and 1 <= v <= MAX_SIDE for v in value):
        raise BadMessage(fault("map_size", most=MAX_SIDE))
    if value[0] * value[1] > MAX_CELLS:
        raise BadMessage(fault("map_cells", most=MAX_CELLS))
    return value[0], value[1]


def _resolution(value: Any) -> float:
    if not _is_number(value) or not 0.001 <= value <= 10:
        raise BadMessage(fault("map_resolution"))
    return float(value)


def _origin(value: Any) -> tuple[float, float, float]:
    if not isinstance(value, list) or len(value) != 3 or not all(_is_number(v) and abs(v) <= MAX_METRES for v in value):
        raise BadMessage(fault("map_origin"))
    return float(value[0]), float(value[1]), float(value[2])


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value)


def _packed(value: Any) -> bytes:
    if not isinstance(value, str) or not value:
        raise BadMessage(fault("map_base64"))
    try:
        return base64.b64decode(value, validate=True)
    except (binascii.Error, ValueError):
        raise BadMessage(fault("map_base64")) from None

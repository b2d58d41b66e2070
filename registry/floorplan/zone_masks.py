"""Zones as Nav2 takes them: masks over the map, cell for cell, and the parameters that say what their values mean.

A mask has the size, resolution and origin of the map. A cell is of a zone if the zone touches it: half a cell in front
of a keep-out is kept out of, too. Nav2 reads values from 0 to 100 of a mask (map_server mode `scale`): for the keep-out
filter 100 is shut; for the speed filter 0 is no limit, and others are metres a second by `multiplier`
(https://docs.nav2.org, costmap filter info server).
"""

from __future__ import annotations

from collections.abc import Iterable
from math import gcd
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from registry.floorplan.map_archive import write_archive
from registry.floorplan.map_server import plain_number
from registry.floorplan.plan import Grid
from registry.floorplan.polygons import Outline, sides_of

SHUT, MOST_VALUE = 100, 100
KEEPOUT, SPEED = "keepout", "speed"
Mask = NDArray[np.uint8]


class Zone(Protocol):
    """What a mask needs of a zone: corners in metres, `keep_out`, `slow` or another rule, metres a second."""

    @property
    def rule(self) -> str:
        """Return its rule."""

    @property
    def points(self) -> Outline:
        """Return its corners."""

    @property
    def speed_m_s(self) -> float | None:
        """Return how fast one may drive where it is slow."""


def write_nav2_archive(grid: Grid, zones: Iterable[Zone]) -> bytes:
    """Return a .zip: both masks as map_server files, and `costmap_filters.yaml` for the nodes that serve them."""
    zones = tuple(zones)
    speed, multiplier = speed_mask(grid, zones)
    masks = {KEEPOUT: keepout_mask(grid, zones), SPEED: speed}
    files = {f"{name}_mask.pgm": _image(mask) for name, mask in masks.items()}
    files |= {f"{name}_mask.yaml": _header(grid, f"{name}_mask.pgm") for name in masks}
    return write_archive({**files, "costmap_filters.yaml": _parameters(multiplier)})


def keepout_mask(grid: Grid, zones: Iterable[Zone]) -> Mask:
    """Return a mask [row from the bottom, column]: 100 where robots keep out, else 0."""
    mask = np.zeros((grid.height, grid.width), dtype=np.uint8)
    for zone in zones:
        if zone.rule == "keep_out":
            mask[cells_touched(grid, zone.points)] = SHUT
    return mask


def speed_mask(grid: Grid, zones: Iterable[Zone]) -> tuple[Mask, float]:
    """Return a mask [row from the bottom, column] and the metres a second that a value of 1 stands for.

    Where zones overlap the slowest holds; a speed that no value stands for is rounded down.
    """
    slow = [(zone, round((zone.speed_m_s or 0.05) * 1000)) for zone in zones if zone.rule == "slow"]
    mask = np.zeros((grid.height, grid.width), dtype=np.uint8)
    if not slow:
        return mask, 0.01
    step, fastest = gcd(*(mm for _, mm in slow)), max(mm for _, mm in slow)
    step_mm = step if fastest <= MOST_VALUE * step else fastest / MOST_VALUE
    for zone, mm in sorted(slow, key=lambda each: -each[1]):
        mask[cells_touched(grid, zone.points)] = max(1, int(mm / step_mm + 1e-9))
    return mask, step_mm / 1000


def cells_touched(grid: Grid, outline: Outline) -> NDArray[np.bool_]:
    """Return which cells [row from the bottom, column] a polygon touches, be it by a corner of theirs."""
    left, bottom, side = grid.origin_x_m, grid.origin_y_m, grid.resolution_m
    corners = [((x - left) / side, (y - bottom) / side) for x, y in outline]
    columns = _window([x for x, _ in corners], grid.width)
    rows = _window([y for _, y in corners], grid.height)
    inside = np.zeros((rows.stop - rows.start, columns.stop - columns.start + 1), dtype=np.int16)
    edges = np.zeros_like(inside)
    for start, end in sides_of(tuple((x - columns.start, y - rows.start) for x, y in corners)):
        _mark_inside(inside, start, end)
        _mark_edge(edges, start, end)
    odd = np.cumsum(inside, axis=1, dtype=np.int16)[:, :-1] % 2 == 1
    touched = np.zeros((grid.height, grid.width), dtype=np.bool_)
    touched[rows, columns] = odd | (np.cumsum(edges, axis=1, dtype=np.int16)[:, :-1] > 0)
    return touched


def _window(values: list[float], count: int) -> slice:
    """Return the rows or columns between which a polygon lies, as far as they are on the map."""
    first = min(max(int(np.floor(min(values))), 0), count)
    return slice(first, max(first, min(int(np.floor(max(values))) + 1, count)))


def _mark_inside(turns: NDArray[np.int16], start: tuple[float, float], end: tuple[float, float]) -> None:
    """Turn over, in each row whose middle a side crosses, all cells whose middle is right of it."""
    (x1, y1), (x2, y2) = (start, end) if start[1] <= end[1] else (end, start)
    rows = _rows(turns, np.ceil(y1 - 0.5), np.ceil(y2 - 0.5))
    if rows.size:
        at = x1 + (rows + 0.5 - y1) * (x2 - x1) / (y2 - y1)
        columns = np.clip(np.ceil(at - 0.5), 0, turns.shape[1] - 1).astype(np.int64)
        np.add.at(turns, (rows, columns), 1)


def _mark_edge(marks: NDArray[np.int16], start: tuple[float, float], end: tuple[float, float]) -> None:
    """Mark in each row the cells that a side goes through."""
    (x1, y1), (x2, y2) = (start, end) if start[1] <= end[1] else (end, start)
    rows = _rows(marks, np.floor(y1), np.floor(y2) + 1)
    slope = (x2 - x1) / (y2 - y1) if y2 > y1 else 0.0
    at_low = x1 + (np.maximum(rows, y1) - y1) * slope
    at_high = x1 + (np.minimum(rows + 1, y2) - y1) * slope if y2 > y1 else np.full(rows.shape, x2)
    width = marks.shape[1] - 1
    first = np.floor(np.minimum(at_low, at_high)).astype(np.int64)
    last = np.floor(np.maximum(at_low, at_high)).astype(np.int64)
    on_map = (last >= 0) & (first < width)
    np.add.at(marks, (rows[on_map], np.maximum(first[on_map], 0)), 1)
    np.add.at(marks, (rows[on_map], np.minimum(last[on_map] + 1, width)), -1)


def _rows(array: NDArray[np.int16], first: float, end: float) -> NDArray[np.int64]:
    return np.arange(max(0, int(first)), max(0, min(array.shape[0], int(end))), dtype=np.int64)


def _image(mask: Mask) -> bytes:
    """Return a mask as a binary PGM, whose darkness in map_server's mode `scale` is the very value."""
    shades = (255 - np.round(np.arange(101) * 2.55)).astype(np.uint8)
    height, width = mask.shape
    return f"P5\n{width} {height}\n255\n".encode() + np.flipud(shades[mask]).tobytes()


def _header(grid: Grid, image: str) -> bytes:
    lines = (
        f"image: {image}",
        "mode: scale",
        f"resolution: {plain_number(grid.resolution_m)}",
        f"origin: [{plain_number(grid.origin_x_m)}, {plain_number(grid.origin_y_m)}, 0]",
        "negate: 0",
        "occupied_thresh: 1.0",
        "free_thresh: 0.0",
    )
    return ("\n".join(lines) + "\n").encode()


def _parameters(multiplier: float) -> bytes:
    """Return the parameters of Nav2's nodes: who serves a mask, who tells what it means, who heeds it."""
    filters = (
        (KEEPOUT, "nav2_costmap_2d::KeepoutFilter", 0, "1.0"),
        (SPEED, "nav2_costmap_2d::SpeedFilter", 2, plain_number(multiplier)),
    )
    lines = ["# Written by VIPO: the site's keep-out and slow zones. Speeds of the speed filter are metres a second."]
    for name, _, kind, each in filters:
        lines += [
            f"{name}_filter_mask_server:",
            "  ros__parameters:",
            f"    yaml_filename: {name}_mask.yaml",
            f"    topic_name: {name}_filter_mask",
            "    frame_id: map",
            f"{name}_costmap_filter_info_server:",
            "  ros__parameters:",
            f"    type: {kind}",
            f"    filter_info_topic: {name}_costmap_filter_info",
            f"    mask_topic: {name}_filter_mask",
            "    base: 0.0",
            f"    multiplier: {each}",
        ]
    lines += ["global_costmap:", "  global_costmap:", "    ros__parameters:"]
    lines.append(f"      filters: [{', '.join(f'{name}_filter' for name, *_ in filters)}]")
    for name, plugin, *_ in filters:
        lines += [
            f"      {name}_filter:",
            f"        plugin: {plugin}",
            "        enabled: true",
            f"        filter_info_topic: {name}_costmap_filter_info",
        ]
    lines.append("        speed_limit_topic: speed_limit")
    return ("\n".join(lines) + "\n").encode()

"""Buildings by chance: rooms behind rooms with doors between, and how much of one a lattice lets robots come to."""

from __future__ import annotations

import random

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from registry.floorplan.lattice import MARGIN_M, Ground, Lattice
from registry.floorplan.plan import FREE, OCCUPIED, Grid

CELL_M = 0.05
WIDE_M, HIGH_M = 26, 16
NEAR_M = 1.2
Room = tuple[int, int, int, int]
_WALL, _DOOR, _BESIDE = 4, (20, 32), 6
"""In cells: how thick walls are, how wide doors, how far from a corner at least."""


def make_building(seed: int) -> Grid:
    """Return a floor that walls of 20 cm halve again and again, each with a door of 1.0 to 1.6 m."""
    cells = np.full((round(HIGH_M / CELL_M), round(WIDE_M / CELL_M)), FREE, np.uint8)
    _halve(cells, random.Random(seed), (2, 2, cells.shape[0] - 2, cells.shape[1] - 2), 4)
    cells[:2] = cells[-2:] = cells[:, :2] = cells[:, -2:] = OCCUPIED
    return Grid(cells.shape[1], cells.shape[0], CELL_M, 0.0, 0.0, cells.tobytes())


def make_town(side: int) -> Grid:
    """Return so many times so many buildings with streets of 4 m between them, each with a gate of 1.5 m."""
    street, gate = round(4 / CELL_M), round(1.5 / CELL_M)
    high, wide = round(HIGH_M / CELL_M), round(WIDE_M / CELL_M)
    cells = np.full((side * (high + street) + street, side * (wide + street) + street), FREE, np.uint8)
    for number in range(side * side):
        house = np.frombuffer(make_building(number).cells, np.uint8).reshape(high, wide).copy()
        chance = random.Random(number)
        begin = next(
            at for _ in range(999) if (house[2:10, (at := chance.randint(4, wide - 40)) : at + gate] == FREE).all()
        )
        house[:2, begin : begin + gate] = FREE
        row, column = (
            street + (each * (size + street)) for each, size in zip(divmod(number, side), (high, wide), strict=True)
        )
        cells[row : row + high, column : column + wide] = house
    cells[:2] = cells[-2:] = cells[:, :2] = cells[:, -2:] = OCCUPIED
    return Grid(cells.shape[1], cells.shape[0], CELL_M, 0.0, 0.0, cells.tobytes())


def _halve(cells: NDArray[np.uint8], chance: random.Random, room: Room, times: int) -> None:
    """Put a wall across the longer side of a room (bottom, left, top, right, in cells), and others into both halves."""
    bottom, left, top, right = room
    if times == 0 or max(top - bottom, right - left) < 6 / CELL_M:
        return
    if top - bottom > right - left:
        _halve(cells.T, chance, (left, bottom, right, top), times)
        return
    wall, door = chance.randint(left + 50, right - 50), chance.randint(*_DOOR)
    low = chance.randint(bottom + _BESIDE, top - _BESIDE - door)
    cells[bottom:top, wall : wall + _WALL] = OCCUPIED
    cells[low : low + door, wall : wall + _WALL] = FREE
    _halve(cells, chance, (bottom, left, top, wall), times - 1)
    _halve(cells, chance, (bottom, wall + _WALL, top, right), times - 1)


def share_reached(ground: Ground, lattice: Lattice) -> float:
    """Return to how much of the floor that is joined robots come: some cell of the lattice is within 1.2 m."""
    labels, _ = ndimage.label(ground.clearance_m >= ground.radius_m + MARGIN_M)
    floor = labels == 1 + int(np.argmax(np.bincount(labels.ravel())[1:]))
    far = np.ones(floor.shape, np.bool_)
    for cell in lattice.links:
        if (at := ground.grid.cell_of(*lattice.centre(cell))) is not None:
            far[at] = False
    return float((floor & (ndimage.distance_transform_edt(far) * CELL_M < NEAR_M)).sum() / floor.sum())

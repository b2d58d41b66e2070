"""How much of buildings by chance robots of several widths come to, over even lines of cells and over VIPO's."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from statistics import mean
from typing import Any

from bench.lattice.buildings import make_building, make_town, share_reached
from registry.floorplan.lattice import Ground, Lattice, make_even_lattice, make_lattice
from registry.floorplan.plan import FREE, Grid, clearance_m

BUILDINGS = 24
WIDTHS_M = (0.36, 0.6, 0.8, 1.0)
WHOLE = 0.97
TOWN = 4


def measure() -> Iterator[dict[str, Any]]:
    """Give a line for each width and kind of lines, for buildings and a town of them, and one for an open floor."""
    floors = [make_building(seed) for seed in range(BUILDINGS)]
    for width_m in WIDTHS_M:
        grounds = [Ground(floor, clearance_m(floor), width_m / 2) for floor in floors]
        for name, make in (("even", make_even_lattice), ("through narrow ways", make_lattice)):
            yield {"robot_m": width_m, "lines": name, "buildings": BUILDINGS, **_reached(grounds, make)}
    town = make_town(TOWN)
    for width_m in WIDTHS_M[:2]:
        ground = Ground(town, clearance_m(town), width_m / 2)
        for name, make in (("even", make_even_lattice), ("through narrow ways", make_lattice)):
            yield {"robot_m": width_m, "lines": name, "town_of": TOWN * TOWN, **_reached([ground], make)}
    open_floor = Grid(4000, 4000, 0.05, 0.0, 0.0, bytes([FREE]) * 16_000_000)
    ground = Ground(open_floor, clearance_m(open_floor), 0.18)
    begun = time.process_time()
    cells = len(make_lattice(ground).links)
    yield {"floor_m": 200, "cells": cells, "cpu_s": round(time.process_time() - begun, 2)}


def _reached(grounds: list[Ground], make: Callable[[Ground], Lattice]) -> dict[str, Any]:
    begun = time.process_time()
    lattices = [make(ground) for ground in grounds]
    spent = time.process_time() - begun
    shares = [share_reached(ground, lattice) for ground, lattice in zip(grounds, lattices, strict=True)]
    whole = sum(share > WHOLE for share in shares)
    return {"share": round(mean(shares), 3), "whole": whole, "cpu_ms_each": round(spent * 1000 / len(grounds), 1)}

"""The demo's occupancy grids, made from their floor plans: `python -m registry.demo.factory` writes the maps."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from registry.floorplan.map_server import write_pgm, write_yaml
from registry.floorplan.plan import FREE, OCCUPIED, UNKNOWN, Grid

FOLDER = Path(__file__).resolve().parent
RESOLUTION_M = 0.05
MARGIN_M = 0.5
MAP_NAME = "painting-factory"
_PLANS = {MAP_NAME: "factory.json", "workshop": "workshop.json"}


def read_plan(name: str = MAP_NAME) -> dict[str, Any]:
    """Return the floor plan of a map; its y counts downwards."""
    plan: dict[str, Any] = json.loads((FOLDER / _PLANS[name]).read_text())
    return plan


def make_grid(plan: dict[str, Any]) -> Grid:
    """Return the grid that a perfect scan of the empty building would give: machines and robots are not in it."""
    xs, ys = zip(*plan["outline"], strict=True)
    left, bottom = -MARGIN_M, -max(ys) - MARGIN_M
    width = round((max(xs) + 2 * MARGIN_M) / RESOLUTION_M)
    height = round((max(ys) + 2 * MARGIN_M) / RESOLUTION_M)
    x = left + (np.arange(width)[None, :] + 0.5) * RESOLUTION_M
    y = bottom + (np.arange(height)[:, None] + 0.5) * RESOLUTION_M
    cells = np.full((height, width), UNKNOWN, dtype=np.uint8)
    cells[_inside(plan["outline"], x, -y)] = FREE
    for x1, y1, x2, y2, thickness in plan["walls"]:
        cells[_within(x, -y, (min(x1, x2), min(y1, y2), max(x1, x2), max(y1, y2)), thickness / 2)] = OCCUPIED
    for column_x, column_y, side in plan["columns"]:
        cells[_within(x, -y, (column_x, column_y, column_x, column_y), side / 2)] = OCCUPIED
    return Grid(width, height, RESOLUTION_M, left, bottom, cells.tobytes())


def get_demo_grid() -> Grid:
    """Return the painting factory's grid."""
    return make_grid(read_plan())


def _within(
    x: NDArray[np.float64], y: NDArray[np.float64], box: tuple[float, float, float, float], reach: float
) -> NDArray[np.bool_]:
    x1, y1, x2, y2 = box
    slack = reach + 1e-6
    return (x >= x1 - slack) & (x <= x2 + slack) & (y >= y1 - slack) & (y <= y2 + slack)


def _inside(outline: list[list[float]], x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Even-odd rule for every cell's middle against the outline."""
    inside = np.zeros((y.shape[0], x.shape[1]), dtype=np.bool_)
    for (x1, y1), (x2, y2) in zip(outline, outline[1:] + outline[:1], strict=True):
        if y1 != y2:
            crosses = (y >= min(y1, y2)) & (y < max(y1, y2))
            inside ^= crosses & (x < x1 + (y - y1) * (x2 - x1) / (y2 - y1))
    return inside


def write_maps(folder: Path = FOLDER) -> None:
    """Write each map's two files."""
    for name in _PLANS:
        grid = make_grid(read_plan(name))
        (folder / f"{name}.pgm").write_bytes(write_pgm(grid))
        (folder / f"{name}.yaml").write_bytes(write_yaml(grid, f"{name}.pgm"))


if __name__ == "__main__":
    write_maps()

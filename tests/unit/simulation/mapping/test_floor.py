"""Beams: where they end, and what a lidar makes of them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from registry.floorplan.plan import FREE, OCCUPIED, UNKNOWN, Grid
from simulation.mapping.floor import Lidar, LidarSpec, TrueFloor
from tests.kit.floors.halls import bare_hall
from vipo_device.protocol.description import Pose

SIDE_M = 0.1
ALL_ROUND = np.linspace(-np.pi, np.pi, 72, endpoint=False)


def is_solid(grid: Grid, x: float, y: float) -> bool:
    cell = grid.cell_of(x, y)
    return cell is None or grid.cells[cell[0] * grid.width + cell[1]] != FREE


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.sampled_from((FREE, FREE, FREE, FREE, OCCUPIED, UNKNOWN)), min_size=12 * 9, max_size=12 * 9),
    st.floats(0.05, 0.95),
    st.floats(0.05, 0.95),
)
def test_a_beam_goes_through_free_cells_only_and_ends_at_the_first_that_is_not(
    cells: list[int], at_x: float, at_y: float
) -> None:
    cells[5 * 12 + 6] = FREE
    grid = Grid(12, 9, SIDE_M, -0.3, 0.2, bytes(cells))
    x, y, range_m = -0.3 + (6 + at_x) * SIDE_M, 0.2 + (5 + at_y) * SIDE_M, 0.45
    for angle, end in zip(ALL_ROUND, TrueFloor(grid).cast(x, y, ALL_ROUND, range_m), strict=True):
        along, up = np.cos(angle), np.sin(angle)
        for gone in np.arange(0.0, min(end, range_m) - 2e-6, 0.003):
            assert not is_solid(grid, x + gone * along, y + gone * up)
        if np.isfinite(end):
            assert end <= range_m
            assert is_solid(grid, x + (end + 1e-6) * along, y + (end + 1e-6) * up)


def test_beams_along_the_axes_measure_a_room_exactly() -> None:
    floor = TrueFloor(bare_hall(6.0, 4.0))
    ends = floor.cast(1.0, 2.0, np.array((0.0, np.pi / 2, np.pi, -np.pi / 2)), 8.0)
    assert ends == pytest.approx((4.9, 1.9, 0.9, 1.9), abs=1e-5)
    assert np.isinf(floor.cast(1.0, 2.0, np.array((0.0,)), 4.8)).all()


def test_what_lies_off_the_map_is_a_wall_and_the_roomiest_place_is_in_the_middle() -> None:
    floor = TrueFloor(Grid(40, 20, SIDE_M, 0.0, 0.0, bytes(800)))
    assert floor.clearance_m(-1.0, 0.5) == 0.0
    assert floor.clearance_m(0.05, 1.0) == pytest.approx(0.05)
    assert floor.roomiest().y == pytest.approx(1.0, abs=0.051)
    assert floor.cast(3.95, 1.0, np.array((0.0,)), 8.0) == pytest.approx((0.05,), abs=1e-5)


def test_a_lidar_is_as_noisy_as_it_says_and_the_same_for_the_same_seed() -> None:
    spec = LidarSpec(range_m=3.0, noise_m=0.02, noise_share=0.0, noise_rad=0.0, lost=0.1)
    floor, at = TrueFloor(bare_hall(20.0, 4.0)), Pose(10.0, 2.0)
    scans = [Lidar(floor, spec, np.random.default_rng(7)).scan(at) for _ in range(2)]
    assert np.array_equal(*scans, equal_nan=True)
    lidar = Lidar(floor, spec, np.random.default_rng(8))
    seen = np.stack([lidar.scan(at) for _ in range(400)])
    up = seen[:, 270]
    assert np.nanmean(up) == pytest.approx(1.9, abs=0.005)
    assert np.nanstd(up) == pytest.approx(0.02, rel=0.15)
    assert np.isnan(seen).mean() == pytest.approx(0.1, abs=0.01)
    assert np.isinf(seen[:, 180][~np.isnan(seen[:, 180])]).all()

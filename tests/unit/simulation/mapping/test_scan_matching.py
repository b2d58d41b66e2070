"""Odometry and scan matching: how wrong the one is, and how the other mends it."""

from __future__ import annotations

from math import hypot

import numpy as np
import pytest

from registry.floorplan.plan import Grid
from simulation.mapping.floor import Lidar, LidarSpec, TrueFloor
from simulation.mapping.occupancy import OccupancyMap, read_scan
from simulation.mapping.odometry import Odometry, OdometrySpec, moved
from simulation.mapping.scan_matching import Trust, match
from tests.kit.floors.halls import bare_hall, generated_hall
from vipo_device.protocol.description import Pose

RANGE_M, SIDE_M = 8.0, 0.05
TRUST = Trust(0.05, 0.1)


def mapped(grid: Grid, places: list[Pose]) -> tuple[OccupancyMap, Lidar]:
    """Return a map of what is seen from known places, and the lidar."""
    lidar = Lidar(TrueFloor(grid), LidarSpec(RANGE_M), np.random.default_rng(3))
    occupancy = OccupancyMap(SIDE_M, (0.0, 0.0), RANGE_M)
    for pose in places:
        occupancy.add(read_scan(lidar.scan(pose), RANGE_M), pose)
    return occupancy, lidar


@pytest.mark.parametrize(("x", "y", "turned"), [(0.08, -0.06, 0.15), (-0.1, 0.0, -0.2), (0.0, 0.1, 0.0)])
def test_a_scan_is_found_where_it_was_taken(x: float, y: float, turned: float) -> None:
    occupancy, lidar = mapped(generated_hall(2), [Pose(3.0 + 0.2 * step, 11.0, 0.0, 0.3 * step) for step in range(12)])
    true = Pose(4.1, 11.05, 0.0, 1.0)
    prior = Pose(true.x + x, true.y + y, 0.0, true.theta + turned)
    found = match(occupancy, read_scan(lidar.scan(true), RANGE_M), prior, TRUST)
    assert hypot(found.x - true.x, found.y - true.y) < 0.01
    assert abs(found.theta - true.theta) < 0.004


def test_along_a_bare_corridor_odometry_is_believed_and_across_it_the_walls_are() -> None:
    occupancy, lidar = mapped(bare_hall(40.0, 3.0), [Pose(19.0 + 0.2 * step, 1.5) for step in range(10)])
    prior = Pose(20.55, 1.58, 0.0, 0.05)
    found = match(occupancy, read_scan(lidar.scan(Pose(20.5, 1.5)), RANGE_M), prior, Trust(0.02, 0.1))
    assert found.x == pytest.approx(prior.x, abs=0.02)
    assert found.y == pytest.approx(1.5, abs=0.01)
    assert found.theta == pytest.approx(0.0, abs=0.004)


def test_where_nothing_is_seen_the_prior_stays() -> None:
    occupancy, lidar = mapped(bare_hall(60.0, 60.0), [Pose(30.0, 30.0)])
    prior = Pose(30.2, 30.0)
    assert match(occupancy, read_scan(lidar.scan(prior), RANGE_M), prior, TRUST) == prior


def test_wheels_without_noise_are_exact_and_with_noise_off_by_their_share() -> None:
    exact = Odometry(OdometrySpec(noise=0.0), np.random.default_rng(1))
    assert exact.measure(0.3, 0.2) == pytest.approx((0.3, 0.2))
    spec = OdometrySpec(noise=0.05, slip_m=0.0)
    ways = [Odometry(spec, np.random.default_rng(seed)).measure(0.01, 0.0)[0] / 0.01 for seed in range(600)]
    assert np.mean(ways) == pytest.approx(1.0, abs=0.006)
    assert np.std(ways) == pytest.approx(0.05 / np.sqrt(2), rel=0.1)


def test_a_wheel_that_spins_counts_way_that_was_not_driven() -> None:
    slipping = Odometry(OdometrySpec(noise=1e-9, slip_every_m=0.1, slip_m=0.03), np.random.default_rng(5))
    said = sum(slipping.measure(0.01, 0.0)[0] for _ in range(1000))
    assert said == pytest.approx(10.0 + 10.0 / 0.1 * 0.015, rel=0.1)


def test_odometry_alone_would_lose_the_way() -> None:
    odometry, pose, true = Odometry(OdometrySpec(), np.random.default_rng(2)), Pose(0.0, 0.0), Pose(0.0, 0.0)
    for _ in range(1000):
        true = moved(true, 0.03, 0.006)
        pose = moved(pose, *odometry.measure(0.03, 0.006))
    assert hypot(pose.x - true.x, pose.y - true.y) > 0.5

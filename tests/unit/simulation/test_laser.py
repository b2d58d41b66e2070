"""A simulated robot's map grows with what its laser sees."""

from __future__ import annotations

import numpy as np

from registry.floorplan.map_message import join_parts, read_grid_part
from registry.floorplan.plan import FREE, OCCUPIED, UNKNOWN, Grid, cells_array
from simulation.laser import RANGE_M, LaserMap, Mapper
from vipo_device.protocol.description import Pose
from vipo_device.protocol.messages import MAX_BYTES

SIDE = 100


def hall() -> Grid:
    """A room of 5 m with walls all round, a wall across at x = 3 m with a door, and unknown cells outside."""
    cells = np.full((SIDE, SIDE), UNKNOWN, np.uint8)
    cells[5:95, 5:95] = OCCUPIED
    cells[6:94, 6:94] = FREE
    cells[6:94, 60] = OCCUPIED
    cells[45:55, 60] = FREE
    return Grid(SIDE, SIDE, 0.05, 0.0, 0.0, cells.tobytes())


def test_walls_hide_what_is_behind_them() -> None:
    floor, robot = hall(), LaserMap(hall())
    assert robot.look(Pose(1.0, 1.0))
    real, seen = cells_array(floor), cells_array(robot.grid)
    known = seen != UNKNOWN
    assert np.array_equal(seen[known], real[known])
    assert (seen[20, 60], seen[20, 80], seen[2, 20]) == (OCCUPIED, UNKNOWN, UNKNOWN)
    assert not robot.look(Pose(1.0, 1.0))


def test_the_laser_reaches_only_so_far() -> None:
    robot = LaserMap(Grid(400, 10, 0.05, 0.0, 0.0, bytes(4000)))
    robot.look(Pose(10.0, 0.25))
    seen = np.flatnonzero(cells_array(robot.grid)[5] == FREE)
    assert abs((seen[-1] - seen[0] + 1) * 0.05 - 2 * RANGE_M) <= 0.1


def test_a_place_off_the_map_shows_nothing_new() -> None:
    assert not LaserMap(hall()).look(Pose(-20.0, 50.0))


def test_driving_through_the_door_makes_the_map_whole() -> None:
    robot = LaserMap(hall())
    for x, y in ((1.0, 1.0), (1.0, 4.0), (2.5, 2.5), (3.5, 2.5), (4.0, 1.0), (4.0, 4.0)):
        robot.look(Pose(x, y))
    floor, seen = cells_array(hall()), cells_array(robot.grid)
    assert np.count_nonzero((floor == FREE) & (seen == FREE)) > 0.99 * np.count_nonzero(floor == FREE)


def test_a_map_is_sent_when_it_has_grown_and_no_sooner_than_after_ten_seconds() -> None:
    mapper = Mapper(hall(), 7)
    first = mapper.next_messages(Pose(1.0, 1.0), 0.0)
    assert all(len(message) < MAX_BYTES for message in first)
    parts = [read_grid_part(message) for message in first]
    assert (parts[0].boot, parts[0].number) == (7, 1)
    assert np.count_nonzero(cells_array(join_parts(parts)) == OCCUPIED) > 50
    assert mapper.next_messages(Pose(1.05, 1.0), 50.0) == []
    assert mapper.next_messages(Pose(3.5, 2.5), 5.0) == []
    assert mapper.next_messages(Pose(3.5, 2.5), 11.0) != []
    mapper.repeat()
    assert mapper.next_messages(Pose(3.5, 2.5), 20.0) == []
    (again,) = mapper.next_messages(Pose(3.5, 2.5), 30.0)
    assert read_grid_part(again).number == mapper.number == 3
    assert mapper.next_messages(Pose(3.5, 2.5), 80.0) == []
    assert mapper.next_messages(Pose(3.5, 2.5), 95.0) != []

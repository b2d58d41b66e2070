from __future__ import annotations

import tracemalloc
from dataclasses import replace
from math import pi

import numpy as np

from registry.floorplan.plan import (
    FloorPlan,
    Grid,
    cells_array,
    clearance_m,
    device_footprints,
    machine_beside,
    stations,
    wall_boxes,
    with_devices,
)
from vipo_device.protocol.description import Description, Pose, Size


def grid_of(rows: list[str], resolution_m: float = 1.0) -> Grid:
    """Rows from the top: `.` free, `#` occupied, `?` unknown."""
    kinds = {".": 0, "#": 100, "?": 255}
    cells = bytes(kinds[c] for row in reversed(rows) for c in row)
    return Grid(len(rows[0]), len(rows), resolution_m, 0.0, 0.0, cells)


def hall(width_m: float, height_m: float, resolution_m: float = 0.1) -> Grid:
    width, height = round(width_m / resolution_m), round(height_m / resolution_m)
    return Grid(width, height, resolution_m, 0.0, 0.0, bytes(width * height))


def machine(
    device_id: str, x: float, y: float, size: tuple[float, float] = (1.0, 1.0), theta: float = 0.0
) -> Description:
    return Description(device_id, device_id, "machine", "mixer", Pose(x, y, 0.0, theta), Size(*size, 1.0))


def test_clearance_is_measured_to_the_edge_of_the_nearest_wall() -> None:
    found = clearance_m(grid_of(["#####", "#...#", "#...#", "#...#", "#####"], 0.1))
    assert np.round(found[1:4, 1:4], 6).tolist() == [[0.05] * 3, [0.05, 0.15, 0.05], [0.05] * 3]
    assert found[0].tolist() == [0.0] * 5


def test_unknown_cells_and_the_end_of_the_map_count_as_wall() -> None:
    found = clearance_m(grid_of(["...", "...", "..?"]))
    assert found.tolist() == [[0.5, 0.5, 0.0], [0.5, np.sqrt(2) - 0.5, 0.5], [0.5, 0.5, 0.5]]


def test_walls_become_few_boxes_that_cover_each_occupied_cell_once() -> None:
    grid = grid_of(["#####", "#...#", "#.?.#", "#####"])
    boxes = wall_boxes(grid)
    assert len(boxes) == 4
    covered = np.zeros((4, 5), dtype=int)
    for x1, y1, x2, y2 in boxes:
        covered[int(y1) : int(y2), int(x1) : int(x2)] += 1
    assert (covered == (cells_array(grid) == 100)).all()


def test_a_map_without_walls_has_no_boxes() -> None:
    assert wall_boxes(hall(1, 1)) == ()


def test_footprints_turn_with_the_machine() -> None:
    corners = device_footprints([machine("a", 2, 3, (2.0, 1.0), pi / 2)])["a"]
    assert [(round(x, 6), round(y, 6)) for x, y in corners] == [(2.5, 2), (2.5, 4), (1.5, 4), (1.5, 2)]


def test_machines_occupy_cells_and_robots_do_not() -> None:
    robot = Description("r", "r", "robot", "turtlebot", Pose(1, 1), Size(0.4, 0.4, 0.4), radius_m=0.2)
    floor = cells_array(with_devices(hall(4, 4), [machine("a", 2, 2), robot]))
    assert int((floor == 100).sum()) == 100
    assert floor[20, 20] == 100
    assert floor[10, 10] == 0


def test_a_machine_beyond_the_edge_of_the_map_is_no_harm() -> None:
    assert (cells_array(with_devices(hall(2, 2), [machine("a", 50, 50)])) == 0).all()


def test_a_robot_stands_before_the_roomier_of_front_and_back_and_looks_at_the_machine() -> None:
    found = stations(hall(6, 6), [machine("high", 3, 4), machine("low", 1.2, 1.0)], 0.18)
    assert found["high"] == Pose(3, 3.17, 0.0, round(pi / 2, 6))
    assert found["low"] == Pose(1.2, 1.83, 0.0, round(-pi / 2, 6))


def test_a_robot_stands_at_a_side_where_front_and_back_have_no_room() -> None:
    found = stations(hall(6, 2), [machine("a", 2, 1, (1.0, 1.8))], 0.18)
    assert found == {"a": Pose(2.83, 1.0, 0.0, round(-pi, 6))}


def test_a_machine_that_nothing_can_reach_has_no_station() -> None:
    walled = grid_of(["...........", ".#####.....", ".#...#.....", ".#...#.....", ".#####....."], 0.5)
    assert stations(walled, [machine("a", 1.5, 1.0, (0.5, 0.4))], 0.18) == {}


def test_the_floor_tells_inside_free_and_reachable() -> None:
    plan = FloorPlan(grid_of(["....#....", "....#....", "....#...."], 0.5), [machine("a", 0.75, 0.75, (0.4, 0.4))])
    assert plan.is_inside(0.1, 0.1)
    assert not plan.is_inside(-0.1, 0.1)
    assert plan.is_free(3.25, 0.75, 0.2)
    assert not plan.is_free(0.75, 0.75, 0.2)
    assert not plan.is_free(99, 99, 0.2)
    assert not plan.is_reachable((1.75, 0.75), (3.25, 0.75), 0.2)
    assert plan.is_reachable((2.75, 0.25), (4.25, 1.25), 0.2)
    assert not plan.is_reachable((99, 0), (3.25, 0.75), 0.2)
    assert not plan.is_reachable((3.25, 0.75), (99, 0), 0.2)


def test_the_floor_tells_how_far_it_is_known() -> None:
    grid = grid_of(["?????", "??#.?", "?..??", "?????"], 0.5)
    assert FloorPlan(grid).known_m == (0.5, 0.5, 2.0, 1.5)
    assert FloorPlan(replace(grid, cells=bytes([255]) * 20)).known_m == (0.0, 0.0, 2.5, 2.0)


def test_a_robot_at_a_machines_station_stands_beside_it_and_one_on_the_way_does_not() -> None:
    def robot(x: float, y: float) -> Description:
        return Description("r", "r", "robot", "turtlebot", Pose(x, y), Size(0.36, 0.36, 0.4), radius_m=0.18)

    oven = machine("oven", 5, 5, (2, 1), pi / 2)
    assert machine_beside([oven], robot(5.8, 5)) == "oven"
    assert machine_beside([oven], robot(5, 6.5)) == "oven"
    assert machine_beside([oven], robot(6.2, 5)) is None


def test_a_floor_knows_the_station_of_each_of_its_machines() -> None:
    high = machine("high", 3, 4)
    plan = FloorPlan(hall(6, 6), [high])
    assert plan.station("high", 0.18) == (3, 3.17)
    assert plan.station("gone", 0.18) is None
    assert [plan.has_machine("high"), plan.has_machine("gone")] == [True, False]


def test_what_is_known_of_robots_is_kept_for_four_radii_the_ones_that_were_asked_for_last() -> None:
    plan = FloorPlan(hall(50, 50), [machine("mixer", 25, 25)])
    tracemalloc.start()
    try:
        usual = plan.regions(0.18)
        for step in range(12):
            radius_m = 0.2 + step / 100
            assert plan.station("mixer", radius_m) == (25.0, round(24.35 - radius_m, 4))
            assert plan.can_stop(5.0, 5.0, radius_m)
            assert plan.regions(0.18) is usual
        kept, _ = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert kept < 4.5 * usual.nbytes + 3 * 10_000 * 500

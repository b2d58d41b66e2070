"""Holding one map against another: what changes, whom it troubles, and what it costs on the largest of maps."""

from __future__ import annotations

import tracemalloc

import numpy as np

from registry.floorplan.comparison import MapTrouble, NamedPoint, compare_maps
from registry.floorplan.plan import FloorPlan, Grid
from vipo_device.protocol.description import Description, Pose, Size


def hall(side: int, *walls: tuple[slice, slice]) -> Grid:
    cells = np.zeros((side, side), dtype=np.uint8)
    for wall in walls:
        cells[wall] = 100
    return Grid(side, side, 0.05, 0.0, 0.0, cells.tobytes())


def machine(device_id: str, x: float, y: float) -> Description:
    return Description(device_id, device_id, "machine", "mixer", Pose(x, y), Size(1.0, 1.0, 1.0))


def test_what_changes_is_told_with_whom_it_troubles_and_whether_the_map_before_did() -> None:
    before, after = hall(100, np.s_[0:10, 0:10]), hall(100, np.s_[80:100, 80:100])
    places = [NamedPoint("new", "New", 4.5, 4.5), NamedPoint("old", "Old", 9.0, 9.0), NamedPoint("ok", "Ok", 1.0, 3.0)]
    told = compare_maps(before, after, [machine("m", 4.5, 4.5), machine("ok", 1.5, 1.5)], places)
    assert (told.floor_gained_m2, told.floor_lost_m2) == (0.25, 1.0)
    assert (told.walls_gained_m2, told.walls_lost_m2) == (1.0, 0.25)
    assert told.troubles == (
        MapTrouble("m", "m", "machine", "walled", True),
        MapTrouble("new", "New", "place", "walled", False),
        MapTrouble("old", "Old", "place", "outside", False),
    )
    first = compare_maps(None, after, [], places[1:2])
    assert (first.floor_gained_m2, first.floor_lost_m2, first.walls_gained_m2) == (24.0, 0.0, 1.0)
    assert first.troubles == (MapTrouble("old", "Old", "place", "outside", True),)


def test_a_place_that_a_new_map_cuts_off_is_told_and_a_rooms_name_may_stand_in_a_wall() -> None:
    before, after = hall(100), hall(100, np.s_[:, 60:64])
    stands = [NamedPoint("off", "Off", 4.0, 2.5), NamedPoint("dock", "Dock", 4.5, 4.0, "dock")]
    rooms = [NamedPoint("in", "In", 3.1, 2.5, "room"), NamedPoint("hall", "Hall", 4.0, 2.5, "room")]
    gone = NamedPoint("gone", "Gone", 9.0, 2.5, "room")
    told = compare_maps(before, after, [], [*stands, *rooms, gone, NamedPoint("ok", "Ok", 1.0, 1.0)])
    assert told.troubles == (
        MapTrouble("off", "Off", "place", "unreachable", True),
        MapTrouble("dock", "Dock", "place", "unreachable", True),
        MapTrouble("gone", "Gone", "place", "outside", False),
    )
    assert [each.why for each in compare_maps(after, after, [], stands).troubles if not each.is_new] == [
        "unreachable",
        "unreachable",
    ]


def test_large_maps_are_compared_with_the_memory_of_one_floor_at_a_time() -> None:
    side = 1500
    before, after = hall(side, np.s_[0:50, 0:50]), hall(side, np.s_[0:side, 0:20])
    places = [NamedPoint("walled", "Walled", 0.5, 5.0)]
    tracemalloc.start()
    try:
        told = compare_maps(before, after, [machine("m", 40, 40)], places)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert [trouble.id for trouble in told.troubles] == ["walled"]
    assert peak < 24 * side * side + 10_000_000


def test_the_stations_of_many_machines_look_at_their_surroundings_not_at_the_whole_floor() -> None:
    side = 2000
    floor = FloorPlan(hall(side), [machine(f"m{n}", 5.0 + 6 * (n % 15), 5.0 + 6 * (n // 15)) for n in range(30)])
    assert floor.station("m0", 0.18) is not None
    tracemalloc.start()
    try:
        found = [floor.station(f"m{n}", 0.18) for n in range(1, 30)]
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert None not in found
    assert peak < side * side // 4, "no copy of all cells, and none of their regions"

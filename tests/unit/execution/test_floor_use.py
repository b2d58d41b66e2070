"""How a floor was used: drives per square of it, waits before zones, and the half hour with the most waiting."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta

import pytest
from hypothesis import given
from hypothesis import strategies as st

from execution.floor.floor_use import (
    SLOTS,
    SQUARE_M,
    Drive,
    JournalLine,
    Path,
    ZoneUse,
    ZoneWait,
    cut,
    heat_of,
    read_back,
    square_for,
    squares_of,
    zones_of,
)

DAY = datetime(2026, 11, 23, tzinfo=UTC)
END = DAY + timedelta(hours=12)
ALONG = ((0.1, 0.1), (1.1, 0.1))
"""From the middle of the square (0, 0) to that of (4, 0), more or less."""


def at(clock: str, day: int = 0) -> datetime:
    """Return a time of day; `day` counts from the first."""
    hours, minutes, *seconds = (int(part) for part in clock.split(":"))
    return DAY + timedelta(days=day, hours=hours, minutes=minutes, seconds=sum(seconds))


def way(path: Path, *, run: str = "r1", robot: str = "robot1", clock: str = "06:00") -> JournalLine:
    return JournalLine(run, at(clock), robot=robot, path=path)


def wait(
    clock: str, zone: str = "site/gate", *, step: str = "a", run: str = "r1", robot: str = "robot1"
) -> JournalLine:
    return JournalLine(run, at(clock), step, robot, zone)


def over(clock: str, *, step: str = "a", run: str = "r1") -> JournalLine:
    return JournalLine(run, at(clock), step, "robot1")


def used(*lines: JournalLine, offset: int = 0) -> tuple[dict[tuple[int, int], int], dict[str, ZoneUse]]:
    """What is counted of journals whose lines are given in the order in which they were written."""
    found = list(read_back(reversed(lines), {"r1": END, "r2": END}))
    heat = heat_of(each for each in found if isinstance(each, Drive))
    return dict(heat), dict(zones_of((each for each in found if isinstance(each, ZoneWait)), offset))


def test_a_square_is_counted_once_for_each_drive_that_comes_through_it() -> None:
    there_and_back = (*ALONG, (0.1, 0.1))
    heat, _ = used(way(there_and_back), way(ALONG, run="r2"))
    assert heat == {(column, 0): 2 for column in range(5)}


def test_squares_left_of_the_origin_and_below_it_count_downwards() -> None:
    assert squares_of(((-0.1, -0.1), (0.1, -0.1))) == {(-1, -1), (0, -1)}


def test_a_path_along_a_border_of_squares_stays_on_one_side() -> None:
    wavering = ((0.0, 0.5), (0.5, 0.5 - 1e-12), (1.0, 0.5))
    assert {row for _, row in squares_of(wavering)} == {2}


def test_a_slanting_path_comes_through_neighbours_only() -> None:
    squares = squares_of(((0.1, 0.05), (1.1, 0.8)))
    assert squares == {(0, 0), (1, 0), (1, 1), (2, 1), (2, 2), (3, 2), (4, 2), (4, 3)}


def test_a_robot_that_sets_out_anew_on_its_way_has_driven_as_far_as_there() -> None:
    heat, _ = used(way(((0.1, 0.1), (2.1, 0.1))), way(((1.1, 0.1), (1.1, 1.1))))
    assert heat == {(0, 0): 1, (1, 0): 1, (2, 0): 1, (3, 0): 1, (4, 0): 2, (4, 1): 1, (4, 2): 1, (4, 3): 1, (4, 4): 1}


def test_a_robot_that_sets_out_elsewhere_has_driven_all_of_the_way_before() -> None:
    heat, _ = used(way(ALONG), way(((0.1, 5.1), (0.4, 5.1))))
    assert heat == {**{(column, 0): 1 for column in range(5)}, (0, 20): 1, (1, 20): 1}


def test_other_robots_and_other_runs_cut_no_way() -> None:
    onward = ((0.6, 0.1), (0.6, 0.2))
    heat, _ = used(way(ALONG), way(onward, robot="robot2"), way(onward, run="r2"))
    assert heat[4, 0] == 1


def test_a_robot_that_never_moved_has_driven_nowhere() -> None:
    assert used(way(ALONG), way(((0.1, 0.1), (0.1, 0.1))))[0] == {}
    assert used(way(((0.1, 0.1),)))[0] == {}


def test_of_two_points_that_are_as_near_a_path_is_cut_at_the_later() -> None:
    round_again = ((0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 0.0), (-2.0, 0.0))
    assert cut(round_again, (0.0, 0.0)) == [*round_again[:4], (0.0, 0.0)]
    assert cut(round_again, (9.0, 9.0)) == round_again
    assert cut(round_again, None) == round_again


def test_a_wait_lasts_until_its_step_says_something_else() -> None:
    _, zones = used(wait("06:00"), over("06:01", step="b"), over("06:01", run="r2"), over("06:02"), over("06:09"))
    assert zones == {"site/gate": ZoneUse(1, 120.0, 350)}


def test_a_wait_goes_on_while_only_who_is_in_the_zone_changes() -> None:
    _, zones = used(wait("06:00"), wait("06:01"), wait("06:02"), over("06:03"), wait("06:05"), over("06:06"))
    assert zones == {"site/gate": ZoneUse(2, 240.0, 350)}


def test_another_zone_or_another_robot_begins_another_wait() -> None:
    _, zones = used(
        wait("06:00"), wait("06:01", "site/aisle"), wait("06:03", "site/aisle", robot="robot2"), over("06:04")
    )
    assert zones == {"site/gate": ZoneUse(1, 60.0, 350), "site/aisle": ZoneUse(2, 180.0, 350)}


def test_a_wait_that_nothing_ends_lasts_as_long_as_its_run() -> None:
    _, zones = used(wait("11:50"))
    assert zones == {"site/gate": ZoneUse(1, 600.0, 700)}


def test_a_wait_of_no_length_is_none() -> None:
    assert used(wait("06:00"), over("06:00"))[1] == {}
    assert used(over("06:00"))[1] == {}


def waits(*spans: tuple[str, str, int], offset: int = 0) -> int | None:
    found = zones_of((ZoneWait("z", at(begun, day), at(ended, day)) for begun, ended, day in spans), offset)
    return found["z"].busiest_min


def test_the_busiest_half_hour_is_that_with_the_most_waiting_on_all_days_together() -> None:
    """Five minutes at noon on one day are less than two minutes and four in the morning of two others."""
    assert waits(("12:00", "12:05", 0), ("06:12", "06:14", 1), ("06:34", "06:38", 2)) == 6 * 60 + 10


@pytest.mark.parametrize(("offset", "begins"), [(0, 350), (60, 410), (-420, 1370), (840, 1190), (345, 690)])
def test_the_busiest_half_hour_is_told_in_the_days_of_who_asks(offset: int, begins: int) -> None:
    """Somebody waited from 6:00 to 6:05 by UTC; the ten minutes in which that is are in the middle."""
    assert waits(("06:00", "06:05", 0), offset=offset) == begins


def test_a_wait_over_midnight_and_one_over_days_are_shared_out() -> None:
    over_midnight = zones_of([ZoneWait("z", at("23:58"), at("00:04", 1))], 0)
    assert over_midnight["z"].busiest_min == 23 * 60 + 40 + 10
    days = zones_of([ZoneWait("z", at("06:05"), at("06:15", 3))], 0)
    assert days["z"] == ZoneUse(1, 3 * 86400 + 600.0, 350)


@given(
    st.lists(
        st.tuples(st.floats(-20, 20, allow_nan=False), st.floats(-20, 20, allow_nan=False)), min_size=2, max_size=5
    )
)
def test_squares_join_up_and_have_the_ends_of_the_path(path: list[tuple[float, float]]) -> None:
    squares = squares_of(path)
    if all(point == path[0] for point in path):
        assert squares == frozenset()
        return
    for x, y in path:
        assert any(abs((c + 0.5) * SQUARE_M - x) < 0.126 and abs((r + 0.5) * SQUARE_M - y) < 0.126 for c, r in squares)
    reached, left = set(), [next(iter(squares))]
    while left:
        column, row = left.pop()
        reached.add((column, row))
        near = {(column + dc, row + dr) for dc in (-1, 0, 1) for dr in (-1, 0, 1)}
        left += (near & squares) - reached
    assert reached == squares


@given(st.integers(0, 86399), st.integers(1, 5 * 86400), st.integers(-720, 840))
def test_no_second_of_a_wait_is_lost_and_its_half_hour_is_one_of_the_day(begun: int, seconds: int, offset: int) -> None:
    start = DAY + timedelta(seconds=begun)
    use = zones_of([ZoneWait("z", start, start + timedelta(seconds=seconds))], offset)["z"]
    assert use.waited_s == seconds
    assert use.busiest_min in range(0, SLOTS * 10, 10)


def test_drives_alone_have_no_zones() -> None:
    assert zones_of([], 0) == {}


def test_squares_are_larger_on_floors_that_would_have_too_many() -> None:
    assert square_for(25.0, 14.4) == SQUARE_M
    assert square_for(50.0, 50.0) == SQUARE_M
    assert square_for(200.0, 200.0) == 1.0
    assert heat_of([Drive(((0.1, 0.1), (3.9, 0.1)))], 1.0) == {(column, 0): 1 for column in range(4)}

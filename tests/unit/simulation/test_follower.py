"""How a robot follows the path that was released to it, as a point without mass."""

from __future__ import annotations

from itertools import pairwise
from math import cos, hypot, pi, sin

import pytest

from simulation.actors import Follower, Motion
from simulation.actors.follower import STUCK_S, wrapped

DT_S = 0.05


class Drive:
    """A follower and the point that it steers; remembers where it was and what it reached."""

    def __init__(self, *pieces: list[tuple[float, float]], theta: float | None = None, heading: float = 0.0) -> None:
        self.follower = Follower(0.5)
        self.motion = Motion(0.0, 0.0, heading)
        self.reached: dict[str, float] = {}
        self.trace: list[tuple[float, float, float]] = []
        self.t_s = 0.0
        self.count = 0
        for piece in pieces:
            self.add(piece, theta if piece is pieces[-1] else None)

    def add(self, piece: list[tuple[float, float]], theta: float | None = None) -> None:
        self.follower.add(piece, f"piece{self.count}", theta)
        self.count += 1

    def go(self, seconds: float) -> None:
        for _ in range(round(seconds / DT_S)):
            self.t_s += DT_S
            speed, turn, reached = self.follower.steer(self.motion, DT_S)
            self.reached.update(dict.fromkeys(reached, round(self.t_s, 2)))
            half_way = self.motion.theta + turn * DT_S / 2
            self.motion.x += cos(half_way) * speed * DT_S
            self.motion.y += sin(half_way) * speed * DT_S
            self.motion.theta = wrapped(self.motion.theta + turn * DT_S)
            self.motion.speed, self.motion.turn = speed, turn
            self.trace.append((self.motion.x, self.motion.y, speed))


def test_a_straight_way_is_driven_at_full_speed_and_ends_at_its_end() -> None:
    drive = Drive([(5.0, 0.0)])
    drive.go(15)
    assert drive.motion.x == pytest.approx(5.0, abs=0.015)
    assert drive.motion.y == pytest.approx(0.0, abs=0.005)
    assert max(speed for _, _, speed in drive.trace) == 0.5
    assert drive.reached["piece0"] == pytest.approx(10 + 0.5 / 0.8, abs=0.5)
    assert drive.follower.idle


def test_a_right_angle_is_turned_in_place() -> None:
    drive = Drive([(2.0, 0.0), (2.0, 2.0)])
    drive.go(15)
    assert max(x for x, _, _ in drive.trace) < 2.01
    assert max(min(abs(y), abs(x - 2.0)) for x, y, _ in drive.trace) < 0.02
    assert (drive.motion.x, drive.motion.y) == pytest.approx((2.0, 2.0), abs=0.015)


def test_pieces_that_come_in_time_are_driven_without_stopping() -> None:
    whole, pieces = Drive([(3.0, 0.0)]), Drive([(1.0, 0.0)], [(2.0, 0.0)], [(3.0, 0.0)])
    whole.go(10)
    pieces.go(10)
    assert pieces.trace == whole.trace
    assert list(pieces.reached) == ["piece0", "piece1", "piece2"]
    assert pieces.reached["piece0"] < pieces.reached["piece1"] < pieces.reached["piece2"] == whole.reached["piece0"]


def test_a_robot_waits_at_the_end_of_what_is_released_and_goes_on_when_more_comes() -> None:
    drive = Drive([(1.0, 0.0)])
    drive.go(6)
    assert drive.motion.x == pytest.approx(1.0, abs=0.015)
    drive.go(5)
    assert drive.motion.x == pytest.approx(1.0, abs=0.015)
    drive.add([(1.0, 0.0), (2.0, 0.0)])
    drive.go(5)
    assert drive.motion.x == pytest.approx(2.0, abs=0.015)
    assert "piece1" in drive.reached


def test_gentle_bends_are_driven_through_near_the_line() -> None:
    arc = [(3 * sin(a / 10), 3 - 3 * cos(a / 10)) for a in range(1, 16)]
    drive = Drive(arc)
    drive.go(14)
    assert drive.reached
    assert max(abs(hypot(x, y - 3) - 3) for x, y, _ in drive.trace) < 0.05
    slowest = min(speed for _, _, speed in drive.trace[40:140])
    assert slowest > 0.4


@pytest.mark.parametrize("bend", [0.1, 0.2, 0.3, -0.34])
def test_a_bend_is_neither_overshot_nor_cut_by_more_than_3_cm(bend: float) -> None:
    drive = Drive([(2.0, 0.0), (2.0 + 2 * cos(bend), 2 * sin(bend))])
    drive.go(10)
    assert drive.reached
    off_first = [abs(y) for x, y, _ in drive.trace]
    off_second = [abs((x - 2) * sin(bend) - y * cos(bend)) for x, y, _ in drive.trace]
    assert max(min(pair) for pair in zip(off_first, off_second, strict=True)) < 0.03
    assert min(speed for x, _, speed in drive.trace if 0.5 < x < 3.0) > 0.35


def test_a_heading_at_the_end_is_taken_before_the_piece_is_done() -> None:
    drive = Drive([(1.0, 0.0)], theta=-pi / 2)
    drive.go(2.5)
    assert not drive.reached
    drive.go(4)
    assert drive.motion.theta == pytest.approx(-pi / 2, abs=0.04)
    assert "piece0" in drive.reached


@pytest.mark.parametrize("heading", [0.5, 1.6, 3.1, -2.0])
def test_a_robot_turns_towards_its_way_before_it_drives(heading: float) -> None:
    drive = Drive([(2.0, 0.0)], heading=heading)
    drive.go(8)
    assert max(abs(y) for _, y, _ in drive.trace) < 0.02
    assert drive.motion.x == pytest.approx(2.0, abs=0.015)


def test_points_that_repeat_the_place_are_reached_at_once() -> None:
    drive = Drive([(0.0, 0.0)], [(0.0, 0.0), (0.005, 0.0), (1.0, 0.0), (1.0, 0.0)])
    drive.go(0.05)
    assert "piece0" in drive.reached
    drive.go(5)
    assert drive.motion.x == pytest.approx(1.0, abs=0.015)
    assert "piece1" in drive.reached


def test_speeding_up_and_braking_keep_to_the_limits() -> None:
    drive = Drive([(2.0, 0.0), (2.0, 1.0)])
    drive.go(10)
    speeds = [speed for _, _, speed in drive.trace]
    changes = [(b - a) / DT_S for a, b in pairwise(speeds)]
    assert max(changes) <= 0.8 + 1e-9
    assert min(changes) >= -1.2 - 1e-9


def test_a_robot_that_comes_no_nearer_gives_up_after_10_s() -> None:
    follower = Follower(0.5)
    follower.add([(3.0, 0.0)], "piece", None)
    motion = Motion(0.0, 0.0, 0.0)
    seconds = 0.0
    while not follower.stuck:
        follower.steer(motion, DT_S)
        seconds += DT_S
        assert seconds < 60
    assert seconds == pytest.approx(STUCK_S, abs=0.2)

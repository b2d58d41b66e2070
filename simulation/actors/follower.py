"""Driving along a released path: from where the robot is to how fast it shall drive and turn.

The same logic steers kinematic robots and those in physics, fed with measured poses. Straight pieces are followed by
aiming at a point a little ahead on the line; at corners sharper than 20 degrees the robot stops and turns in place.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, replace
from math import atan2, cos, hypot, pi, sqrt

ACCELERATION_M_S2 = 0.8
TURN_RAD_S = 2.0
TURN_RAD_S2 = 6.0
LOOK_AHEAD_M = 0.25
CORNER_RAD = 0.35
ALIGNED_RAD = 0.03
NEAR_M = 0.03
ARRIVED_M = 0.012
SAME_M = 0.01
STUCK_S = 10.0
PROGRESS_M = 0.02


@dataclass(slots=True)
class Motion:
    """Where a robot is (metres, radians) and how fast it drives (m/s) and turns (rad/s)."""

    x: float
    y: float
    theta: float
    speed: float = 0.0
    turn: float = 0.0


@dataclass(frozen=True, slots=True)
class Waypoint:
    """A point to drive to, at most at `limit_m_s`.

    `commands` are the pieces that end there, `theta` is set where a heading is asked for.
    """

    x: float
    y: float
    commands: tuple[str, ...] = ()
    theta: float | None = None
    limit_m_s: float | None = None

    def is_at(self, x: float, y: float) -> bool:
        """Tell whether this is practically the same point."""
        return hypot(self.x - x, self.y - y) < SAME_M

    def is_near(self, motion: Motion) -> bool:
        """Tell whether the robot is as good as there."""
        return self.theta is None and hypot(self.x - motion.x, self.y - motion.y) < NEAR_M


def wrapped(angle: float) -> float:
    """Return the angle in -pi..pi."""
    return (angle + pi) % (2 * pi) - pi


@dataclass(frozen=True, slots=True)
class Leg:
    """The present line: its end, its direction (0, 0 if it is but a point), its length, and what follows its end."""

    x: float
    y: float
    ahead_x: float
    ahead_y: float
    length_m: float
    theta: float | None
    stops: bool
    beyond_m: float
    next_x: float
    next_y: float

    def left_m(self, motion: Motion) -> float:
        """Return how far it is along the line to its end."""
        dx, dy = self.x - motion.x, self.y - motion.y
        if self.length_m > 0:
            return dx * self.ahead_x + dy * self.ahead_y
        distance = hypot(dx, dy)
        return distance if distance > NEAR_M else 0.0

    def bearing(self, motion: Motion, left_m: float) -> float:
        """Return the direction to a point a little ahead on the path, so that bends are cut by a hair, not overshot.

        Beyond a place to stand the aim goes on straight, so that the heading stays calm while the robot arrives.
        """
        ahead_m = LOOK_AHEAD_M - left_m
        along_x, along_y = (self.next_x, self.next_y) if ahead_m > 0 else (self.ahead_x, self.ahead_y)
        return atan2(self.y + along_y * ahead_m - motion.y, self.x + along_x * ahead_m - motion.x)


class Follower:
    """The path that a robot was given, and how it follows it."""

    def __init__(self, speed_m_s: float) -> None:
        self.speed_m_s = speed_m_s
        self._braking_m = speed_m_s**2 / (2 * ACCELERATION_M_S2) + 0.1
        self._path: deque[Waypoint] = deque()
        self._from: tuple[float, float] | None = None
        self._leg: Leg | None = None
        self._turning = True
        self._speed = self._turn = 0.0
        self._best_m = float("inf")
        self._stalled_s = 0.0

    @property
    def idle(self) -> bool:
        """True when there is nowhere to go and the robot stands."""
        return not self._path and self._speed == 0.0 and self._turn == 0.0

    @property
    def stuck(self) -> bool:
        """True when the robot has come no nearer for 10 s, though it should have."""
        return self._stalled_s >= STUCK_S

    def add(
        self,
        points: list[tuple[float, float]],
        command: str,
        theta: float | None,
        limit_m_s: float | None = None,
    ) -> None:
        """Append a piece of the path; points that repeat the one before are joined with it."""
        for x, y in points:
            if not (self._path and self._path[-1].is_at(x, y)):
                self._path.append(Waypoint(x, y, limit_m_s=limit_m_s))
        end = self._path[-1]
        turned = end.theta if theta is None else theta
        self._path[-1] = replace(end, commands=(*end.commands, command), theta=turned)
        self._look_anew()

    def clear(self) -> None:
        """Forget the path; the robot brakes."""
        self._path.clear()
        self._from, self._turning = None, True
        self._look_anew()

    def drop_after(self, command: str) -> None:
        """Forget all that comes after the end of a piece."""
        while self._path and command not in self._path[-1].commands:
            self._path.pop()
        self._look_anew()

    def brake(self, dt_s: float) -> tuple[float, float]:
        """Come to a stand; return speed and turn for the next moment."""
        self._stalled_s = 0.0
        return self._limited(0.0, 0.0, dt_s)

    def steer(self, motion: Motion, dt_s: float) -> tuple[float, float, list[str]]:
        """Return speed (m/s) and turn (rad/s) for the next `dt_s`, and the pieces whose end has been reached."""
        reached: list[str] = []
        while self._path:
            leg = self._leg or self._start_leg(motion)
            left_m = leg.left_m(motion)
            if not self._is_there(leg, left_m, motion):
                return (*self._drive(leg, left_m, motion, dt_s), reached)
            self._turning = self._turning or leg.stops
            self._from = (leg.x, leg.y)
            reached.extend(self._path.popleft().commands)
            self._look_anew()
        self._from = None
        return (*self._limited(0.0, 0.0, dt_s), reached)

    def _start_leg(self, motion: Motion) -> Leg:
        if self._from is None:
            # A path that begins where the robot is already begins with its second point.
            while len(self._path) > 1 and not self._path[0].commands and self._path[0].is_near(motion):
                self._path.popleft()
            self._from = (motion.x, motion.y)
        end = self._path[0]
        length, x, y = _direction(self._from, (end.x, end.y))
        stops = self._stops_at(0)
        _, next_x, next_y = (0.0, x, y) if stops else _direction((end.x, end.y), (self._path[1].x, self._path[1].y))
        beyond_m = 0.0 if stops else self._beyond_m()
        self._leg = Leg(end.x, end.y, x, y, length, end.theta, stops, beyond_m, next_x, next_y)
        return self._leg

    def _is_there(self, leg: Leg, left_m: float, motion: Motion) -> bool:
        if not leg.stops:
            return left_m <= 0.0
        if left_m > ARRIVED_M and not (abs(self._speed) < 0.02 and left_m < 2 * ARRIVED_M):
            return False
        if leg.theta is None:
            return True
        return abs(wrapped(leg.theta - motion.theta)) < ALIGNED_RAD and abs(self._turn) < 0.3

    def _stops_at(self, index: int) -> bool:
        """Tell whether the robot has to stand at a waypoint: at the end, for a heading, and at sharp corners."""
        here = self._path[index]
        if index + 1 >= len(self._path) or here.theta is not None:
            return True
        before = self._from if index == 0 else (self._path[index - 1].x, self._path[index - 1].y)
        after = self._path[index + 1]
        assert before is not None
        in_x, in_y, out_x, out_y = here.x - before[0], here.y - before[1], after.x - here.x, after.y - here.y
        if hypot(in_x, in_y) < 1e-6:
            return False
        return abs(wrapped(atan2(out_y, out_x) - atan2(in_y, in_x))) > CORNER_RAD

    def _beyond_m(self) -> float:
        """Return how far the next place to stand is from the present line's end, no farther than braking takes."""
        path_m = 0.0
        for i in range(len(self._path) - 1):
            if self._stops_at(i) or path_m > self._braking_m:
                break
            here, after = self._path[i], self._path[i + 1]
            path_m += hypot(after.x - here.x, after.y - here.y)
        return path_m

    def _drive(self, leg: Leg, left_m: float, motion: Motion, dt_s: float) -> tuple[float, float]:
        """Return speed and turn, and watch whether the robot comes nearer."""
        error = wrapped(leg.bearing(motion, left_m) - motion.theta)
        measure = left_m + (abs(error) if self._turning else 0.0)
        if measure < self._best_m - PROGRESS_M:
            self._best_m, self._stalled_s = measure, 0.0
        else:
            self._stalled_s += dt_s
        if leg.theta is not None and left_m <= 2 * ARRIVED_M:
            return self._limited(0.0, _turn_towards(wrapped(leg.theta - motion.theta)), dt_s)
        if self._turning or abs(error) > 2 * CORNER_RAD:
            self._turning = abs(error) > ALIGNED_RAD
            return self._limited(0.0, _turn_towards(error), dt_s)
        brake_m = max(0.0, left_m + leg.beyond_m - ARRIVED_M / 2)
        limit_m_s = self._path[0].limit_m_s
        fastest = self.speed_m_s if limit_m_s is None else min(self.speed_m_s, limit_m_s)
        speed = min(fastest, sqrt(1.6 * ACCELERATION_M_S2 * brake_m))
        return self._limited(max(0.02, speed * max(0.0, cos(2 * error))), 3.0 * error, dt_s)

    def _limited(self, speed: float, turn: float, dt_s: float) -> tuple[float, float]:
        """Keep to what the motors can do."""
        slower, faster = self._speed - 1.5 * ACCELERATION_M_S2 * dt_s, self._speed + ACCELERATION_M_S2 * dt_s
        self._speed = min(max(speed, slower, 0.0), faster)
        change = TURN_RAD_S2 * dt_s
        turn = min(max(turn, -TURN_RAD_S), TURN_RAD_S)
        self._turn = min(max(turn, self._turn - change), self._turn + change)
        return self._speed, self._turn

    def _look_anew(self) -> None:
        """The path has changed, and with it the present line and what counts as progress."""
        self._leg = None
        self._best_m, self._stalled_s = float("inf"), 0.0


def _direction(start: tuple[float, float], end: tuple[float, float]) -> tuple[float, float, float]:
    """Return the length of a line and its unit vector; no length and no direction when it is but a point."""
    x, y = end[0] - start[0], end[1] - start[1]
    length = hypot(x, y)
    return (length, x / length, y / length) if length > 1e-6 else (0.0, 0.0, 0.0)


def _turn_towards(error: float) -> float:
    """Return the fastest turn that still stops in time."""
    size = min(TURN_RAD_S, sqrt(2 * 0.6 * TURN_RAD_S2 * abs(error)), 6.0 * abs(error))
    return size if error > 0 else -size

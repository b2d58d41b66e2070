"""A robot maps a floor in virtual time: it drives, and meets walls, slip and noise. Same seed, same map."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from math import hypot

import numpy as np

from registry.floorplan.plan import Grid
from simulation.actors.follower import wrapped
from simulation.mapping.floor import Lidar, LidarSpec, TrueFloor
from simulation.mapping.map_maker import MapMaker, RobotSpec
from simulation.mapping.occupancy import Floats
from simulation.mapping.odometry import Odometry, OdometrySpec, moved
from simulation.world import Obstacle
from vipo_device.protocol.description import Pose

TICK_S = 0.1
SCAN_EVERY = 2
LONGEST_S = 4 * 3600.0


@dataclass(frozen=True, slots=True)
class SurveyPlan:
    """Who maps what, and from where (none: the roomiest place); `longest_s` ends a survey that does not end."""

    grid: Grid
    seed: int
    robot: RobotSpec = field(default_factory=RobotSpec)
    lidar: LidarSpec = field(default_factory=LidarSpec)
    odometry: OdometrySpec = field(default_factory=OdometrySpec)
    start: Pose | None = None
    longest_s: float = LONGEST_S


@dataclass(frozen=True, slots=True)
class Survey:
    """What came of it: metres, radians, virtual seconds. `is_whole` when the robot saw all that it could reach.

    `is_barred` when it did not get out of or through a narrow place behind which there is more to see.
    """

    grid: Grid
    start: Pose
    is_whole: bool
    is_barred: bool
    driven_m: float
    virtual_s: float
    scans: int
    given_up: int
    bumps: int
    final_error: tuple[float, float]
    largest_error: tuple[float, float]


class NoRoom(Exception):
    """The robot does not fit where it shall begin."""


def run_survey(plan: SurveyPlan, watch: Callable[[float, MapMaker], None] | None = None) -> Survey:
    """Let a robot map a floor; `watch` is called after each scan with the virtual time. Raises NoRoom."""
    expedition = Expedition(plan)
    while not expedition.is_over:
        if expedition.tick() and watch is not None:
            watch(expedition.time_s, expedition.maker)
    return expedition.survey()


class Expedition:
    """A robot on its way over a floor, tick by tick. Raises NoRoom where it does not fit."""

    def __init__(self, plan: SurveyPlan, believed: Pose | None = None) -> None:
        """Stand at the plan's start; `believed` is where the robot takes that to be, if it errs."""
        self._plan, self._floor = plan, TrueFloor(plan.grid)
        start = plan.start or self._floor.roomiest()
        if self._floor.clearance_m(start.x, start.y) < plan.robot.radius_m:
            raise NoRoom(
                f"A robot with a radius of {plan.robot.radius_m:g} m does not fit at ({start.x:g}, {start.y:g})."
            )
        seeds = np.random.SeedSequence(plan.seed).spawn(2)
        self._lidar = Lidar(self._floor, plan.lidar, np.random.default_rng(seeds[0]))
        self._odometry = Odometry(plan.odometry, np.random.default_rng(seeds[1]))
        anchor = (plan.grid.origin_x_m, plan.grid.origin_y_m)
        self.maker = MapMaker(plan.robot, believed or start, plan.grid.resolution_m, anchor)
        self._start = self.pose = start
        self._ticks, self._speed, self._turn = 0, 0.0, 0.0
        self._until_s = plan.longest_s
        self.stands_before = False
        self._driven_m, self._bumps = 0.0, 0
        self._errors = (0.0, 0.0)
        self._obstacles: Sequence[Obstacle] = ()

    @property
    def time_s(self) -> float:
        """Return the virtual time."""
        return self._ticks * TICK_S

    @property
    def is_over(self) -> bool:
        """True when the map is made, the robot cannot make more of it, or the time is over."""
        return self.maker.is_done or self.time_s >= self._until_s

    def go_on(self) -> bool:
        """Explore on with the same map, for as long as at first; False when the map is whole."""
        if self.maker.is_whole:
            return False
        self._until_s = self.time_s + self._plan.longest_s
        if self.maker.is_barred:
            self.maker.go_on()
        return True

    def put_in_the_way(self, obstacles: Sequence[Obstacle]) -> None:
        """Let things stand on the floor that the robot was not told of, in place of those that stood there.

        One can be put where the robot stands no sooner than it has left.
        """
        radius_m, at = self._plan.robot.radius_m, self.pose
        here = tuple(o for o in obstacles if hypot(o.x - at.x, o.y - at.y) > o.size_m / 2 + radius_m)
        if here != self._obstacles:
            self._obstacles = here
            self._floor.put(here)

    def tick(self) -> bool:
        """Let a tick pass in which the robot explores; True when a scan went into the map."""
        sees = False
        self._move(self._speed, self._turn)
        if self._ticks % SCAN_EVERY == 0:
            ranges, sees = self._look()
            self._speed, self._turn = self.maker.drive(ranges, SCAN_EVERY * TICK_S)
        self._ticks += 1
        return sees

    def drive(self, speed: float, turn: float) -> None:
        """Let a tick pass in which the robot is steered (m/s, rad/s); it stands before what its lidar sees ahead."""
        if self._ticks % SCAN_EVERY == 0:
            ranges, _ = self._look()
            self.stands_before = speed > 0 and self.maker.is_blocked(ranges)
        self._speed, self._turn = 0.0 if self.stands_before else speed, turn
        self._move(self._speed, self._turn)
        self._ticks += 1

    def _look(self) -> tuple[Floats, bool]:
        """Scan; what is far enough from the last scan goes into the map, and says where the robot is."""
        ranges = self._lidar.scan(self.pose)
        sees = self.maker.wants_scan()
        if sees:
            self.maker.see(ranges)
            self._note_error()
        return ranges, sees

    def survey(self) -> Survey:
        """Look round once more, and return what has come of it."""
        self.look_round()
        return self._survey(self.time_s)

    def look_round(self) -> Pose:
        """Scan where the robot stands, and return where it believes to be then."""
        self.maker.see(self._lidar.scan(self.pose))
        self._note_error()
        return replace(self.maker.pose, z=0.0)

    def _move(self, speed: float, turn: float) -> None:
        """Drive for a tick; a robot that would touch something stands, and its wheels do, too."""
        goes = moved(self.pose, speed * TICK_S, turn * TICK_S)
        if speed and self._floor.clearance_m(goes.x, goes.y) < self._plan.robot.radius_m:
            before = self._floor.clearance_m(self.pose.x, self.pose.y)
            if self._floor.clearance_m(goes.x, goes.y) <= before:
                self._bumps += 1
                goes, speed = moved(self.pose, 0.0, turn * TICK_S), 0.0
        self.pose = goes
        self._driven_m += abs(speed) * TICK_S
        if speed or turn:
            self.maker.move(*self._odometry.measure(speed * TICK_S, turn * TICK_S))

    def _note_error(self) -> None:
        way, turn = self._error()
        self._errors = max(self._errors[0], way), max(self._errors[1], turn)

    def _error(self) -> tuple[float, float]:
        """Return how far the robot is from where it believes to be."""
        believed = self.maker.pose
        way = hypot(believed.x - self.pose.x, believed.y - self.pose.y)
        return way, abs(wrapped(believed.theta - self.pose.theta))

    def _survey(self, virtual_s: float) -> Survey:
        maker = self.maker
        return Survey(
            grid=maker.grid(),
            start=self._start,
            is_whole=maker.is_whole,
            is_barred=maker.is_barred,
            driven_m=self._driven_m,
            virtual_s=virtual_s,
            scans=maker.matches,
            given_up=len(maker.given_up),
            bumps=self._bumps,
            final_error=self._error(),
            largest_error=self._errors,
        )

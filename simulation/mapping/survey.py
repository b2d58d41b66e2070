"""A robot maps a floor in virtual time: it drives, and meets walls, slip and noise. Same seed, same map."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from math import hypot

import numpy as np

from registry.floorplan.plan import Grid
from simulation.actors.follower import wrapped
from simulation.mapping.floor import Lidar, LidarSpec, TrueFloor
from simulation.mapping.map_maker import MapMaker, RobotSpec
from simulation.mapping.odometry import Odometry, OdometrySpec, moved
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
    """What came of it: metres, radians, virtual seconds. `is_whole` when the robot saw all that it could reach."""

    grid: Grid
    start: Pose
    is_whole: bool
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
    return _Run(plan).to_the_end(watch)


class _Run:
    def __init__(self, plan: SurveyPlan) -> None:
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
        self._maker = MapMaker(plan.robot, start, plan.grid.resolution_m, anchor)
        self._start = self._pose = start
        self._driven_m, self._bumps = 0.0, 0
        self._errors = (0.0, 0.0)

    def to_the_end(self, watch: Callable[[float, MapMaker], None] | None) -> Survey:
        """Tick by tick until the map is made or the time is over."""
        maker, tick = self._maker, 0
        speed = turn = 0.0
        while not maker.is_done and tick * TICK_S < self._plan.longest_s:
            self._move(speed, turn)
            if tick % SCAN_EVERY == 0:
                ranges = self._lidar.scan(self._pose)
                if maker.wants_scan():
                    maker.see(ranges)
                    self._note_error()
                    if watch is not None:
                        watch(tick * TICK_S, maker)
                speed, turn = maker.drive(ranges, SCAN_EVERY * TICK_S)
            tick += 1
        maker.see(self._lidar.scan(self._pose))
        self._note_error()
        return self._survey(tick * TICK_S)

    def _move(self, speed: float, turn: float) -> None:
        """Drive for a tick; a robot that would touch something stands, and its wheels do, too."""
        goes = moved(self._pose, speed * TICK_S, turn * TICK_S)
        if speed and self._floor.clearance_m(goes.x, goes.y) < self._plan.robot.radius_m:
            before = self._floor.clearance_m(self._pose.x, self._pose.y)
            if self._floor.clearance_m(goes.x, goes.y) <= before:
                self._bumps += 1
                goes, speed = moved(self._pose, 0.0, turn * TICK_S), 0.0
        self._pose = goes
        self._driven_m += abs(speed) * TICK_S
        if speed or turn:
            self._maker.move(*self._odometry.measure(speed * TICK_S, turn * TICK_S))

    def _note_error(self) -> None:
        way, turn = self._error()
        self._errors = max(self._errors[0], way), max(self._errors[1], turn)

    def _error(self) -> tuple[float, float]:
        """Return how far the robot is from where it believes to be."""
        believed = self._maker.pose
        way = hypot(believed.x - self._pose.x, believed.y - self._pose.y)
        return way, abs(wrapped(believed.theta - self._pose.theta))

    def _survey(self, virtual_s: float) -> Survey:
        maker = self._maker
        return Survey(
            grid=maker.grid(),
            start=self._start,
            is_whole=maker.is_done,
            driven_m=self._driven_m,
            virtual_s=virtual_s,
            scans=maker.matches,
            given_up=len(maker.given_up),
            bumps=self._bumps,
            final_error=self._error(),
            largest_error=self._errors,
        )

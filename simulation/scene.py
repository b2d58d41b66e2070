"""From a map and descriptions to what a world is made of: walls, machines, robots."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from random import Random

from registry.floorplan.plan import Grid, wall_boxes
from simulation.actors import Chance, Emit, InitialState, Machine, Motion, Robot, Surroundings
from simulation.behaviour import behaviour_of
from simulation.kind_file import default_kinds
from simulation.proximity import Body, machine_bodies, wall_bodies
from simulation.world import Scene
from vipo_device.protocol.description import Description, Pose
from vipo_device.protocol.messages import AckMessage

WALL_HEIGHT_M = 1.0


@dataclass(frozen=True, slots=True)
class RobotStart:
    """Where a robot begins, how big it is, and how fast it drives at most."""

    id: str
    pose: Pose
    radius_m: float
    speed_m_s: float


@dataclass(frozen=True, slots=True)
class Layout:
    """What stands on the floor."""

    walls: tuple[Body, ...]
    machines: tuple[Body, ...]
    robots: tuple[RobotStart, ...]


@dataclass(frozen=True, slots=True)
class Actors:
    """The actors of a scene."""

    machines: dict[str, Machine]
    robots: dict[str, Robot]


def make_layout(scene: Scene, actors: Actors) -> Layout:
    """Return the bodies of a scene."""
    robots = tuple(
        RobotStart(name, scene.poses.get(name, robot.description.pose), robot.radius_m, robot.speed_m_s)
        for name, robot in actors.robots.items()
    )
    solid = [d for d in scene.devices if d.id not in scene.bodiless]
    return Layout(tuple(wall_bodies(wall_boxes(scene.grid))), tuple(machine_bodies(solid)), robots)


def make_actors(scene: Scene, emit: Emit) -> Actors:
    """Make the actors of a scene, in the order of its devices."""
    machines = {d.id: _machine(scene, d, emit) for d in scene.devices if d.kind == "machine"}
    robots = {d.id: _robot(scene, d, emit, machines) for d in scene.devices if d.kind == "robot"}
    return Actors(machines, robots)


def _machine(scene: Scene, description: Description, emit: Emit) -> Machine:
    return Machine(description, emit, _initial_state(scene, description, scene.stocks))


def _robot(scene: Scene, description: Description, emit: Emit, machines: dict[str, Machine]) -> Robot:
    initial = _initial_state(scene, description, scene.carrying)
    robot = Robot(description, emit, initial, Surroundings(machines, _bounds(scene.grid)))
    pose = scene.poses.get(description.id, description.pose)
    robot.stands_at(Motion(pose.x, pose.y, pose.theta))
    return robot


def _initial_state(scene: Scene, description: Description, holds: Mapping[str, Mapping[str, int]]) -> InitialState:
    device = description.id
    return InitialState(
        readings=scene.readings.get(device, {}),
        holds=holds.get(device),
        faults=tuple(f for f in scene.faults if f.device == device),
        remembered=tuple(AckMessage(a.command, a.status, a.why, a.result) for a in scene.remembered.get(device, ())),
        paces=scene.paces.get(device, {}),
        behaviour=behaviour_of(description, default_kinds() if scene.kinds is None else scene.kinds),
        chance=_chance(scene.seed, device),
        fault_chance=_chance(scene.seed, f"{device}:faults"),
    )


def _chance(seed: int, device: str) -> Chance | None:
    """Return a device's own chance, so that another device more does not change it; the seed 0 leaves none."""
    return Random(f"{seed}:{device}").random if seed else None  # noqa: S311 - a play of chance that can be repeated


def _bounds(grid: Grid) -> tuple[float, float, float, float]:
    """Return the map's edges (x1, y1, x2, y2) in metres."""
    width, height = grid.width * grid.resolution_m, grid.height * grid.resolution_m
    return grid.origin_x_m, grid.origin_y_m, grid.origin_x_m + width, grid.origin_y_m + height

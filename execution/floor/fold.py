"""What a site's floor makes of what it is told, in memory: nothing here is written."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from execution.floor_protocol import ToFloor, ToRun, to_run
from execution.traffic import floor
from execution.traffic import messages as m
from execution.traffic.admissions import why_waiting, zone_awaited
from execution.traffic.doors import doors_of
from execution.traffic.floor_state import FloorState as State
from execution.traffic.floor_state import FloorTask
from execution.traffic.layout import Layout, Node
from registry import services as registry

TRAFFIC_EVERY_S = 0.2
AFTERWARDS_S = 20.0
"""A floor is looked after this long after its last robot has come to rest."""
TRAFFIC_AGAIN_S = 5.0
"""After so long all is shown once more: to browsers that have come since."""


@dataclass(slots=True)
class _Published:
    """What browsers have been shown of a site's floor: when last, when the whole of it, and each robot's part."""

    at: float = float("-inf")
    whole_at: float = float("-inf")
    robots: dict[str, Mapping[str, Any]] = field(default_factory=dict)


_published: dict[str, _Published] = {}


@dataclass
class FloorWork:
    """A floor in memory with what a turn has made of it so far: commands, what is over, doors that need people."""

    site: str
    state: State
    commands: list[m.SendCommand] = field(default_factory=list)
    answered: set[str] = field(default_factory=set)
    stuck: list[m.DoorStuck] = field(default_factory=list)

    def fork(self) -> FloorWork:
        """Return the same to work on; this one stays as it is."""
        return replace(self, commands=list(self.commands), answered=set(self.answered), stuck=list(self.stuck))

    def settled(self) -> FloorWork:
        """Return the floor after all this was written down."""
        return FloorWork(self.site, self.state)

    @property
    def is_active(self) -> bool:
        """Tell whether the floor has something under way, or had until just now."""
        state = self.state
        moving = any(len(robot.path) > 1 for robot in state.robots.values())
        resting = any(state.now - robot.idle_since < AFTERWARDS_S for robot in state.robots.values())
        held = any(door.ours for door in state.doors.values())
        return bool(state.tasks or state.sent or moving or resting or held)


def step_floor(
    work: FloorWork, layout: Layout, news: Sequence[m.Event], told: Sequence[ToFloor], now: float
) -> tuple[FloorWork, list[tuple[str, ToRun]]]:
    """Take in news of the registry, then what the floor is told; return the floor after it, and what runs are told.

    `now` is in seconds since 1970. The work that was given is as it was.
    """
    new = work.fork()
    events = [*news, *_reports(work.site, work.state, told), *told, m.Tick()]
    new.state, actions = floor.step(layout, work.state, events, now)
    new.answered |= {each.command for each in told if isinstance(each, m.CommandAnswered)}
    new.commands += [action for action in actions if isinstance(action, m.SendCommand)]
    new.stuck += [action for action in actions if isinstance(action, m.DoorStuck)]
    return new, [said for action in actions if (said := to_run(action)) is not None]


def news_of(before: State, devices: tuple[registry.PositionView, ...]) -> list[m.Event]:
    """Return what has changed on the floor according to the registry: who is there, and where the robots are."""
    news: list[m.Event] = []
    for device in devices:
        robot = before.robots.get(device.id)
        known_online = robot.online if robot else device.id not in before.offline
        if device.online and (not known_online or device.id in before.offline):
            news.append(m.DeviceOnline(device.id))
        elif not device.online and device.id not in before.offline:
            news.append(m.DeviceOffline(device.id))
        pose = device.pose
        if device.kind == "robot" and (robot is None or not robot.path or (robot.x, robot.y) != (pose.x, pose.y)):
            news.append(m.RobotMoved(device.id, pose.x, pose.y, pose.theta))
    return news


def _reports(slug: str, before: State, told: Sequence[ToFloor]) -> list[m.Event]:
    """Return what free robots report, where a task waits for a robot that is chosen by it, and the doors: one read."""
    doors = doors_of(before, (zone for each in told if isinstance(each, m.TaskAsked) for zone in each.zones))
    tasks: list[FloorTask | m.TaskAsked] = [*before.tasks, *(each for each in told if isinstance(each, m.TaskAsked))]
    waiting = (f"{task.run}/{task.order.role}" for task in tasks if task.where)
    choosing = not all(key in before.roles for key in waiting)
    if not choosing and not doors:
        return []
    over = {message.run for message in told if isinstance(message, m.RunOver)}
    free = [robot.id for robot in before.robots.values() if choosing and (robot.run == "" or robot.run in over)]
    readings = registry.get_readings(site=slug, ids=[*free, *sorted(doors)])
    return [m.RobotsReport({robot: one.values for robot, one in readings.items()})]


def publish_traffic(slug: str, layout: Layout, state: State, now: float | None = None) -> None:
    """Show browsers the paths, what is reserved of them and why robots wait: what has changed, five times a second.

    `now` is a monotonic clock's time in seconds.
    """
    now = time.monotonic() if now is None else now
    last = _published.setdefault(slug, _Published())
    if now - last.at < TRAFFIC_EVERY_S:
        return
    shown = {robot.id: _shown(layout, state, robot.id) for robot in state.robots.values() if robot.path}
    is_whole = now - last.whole_at >= TRAFFIC_AGAIN_S
    robots = {name: robot for name, robot in shown.items() if is_whole or robot != last.robots.get(name)}
    if robots:
        _published[slug] = _Published(now, now if is_whole else last.whole_at, shown)
        registry.publish(slug, {"type": "traffic", "robots": robots})


def _shown(layout: Layout, state: State, name: str) -> Mapping[str, Any]:
    robot = state.robots[name]
    ahead = robot.path[robot.passed :]
    reason = next((task.wait for task in state.tasks if task.robot == name and task.wait), None)
    if reason is None and (zone := zone_awaited(layout, state, name)) is not None:
        reason = why_waiting(layout.name(name), name, zone)
    moving = len(ahead) > 1
    return {
        "route": _points(layout, ahead) if moving else [],
        "reserved": _points(layout, robot.path[robot.passed : robot.released + 1]) if moving else [],
        "wait": reason.text if reason else None,
        "why": {"code": reason.code, "args": dict(reason.args)} if reason else None,
    }


def _points(layout: Layout, nodes: Iterable[Node]) -> list[list[float]]:
    """Return where nodes are, in metres to the centimetre."""
    return [[round(x, 2), round(y, 2)] for x, y in map(layout.point, nodes)]

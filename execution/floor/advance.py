"""One step of a site's floor: take in what came, decide, write everything in one transaction."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from typing import Any, Literal

from django.db import transaction

from editor.language.site.surroundings import PlaceFacts
from execution import mailbox
from execution.errors import StepConflict
from execution.floor_protocol import TaskEnded, ToFloor, to_run
from execution.models import Command, FloorState
from execution.traffic import floor
from execution.traffic import messages as m
from execution.traffic.doors import doors_of
from execution.traffic.floor_state import FloorState as State
from execution.traffic.floor_state import FloorTask
from execution.traffic.layout import Layout, make_layout
from registry import services as registry
from vipo_device.protocol.description import Description, Pose

TRAFFIC_EVERY_S = 0.2
MOST_CHARACTERS = 300
AFTERWARDS_S = 20.0
"""A floor is looked after this long after its last robot has come to rest."""


@dataclass(frozen=True, slots=True)
class _Known:
    """A site's layout, with what it was made of; `stamp` tells the same without the descriptions (None: cannot)."""

    stamp: tuple[object, ...] | None
    made_of: tuple[int, tuple[Description, ...], tuple[PlaceFacts, ...]]
    layout: Layout


_layouts: dict[str, _Known] = {}
_published: dict[str, tuple[float, str]] = {}


def advance_site(slug: str) -> bool:
    """Bring a site's floor up to date; False when another process is at it already."""
    with transaction.atomic():
        FloorState.objects.get_or_create(site_id=registry.get_site_id(site=slug))
        row = FloorState.objects.select_for_update(skip_locked=True).filter(site__slug=slug).first()
        if row is None:
            return False
        deliveries = mailbox.waiting_for_floor(slug)
        layout, devices = _look_at_site(slug)
        before = floor.from_json(row.state) if row.state else floor.start(layout, str(row.namespace))
        told = [delivery.message for delivery in deliveries]
        news = [*_news(before, devices), *_reports(slug, before, told), *told, m.Tick()]
        after, actions = floor.step(layout, before, news, time.time())
        _write(slug, row, before, after, actions)
        mailbox.mark_taken(deliveries)
        mailbox.crash_point("site_before_commit")
    mailbox.crash_point("site_after_commit")
    _publish_traffic(slug, layout, after)
    return True


def get_layout(slug: str) -> Layout:
    """Return the layout of a site as its map, places and approved devices are now; raises NoMap."""
    return _look_at_site(slug)[0]


def _look_at_site(slug: str) -> tuple[Layout, tuple[registry.PositionView, ...]]:
    """Return the layout and where the devices are; what these say of themselves is read only when it is news."""
    positions = registry.list_positions(site=slug, lifecycle="approved")
    places = tuple(place_facts(place) for place in registry.list_places(site=slug))
    site_map = registry.get_map(site=slug)
    known, stamp = _layouts.get(slug), _stamp(site_map.version, positions, places)
    if known is not None and stamp is not None and known.stamp == stamp:
        return known.layout, positions
    placed = registry.list_placed(site=slug, lifecycle="approved")
    positions = tuple(position for position, _ in placed)
    at_home = tuple(replace(d, pose=Pose(0, 0)) if d.kind == "robot" else d for _, d in placed)
    made_of = (site_map.version, at_home, places)
    is_same = known is not None and known.made_of == made_of
    layout = known.layout if known is not None and is_same else make_layout(site_map.grid, at_home, places)
    _layouts[slug] = _Known(_stamp(site_map.version, positions, places), made_of, layout)
    return layout, positions


def _stamp(
    version: int, positions: tuple[registry.PositionView, ...], places: tuple[PlaceFacts, ...]
) -> tuple[object, ...] | None:
    """Return what differs whenever a layout would; robots are at home wherever they are."""
    if not all(position.version for position in positions):
        return None
    return (version, tuple((p.id, p.version, None if p.kind == "robot" else p.pose) for p in positions), places)


def place_facts(place: registry.PlaceView) -> PlaceFacts:
    """Return a place as the language and traffic see it."""
    kind: Literal["dock", "room", "point"] = (
        "dock" if place.kind == "dock" else "room" if place.kind == "room" else "point"
    )
    return PlaceFacts(place.id, place.name, kind, place.x, place.y, place.theta)


def _news(before: State, devices: tuple[registry.PositionView, ...]) -> list[m.Event]:
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


def _write(slug: str, row: FloorState, before: State, after: State, actions: tuple[m.Action, ...]) -> None:
    """Write what one step has decided; a floor that was advanced elsewhere meanwhile refuses it all."""
    commands = [action for action in actions if isinstance(action, m.SendCommand)]
    written = FloorState.objects.filter(pk=row.pk, epoch=row.epoch).update(
        state=floor.to_json(after),
        epoch=row.epoch + 1,
        active=_is_active(after),
        commands=row.commands + len(commands),
    )
    if not written:
        raise StepConflict(f"The floor of {slug} was advanced by another process.")
    now = datetime.now(UTC)
    Command.objects.bulk_create(_command_rows(row, commands, now))
    given_up = set(before.sent) - set(after.sent)
    if given_up:
        still_open = Command.objects.filter(id__in=given_up, status__in=Command.OPEN)
        still_open.update(status=Command.Status.TIMED_OUT, ended_at=now)
    for number, action in enumerate(actions):
        _tell_run(row, number, action)
    stuck = [action for action in actions if isinstance(action, m.DoorStuck)]
    registry.raise_alerts(raised=[_as_raised(door, now) for door in stuck])
    if commands:
        transaction.on_commit(lambda: registry.wake("gateway"))


def _as_raised(door: m.DoorStuck, now: datetime) -> registry.Raised:
    """Return the alert about a door that has kept robots waiting; it is over once the door has done what it is told."""
    why = {"why": door.why[:MOST_CHARACTERS]} if door.why else {}
    return registry.Raised(door.device, "command_failed", now, {"method": door.method, **why})


def _is_active(state: State) -> bool:
    moving = any(len(robot.path) > 1 for robot in state.robots.values())
    resting = any(state.now - robot.idle_since < AFTERWARDS_S for robot in state.robots.values())
    held = any(door.ours for door in state.doors.values())
    return bool(state.tasks or state.sent or moving or resting or held)


def _command_rows(row: FloorState, commands: list[m.SendCommand], now: datetime) -> list[Command]:
    return [
        Command(
            id=command.id,
            site_id=row.site_id,
            position=row.commands + number,
            device=command.device,
            method=command.method,
            arguments=dict(command.arguments),
            run=command.run or None,
            step=command.step,
            piece=command.piece,
            fence=row.epoch,
            send_after=now,
            created_at=now,
        )
        for number, command in enumerate(commands)
    ]


def _tell_run(row: FloorState, number: int, action: m.Action) -> None:
    """Put into a run's inbox what the floor has to say to it."""
    told = to_run(action)
    if told is not None:
        run, message = told
        key = f"{row.namespace}:{row.epoch}:{number}"
        if isinstance(message, TaskEnded):
            key = f"over:{run}:{message.task}"
        mailbox.post_to_run(run, [(key, message)])


def _publish_traffic(slug: str, layout: Layout, state: State) -> None:
    """Show browsers the paths and reserved cells, at most five times a second and only when they have changed."""
    robots = {robot.id: _shown(layout, state, robot.id) for robot in state.robots.values() if robot.path}
    last_at, last = _published.get(slug, (0.0, ""))
    now = time.monotonic()
    seen = repr(robots)
    if seen != last and now - last_at >= TRAFFIC_EVERY_S:
        _published[slug] = (now, seen)
        registry.publish(slug, {"type": "traffic", "robots": robots})


def _shown(layout: Layout, state: State, name: str) -> Mapping[str, Any]:
    robot = state.robots[name]
    ahead = robot.path[robot.passed :]
    reason = next((task.wait for task in state.tasks if task.robot == name and task.wait), None)
    moving = len(ahead) > 1
    return {
        "route": [list(layout.point(node)) for node in ahead] if moving else [],
        "reserved": [list(layout.point(node)) for node in robot.path[robot.passed : robot.released + 1]]
        if moving
        else [],
        "wait": reason.text if reason else None,
        "why": {"code": reason.code, "args": dict(reason.args)} if reason else None,
    }

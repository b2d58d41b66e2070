"""Robots that wait to be let into a zone of a site, and people who let them in."""

from __future__ import annotations

from dataclasses import dataclass
from uuid import uuid4

from django.db import transaction

from execution import mailbox
from execution.errors import NotPossibleNow
from execution.floor.layouts import look_at_site
from execution.models import FloorState
from execution.traffic import floor
from execution.traffic.admissions import zone_awaited
from execution.traffic.messages import RobotLetIn
from registry import services as registry

NOT_WAITING = (
    "{robot} does not wait before {zone}. Somebody may have let it in, or it drives elsewhere; look at the map."
)


@dataclass(frozen=True, slots=True)
class AwaitedAdmission:
    """A robot that waits before a zone of its site; `run` is the id of the run that it works for, if any."""

    zone: str
    zone_name: str
    robot: str
    robot_name: str
    run: str


def list_awaited(*, site: str) -> list[AwaitedAdmission]:
    """Return who waits to be let into which zone of a site; raises NotAMember."""
    row = FloorState.objects.filter(site_id=registry.get_site_id(site=site)).first()
    state = floor.from_json(row.state) if row is not None and row.state else None
    if state is None or not state.awaiting:
        return []
    try:
        layout, _ = look_at_site(site)
    except registry.NoMap:
        return []
    found = []
    for robot in sorted(state.awaiting):
        zone = zone_awaited(layout, state, robot)
        if zone is not None and robot in state.robots:
            zone_id = zone.key.partition("/")[2]
            found.append(AwaitedAdmission(zone_id, zone.name, robot, layout.name(robot), state.robots[robot].run))
    return found


def let_in(*, site: str, zone_id: str, robot_id: str) -> None:
    """Let a robot that waits before a zone into it, for one visit. Of several people at once one does.

    Raises:
        NoSuchZone: the site has no such zone.
        NotPossibleNow: the robot does not wait there, or not any more.
    """
    zone = registry.find_zone(site=site, zone_id=zone_id)
    with transaction.atomic():
        awaited = next(
            (each for each in list_awaited(site=site) if (each.zone, each.robot) == (zone.id, robot_id)), None
        )
        if awaited is None:
            names = registry.get_device_names(site=site, ids=[robot_id[:64]])
            named = {"robot": names.get(robot_id) or robot_id[:64], "zone": zone.name}
            raise NotPossibleNow(NOT_WAITING.format_map(named), {"why": "not_waiting", **named})
        mailbox.post_to_floor(site, [(f"let-in:{uuid4()}", RobotLetIn(f"site/{zone.id}", robot_id))])
        facts = {"robot": awaited.robot_name, "zone": zone.name}
        registry.note_act(site_id=registry.get_site_id(site=site), code="robot_let_in", facts=facts)

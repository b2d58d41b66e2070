"""Zones that a person lets robots into: a robot waits before one until somebody has let it in, each time anew.

A zone can be opened to all robots for a time; when that is over, those under way that are not in it yet stop before it.

An admission is for one robot and one visit. It is over when the robot has left the zone again, when nothing that the
robot has to do leads there any more, or when the robot has not come in for a minute, since whoever has looked is gone
by then. Who is in such a zone already drives on in it, and leaves it.
"""

from __future__ import annotations

from dataclasses import replace

from execution.traffic.floor_state import Admission, FloorState, Robot
from execution.traffic.layout import Layout, Node
from execution.traffic.messages import FloorZone, Reason
from execution.traffic.turn import Turn
from execution.traffic.zones import is_in, zones_with_admission

ENTERS_WITHIN_S = 60.0


def zone_before(turn: Turn, robot: Robot, index: int) -> FloorZone | None:
    """Return the first zone that a robot comes into at a node of its path and that nobody has let it into."""
    for zone in zones_with_admission(turn.layout.zones, turn.now):
        if _enters(turn.layout, robot.path, index, zone) and (zone.key, robot.id) not in turn.admissions:
            return zone
    return None


def _enters(layout: Layout, path: tuple[Node, ...], index: int, zone: FloorZone) -> bool:
    return is_in(layout, path[index], zone) and not (index > 0 and is_in(layout, path[index - 1], zone))


def let_in(turn: Turn, zone_key: str, robot_id: str) -> None:
    """A person lets a robot into a zone before which it waits; for one that does not wait there nothing changes."""
    if turn.before.awaiting.get(robot_id) == zone_key:
        turn.admissions[zone_key, robot_id] = Admission(zone_key, robot_id, turn.now)


def keep_admissions(turn: Turn) -> None:
    """Note who has come into its zone, and end the admissions of who has left it or has nothing to do there."""
    zones = {zone.key: zone for zone in zones_with_admission(turn.layout.zones, turn.now)} if turn.admissions else {}
    for key, admission in list(turn.admissions.items()):
        zone, robot = zones.get(admission.zone), turn.robots.get(admission.robot)
        if zone is None or robot is None or not robot.path:
            del turn.admissions[key]
        elif is_in(turn.layout, turn.node(robot), zone):
            turn.admissions[key] = replace(admission, entered=True)
        elif admission.entered or _is_stale(turn, admission) or not _leads_to(turn, robot, zone):
            del turn.admissions[key]


def _is_stale(turn: Turn, admission: Admission) -> bool:
    return turn.now - admission.at > ENTERS_WITHIN_S


def _leads_to(turn: Turn, robot: Robot, zone: FloorZone) -> bool:
    """Tell whether a robot may still come to a zone: on its path, or on one that its task will have."""
    ahead = robot.path[robot.passed + 1 :]
    return turn.task_of(robot) is not None or any(is_in(turn.layout, node, zone) for node in ahead)


def wait_for_admission(turn: Turn, robot: Robot, zone: FloorZone) -> None:
    """Say that a robot waits to be let in, to its run and to the site."""
    turn.awaiting[robot.id] = zone.key
    if task := turn.task_of(robot):
        turn.wait_for(task, why_waiting(turn.name(robot.id), robot.id, zone))


def why_waiting(name: str, robot_id: str, zone: FloorZone) -> Reason:
    """Return the reason for which a robot, called `name`, stands before a zone."""
    text = f"{name} waits to be let into {zone.name}."
    return Reason("not_let_in", text, {"robot": robot_id, "zone": zone.name, "zone_id": zone.key.partition("/")[2]})


def zone_awaited(layout: Layout, state: FloorState, robot_id: str) -> FloorZone | None:
    """Return the zone that a robot waits to be let into now."""
    key = state.awaiting.get(robot_id)
    return next((zone for zone in zones_with_admission(layout.zones, state.now) if zone.key == key), None)

"""What a run is told of the world before each step: readings, positions, roles, the time of day, devices' names."""

from __future__ import annotations

import time
from bisect import bisect_left
from collections import OrderedDict
from collections.abc import Iterable
from datetime import datetime, timedelta
from uuid import UUID

from django.utils import timezone

from execution.floor_protocol import CommandEnded, CommandGiven, RobotSetsOut, RoleEmptied, RoleFilled, ToRun, WaitNoted
from execution.machine.needs import Facts, Needs, clock_fact, position_facts, role_facts
from execution.models import Run
from registry import services as registry

POSES_EVERY_S = 1.0
KEPT = 256
_posed_at: OrderedDict[UUID, float] = OrderedDict()


def facts_of(needs: Needs, run: Run, messages: Iterable[ToRun], now: datetime) -> Facts:
    """Return what a run wants to know; robots' positions at most once a second, places as they were when it began."""
    robots = run.started_at is None or _is_time_for_poses(run.id)
    taken = {message.robot for message in messages if isinstance(message, RoleFilled)}
    of_roles = frozenset(taken.union(run.roles.values()))
    facts = site_facts(needs, run.site.slug, now, robots=robots, of_roles=of_roles) | role_facts(needs, run.roles)
    if needs.positions:
        facts |= position_facts((place["id"], place["x"], place["y"]) for place in run.places or ())
    return facts


def site_facts(
    needs: Needs, site: str, now: datetime, *, robots: bool = True, of_roles: frozenset[str] = frozenset()
) -> Facts:
    """Return the facts about a site that are needed; `of_roles` are the robots that roles have."""
    facts: Facts = {}
    things = None if needs.things is None else needs.things | of_roles
    if needs.properties:
        said = registry.get_readings(site=site, ids=things)
        facts |= {(d, name): v for d, one in said.items() for name, v in one.values.items() if name in needs.properties}
    if needs.positions:
        there = [p for p in registry.list_positions(site=site, ids=things) if robots or p.kind != "robot"]
        facts |= position_facts((p.id, p.pose.x, p.pose.y) for p in there)
        facts |= position_facts((place.id, place.x, place.y) for place in registry.list_places(site=site))
    if needs.clock:
        facts |= clock_fact(_second_of_day(now))
    return facts


def _second_of_day(now: datetime) -> int:
    """Return the time of day; in the hour that clocks repeat, the last second before they were put back.

    So it never goes back within a day, and what was once true of it does not become true again.
    """
    local = timezone.localtime(now)
    if local.fold:
        hidden = local.replace(fold=0).utcoffset() or timedelta()
        repeated = int((hidden - (local.utcoffset() or timedelta())).total_seconds())
        seconds = range(1, repeated + 1)
        left = bisect_left(seconds, 1, key=lambda later: not timezone.localtime(now + timedelta(seconds=later)).fold)
        local = local.replace(fold=0, tzinfo=None) + timedelta(seconds=left)
    return local.hour * 3600 + local.minute * 60 + local.second


def things_named(messages: Iterable[ToRun]) -> frozenset[str]:
    """Return what may be ids of devices that the lines about these messages name."""
    return frozenset(str(name) for message in messages for name in _named(message) if name)


def _named(message: ToRun) -> Iterable[object]:
    """Return all that may be a device's id, arguments of a command among it."""
    match message:
        case RoleFilled(robot=robot) | RoleEmptied(robot=robot) | RobotSetsOut(robot=robot) | WaitNoted(robot=robot):
            return (robot,)
        case CommandGiven(device=device, arguments=arguments):
            return (device, *arguments.values())
        case CommandEnded(device=device):
            return (device,)
    return ()


def _is_time_for_poses(run: UUID) -> bool:
    now = time.monotonic()
    if now - _posed_at.get(run, -POSES_EVERY_S) < POSES_EVERY_S:
        return False
    _posed_at[run] = now
    while len(_posed_at) > KEPT:
        _posed_at.popitem(last=False)
    return True

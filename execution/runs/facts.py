"""What a run is told of the world before each step: readings, positions, roles, the time of day, devices' names."""

from __future__ import annotations

import time
from collections import OrderedDict
from collections.abc import Iterator, Mapping, Sequence
from datetime import datetime
from typing import Any
from uuid import UUID

from django.utils import timezone

from execution.machine.needs import Facts, Needs, clock_fact, position_facts, role_facts
from execution.models import InboxEvent, Run
from registry import services as registry

POSES_EVERY_S = 1.0
KEPT = 256
_posed_at: OrderedDict[UUID, float] = OrderedDict()


def facts_of(needs: Needs, run: Run, events: Sequence[InboxEvent], now: datetime) -> Facts:
    """Return what a run wants to know; robots' positions at most once a second."""
    robots = run.state is None or _is_time_for_poses(run.id)
    taken = {row.payload["robot"] for row in events if row.payload["type"] == "role_bound"}
    of_roles = frozenset(taken.union(run.roles.values()))
    return site_facts(needs, run.site.slug, now, robots=robots, of_roles=of_roles) | role_facts(needs, run.roles)


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
        local = timezone.localtime(now)
        facts |= clock_fact(local.hour * 3600 + local.minute * 60 + local.second)
    return facts


def names_of(run: Run, events: Sequence[InboxEvent]) -> Mapping[str, str]:
    """Return what the devices are called that the lines about these events may name, by id."""
    ids = {name for row in events for name in _named(row.payload)}
    return registry.get_device_names(site=run.site.slug, ids=ids) if ids else {}


def _named(event: Mapping[str, Any]) -> Iterator[str]:
    """Yield all that may be a device's id, arguments of a command among it."""
    for value in (event.get("robot"), event.get("device"), *event.get("arguments", {}).values()):
        if value:
            yield str(value)


def _is_time_for_poses(run: UUID) -> bool:
    now = time.monotonic()
    if now - _posed_at.get(run, -POSES_EVERY_S) < POSES_EVERY_S:
        return False
    _posed_at[run] = now
    while len(_posed_at) > KEPT:
        _posed_at.popitem(last=False)
    return True

"""What a run is told of the world before each step: readings, positions, roles, the time of day."""

from __future__ import annotations

import time
from collections import OrderedDict
from datetime import datetime
from uuid import UUID

from django.utils import timezone

from execution.machine.needs import Facts, Needs, clock_fact, position_facts, role_facts
from execution.models import Run
from registry import services as registry

POSES_EVERY_S = 1.0
KEPT = 256
_posed_at: OrderedDict[UUID, float] = OrderedDict()


def facts_of(needs: Needs, run: Run, now: datetime) -> Facts:
    """Return what a run wants to know; robots' positions at most once a second."""
    robots = run.state is None or _is_time_for_poses(run.id)
    return site_facts(needs, run.site.slug, now, robots=robots) | role_facts(needs, run.roles)


def site_facts(needs: Needs, site: str, now: datetime, *, robots: bool = True) -> Facts:
    """Return the facts about a site that are needed."""
    facts: Facts = {}
    if needs.properties or needs.positions:
        devices = registry.list_devices(site=site)
        facts |= {
            (d.id, name): value for d in devices for name, value in d.readings.items() if name in needs.properties
        }
        if needs.positions:
            there = [d for d in devices if robots or d.kind != "robot"]
            facts |= position_facts((d.id, d.pose.x, d.pose.y) for d in there)
            facts |= position_facts((place.id, place.x, place.y) for place in registry.list_places(site=site))
    if needs.clock:
        local = timezone.localtime(now)
        facts |= clock_fact(local.hour * 3600 + local.minute * 60 + local.second)
    return facts


def _is_time_for_poses(run: UUID) -> bool:
    now = time.monotonic()
    if now - _posed_at.get(run, -POSES_EVERY_S) < POSES_EVERY_S:
        return False
    _posed_at[run] = now
    while len(_posed_at) > KEPT:
        _posed_at.popitem(last=False)
    return True

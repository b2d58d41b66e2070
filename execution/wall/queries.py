"""Reads what a wall screen shows; called on threads."""

from __future__ import annotations

import base64
import zlib
from typing import Any

from django.db import DatabaseError
from django.db.models import Case, F, Q, When
from django.utils import timezone

from execution.floor.stops import get_stop
from execution.models import Run
from execution.views import view_run
from execution.wall.picture import MOST_RUNS, picture_of, place_to_wall, run_to_wall
from registry import services as registry

OPEN = ("pending", "running", "paused")
_BEGUN = Q(started_at__isnull=False)
_FIRST = (
    Case(When(status=Run.Status.RUNNING, then=0), When(_BEGUN, then=1), default=2),
    Case(When(_BEGUN, then=None), default=F("not_before")).asc(nulls_first=True),
    "-number",
)
"""Runs that go on come first, then those that were paused under way, then those to come, the soonest first."""


def read_picture(site: str) -> dict[str, Any]:
    """Return what a site looks like at this moment. Raises NotAMember where there is no such site any more."""
    stop = get_stop(site=site)
    rows = Run.objects.select_related("site").filter(site__slug=site, status__in=OPEN).order_by(*_FIRST)
    runs = [
        run_to_wall(view_run(row), row.compiled)
        for row in rows.defer("document", "plan", "state", "places")[:MOST_RUNS]
    ]
    return picture_of(
        site=registry.get_site(site=site),
        stop=(stop.active, stop.at),
        devices=[device for device in registry.list_devices(site=site) if device.lifecycle == "approved"],
        runs=runs,
        alerts=registry.list_alerts(site=site, role="viewer"),
    )


def read_map(site: str) -> dict[str, Any] | None:
    """Return a site's map as a message, its cells deflated and in base64; None where it has none."""
    try:
        found = registry.get_map(site=site)
    except registry.NoMap:
        return None
    grid = found.grid
    return {
        "type": "map",
        "version": found.version,
        "tag": found.tag,
        "width": grid.width,
        "height": grid.height,
        "resolution_m": grid.resolution_m,
        "origin": {"x": grid.origin_x_m, "y": grid.origin_y_m},
        "places": [place_to_wall(place) for place in registry.list_places(site=site)],
        "cells": base64.b64encode(zlib.compress(grid.cells, 5)).decode(),
    }


def find_wall(key: str) -> registry.OpenedWall | None:
    """Return which wall screen the key of a cookie opens now."""
    return registry.find_wall(key=key, now=timezone.now())


def note_seen(wall: int) -> None:
    """Keep that a wall screen shows its site; not worth an error while the database is away."""
    try:
        registry.note_wall_seen(wall=wall, now=timezone.now())
    except DatabaseError:
        return

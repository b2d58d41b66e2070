"""Obstacles that people put on a site's floor for its simulated robots to meet; they are on no map.

Robots stop before one and say so, as before a pallet that somebody has left. Real robots never hear of them, plans and
rehearsals do without them.
"""

from __future__ import annotations

from math import isfinite

from django.db import transaction

from registry.audit.record import note_act
from registry.errors import RegistryError
from registry.live.fanout import publish
from registry.maps.site_maps import get_map
from registry.models import SimulatedObstacle
from registry.sites.sites import find_site, lock_site
from registry.sites.views import ObstacleView

MOST_OBSTACLES = 50
SMALLEST_M, LARGEST_M = 0.1, 2.0


class BadObstacle(RegistryError):
    """An obstacle that cannot be so."""

    code = "bad_obstacle"
    status = 422


class NoSuchObstacle(RegistryError):
    """An obstacle that is not, or no longer, at the site."""

    code = "no_such_obstacle"
    status = 404


def add_obstacle(*, site: str, x: float, y: float, size_m: float) -> ObstacleView:
    """Put an obstacle on the floor. Raises BadObstacle, NoMap, NotAMember."""
    found = _checked(site, x, y, size_m)
    with transaction.atomic():
        row = lock_site(site)
        if row.obstacles.count() >= MOST_OBSTACLES:
            text = f"A site has at most {MOST_OBSTACLES} obstacles. Take one away that nobody needs."
            raise BadObstacle(text, {"why": "many", "most": MOST_OBSTACLES})
        made = SimulatedObstacle.objects.create(site=row, x=found[0], y=found[1], size_m=found[2])
        note_act(site_id=row.pk, code="obstacle_added", facts={"x": made.x, "y": made.y, "size_m": made.size_m})
        _tell(site)
    return ObstacleView(made.pk, made.x, made.y, made.size_m)


def move_obstacle(*, site: str, obstacle: int, x: float, y: float, size_m: float | None = None) -> ObstacleView:
    """Put an obstacle somewhere else; without a width it keeps its own.

    Raises NoSuchObstacle, BadObstacle, NoMap, NotAMember.
    """
    with transaction.atomic():
        row = SimulatedObstacle.objects.select_for_update().filter(site=find_site(site), pk=obstacle).first()
        if row is None:
            raise _missing(obstacle)
        row.x, row.y, row.size_m = _checked(site, x, y, row.size_m if size_m is None else size_m)
        row.save(update_fields=["x", "y", "size_m"])
        _tell(site)
    return ObstacleView(row.pk, row.x, row.y, row.size_m)


def remove_obstacle(*, site: str, obstacle: int) -> None:
    """Take an obstacle away; robots that have not given up go on. Raises NoSuchObstacle, NotAMember."""
    if not _remove(site, obstacle):
        raise _missing(obstacle)


def remove_obstacles(*, site: str) -> None:
    """Take all obstacles of a site away. Raises NotAMember."""
    _remove(site)


def _remove(site: str, only: int | None = None) -> int:
    """Return how many were there."""
    with transaction.atomic():
        row = find_site(site)
        rows = SimulatedObstacle.objects.filter(site=row)
        gone, _ = (rows if only is None else rows.filter(pk=only)).delete()
        if gone:
            note_act(site_id=row.pk, code="obstacles_removed", facts={"count": gone})
            _tell(site)
    return gone


def _missing(obstacle: int) -> NoSuchObstacle:
    return NoSuchObstacle(f"There is no obstacle {obstacle} at this site. Somebody may have taken it away.")


def _tell(site: str) -> None:
    transaction.on_commit(lambda: publish(site, {"type": "obstacles"}))


def _checked(site: str, x: float, y: float, size_m: float) -> tuple[float, float, float]:
    """Return where an obstacle is and how wide, to the centimetre. Raises BadObstacle, NoMap, NotAMember."""
    if not (isfinite(size_m) and SMALLEST_M <= size_m <= LARGEST_M):
        text = f"An obstacle is {SMALLEST_M:g} to {LARGEST_M:g} m wide. Enter such a width."
        raise BadObstacle(text, {"why": "size", "least": SMALLEST_M, "most": LARGEST_M})
    if get_map(site=site).grid.cell_of(x, y) is None:
        text = f"The obstacle is off the map at {x:.2f}, {y:.2f}. Put it on the map."
        raise BadObstacle(text, {"why": "off", "x": x, "y": y})
    return round(x, 2), round(y, 2), round(size_m, 2)

"""The zones of a site: areas of its map that all robots heed at any time, as its admins draw them.

A zone stands over the map and stays where it is when the map becomes another one. Whoever shows or checks anything
with a map hears of a change as of a new map.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta

from django.db import transaction
from django.utils import timezone

from registry.audit.record import note_act
from registry.errors import RegistryError
from registry.floorplan.plan import Grid
from registry.floorplan.polygons import Outline, area_m2, crosses_itself
from registry.live.fanout import publish
from registry.maps.names import Naming
from registry.maps.site_maps import find_map, get_map
from registry.models import SiteZone
from registry.sites.sites import find_site, list_zones, lock_site
from registry.sites.views import ZoneView

MOST_ZONES = 100
FEWEST_CORNERS, MOST_CORNERS = 3, 100
SMALLEST_M2 = 0.01
SLOWEST_M_S, FASTEST_M_S = 0.05, 5.0
MOST_ROBOTS = 20
NO_DOOR = (
    "Robots need not be let into {zone}, so it is neither opened nor closed. An admin can change what it asks of them."
)
LONGEST_OPEN_MIN = 24 * 60


class BadZone(RegistryError):
    """A zone that cannot be so."""

    code = "bad_zone"
    status = 422


class NoSuchZone(RegistryError):
    """A zone that is not, or no longer, at the site."""

    code = "no_such_zone"
    status = 404


class ZoneTaken(RegistryError):
    """A name or id that another zone of the site has."""

    code = "zone_taken"
    status = 409


class NotAReleasedZone(RegistryError):
    """A zone that is to be opened or closed and that robots drive into anyway, or never."""

    code = "not_a_released_zone"
    status = 409


@dataclass(frozen=True, slots=True)
class ZoneChange:
    """What is to be another about a zone; None leaves it. Metres in the map frame, metres a second.

    `robots` is how many may be in a zone at once whose rule is that; `heading_deg` where one drives in a one-way zone,
    degrees from the x axis, counter-clockwise.
    """

    name: str | None = None
    rule: str | None = None
    points: Sequence[tuple[float, float]] | None = None
    speed_m_s: float | None = None
    robots: int | None = None
    heading_deg: float | None = None


def add_zone(*, site: str, zone: ZoneChange, zone_id: str = "") -> ZoneView:
    """Make a zone; its id is made of its name, if none is wished. Raises BadZone, ZoneTaken, NoMap, NotAMember."""
    known = get_map(site=site)
    with transaction.atomic():
        row = lock_site(site)
        keys = set(SiteZone.objects.filter(site=row).values_list("key", flat=True))
        key = _naming().new_key(zone_id, zone.name or "", keys)
        made = SiteZone(site=row, key=key, rule=SiteZone.Rule.KEEP_OUT, points=[])
        _change(made, zone, known.grid)
        made.save(force_insert=True)
        note_act(site_id=row.pk, code="zone_added", facts={"zone": made.name})
        _tell(site, known.version)
    return find_zone(site=site, zone_id=made.key)


def change_zone(*, site: str, zone_id: str, zone: ZoneChange) -> ZoneView:
    """Change what is named of a zone. Raises NoSuchZone, BadZone, ZoneTaken, NoMap, NotAMember."""
    known = get_map(site=site)
    with transaction.atomic():
        lock_site(site)
        row = _lock(site, zone_id)
        _change(row, zone, known.grid)
        row.save()
        note_act(site_id=row.site_id, code="zone_changed", facts={"zone": row.name})
        _tell(site, known.version)
    return find_zone(site=site, zone_id=zone_id)


def remove_zone(*, site: str, zone_id: str) -> None:
    """Take a zone away: robots drive there as anywhere. Raises NoSuchZone, NotAMember."""
    with transaction.atomic():
        lock_site(site)
        row = _lock(site, zone_id)
        note_act(site_id=row.site_id, code="zone_removed", facts={"zone": row.name})
        row.delete()
        known = find_map(site=site)
        _tell(site, known.version if known else 0)


def open_zone(*, site: str, zone_id: str, minutes: int) -> ZoneView:
    """Let all robots into a zone for so many minutes from now; one that is open already is open for so long then.

    Raises:
        NoSuchZone: the site has no such zone.
        NotAReleasedZone: its rule is not that people let robots in.
        BadZone: for less than a minute or more than a day.
    """
    if not 1 <= minutes <= LONGEST_OPEN_MIN:
        text = f"A zone is opened for 1 to {LONGEST_OPEN_MIN} minutes. Enter such a number."
        raise BadZone(text, {"why": "minutes", "most": LONGEST_OPEN_MIN})
    return _set_open(site, zone_id, timezone.now() + timedelta(minutes=minutes), "zone_opened", minutes=minutes)


def close_zone(*, site: str, zone_id: str) -> ZoneView:
    """Let robots into a zone one by one again; who is in it leaves it. Raises NoSuchZone, NotAReleasedZone."""
    return _set_open(site, zone_id, None, "zone_closed")


def _set_open(site: str, zone_id: str, until: datetime | None, code: str, **facts: int) -> ZoneView:
    with transaction.atomic():
        lock_site(site)
        row = _lock(site, zone_id)
        if row.rule != SiteZone.Rule.RELEASE:
            text = NO_DOOR.format(zone=row.name)
            raise NotAReleasedZone(text, {"why": "rule", "zone": row.name})
        if until is not None or row.open_until is not None:
            row.open_until = until
            row.save(update_fields=["open_until"])
            note_act(site_id=row.site_id, code=code, facts={"zone": row.name, **facts})
            known = find_map(site=site)
            _tell(site, known.version if known else 0)
    return find_zone(site=site, zone_id=zone_id)


def find_zone(*, site: str, zone_id: str) -> ZoneView:
    """Return a zone of a site. Raises NoSuchZone, NotAMember."""
    found = next((zone for zone in list_zones(site=site) if zone.id == zone_id), None)
    if found is None:
        raise _missing(zone_id)
    return found


def _naming() -> Naming:
    return Naming("zone", MOST_ZONES, BadZone, ZoneTaken)


def _lock(site: str, zone_id: str) -> SiteZone:
    row = SiteZone.objects.select_for_update().filter(site=find_site(site), key=zone_id).first()
    if row is None:
        raise _missing(zone_id)
    return row


def _missing(zone_id: str) -> NoSuchZone:
    return NoSuchZone(f"There is no zone {zone_id[:64]!r} at this site. Somebody may have removed it.")


def _tell(site: str, version: int) -> None:
    transaction.on_commit(lambda: publish(site, {"type": "map", "version": version}))


def _change(row: SiteZone, zone: ZoneChange, grid: Grid) -> None:
    """Write what is named into the row. Raises BadZone, ZoneTaken."""
    if zone.name is not None or not row.name:
        others = SiteZone.objects.filter(site_id=row.site_id).exclude(key=row.key).values_list("name", flat=True)
        row.name = _naming().checked_name(zone.name or "", others)
    if zone.rule is not None:
        row.rule = _checked_rule(zone.rule)
    if zone.points is not None or not row.points:
        row.points = [list(point) for point in _checked_points(zone.points or (), grid)]
    if zone.speed_m_s is not None:
        row.speed_m_s = _checked_speed(zone.speed_m_s)
    if zone.robots is not None:
        row.robots = _checked_robots(zone.robots)
    if zone.heading_deg is not None:
        row.heading_deg = round(zone.heading_deg, 1) % 360
    _settle(row)


def _settle(row: SiteZone) -> None:
    """Leave of the numbers the one that belongs to the row's rule. Raises BadZone if it is missing."""
    if row.rule != SiteZone.Rule.ONE_AT_A_TIME:
        row.robots = None
    if row.rule != SiteZone.Rule.RELEASE:
        row.open_until = None
    if row.rule != SiteZone.Rule.ONE_WAY:
        row.heading_deg = None
    elif row.heading_deg is None:
        raise BadZone("A one-way zone says where robots drive in it. Choose a direction.", {"why": "no_heading"})
    if row.rule != SiteZone.Rule.SLOW:
        row.speed_m_s = None
    elif row.speed_m_s is None:
        raise BadZone("A zone where robots drive slowly says how fast they may be. Enter a speed.", {"why": "no_speed"})


def _checked_rule(rule: str) -> str:
    if rule not in SiteZone.Rule.values:
        raise BadZone(f"A zone's rule is one of {', '.join(SiteZone.Rule.values)}; {rule[:20]!r} is none of them.")
    return rule


def _checked_points(points: Sequence[tuple[float, float]], grid: Grid) -> Outline:
    """Return the corners to the centimetre. Raises BadZone."""
    outline = tuple((round(x, 2), round(y, 2)) for x, y in points)
    if not FEWEST_CORNERS <= len(outline) <= MOST_CORNERS:
        text = f"A zone has {FEWEST_CORNERS} to {MOST_CORNERS} corners. Draw it with that many."
        raise BadZone(text, {"why": "corners", "fewest": FEWEST_CORNERS, "most": MOST_CORNERS})
    if off := next((point for point in outline if not _is_on_map(grid, point)), None):
        args = {"x": off[0], "y": off[1]}
        text = "The zone has a corner off the map at {x:.2f}, {y:.2f}. Put it on the map.".format(**args)
        raise BadZone(text, {"why": "off", **args})
    if crosses_itself(outline):
        raise BadZone("The outline of the zone crosses itself. Move its corners apart.", {"why": "crossing"})
    if area_m2(outline) < SMALLEST_M2:
        raise BadZone("The zone is smaller than 10 cm by 10 cm. Make it larger.", {"why": "small"})
    return outline


def _is_on_map(grid: Grid, point: tuple[float, float]) -> bool:
    """Tell whether a corner lies on the map or its edge, to the centimetre."""
    right = grid.origin_x_m + grid.width * grid.resolution_m
    top = grid.origin_y_m + grid.height * grid.resolution_m
    spare = 0.005 + 1e-9
    return grid.origin_x_m - spare <= point[0] <= right + spare and grid.origin_y_m - spare <= point[1] <= top + spare


def _checked_speed(speed_m_s: float) -> float:
    if not SLOWEST_M_S <= speed_m_s <= FASTEST_M_S:
        text = f"Robots drive {SLOWEST_M_S:g} to {FASTEST_M_S:g} m/s in a slow zone. Enter such a speed."
        raise BadZone(text, {"why": "speed", "least": SLOWEST_M_S, "most": FASTEST_M_S})
    return round(speed_m_s, 3)


def _checked_robots(robots: int) -> int:
    if not 1 <= robots <= MOST_ROBOTS:
        text = f"1 to {MOST_ROBOTS} robots may be in a zone at once. Enter such a number."
        raise BadZone(text, {"why": "robots", "most": MOST_ROBOTS})
    return robots

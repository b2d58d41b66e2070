"""The floor check over HTTP: for the site's own robots, or for one of another width that somebody thinks of."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, replace
from time import thread_time
from typing import Any, NamedTuple
from weakref import ref

from django.http import HttpRequest
from ninja import Query, Router, Schema
from pydantic import Field

from editor.language.site.surroundings import PlaceFacts
from execution.errors import ExecutionError
from execution.floor.floor_check import Finding, FindingCode, FloorCheck, check_floor
from execution.floor.layouts import get_floor
from execution.floor.remedies import CheckedFloor, find_remedies
from execution.traffic.layout import DEFAULT_RADIUS_M, Layout, make_layout
from registry import services as registry
from registry.floorplan.plan import Grid
from registry.requests import refuses, signed_in
from vipo_device.protocol.description import Description, Pose, Size

router = Router(tags=["execution"])
LEAST_WIDTH_M, MOST_WIDTH_M = 0.1, 3.0
PATIENCE_S = 5.0
KEPT = 64
"""So many checks are kept, of all sites."""
check_slots = registry.Slots(in_all=3, of_site=2, of_person=2, most_waiting=1)
"""Floors that are checked at once: a screen asks for the site's width and for another one."""
remedy_slots = registry.Slots(in_all=1, of_site=1, of_person=1, most_waiting=1)
"""Searches for remedies at once: one takes the time of many checks, and keeps nobody from those."""
MOST_SEARCHED_S = 4.0
"""So much of a processor's time a search may take before its last trial."""
_kept: dict[tuple[str, float | None], tuple[ref[Layout], FloorCheck]] = {}
"""Checks of sites by width, with the site's own layout at that time, which may be large and so is not kept by this."""


class _Floor(NamedTuple):
    """A site's floor as it was read once: what is found on it and what is tried on it are of the same moment."""

    grid: Grid
    layout: Layout
    places: tuple[PlaceFacts, ...]


class TooManyChecks(ExecutionError):
    """This process checks as many floors as it may, in all or for this person."""

    code = "too_many_floor_checks"
    status = 429


class NoSuchFinding(ExecutionError):
    """The floor has no such finding, or none any more."""

    code = "no_such_finding"
    status = 409


class FloorFindingShape(Schema):
    """Something that keeps robots from a place or machine (`target`), or may.

    `no_room`, `too_narrow`, `no_way`, `off_lattice`: nobody comes there, by the map. `keep_out`, `cut_off`,
    `no_way_in`, `no_way_out`: by a zone, `other` if it is one alone. `together`: no two robots can be at `target` and
    `other` at once. `in_the_way`: a robot that stands at `other` keeps others from `target`.

    Metres: where it is (`x`, `y`), `width_m` what there is, `needs_m` what a robot needs, `sides` the ends of that
    width and `beside` the machines there (null: a wall).
    """

    code: FindingCode
    target: str
    x: float
    y: float
    other: str | None
    width_m: float | None
    needs_m: float | None
    sides: list[tuple[float, float]]
    beside: list[str | None]


class Reached(Schema):
    """How many of the site's machines or places robots come to, of how many."""

    reached: int
    of: int


class ZoneWidthShape(Schema):
    """How wide the way through a zone for so many robots is at its narrowest, and what two beside each other need."""

    zone: str
    width_m: float
    needs_m: float


class FloorCheckShape(Schema):
    """What a site's floor offers robots so wide. `robot` is the device that is so wide, null for another width."""

    map_version: int
    width_m: float
    robot: str | None
    machines: Reached
    places: Reached
    findings: list[FloorFindingShape]
    zones: list[ZoneWidthShape]


class AskFloorCheck(Schema):
    """For which robots a floor is checked: of this width in metres, else for the site's widest."""

    width_m: float | None = Field(None, ge=LEAST_WIDTH_M, le=MOST_WIDTH_M)


class AskRemedies(AskFloorCheck):
    """For which finding of a floor check remedies are looked for."""

    code: FindingCode
    target: str = Field(max_length=64)
    other: str | None = Field(None, max_length=64)


class RemedyShape(Schema):
    """A place or machine of the site (`target`) to move so many metres, to (`x`, `y`); then the finding is gone."""

    target: str
    x: float
    y: float
    by_m: float


@router.get("/sites/{slug:site}/floor-check", response=FloorCheckShape)
def get_floor_check(request: HttpRequest, site: str, asked: Query[AskFloorCheck]) -> dict[str, Any]:
    """Tell what robots cannot come to on a site's floor and why, and where one is in another's way.

    All robots of a site keep the room that the widest needs, so its check holds for all.
    """
    user = signed_in(request)
    registry.require(user, site, "viewer")
    refusal = TooManyChecks("Other floors are being checked, by you or others. Try again in a moment.")
    with check_slots.held(registry.Claim(user.pk), refusal, patience_s=PATIENCE_S):
        floor = _Floor(*get_floor(site))
        check = _check(site, floor, asked.width_m)
    robot = None if asked.width_m else _widest(floor.layout.devices.values())
    return _to_json(check, registry.get_map(site=site).version, robot)


@router.get("/sites/{slug:site}/floor-check/remedies", response=list[RemedyShape], openapi_extra=refuses(409))
def list_remedies(request: HttpRequest, site: str, asked: Query[AskRemedies]) -> list[dict[str, Any]]:
    """Return moves of a place or machine that would mend a finding, the smallest first.

    Each was tried: the floor, checked anew with it, has lost the finding and got no other, at the width that is asked
    for and at the site's own. None is told where no move of a metre was found, and of what zones do.
    """
    user = signed_in(request)
    registry.require(user, site, "admin")
    refusal = TooManyChecks("Remedies are being looked for, for you or others. Try again in a moment.")
    with remedy_slots.held(registry.Claim(user.pk), refusal, patience_s=PATIENCE_S):
        now = _Floor(*get_floor(site))
        floor = _checked_floor(site, now, asked.width_m)
        wanted = (asked.code, asked.target, asked.other)
        finding = next((each for each in floor.check.findings if _key(each) == wanted), None)
        if finding is None:
            raise NoSuchFinding("The floor check finds this no more. Look at it anew.")
        own = _checked_floor(site, now, None) if asked.width_m else None
        ends_at = thread_time() + MOST_SEARCHED_S
        found = find_remedies(floor, finding, own, lambda: thread_time() > ends_at)
    return [{"target": each.target, "x": each.at[0], "y": each.at[1], "by_m": each.by_m} for each in found]


def _key(finding: Finding) -> tuple[str, str, str | None]:
    return finding.code, finding.target, _id_of(finding.other)


def _check(site: str, floor: _Floor, width_m: float | None) -> FloorCheck:
    """Return what is found on a site's floor for robots so wide."""
    kept = _kept.get((site, width_m))
    if kept is None or kept[0]() is not floor.layout:
        found = check_floor(floor.grid, _for_width(floor, width_m), floor.places)
        kept = _keep(site, width_m, floor.layout, found)
    return kept[1]


def _keep(site: str, width_m: float | None, layout: Layout, found: FloorCheck) -> tuple[ref[Layout], FloorCheck]:
    if len(_kept) >= KEPT:
        _kept.clear()
    kept = _kept[site, width_m] = (ref(layout), found)
    return kept


def _checked_floor(site: str, floor: _Floor, width_m: float | None) -> CheckedFloor:
    """Return a floor as it is laid out for robots so wide, with what was found on it."""
    check = _check(site, floor, width_m)
    return CheckedFloor(floor.grid, _for_width(floor, width_m), floor.places, check)


def _for_width(floor: _Floor, width_m: float | None) -> Layout:
    """Return the floor as it would be laid out if all robots were so wide."""
    grid, layout, places = floor
    if width_m is None:
        return layout
    devices = [
        replace(device, radius_m=width_m / 2) if device.kind == "robot" else device
        for device in layout.devices.values()
    ]
    if not any(device.kind == "robot" for device in devices):
        devices.append(Description("-", "-", "robot", "", Pose(0.0, 0.0), Size(0.0, 0.0, 0.0), radius_m=width_m / 2))
    return replace(make_layout(grid, devices, places, layout.zones), bodies=layout.bodies)


def _widest(devices: Iterable[Description]) -> str | None:
    robots = [device for device in devices if device.kind == "robot"]
    widest = max(robots, key=lambda robot: (robot.radius_m, robot.id), default=None)
    return widest.id if widest and widest.radius_m > 0 else None


def _to_json(check: FloorCheck, version: int, robot: str | None) -> dict[str, Any]:
    return {
        "map_version": version,
        "width_m": round(2 * (check.radius_m or DEFAULT_RADIUS_M), 3),
        "robot": robot,
        "machines": dict(zip(("reached", "of"), check.machines, strict=True)),
        "places": dict(zip(("reached", "of"), check.places, strict=True)),
        "findings": [
            {**asdict(found), "other": _id_of(found.other), "x": round(found.at[0], 3), "y": round(found.at[1], 3)}
            for found in check.findings
        ],
        "zones": [asdict(zone) for zone in check.zones],
    }


def _id_of(other: str | None) -> str | None:
    """Return the id of a place or a zone of the site, by which its key of the floor is told."""
    return other.removeprefix("site/") if other else None

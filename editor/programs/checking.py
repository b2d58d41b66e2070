"""A program checked against its site: what the language says of the document, stored, and published to who watches."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any, cast
from uuid import UUID

from django.db.models import Q

from editor.errors import NoSuchProgram
from editor.language.site.signature import Signature, signature_from_json
from editor.language.site.surroundings import (
    DeviceFacts,
    FloorFacts,
    LibraryFacts,
    PlaceFacts,
    Surroundings,
    ZoneFacts,
    ZoneRule,
)
from editor.models import LibraryFunction, LibraryUse, LibraryVersion, Program
from editor.programs.summary import Summary
from registry import services as registry
from registry.floorplan.plan import FloorPlan, machine_beside
from vipo_device.protocol.description import Description, Pose

MOST_NUMBER = 1_000_000_000


def build_surroundings(*, site: str) -> Surroundings:
    """Return what the programs of a site are checked against: its devices, places and floor, as they are now."""
    devices = find_devices(site=site)
    places = {
        place.id: PlaceFacts(place.id, place.name, _kind(place.kind), place.x, place.y, place.theta)
        for place in registry.list_places(site=site)
    }
    return Surroundings(devices, places, _floor(site), _library(site), find_zones(site=site))


def find_devices(*, site: str) -> dict[str, DeviceFacts]:
    """Return the devices of a site by id, as they are now."""
    views = registry.list_devices(site=site)
    machines = [view.canonical for view in views if view.kind == "machine" and view.lifecycle == "approved"]
    return {view.id: _facts(view, machines) for view in views}


def find_zones(*, site: str) -> tuple[ZoneFacts, ...]:
    """Return the zones of a site's floor as the language and traffic see them, by id."""
    return tuple(zone_facts(zone=zone) for zone in registry.list_zones(site=site))


def zone_facts(*, zone: registry.ZoneView) -> ZoneFacts:
    """Return a zone as the language and traffic see it."""
    rule = cast("ZoneRule", zone.rule)
    return ZoneFacts(zone.id, zone.name, rule, zone.points, zone.speed_m_s, zone.robots or 1, zone.heading_deg)


def _library(site: str) -> dict[str, LibraryFacts]:
    """Return the functions that the site sees, with what each version is to who calls it.

    They are those that its members see, and of other sites those for everyone that its programs hold. What a single
    person sees says nothing to the others.
    """
    own = Q(site__slug=site) & ~Q(visibility="me")
    held = Q(visibility="everyone", pk__in=LibraryUse.objects.filter(program__site__slug=site).values("function"))
    rows = LibraryVersion.objects.filter(function__in=LibraryFunction.objects.filter(own | held)).values_list(
        "function_id", "function__name", "number", "signature"
    )
    names: dict[str, str] = {}
    versions: dict[str, dict[int, Signature]] = {}
    for function, name, number, signature in rows:
        names[str(function)] = name
        versions.setdefault(str(function), {})[number] = signature_from_json(signature)
    return {function: LibraryFacts(name, versions[function]) for function, name in names.items()}


def _facts(view: registry.DeviceView, machines: Iterable[Description]) -> DeviceFacts:
    """Return what the language knows of a device; only of a robot that rests is it known where it stands."""
    lifecycle: Any = view.lifecycle
    resting = view.kind == "robot" and view.online and view.done
    standing_at = machine_beside(machines, view.canonical) if resting else None
    return DeviceFacts(view.canonical, lifecycle, view.online, dict(view.readings), standing_at)


def _kind(kind: str) -> Any:
    return kind if kind in {"dock", "room", "point"} else "point"


def _floor(site: str) -> FloorFacts | None:
    try:
        return registry.get_floor_plan(site=site)
    except registry.NoMap:
        return None


def new_revision() -> int:
    """Return a number for a look at a document, in microseconds: no two looks share one, in whatever process."""
    return time.time_ns() // 1_000


@dataclass(frozen=True, slots=True)
class Around:
    """What programs of a site are checked against, and its fingerprint."""

    surroundings: Surroundings
    fingerprint: str


def read_around(program_id: str) -> Around:
    """Return what is around a program now. Raises NoSuchProgram."""
    site = Program.objects.filter(pk=program_id).values_list("site__slug", flat=True).first()
    if site is None:
        raise NoSuchProgram("There is no such program. It may have been deleted.")
    surroundings = build_surroundings(site=site)
    return Around(surroundings, fingerprint_of(surroundings))


def store_summary(program_id: str, summary: Summary, against: str) -> bool:
    """Store what lists show of a program that was checked `against` that; tell whether they show something else."""
    rows = Program.objects.filter(pk=program_id)
    after = {
        "kinds": list(summary.kinds),
        "devices": list(summary.devices),
        "places": list(summary.places),
        "errors": summary.errors,
        "warnings": summary.warnings,
    }
    before = rows.values(*after).first()
    rows.update(**after, checked_against=against)
    if program := rows.select_related("site").first():
        _store_uses(program, summary.sources)
    return before is not None and before != after


def store_failure(program_id: str, against: str) -> bool:
    """Store that a program could not be checked, which lists show as an error; tell whether that is new to them."""
    rows = Program.objects.filter(pk=program_id)
    before = rows.values_list("errors", "warnings").first()
    rows.update(errors=1, warnings=0, checked_against=against)
    return before is not None and before != (1, 0)


def fingerprint_of(surroundings: Surroundings) -> str:
    """Return a hash of what programs depend on in their surroundings; where robots stand is left out."""
    devices = [
        (name, facts.lifecycle, facts.online, _without_pose(facts.description))
        for name, facts in sorted(surroundings.devices.items())
    ]
    library = sorted((name, facts.name, sorted(facts.versions.items())) for name, facts in _known(surroundings).items())
    floor = surroundings.floor
    mark = floor.mark if isinstance(floor, FloorPlan) else ""
    zones = (surroundings.zones,) if surroundings.zones else ()
    seen = (devices, sorted(surroundings.places.items()), library, mark, *zones)
    return hashlib.sha256(repr(seen).encode()).hexdigest()


def _known(surroundings: Surroundings) -> Mapping[str, LibraryFacts]:
    return surroundings.library or {}


def _without_pose(description: Description) -> Description:
    return replace(description, pose=Pose(0, 0)) if description.kind == "robot" else description


def _store_uses(program: Program, sources: Iterable[tuple[str, int]]) -> None:
    """Store which library functions the program holds, of whatever site, and at which versions."""
    wanted = _versions_by_id(sources)
    known = {str(use.function_id): use for use in program.library_uses.all()}
    if wanted == {name: use.versions for name, use in known.items()}:
        return
    program.library_uses.exclude(function_id__in=[name for name in wanted if name in known]).delete()
    there = LibraryFunction.objects.filter(pk__in=wanted.keys() - known).values_list("pk", flat=True)
    fresh = [LibraryUse(function_id=pk, program=program, versions=wanted[str(pk)]) for pk in there]
    LibraryUse.objects.bulk_create(fresh, ignore_conflicts=True)
    for name, use in known.items():
        if name in wanted and use.versions != wanted[name]:
            program.library_uses.filter(pk=use.pk).update(versions=wanted[name])


def _versions_by_id(sources: Iterable[tuple[str, int]]) -> dict[str, list[int]]:
    """Return the versions by those texts that can be ids, in the form in which ids are written."""
    found: dict[str, set[int]] = {}
    for source, number in sources:
        with suppress(ValueError):
            found.setdefault(str(UUID(source)), set()).update([number] if 0 < number < MOST_NUMBER else [])
    return {name: sorted(numbers) for name, numbers in found.items()}


def changes_programs(message: Mapping[str, Any]) -> bool:
    """Tell whether programs may read differently after a live message of their site."""
    kind = message.get("type")
    return kind in {"device_removed", "hello", "library", "map"} or (kind == "device" and "redescribed" in message)

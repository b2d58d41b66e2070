"""A program of one site made anew at another: bound by what devices describe, with holes where nobody fits."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal
from uuid import UUID

from django.db import transaction

from editor import services
from editor.errors import BadRequest
from editor.language.reading.well_formed import well_formed
from editor.language.signatures.binding import bind_document
from editor.language.signatures.fit import find_matches
from editor.language.signatures.needs import find_needs, find_places
from editor.language.site.signature import Need
from editor.language.site.surroundings import Surroundings
from editor.models import Program
from editor.programs.views import ProgramView
from editor.reviews.reviews import find_makers

MOST_CANDIDATES = 100


@dataclass(frozen=True, slots=True)
class Candidate:
    """A device or place of the other site that may stand for one of this; `fits`: it can all that the steps want."""

    id: str
    name: str
    fits: bool


@dataclass(frozen=True, slots=True)
class Binding:
    """A device or place that a program names, who may stand for it, the best first, and who is proposed.

    `need` is what the steps want of a device, and None of a place; `proposed` is None where nobody fits.
    """

    kind: Literal["device", "place"]
    id: str
    name: str
    need: Need | None
    candidates: tuple[Candidate, ...]
    proposed: str | None


@dataclass(frozen=True, slots=True)
class Look:
    """What has to be bound; `points` and `zones` of the map here are left open or out there."""

    bindings: tuple[Binding, ...]
    points: int
    zones: int


def look_at_promotion(*, program: ProgramView, site: str) -> Look:
    """Return what a program names of its site and who at another may stand for it. Raises BadRequest."""
    _require_other(program, site)
    document = well_formed(services.get_document(program_id=program.id))
    here, there = services.build_surroundings(site=program.site), services.build_surroundings(site=site)
    return Look(_bindings(document, here, there), _count_points(document), len(document["zones"]))


def promote_program(
    *, program: ProgramView, site: str, name: str, chosen: Mapping[str, str | None], user: Any
) -> ProgramView:
    """Make a program anew at another site, as it is now, which becomes a version; it keeps which one that was.

    `chosen` says who stands for whom; what it leaves out is bound as proposed. Raises BadRequest.
    """
    _require_other(program, site)
    pinned = services.pin_version(program_id=program.id, user=user)
    version = services.find_version(program_id=program.id, number=pinned.number)
    here, there = services.build_surroundings(site=program.site), services.build_surroundings(site=site)
    document = well_formed(version.document)
    bindings = _bindings(document, here, there)
    _check_chosen(bindings, chosen)
    bound = {binding.id: chosen.get(binding.id, binding.proposed) for binding in bindings}
    made = bind_document(document, bound, _spots(here), _spots(there))
    makers = find_makers(program_id=program.id, number=pinned.number, site=site)
    with transaction.atomic():
        view = services.create_program(site=site, name=name, document=made, user=user, makers=makers)
        Program.objects.filter(pk=view.id).update(origin_id=program.id, origin_version=pinned.number)
    return view


def _require_other(program: ProgramView, site: str) -> None:
    if program.site == site:
        raise BadRequest("The program is at that site already. Choose another site, or copy one of its versions.")


def _check_chosen(bindings: tuple[Binding, ...], chosen: Mapping[str, str | None]) -> None:
    offered = {binding.id: {each.id for each in binding.candidates} for binding in bindings}
    for old, new in chosen.items():
        if new is not None and new not in offered.get(old, ()):
            raise BadRequest(f"{new} cannot stand for {old} at that site. Look again at what is offered there.")


def _bindings(document: Mapping[str, Any], here: Surroundings, there: Surroundings) -> tuple[Binding, ...]:
    by_device: dict[str, Need] = {}
    for need in find_needs(document, here.devices):
        if need.device:
            known = by_device.get(need.device, need)
            joined = (tuple(sorted({*getattr(known, k), *getattr(need, k)})) for k in Need.__slots__[3:])
            by_device[need.device] = Need(need.of, known.name, need.device, *joined)
    devices = [_of_device(need, here, there) for need in by_device.values()]
    return (*devices, *(_of_place(place, here, there) for place in find_places(document, here.devices)))


def _of_device(need: Need, here: Surroundings, there: Surroundings) -> Binding:
    known = here.devices.get(need.device)
    name = known.description.name if known else need.name
    matches = find_matches(need, there.devices)[:MOST_CANDIDATES]
    candidates = tuple(Candidate(match.device, match.name, not match.lacks) for match in matches)
    proposed = candidates[0].id if candidates and candidates[0].fits else None
    return Binding("device", need.device, name, need, candidates, proposed)


def _of_place(place: str, here: Surroundings, there: Surroundings) -> Binding:
    known = here.places.get(place)
    name = known.name if known else place
    alike = [each.id for each in there.places.values() if each.name.casefold() == name.casefold()]
    others = sorted(there.places.values(), key=lambda each: (each.id not in alike, each.name))
    candidates = tuple(Candidate(each.id, each.name, each.id in alike) for each in others[:MOST_CANDIDATES])
    return Binding("place", place, name, None, candidates, alike[0] if alike else None)


def _spots(site: Surroundings) -> dict[str, tuple[float, float]]:
    poses = {device: facts.description.pose for device, facts in site.devices.items()}
    places = {place.id: (place.x, place.y) for place in site.places.values()}
    return {**places, **{device: (pose.x, pose.y) for device, pose in poses.items()}}


def _count_points(document: Mapping[str, Any]) -> int:
    """Return how many values of the steps are points of the map."""
    count, left = 0, [step["params"] for step in document["steps"].values()]
    while left:
        value = left.pop()
        if isinstance(value, Mapping):
            count += set(value) == {"point"}
            left.extend(value.values())
        elif isinstance(value, list):
            left.extend(value)
    return count


def find_origin(*, program_id: UUID, sees: frozenset[str]) -> tuple[ProgramView, int, int] | None:
    """Return what a program was made from, at which version, and which is its newest; None where that is not seen.

    `sees` are the sites of whoever asks.
    """
    row = Program.objects.select_related("origin__site").filter(pk=program_id).first()
    if row is None or row.origin is None or row.origin.site.slug not in sees:
        return None
    return services.get_program(program_id=row.origin.pk), row.origin_version, row.origin.last_version


MOST_COPIES = 20


@dataclass(frozen=True, slots=True)
class CopyView:
    """A program of another site that was made from one, at which version of that, and its own newest version."""

    id: UUID
    name: str
    site: str
    version: int
    newest: int


def list_copies(*, program_id: UUID, sees: frozenset[str]) -> list[CopyView]:
    """Return the programs that were made from a program at the sites of whoever asks, the last made first."""
    rows = Program.objects.select_related("site").filter(origin=program_id, site__slug__in=sees)
    found = rows.order_by("-created_at", "pk")[:MOST_COPIES]
    return [CopyView(row.pk, row.name, row.site.slug, row.origin_version, row.last_version) for row in found]

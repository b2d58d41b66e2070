"""What is asked of the library: found by what functions do, shown at a version, and how versions differ."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from typing import Any
from uuid import UUID

from django.db.models import Count, F, Prefetch, QuerySet

from editor.documents.shared_document import migrate_document
from editor.errors import NoSuchProgram
from editor.language.reading.well_formed import well_formed_function
from editor.language.signatures.compatibility import Reason, find_reasons
from editor.language.signatures.fit import are_met, find_lacks
from editor.language.site.signature import Need, signature_from_json
from editor.language.site.surroundings import DeviceFacts
from editor.library.access import changer, seen_by
from editor.library.words import stems_of
from editor.models import LibraryFunction, LibraryUse, LibraryVersion
from editor.programs.checking import find_devices
from editor.programs.views import AuthorView, view_author
from registry import services as registry
from registry.services import FIRST, Listed, Page

GONE = "The library has no such function."
MOST_VERSIONS = 200


@dataclass(frozen=True, slots=True)
class OriginView:
    """The function that another was made from, at which version of it, and which is its newest."""

    id: UUID
    name: str
    site: str
    version: int
    newest: int


@dataclass(frozen=True, slots=True, kw_only=True)
class LibraryView:
    """A library function, with one of its versions; `definition` is {function, functions, steps, roles, zones}.

    `visibility` says who sees it: me (its author), site, everyone. `mine` is whether who asked may change it. `lacks`
    is what no device of the site that was asked about can do; None where none was. `origin` is what it was made from,
    as far as who asked sees that. `reasons` is what is otherwise since the version before it; None for the first one,
    and in lists.
    """

    id: UUID
    site: str
    name: str
    description: str
    version: int
    author: AuthorView | None
    parameters: tuple[Mapping[str, Any], ...]
    used_in: int
    updated_at: datetime
    script: str
    definition: Mapping[str, Any]
    visibility: str
    mine: bool
    lacks: tuple[Need, ...] | None = None
    origin: OriginView | None = None
    reasons: tuple[Reason, ...] | None = None


@dataclass(frozen=True, slots=True)
class VersionLine:
    """A version of a function without what is in it; `reasons` is what is otherwise since the one before it."""

    number: int
    author: AuthorView | None
    created_at: datetime
    reasons: tuple[Reason, ...] | None


@dataclass(frozen=True, slots=True)
class VersionsCompared:
    """Two versions of a function: what is otherwise for who calls it, and both as they were saved."""

    old: LibraryView
    new: LibraryView
    reasons: tuple[Reason, ...]


def search_library(
    *, user: Any, site: str = "", query: str = "", fits: str = "", only_fitting: bool = False, page: Page = FIRST
) -> Listed[LibraryView]:
    """Return the functions that somebody sees, of one site or all, that have every word of the query, by name.

    Words are those of name and description, of the steps in both languages, and of what devices are and do; each fits
    at the beginning of one. With `fits` each tells what the devices of that site cannot do of it;
    `only_fitting` leaves out those of which they lack anything.

    Raises BadMark.
    """
    newest = LibraryVersion.objects.select_related("author").filter(number=F("function__last_version"))
    rows = _seen(user).filter(last_version__gt=0)
    if site:
        rows = rows.filter(site__slug=site)
    for stem in stems_of(query):
        rows = rows.filter(found_by__contains=f" {stem}")
    devices = find_devices(site=fits) if fits else None
    if only_fitting and devices is not None:
        known = rows.order_by().values_list("demands", flat=True).distinct()
        rows = rows.filter(demands__in=[demands for demands in known if are_met(demands, devices)])
    rows = rows.prefetch_related(Prefetch("versions", queryset=newest, to_attr="newest"))
    found = registry.take_page(rows=rows, by="name", page=page, view=lambda row: row)
    reader = _Reader(user, devices, found)
    shown: Listed[LibraryView] = Listed(reader.view(row, vars(row)["newest"][0]) for row in found)
    shown.rest = found.rest
    return shown


def get_function(*, function_id: UUID | str, user: Any, version: int | None = None, fits: str = "") -> LibraryView:
    """Return a function that somebody sees, as of a version or the newest. Raises NoSuchProgram."""
    row = _row(function_id, user)
    found = _version(row, row.last_version if version is None else version)
    view = _Reader(user, find_devices(site=fits) if fits else None, [row]).view(row, found)
    before = row.versions.filter(number=found.number - 1).first()
    return replace(view, reasons=None if before is None else _reasons(before, found))


def get_definitions(*, function_id: UUID | str, user: Any, versions: Collection[int]) -> dict[int, Mapping[str, Any]]:
    """Return what these versions of a function have, by number; those that there are not are left out.

    Raises NoSuchProgram.
    """
    found = _row(function_id, user).versions.filter(number__in=versions)
    return {number: migrate_document(definition) for number, definition in found.values_list("number", "definition")}


def list_function_versions(*, function_id: UUID | str, user: Any) -> tuple[VersionLine, ...]:
    """Return a function's last versions, the newest first, each with what is otherwise in it. Raises NoSuchProgram."""
    row = _row(function_id, user)
    found = list(
        row.versions.select_related("author").defer("definition", "script").order_by("-number")[:MOST_VERSIONS]
    )
    older = [*found[1:], row.versions.filter(number=found[-1].number - 1).first() if found else None]
    return tuple(
        VersionLine(
            each.number,
            view_author(each.author),
            each.created_at,
            None if before is None else _reasons(before, each),
        )
        for each, before in zip(found, older, strict=False)
    )


def compare_function(*, function_id: UUID | str, user: Any, old: int, new: int | None) -> VersionsCompared:
    """Compare two versions of a function; without `new` with the newest. Raises NoSuchProgram."""
    row = _row(function_id, user)
    sides = [_version(row, old), _version(row, row.last_version if new is None else new)]
    reader = _Reader(user, None, [row])
    views = [reader.view(row, side) for side in sides]
    return VersionsCompared(views[0], views[1], _reasons(sides[0], sides[1]))


def _reasons(old: LibraryVersion, new: LibraryVersion) -> tuple[Reason, ...]:
    return find_reasons(signature_from_json(old.signature), signature_from_json(new.signature))


def _row(function_id: UUID | str, user: Any) -> LibraryFunction:
    row = _seen(user).filter(pk=function_id).first()
    if row is None:
        raise NoSuchProgram(GONE)
    return row


def _seen(user: Any) -> QuerySet[LibraryFunction]:
    return LibraryFunction.objects.select_related("site").filter(seen_by(user)).defer("found_by")


def _version(row: LibraryFunction, number: int) -> LibraryVersion:
    found = row.versions.select_related("author").filter(number=number).first()
    if found is None:
        raise NoSuchProgram(f"The function {row.name} has no version {number}.")
    return found


class _Reader:
    """What somebody reads of these functions: what they may change, which origins they see, how it fits their devices.

    What is counted and looked up is asked for all of them at once, and for no others: in one query with the search, a
    database works it out for everything that is found.
    """

    def __init__(self, user: Any, devices: Mapping[str, DeviceFacts] | None, rows: Sequence[LibraryFunction]) -> None:
        self._devices, self._may_change = devices, changer(user)
        uses = LibraryUse.objects.filter(function__in=[row.pk for row in rows]).order_by().values("function")
        self._uses = dict(uses.annotate(count=Count("pk")).values_list("function", "count"))
        wanted = {row.origin_id for row in rows if row.origin_id is not None}
        self._origins = {row.pk: row for row in _seen(user).filter(pk__in=wanted)} if wanted else {}

    def view(self, row: LibraryFunction, version: LibraryVersion) -> LibraryView:
        definition = migrate_document(version.definition)
        definition["function"] = well_formed_function(definition.get("function"))  # saved when less was looked at
        needs = signature_from_json(version.signature).needs
        return LibraryView(
            id=row.pk,
            site=row.site.slug,
            name=row.name,
            description=row.description,
            version=version.number,
            author=view_author(version.author),
            parameters=tuple(definition["function"].get("parameters") or ()),
            used_in=self._uses.get(row.pk, 0),
            updated_at=row.updated_at,
            script=version.script,
            definition=definition,
            visibility=row.visibility,
            mine=self._may_change(row),
            lacks=None if self._devices is None else find_lacks(needs, self._devices),
            origin=self._origin(row),
        )

    def _origin(self, row: LibraryFunction) -> OriginView | None:
        origin = self._origins.get(row.origin_id) if row.origin_id is not None else None
        if origin is None:
            return None
        return OriginView(origin.pk, origin.name, origin.site.slug, row.origin_version, origin.last_version)

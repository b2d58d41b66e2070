"""Who holds a function of the library: programs, and functions made of it, over the sites that somebody sees."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any
from uuid import UUID

from django.db.models import F

from editor.errors import NoSuchProgram
from editor.library.access import seen_by
from editor.library.queries import GONE
from editor.models import LibraryFunction, LibraryPart, LibraryUse
from registry import services as registry

MOST_SHOWN = 200


@dataclass(frozen=True, slots=True)
class ProgramUse:
    """A program that holds a function, at these of its versions; none until the program is next checked."""

    id: UUID
    name: str
    site: str
    versions: list[int]


@dataclass(frozen=True, slots=True)
class FunctionUse:
    """A function whose newest version, `version`, holds another at these versions of that."""

    id: UUID
    name: str
    site: str
    version: int
    versions: list[int]


@dataclass(frozen=True, slots=True)
class FunctionUses:
    """Who holds a function as far as somebody sees them, by name; `hidden` more programs are at sites of others."""

    programs: tuple[ProgramUse, ...]
    functions: tuple[FunctionUse, ...]
    hidden: int


def list_uses(*, function_id: UUID, user: Any) -> FunctionUses:
    """Return who holds a function: programs of the person's sites, and functions that they see; at most 200 of each.

    Raises NoSuchProgram.
    """
    if not LibraryFunction.objects.filter(seen_by(user), pk=function_id).exists():
        raise NoSuchProgram(GONE)
    uses = LibraryUse.objects.filter(function=function_id).select_related("program__site").order_by("program__name")
    seen = uses.filter(program__site__slug__in=[site.slug for site in registry.list_sites(user=user)])
    programs = tuple(
        ProgramUse(use.program.pk, use.program.name, use.program.site.slug, use.versions) for use in seen[:MOST_SHOWN]
    )
    return FunctionUses(programs, tuple(_functions(function_id, user)), uses.count() - seen.count())


def _functions(function_id: UUID, user: Any) -> Iterable[FunctionUse]:
    parts = LibraryPart.objects.filter(
        function=function_id, holder__function__in=LibraryFunction.objects.filter(seen_by(user))
    )
    newest = parts.filter(holder__number=F("holder__function__last_version"))
    found: dict[UUID, FunctionUse] = {}
    for part in newest.select_related("holder__function__site").order_by("holder__function__name", "number"):
        row = part.holder.function
        use = found.setdefault(row.pk, FunctionUse(row.pk, row.name, row.site.slug, row.last_version, []))
        use.versions.append(part.number)
        if len(found) > MOST_SHOWN:
            break
    return list(found.values())[:MOST_SHOWN]

"""A site's library of functions: saved from programs under version numbers, brought into other programs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any
from uuid import UUID

from django.db import transaction
from django.db.models import Count, Q, QuerySet

from editor.documents.shared_document import empty_document, migrate_document
from editor.documents.store import get_document
from editor.errors import BadRequest, NameTaken, NoSuchProgram
from editor.language.document.format_migrations import FORMAT
from editor.language.reading.well_formed import well_formed, well_formed_function
from editor.models import LibraryFunction, LibraryVersion, Program
from editor.programs.checking import build_surroundings
from editor.programs.compilations import print_program
from editor.programs.views import LibraryView, view_author
from registry import services as registry
from registry.services import FIRST, Listed, Part

MOST_NAME, MOST_DESCRIPTION = 120, 500


def cut_out_function(document: Mapping[str, Any], function: str) -> dict[str, Any]:
    """Return a function of a plain document with its steps and the functions that it calls.

    {function: {name, parameters, …}, id, functions: {id: …} of those called, steps: {id: …}, format}.
    Raises BadRequest.
    """
    document = well_formed(document)
    functions = document["functions"]
    if function not in functions:
        raise BadRequest("The program has no such function. It may have been deleted; reload the page.")
    wanted, steps, left = [function], {}, [function]
    while left:
        parent = left.pop()
        for step, body in document["steps"].items():
            if _parent_of(body) != parent or step in steps:
                continue
            steps[step] = body
            left.append(step)
            called = body["params"].get("function") if body["kind"] == "call" else None
            if isinstance(called, str) and called in functions and called not in wanted:
                wanted.append(called)
                left.append(called)
    others = {other: functions[other] for other in wanted[1:]}
    return {"id": function, "function": functions[function], "functions": others, "steps": steps, "format": FORMAT}


def _parent_of(step: Mapping[str, Any]) -> str | None:
    place = step.get("place")
    return place[0] if place else None


def save_function(
    *, site: str, program_id: UUID | str, function: str, name: str, description: str, user: Any
) -> LibraryView:
    """Save a program's function into its site's library; under a name of one's own, as its next version.

    Raises NoSuchProgram, BadRequest, NameTaken.
    """
    name = " ".join(name.split())
    if not 1 <= len(name) <= MOST_NAME or len(description) > MOST_DESCRIPTION:
        raise BadRequest(f"A name has 1 to {MOST_NAME} characters, a description at most {MOST_DESCRIPTION}.")
    program = Program.objects.filter(pk=program_id, site__slug=site).first()
    if program is None:
        raise NoSuchProgram("There is no such program at this site.")
    definition = cut_out_function(get_document(program_id=program_id), function)
    script = print_function(definition, site)
    with transaction.atomic():
        row, _ = LibraryFunction.objects.get_or_create(site_id=program.site_id, name=name)
        row = LibraryFunction.objects.select_for_update().get(pk=row.pk)
        _require_own(row, site, user)
        row.last_version += 1
        row.description = description or row.description
        row.save()
        LibraryVersion.objects.create(
            function=row, number=row.last_version, author=user, definition=definition, script=script
        )
    registry.publish(site, {"type": "library"})
    return get_function(function_id=row.pk)


def _require_own(row: LibraryFunction, site: str, user: Any) -> None:
    """Raise NameTaken unless somebody may go on with a function: whoever made its first version, and the admins."""
    first = row.versions.order_by("number").first()
    if user is None or first is None or first.author_id == user.pk:
        return
    access = registry.find_access(user, site)
    if access is None or not access.allows("admin"):
        raise NameTaken(
            f"The library of this site has a function “{row.name}” of somebody else. Save yours under another name.",
            {"why": "library", "name": row.name},
        )


def print_function(definition: Mapping[str, Any], site: str) -> str:
    """Return the script of a function alone, as it reads in a program of the site."""
    functions = {definition["id"]: definition["function"], **definition["functions"]}
    migrated = migrate_document(definition)
    document = {**empty_document(), "functions": functions, "steps": migrated["steps"]}
    return print_program(document, build_surroundings(site=site))


def search_library(*, sites: Iterable[str], query: str = "", part: Part = FIRST) -> Listed[LibraryView]:
    """Return the functions of the sites whose name or description has every word of the query, by name.

    Raises BadMark.
    """
    rows = _rows().filter(site__slug__in=list(sites), last_version__gt=0)
    for word in query.split()[:10]:
        rows = rows.filter(Q(name__icontains=word) | Q(description__icontains=word))
    return registry.take_part(
        rows=rows, by="name", part=part, view=lambda row: _view(row, _version(row, row.last_version))
    )


def get_function(*, function_id: UUID | str, version: int | None = None) -> LibraryView:
    """Return a library function, as of a version or the newest. Raises NoSuchProgram."""
    row = _rows().filter(pk=function_id).first()
    if row is None:
        raise NoSuchProgram("The library has no such function.")
    return _view(row, _version(row, row.last_version if version is None else version))


def _rows() -> QuerySet[LibraryFunction]:
    counted: QuerySet[LibraryFunction] = LibraryFunction.objects.select_related("site").annotate(
        used_in=Count("uses", distinct=True)
    )
    return counted


def _version(row: LibraryFunction, number: int) -> LibraryVersion:
    found = row.versions.select_related("author").filter(number=number).first()
    if found is None:
        raise NoSuchProgram(f"The function {row.name} has no version {number}.")
    return found


def _view(row: LibraryFunction, version: LibraryVersion) -> LibraryView:
    used_in: int = getattr(row, "used_in", 0)
    definition = migrate_document(version.definition)
    definition["function"] = well_formed_function(definition.get("function"))  # saved when less was looked at
    return LibraryView(
        id=row.pk,
        site=row.site.slug,
        name=row.name,
        description=row.description,
        version=version.number,
        author=view_author(version.author),
        parameters=tuple(definition["function"].get("parameters") or ()),
        used_in=used_in,
        updated_at=row.updated_at,
        script=version.script,
        definition=definition,
    )

"""The library of functions: saved from a site's programs under version numbers, brought into other programs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any
from uuid import UUID

from django.db import transaction
from django.db.models import Count, F, Prefetch, Q, QuerySet

from editor.documents.shared_document import empty_document, migrate_document
from editor.documents.store import get_document
from editor.errors import BadRequest, NameTaken, NoSuchProgram, NotYours
from editor.language.document.format_migrations import FORMAT
from editor.language.reading.well_formed import well_formed, well_formed_function
from editor.models import LibraryFunction, LibraryUse, LibraryVersion, Program
from editor.programs.checking import build_surroundings
from editor.programs.compilations import print_program
from editor.programs.library_access import changer, seen_by
from editor.programs.views import LibraryView, view_author
from registry import services as registry
from registry.services import FIRST, Listed, Part

MOST_NAME, MOST_DESCRIPTION = 120, 500
_GONE = "The library has no such function."


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


@dataclass(frozen=True, slots=True)
class Said:
    """What is said of a function that is saved; without `visibility` it stays as it was, and is the site's at first."""

    name: str
    description: str = ""
    visibility: str | None = None


def save_function(*, site: str, program_id: UUID | str, function: str, said: Said, user: Any) -> LibraryView:
    """Save a program's function into its site's library; under a name of one's own, as its next version.

    Raises NoSuchProgram, BadRequest, NameTaken.
    """
    name = " ".join(said.name.split())
    if not 1 <= len(name) <= MOST_NAME or len(said.description) > MOST_DESCRIPTION:
        raise BadRequest(f"A name has 1 to {MOST_NAME} characters, a description at most {MOST_DESCRIPTION}.")
    program = Program.objects.filter(pk=program_id, site__slug=site).first()
    if program is None:
        raise NoSuchProgram("There is no such program at this site.")
    definition = cut_out_function(get_document(program_id=program_id), function)
    content = {"author": user, "definition": definition, "script": print_function(definition, site)}
    row = _add_version(program.site_id, replace(said, name=name), content)
    _tell_of(row)
    return get_function(function_id=row.pk, user=user)


def _add_version(site_id: int, said: Said, content: Mapping[str, Any]) -> LibraryFunction:
    """Store the next version of the function with that name, which is made if there is none. Raises NameTaken."""
    user, functions = content["author"], LibraryFunction.objects
    with transaction.atomic():
        made_by = {"author": user}
        row, _ = functions.get_or_create(site_id=site_id, name=said.name, defaults=made_by)
        row = functions.select_for_update(of=("self",)).select_related("site").get(pk=row.pk)
        if not changer(user)(row):
            raise NameTaken(
                f"The library of this site has a function “{row.name}” of somebody else. Save yours under another "
                "name.",
                {"why": "library", "name": row.name},
            )
        row.last_version += 1
        row.description = said.description or row.description
        row.visibility = said.visibility or row.visibility
        row.save()
        LibraryVersion.objects.create(function=row, number=row.last_version, **content)
    return row


def change_function(
    *, function_id: UUID | str, user: Any, visibility: str | None = None, description: str | None = None
) -> LibraryView:
    """Change who sees a function, or what is said of it; its versions stay. Raises NoSuchProgram, NotYours."""
    with transaction.atomic():
        row = _seen(user).select_for_update(of=("self",)).filter(pk=function_id).first()
        if row is None:
            raise NoSuchProgram(_GONE)
        if not changer(user)(row):
            raise NotYours(
                f"“{row.name}” is somebody else's function. Ask its author or an admin of its site to change it."
            )
        row.visibility = row.visibility if visibility is None else visibility
        row.description = row.description if description is None else description
        row.save()
    _tell_of(row)
    return get_function(function_id=function_id, user=user)


def _tell_of(row: LibraryFunction) -> None:
    """Tell the function's site, and those whose programs hold it, that the library has changed."""
    holders = LibraryUse.objects.filter(function=row).values_list("program__site__slug", flat=True)
    for slug in {row.site.slug, *holders}:
        registry.publish(slug, {"type": "library"})


def print_function(definition: Mapping[str, Any], site: str) -> str:
    """Return the script of a function alone, as it reads in a program of the site."""
    functions = {definition["id"]: definition["function"], **definition["functions"]}
    migrated = migrate_document(definition)
    document = {**empty_document(), "functions": functions, "steps": migrated["steps"]}
    return print_program(document, build_surroundings(site=site))


def search_library(*, user: Any, site: str = "", query: str = "", part: Part = FIRST) -> Listed[LibraryView]:
    """Return the functions that somebody sees, of one site or all, with every word in name or description, by name.

    Raises BadMark.
    """
    newest = LibraryVersion.objects.select_related("author").filter(number=F("function__last_version"))
    rows = _counted(user).filter(last_version__gt=0)
    if site:
        rows = rows.filter(site__slug=site)
    for word in query.split()[:10]:
        rows = rows.filter(Q(name__icontains=word) | Q(description__icontains=word))
    rows = rows.prefetch_related(Prefetch("versions", queryset=newest, to_attr="newest"))
    may = changer(user)
    return registry.take_part(
        rows=rows, by="name", part=part, view=lambda row: _view(row, vars(row)["newest"][0], mine=may(row))
    )


def get_function(*, function_id: UUID | str, user: Any, version: int | None = None) -> LibraryView:
    """Return a function that somebody sees, as of a version or the newest. Raises NoSuchProgram."""
    row = _counted(user).filter(pk=function_id).first()
    if row is None:
        raise NoSuchProgram(_GONE)
    return _view(row, _version(row, row.last_version if version is None else version), mine=changer(user)(row))


def _seen(user: Any) -> QuerySet[LibraryFunction]:
    return LibraryFunction.objects.select_related("site").filter(seen_by(user))


def _counted(user: Any) -> QuerySet[LibraryFunction]:
    counted: QuerySet[LibraryFunction] = _seen(user).annotate(used_in=Count("uses", distinct=True))
    return counted


def _version(row: LibraryFunction, number: int) -> LibraryVersion:
    found = row.versions.select_related("author").filter(number=number).first()
    if found is None:
        raise NoSuchProgram(f"The function {row.name} has no version {number}.")
    return found


def _view(row: LibraryFunction, version: LibraryVersion, *, mine: bool) -> LibraryView:
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
        visibility=row.visibility,
        mine=mine,
    )

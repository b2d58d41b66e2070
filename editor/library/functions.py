"""The library of functions: saved from programs under version numbers, changed, and made anew at other sites."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any
from uuid import UUID

from django.db import transaction

from editor.documents.shared_document import empty_document, migrate_document
from editor.documents.store import get_document
from editor.errors import BadRequest, NameTaken, NoSuchProgram, NotYours
from editor.language.signatures.fit import demands_of
from editor.language.signatures.signature import signature_of
from editor.language.site.signature import Signature, signature_to_json
from editor.language.site.surroundings import DeviceFacts
from editor.library.access import changer, seen_by
from editor.library.function_extraction import cut_out_function, held_by, made_from
from editor.library.queries import GONE, LibraryView, get_function
from editor.library.words import words_of
from editor.models import LibraryFunction, LibraryPart, LibraryUse, LibraryVersion, Program
from editor.programs.checking import build_surroundings, find_devices
from editor.programs.compilations import print_program
from registry import services as registry

MOST_NAME, MOST_DESCRIPTION = 120, 500


@dataclass(frozen=True, slots=True)
class Said:
    """What is said of a function that is saved; without `visibility` it stays as it was, and is the site's at first."""

    name: str
    description: str = ""
    visibility: str | None = None


@dataclass(frozen=True, slots=True)
class _Content:
    """What is stored of a version; `devices` are those of the site that it is saved at."""

    author: Any
    definition: Mapping[str, Any]
    signature: Signature
    script: str
    devices: Mapping[str, DeviceFacts]
    origin: tuple[Any, int] | None = None


def save_function(*, site: str, program_id: UUID | str, function: str, said: Said, user: Any) -> LibraryView:
    """Save a program's function into its site's library; under a name of one's own, as its next version.

    What was brought in from another function and is saved under a name of its own keeps where it came from.

    Raises NoSuchProgram, BadRequest, NameTaken.
    """
    said = _checked(said)
    program = Program.objects.filter(pk=program_id, site__slug=site).first()
    if program is None:
        raise NoSuchProgram("There is no such program at this site.")
    definition = cut_out_function(get_document(program_id=program_id), function)
    origin = made_from(definition)
    row = add_version(program.site_id, site, said, definition, user, _find_origin(origin, user))
    return get_function(function_id=row.pk, user=user)


def fork_function(*, site: str, function_id: UUID | str, version: int | None, said: Said, user: Any) -> LibraryView:
    """Make a function of the library anew at a site, as it is at a version; it keeps where it came from.

    Raises NoSuchProgram, BadRequest, NameTaken.
    """
    said = _checked(said)
    source = get_function(function_id=function_id, user=user, version=version)
    if LibraryFunction.objects.filter(site__slug=site, name=said.name).exists():
        raise NameTaken(
            f"The library of this site has a function “{said.name}” already. Give the copy another name.",
            {"why": "library", "name": said.name},
        )
    row = LibraryFunction.objects.select_related("site").get(pk=source.id)
    said = replace(said, description=said.description or source.description)
    site_id = registry.get_site_id(site=site)
    made = add_version(site_id, site, said, source.definition, user, (row.pk, source.version))
    return get_function(function_id=made.pk, user=user)


def _checked(said: Said) -> Said:
    name = " ".join(said.name.split())
    if not 1 <= len(name) <= MOST_NAME or len(said.description) > MOST_DESCRIPTION:
        raise BadRequest(f"A name has 1 to {MOST_NAME} characters, a description at most {MOST_DESCRIPTION}.")
    return replace(said, name=name)


def _find_origin(origin: tuple[str, int] | None, user: Any) -> tuple[Any, int] | None:
    """Return the function that a document names as its origin, if there is one that the person sees."""
    try:
        found = origin and LibraryFunction.objects.filter(seen_by(user), pk=UUID(origin[0])).first()
    except ValueError:
        return None
    return (found.pk, origin[1]) if found and origin and 0 < origin[1] <= found.last_version else None


def add_version(
    site_id: int, site: str, said: Said, definition: Mapping[str, Any], user: Any, origin: tuple[Any, int] | None
) -> LibraryFunction:
    """Store the next version of the function with that name, which is made if there is none, and tell of it.

    Raises NameTaken.
    """
    devices = find_devices(site=site)
    signature = signature_of(definition, devices)
    content = _Content(user, definition, signature, print_function(definition, site), devices, origin)
    row = _store_version(site_id, said, content)
    _tell_of(row)
    return row


def _store_version(site_id: int, said: Said, content: _Content) -> LibraryFunction:
    user, functions = content.author, LibraryFunction.objects
    with transaction.atomic():
        row, is_new = functions.get_or_create(site_id=site_id, name=said.name, defaults={"author": user})
        row = functions.select_for_update(of=("self",)).select_related("site").get(pk=row.pk)
        if not changer(user)(row):
            raise NameTaken(
                f"The library of this site has a function “{row.name}” of somebody else. Save yours under another "
                "name.",
                {"why": "library", "name": row.name},
            )
        if is_new and content.origin is not None:
            row.origin_id, row.origin_version = content.origin
        row.last_version += 1
        row.description = said.description or row.description
        row.visibility = said.visibility or row.visibility
        row.found_by = words_of(row.name, row.description, content.definition, content.signature, content.devices)
        row.demands = demands_of(content.signature.needs)
        row.save()
        version = LibraryVersion.objects.create(
            function=row,
            number=row.last_version,
            author=user,
            definition=content.definition,
            script=content.script,
            signature=signature_to_json(content.signature),
        )
        _store_parts(version)
    return row


def _store_parts(version: LibraryVersion) -> None:
    """Note which functions of the library a version holds, as far as there are such."""
    held = {(str(function), number) for function, number in held_by(version.definition)}
    ids = [function for function, _ in held if _is_id(function)]
    known = {str(pk) for pk in LibraryFunction.objects.filter(pk__in=ids).values_list("pk", flat=True)}
    parts = [
        LibraryPart(function_id=one, number=n, holder=version) for one, n in sorted(held) if one in known and n > 0
    ]
    LibraryPart.objects.bulk_create(parts, ignore_conflicts=True)


def _is_id(text: str) -> bool:
    try:
        UUID(text)
    except ValueError:
        return False
    return True


def change_function(
    *, function_id: UUID | str, user: Any, visibility: str | None = None, description: str | None = None
) -> LibraryView:
    """Change who sees a function, or what is said of it; its versions stay. Raises NoSuchProgram, NotYours."""
    with transaction.atomic():
        seen = LibraryFunction.objects.select_related("site").filter(seen_by(user))
        row = seen.select_for_update(of=("self",)).filter(pk=function_id).first()
        if row is None:
            raise NoSuchProgram(GONE)
        if not changer(user)(row):
            raise NotYours(
                f"“{row.name}” is somebody else's function. Ask its author or an admin of its site to change it."
            )
        row.visibility = row.visibility if visibility is None else visibility
        if description is not None:
            row.description = description
            row.found_by = _words_now(row)
        row.save()
    _tell_of(row)
    return get_function(function_id=function_id, user=user)


def _words_now(row: LibraryFunction) -> str:
    newest = row.versions.get(number=row.last_version)
    devices = find_devices(site=row.site.slug)
    signature = signature_of(newest.definition, devices)
    return words_of(row.name, row.description, newest.definition, signature, devices)


def _tell_of(row: LibraryFunction) -> None:
    """Tell the function's site, and those whose programs hold it, that the library has changed."""
    holders = LibraryUse.objects.filter(function=row).values_list("program__site__slug", flat=True)
    for slug in {row.site.slug, *holders}:
        registry.publish(slug, {"type": "library"})


def print_function(definition: Mapping[str, Any], site: str) -> str:
    """Return the script of a function alone, as it reads in a program of the site."""
    functions = {**definition.get("functions", {}), definition["id"]: definition["function"]}
    migrated = migrate_document(definition)
    others = {root: definition[root] for root in ("roles", "zones") if definition.get(root)}
    document = {**empty_document(), "functions": functions, "steps": migrated["steps"], **others}
    return print_program(document, build_surroundings(site=site))

"""The versions of programs: made when something has changed, by people or by themselves, named, listed and opened."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import Any
from uuid import UUID

from django.contrib.auth import get_user_model
from django.db import transaction
from django.db.models import QuerySet

from editor.documents.shared_document import digest_of, migrate_document
from editor.documents.store import get_document, last_row
from editor.errors import BadRequest, NoSuchProgram, UnreadableVersion
from editor.language import Misfit
from editor.models import Program, Version, VersionToTest
from editor.programs.checking import build_surroundings, new_revision
from editor.programs.compilations import Compilation, compile_program, find_misfit_of_program, print_program
from editor.programs.packing import Content, UnknownPacking, pack, pack_difference, unpack
from editor.programs.programs import GONE, find_program
from editor.programs.views import AuthorView, VersionView, WholeVersionView, view_author
from registry import services as registry
from registry.services import FIRST, Listed, Page
from vipo_device.protocol.description import Scalar
from vipo_device.protocol.texts import find_unfit, normal

MOST_NAME, MOST_MESSAGE = 80, 300


def list_versions(*, program_id: UUID | str, page: Page = FIRST) -> Listed[VersionView]:
    """Return a program's versions without what is in them, the newest first. Raises NoSuchProgram, BadMark."""
    program = find_program(program_id)
    rows = program.versions.select_related("author").defer("content")
    found = registry.take_page(rows=rows, by="-number", page=page, view=lambda row: row)
    people = _people(found)
    listed = Listed(_view(row, program.site.slug, people) for row in found)
    listed.rest = found.rest
    return listed


def get_version(*, version_id: UUID | str) -> WholeVersionView:
    """Return a version. Raises NoSuchProgram, UnreadableVersion."""
    row = _whole_rows().filter(pk=version_id).first()
    if row is None:
        raise NoSuchProgram("There is no such version. Its program may have been deleted.")
    return _whole_view(row)


def find_version(*, program_id: UUID | str, number: int) -> WholeVersionView:
    """Return a program's version by its number. Raises NoSuchProgram, UnreadableVersion."""
    row = _whole_rows().filter(program_id=program_id, number=number).first()
    if row is None:
        raise NoSuchProgram(f"The program has no version {number}.")
    return _whole_view(row)


def pin_version(
    *, program_id: UUID | str, user: Any, name: str = "", message: str = "", cause: str = ""
) -> WholeVersionView:
    """Make the document as it is now a version; if nothing has changed since the last one, that is returned.

    The last one takes name and message then, where it has none. Raises NoSuchProgram, BadRequest, DocumentHole.
    """
    words = _checked_words(name, message)
    rows = last_row(str(program_id))
    document = get_document(program_id=program_id)
    digest = digest_of(document)
    if (last := _last(program_id)) is None or last.digest != digest:
        content = Content(
            document, print_program(document, build_surroundings(site=find_program(program_id).site.slug))
        )
        last, made = add_version(program_id, content, digest, rows, {**words, "author": _saved(user), "cause": cause})
        if made:
            _ask_for_tests(last.pk, "", words["name"])
            return replace(get_version(version_id=last.pk), made=True)
    if not (last.name or last.message) and any(words.values()):
        Version.objects.filter(pk=last.pk).update(**words)
        _ask_for_tests(last.pk, last.name, words["name"])
    return get_version(version_id=last.pk)


def _ask_for_tests(version: UUID, name_before: str, name: str) -> None:
    """Note that a version has a name now, for whoever carries out the program's tests."""
    if name and not name_before:
        VersionToTest.objects.get_or_create(version_id=version)


def name_version(*, program_id: UUID | str, number: int, name: str, message: str) -> VersionView:
    """Give a version another name and message; nothing else of it changes. Raises NoSuchProgram, BadRequest."""
    words = _checked_words(name, message)
    before = Version.objects.filter(program_id=program_id, number=number).values_list("name", flat=True).first()
    if before is None or not Version.objects.filter(program_id=program_id, number=number).update(**words):
        raise NoSuchProgram(f"The program has no version {number}.")
    row = (
        Version.objects.select_related("author", "program__site")
        .defer("content")
        .get(program_id=program_id, number=number)
    )
    _ask_for_tests(row.pk, before, row.name)
    return _view(row, row.program.site.slug, _people([row]))


def compile_version(*, version: WholeVersionView) -> Compilation:
    """Compile a version for its site as that is now, with its plan."""
    return compile_program(version.document, build_surroundings(site=version.site), with_plan=True)


def find_misfit(*, version: WholeVersionView, given: Mapping[str, Scalar]) -> Misfit | None:
    """Return the first parameter of a version that is given a device which cannot do what the program does with it.

    `given` has them by their names in the script. None where all devices can, as the site is now.
    """
    return find_misfit_of_program(version.document, build_surroundings(site=version.site), given)


def compile_version_to_json(*, version: WholeVersionView) -> dict[str, object]:
    """Compile a version for its site as that is now, as JSON."""
    surroundings = build_surroundings(site=version.site)
    return compile_program(version.document, surroundings, revision=new_revision()).compiled()


def _checked_words(name: str, message: str) -> dict[str, str]:
    name, message = normal(" ".join(name.split())), normal(message.strip())
    if len(name) > MOST_NAME or len(message) > MOST_MESSAGE or find_unfit(name, is_line=True) or find_unfit(message):
        raise BadRequest(
            f"A version's name has at most {MOST_NAME} characters, its message {MOST_MESSAGE}. Shorten them."
        )
    return {"name": name, "message": message}


def _saved(user: Any) -> Any:
    return user if user is not None and user.pk else None


def _last(program_id: UUID | str) -> Version | None:
    return Version.objects.filter(program_id=program_id).select_related("base").order_by("-number").first()


def add_version(
    program_id: UUID | str, content: Content, digest: str, rows: int, about: Mapping[str, Any]
) -> tuple[Version, bool]:
    """Add a version unless somebody else has just added the same; tell whether it was added.

    `rows` is how many of the program's rows the document holds: who drew in later ones is told of the next version.
    """
    with transaction.atomic():
        program = Program.objects.select_for_update().filter(pk=program_id).first()
        if program is None:
            raise NoSuchProgram(GONE)
        last = _last(program_id)
        if last is not None and last.digest == digest:
            return last, False
        drawn = program.drawn_by
        program.last_version += 1
        program.drawn_by = {author: row for author, row in drawn.items() if row > rows}
        program.save(update_fields=["last_version", "drawn_by"])
        authors = sorted(int(author) for author in drawn)
        row = Version(program=program, number=program.last_version, digest=digest, authors=authors, **about)
        row.content, row.base = _packed(content, last)
        row.save()
        return row, True


def _packed(content: Content, last: Version | None) -> tuple[bytes, Version | None]:
    """Return a version's content, and the version that it is a difference to."""
    base = None if last is None else last.base or last
    if base is not None:
        try:
            packed = pack_difference(content, unpack(bytes(base.content)), len(base.content))
        except UnknownPacking:
            packed = None
        if packed is not None:
            return packed, base
    return pack(content), None


def _whole_rows() -> QuerySet[Version]:
    return Version.objects.select_related("author", "program__site", "base")


def _people(rows: Collection[Version]) -> dict[int, AuthorView]:
    """Return the people who drew these versions; those who are gone are not among them."""
    found = get_user_model().objects.in_bulk({author for row in rows for author in row.authors})
    return {pk: view for pk, user in found.items() if (view := view_author(user)) is not None}


def _view(row: Version, site: str, people: Mapping[int, AuthorView]) -> VersionView:
    return VersionView(
        id=row.pk,
        program=row.program_id,
        site=site,
        number=row.number,
        author=view_author(row.author),
        authors=tuple(people[author] for author in row.authors if author in people),
        name=row.name,
        message=row.message,
        cause=row.cause,
        created_at=row.created_at,
    )


def _whole_view(row: Version) -> WholeVersionView:
    try:
        base = None if row.base is None else unpack(bytes(row.base.content))
        content = unpack(bytes(row.content), base)
    except UnknownPacking as error:
        raise UnreadableVersion(
            f"Version {row.number} cannot be read by this VIPO. It was written by a later one, or is damaged."
        ) from error
    view = _view(row, row.program.site.slug, _people([row]))
    fields = {name: getattr(view, name) for name in VersionView.__dataclass_fields__}
    return WholeVersionView(**fields, document=migrate_document(content.document), script=content.script)

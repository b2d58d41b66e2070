"""What programs hold, with the digest by which it is known again; and the versions whose tests are asked for."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any
from uuid import UUID

from editor.documents.shared_document import digest_of
from editor.documents.store import get_document
from editor.errors import NoSuchProgram
from editor.models import Program, Version, VersionToTest
from editor.programs.checking import build_surroundings
from editor.programs.compilations import Compilation, compile_program
from editor.programs.programs import GONE, get_program
from editor.programs.versions import find_version


@dataclass(frozen=True, slots=True)
class ContentView:
    """What a program holds: as it is drawn now, or with `number` in a version; equal contents have equal digests."""

    program: UUID
    site: str
    name: str
    number: int | None
    document: Mapping[str, Any]
    digest: str


@dataclass(frozen=True, slots=True)
class VersionToTestView:
    """A version that was named: its tests are asked for, by its author if they are still here."""

    version: UUID
    program: UUID
    number: int
    person: int | None
    by: str


def get_content(*, program_id: UUID, number: int | None = None) -> ContentView:
    """Return a program's content, or that of a version. Raises NoSuchProgram, UnreadableVersion, DocumentHole."""
    program = get_program(program_id=program_id)
    if number is None:
        document: Mapping[str, Any] = get_document(program_id=program_id)
        digest = digest_of(document)
    else:
        document = find_version(program_id=program_id, number=number).document
        digest = Version.objects.values_list("digest", flat=True).get(program_id=program_id, number=number)
    return ContentView(program_id, program.site, program.name, number, document, digest)


def find_numbers(*, program_id: UUID, digests: Iterable[str]) -> dict[int, str]:
    """Return the numbers of a program's versions that hold these contents, each with its digest."""
    rows = Version.objects.filter(program_id=program_id, digest__in=set(digests))
    return dict(rows.values_list("number", "digest"))


def lock_program(*, program_id: UUID) -> None:
    """Let nobody else count what belongs to a program until this transaction is over. Raises NoSuchProgram."""
    if not Program.objects.select_for_update().filter(pk=program_id).values_list("pk"):
        raise NoSuchProgram(GONE)


def compile_content(*, content: ContentView) -> Compilation:
    """Compile a content for its site as that is now, with its plan."""
    return compile_program(content.document, build_surroundings(site=content.site), with_plan=True)


def has_versions_to_test() -> bool:
    """Tell whether a version was named whose tests nobody has taken on."""
    return VersionToTest.objects.exists()


def list_versions_to_test(*, most: int) -> list[VersionToTestView]:
    """Return versions that were named, the first named first."""
    rows = VersionToTest.objects.select_related("version__author").order_by("pk")[:most]
    return [
        VersionToTestView(
            version=row.version_id,
            program=row.version.program_id,
            number=row.version.number,
            person=row.version.author_id,
            by=row.version.author.display_name if row.version.author else "",
        )
        for row in rows.defer("version__content")
    ]


def take_version_to_test(*, version: UUID) -> bool:
    """Take a version on, in the transaction that sees to its tests; False when somebody else has."""
    return bool(VersionToTest.objects.filter(version=version).delete()[0])

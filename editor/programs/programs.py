"""Programs: made, named, listed, checked. Their versions are beside them."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterable, Mapping
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any
from uuid import UUID

from django.conf import settings
from django.db import transaction
from django.utils import timezone

from editor.documents.shared_document import (
    SharedDocument,
    empty_document,
    encode_document,
    migrate_document,
)
from editor.documents.store import get_document
from editor.errors import BadRequest, DocumentHole, NoSuchProgram
from editor.models import Program, Snapshot
from editor.programs.checking import build_surroundings, fingerprint_of, new_revision, read_around, store_summary
from editor.programs.compilations import Compilation, compile_program
from editor.programs.views import ProgramView, view_author
from registry import services as registry
from registry.services import FIRST, Listed, Page, publish
from vipo_device.protocol.texts import find_unfit, normal

MOST_NAME = 120
MOST_CHECKED_AT_ONCE = 100
GONE = "There is no such program. It may have been deleted."


def list_programs(*, site: str, page: Page = FIRST, words: str = "") -> Listed[ProgramView]:
    """Return a site's programs whose names have these words, the last edited first.

    Counts that the site's devices have outdated are renewed, but for programs that cannot be read. Raises BadMark.
    """
    rows = Program.objects.filter(site__slug=site).select_related("site", "edited_by")
    for word in words.split()[:10]:
        rows = rows.filter(name__icontains=word)
    current = fingerprint_of(build_surroundings(site=site))
    stale = rows.exclude(checked_against=current).order_by("-edited_at")
    for program in stale.values_list("pk", flat=True)[:MOST_CHECKED_AT_ONCE]:
        with suppress(DocumentHole, NoSuchProgram):  # then its counts stay as they were
            get_compiled(program_id=program)
    return registry.take_page(rows=rows, by="-edited_at", page=page, view=_view)


def get_program(*, program_id: UUID | str) -> ProgramView:
    """Return a program. Raises NoSuchProgram."""
    return _view(find_program(program_id))


def create_program(
    *,
    site: str,
    name: str,
    document: Mapping[str, Any] | None = None,
    user: Any = None,
    makers: Collection[int] = (),
) -> ProgramView:
    """Make a program, empty or from a plain document. Raises BadRequest for a bad name.

    The first version names as those who have drawn the document its `user` and its `makers`, the ids of people.
    """
    plain = migrate_document(document or empty_document())
    data = encode_document(plain)
    site_id = registry.get_site_id(site=site)
    drawn = {*makers, user.pk} if document and user else set(makers)
    with transaction.atomic():
        program = Program.objects.create(
            site_id=site_id,
            name=_checked_name(name),
            edited_at=timezone.now(),
            edited_by=user,
            last_seq=1,
            drawn_by={str(person): 1 for person in sorted(drawn)},
        )
        Snapshot.objects.create(program=program, seq=1, data=data)
        transaction.on_commit(lambda: publish(site, {"type": "programs"}))
    shared = SharedDocument([data]).to_json()
    _check(str(program.pk), shared)
    return get_program(program_id=program.pk)


def rename_program(*, program_id: UUID | str, name: str, user: Any) -> ProgramView:
    """Give a program another name. Raises NoSuchProgram, BadRequest."""
    program = find_program(program_id)
    Program.objects.filter(pk=program.pk).update(name=_checked_name(name), edited_at=timezone.now(), edited_by=user)
    publish(program.site.slug, {"type": "programs"})
    return get_program(program_id=program_id)


def delete_program(*, program_id: UUID | str) -> None:
    """Delete a program; whoever has it open is told. Raises NoSuchProgram."""
    program = find_program(program_id)
    site = program.site.slug
    with transaction.atomic():
        registry.note_act(site_id=program.site_id, code="program_deleted", facts={"program": program.name})
        program.delete()
        transaction.on_commit(lambda: publish(site, {"type": "programs"}))


def get_compiled(*, program_id: UUID | str) -> dict[str, object]:
    """Return a program compiled as it is now, as JSON. Raises NoSuchProgram."""
    return _check(str(program_id), get_document(program_id=program_id)).compiled()


def _check(program_id: str, document: Mapping[str, Any]) -> Compilation:
    around, revision = read_around(program_id), new_revision()
    compilation = compile_program(document, around.surroundings, revision=revision)
    if store_summary(program_id, compilation.summary, around.fingerprint):
        transaction.on_commit(lambda: tell_checked(program_id=program_id, revision=revision))
    return compilation


def tell_checked(*, program_id: UUID | str, revision: int) -> None:
    """Tell a site what its lists are to show of a program from now on; of one that is gone, nothing."""
    with suppress(NoSuchProgram):
        view = get_program(program_id=program_id)
        shown = {key: value for key, value in asdict(view).items() if key not in {"id", "site", "name"}}
        shown["edited_at"] = view.edited_at.isoformat(timespec="milliseconds")
        publish(view.site, {"type": "checked", "program": str(view.id), "revision": revision, "shown": shown})


def find_program(program_id: UUID | str) -> Program:
    """Return a program's row with its site and last editor. Raises NoSuchProgram."""
    program = Program.objects.select_related("site", "edited_by").filter(pk=program_id).first()
    if program is None:
        raise NoSuchProgram(GONE)
    return program


def keep_existing(*, program_ids: Iterable[UUID]) -> frozenset[UUID]:
    """Return which of these programs there are."""
    return frozenset(Program.objects.filter(pk__in=list(program_ids)).values_list("pk", flat=True))


def _checked_name(name: str) -> str:
    name = normal(" ".join(name.split()))
    if not 1 <= len(name) <= MOST_NAME or find_unfit(name, is_line=True):
        raise BadRequest(f"A program's name has 1 to {MOST_NAME} characters. Enter one.")
    return name


def _view(row: Program) -> ProgramView:
    return ProgramView(
        id=row.pk,
        site=row.site.slug,
        name=row.name,
        kinds=tuple(row.kinds),
        devices=tuple(row.devices),
        places=tuple(row.places),
        edited_at=row.edited_at,
        edited_by=view_author(row.edited_by),
        errors=row.errors,
        warnings=row.warnings,
    )


_SEEDS = (("Paint order", "paint-order.json"), ("First task", None))


def seed_programs(*, site: str) -> None:
    """Give a site the example programs that it does not have yet; harmless when done again."""
    have = set(Program.objects.filter(site__slug=site).values_list("name", flat=True))
    for name, file in reversed(_SEEDS):
        if name in have:
            continue
        document = empty_document() if file is None else _read_example(Path(settings.BASE_DIR) / "examples" / file)
        if document is not None:
            create_program(site=site, name=name, document=document)


def _read_example(path: Path) -> dict[str, Any] | None:
    """Return the document of an example file: bare, or under `document`; None while there is no such file."""
    if not path.exists():
        return None
    body: dict[str, Any] = json.loads(path.read_text())
    document: dict[str, Any] = body.get("document", body)
    return document

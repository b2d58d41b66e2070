"""The shared documents in the database: updates appended in batches, now and then folded into a snapshot."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any
from uuid import UUID

from django.db import transaction

from editor.documents.shared_document import SharedDocument
from editor.documents.yjs_encoding import decode_state_vector
from editor.errors import NoSuchProgram
from editor.models import DocumentUpdate, Program, Snapshot

COMPACT_AFTER_ROWS = 500


class SnapshotDiffers(RuntimeError):
    """A snapshot did not hold what the rows hold; nothing was deleted."""


@dataclass(frozen=True, slots=True)
class Stored:
    """What the database holds of a document: updates to be merged, and the number of the last one."""

    site: str
    updates: tuple[bytes, ...]
    seq: int


@dataclass(frozen=True, slots=True)
class Change:
    """A change made here, which is to be saved: who made it, and the bytes of the document's own update."""

    author: int | None
    update: bytes


_flushes: list[Callable[[str], None]] = []


def flush_before_reading(flush: Callable[[str], None]) -> None:
    """Have `flush` write what this process still holds of a program before `get_document` reads the program."""
    if flush not in _flushes:
        _flushes.append(flush)


def get_document(*, program_id: UUID | str) -> dict[str, Any]:
    """Return a program's document as it is now, as plain JSON in today's format. Raises NoSuchProgram."""
    for flush in _flushes:
        flush(str(program_id))
    document = SharedDocument(load_document(str(program_id)).updates)
    document.migrate()
    return document.to_json()


def load_document(program_id: str) -> Stored:
    """Return the newest snapshot and the updates after it, as of one moment. Raises NoSuchProgram."""
    with transaction.atomic():
        program = Program.objects.select_related("site").filter(pk=program_id).first()
        if program is None:
            raise NoSuchProgram("There is no such program. It may have been deleted.")
        snapshot = program.snapshots.order_by("-seq").first()
        rows = program.updates.filter(seq__gt=snapshot.seq if snapshot else 0).order_by("seq")
        updates = [bytes(row) for row in rows.values_list("data", flat=True)]
        if snapshot is not None:
            updates.insert(0, bytes(snapshot.data))
        return Stored(program.site.slug, tuple(updates), program.last_seq)


def append_changes(program_id: str, changes: Sequence[Change], now: datetime) -> tuple[int, int]:
    """Append a batch; returns the number of its last change and how many rows there are. Raises NoSuchProgram."""
    with transaction.atomic():
        program = Program.objects.select_for_update().filter(pk=program_id).first()
        if program is None:
            raise NoSuchProgram("There is no such program. It may have been deleted.")
        rows = [
            DocumentUpdate(program=program, seq=program.last_seq + number, author_id=change.author, data=change.update)
            for number, change in enumerate(changes, 1)
        ]
        DocumentUpdate.objects.bulk_create(rows)
        program.last_seq += len(rows)
        program.edited_at = now
        authors = [change.author for change in changes if change.author is not None]
        program.edited_by_id = authors[-1] if authors else program.edited_by_id
        program.save(update_fields=["last_seq", "edited_at", "edited_by"])
        return program.last_seq, program.updates.count()


def compact_document(program_id: str) -> None:
    """Fold the rows into a snapshot; the rows go only when the snapshot was read back and holds the same.

    Raises SnapshotDiffers.
    """
    with transaction.atomic():
        program = Program.objects.select_for_update().filter(pk=program_id).first()
        if program is None:
            return
        stored = load_document(program_id)
        document = SharedDocument(stored.updates)
        written, _ = Snapshot.objects.update_or_create(
            program=program, seq=stored.seq, defaults={"data": document.encode()}
        )
        written.refresh_from_db()
        copy = SharedDocument([bytes(written.data)])
        if copy.digest() != document.digest() or _clocks(copy) != _clocks(document):
            raise SnapshotDiffers(f"The snapshot of program {program_id} differs from its updates; they are kept.")
        program.updates.filter(seq__lte=stored.seq).delete()
        program.snapshots.filter(seq__lt=stored.seq).delete()


def _clocks(document: SharedDocument) -> dict[int, int]:
    return decode_state_vector(document.state())

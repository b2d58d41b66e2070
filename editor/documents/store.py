"""The shared documents in the database: updates appended in batches, now and then folded into a snapshot."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from operator import itemgetter
from typing import Any
from uuid import UUID

from django.db import transaction
from django.db.models import Value

from editor.documents import work
from editor.documents.shared_document import BadUpdate, SharedDocument, clients_of, merge
from editor.documents.tasks import Folded, Folding, Reading
from editor.errors import DocumentHole, NoSuchProgram
from editor.models import DocumentUpdate, Program, Snapshot

COMPACT_AFTER_ROWS = 500
MOST_ROW_BYTES = 128 * 1024
"""Of changes that are gathered; one that is larger is a row by itself."""
_BYTES_OF_A_STEP = 100
_MISSING = "A part of this program is missing in the database."
_UNREADABLE = "A part of this program in the database cannot be read."
_MENDED = "`vipo mend-program` shows what is left."


class SnapshotDiffers(RuntimeError):
    """A snapshot did not hold what the rows hold; nothing was deleted."""


@dataclass(frozen=True, slots=True)
class Stored:
    """What the database holds of a document: updates to be merged.

    `seq` is the number of the last one, `compacted` of the last one in the snapshot; `stored_to` is the entry of the
    room's stream up to which every change is in them.
    """

    site: str
    updates: tuple[bytes, ...]
    seq: int
    compacted: int
    stored_to: str

    @property
    def appended(self) -> tuple[bytes, ...]:
        """The updates after the snapshot."""
        return self.updates[self.compacted > 0 :]

    @property
    def size(self) -> int:
        """About how many steps it holds."""
        return sum(map(len, self.updates)) // _BYTES_OF_A_STEP

    def open(self, more: Iterable[bytes] = ()) -> SharedDocument:
        """Return the document, with further updates. Raises DocumentHole."""
        try:
            document = SharedDocument([*self.updates, *more])
        except BadUpdate as error:
            raise DocumentHole(f"{_UNREADABLE} {_MENDED}") from error
        if document.has_hole([*self.appended, *more]):
            raise DocumentHole(f"{_MISSING} {_MENDED}")
        return document


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
    """Return a program's document as it is now, as plain JSON in today's format. Raises NoSuchProgram, DocumentHole."""
    for flush in _flushes:
        flush(str(program_id))
    stored = load_document(str(program_id))
    read = work.do(Reading(stored.updates, stored.appended), stored.size)
    if read.has_hole or not read.is_readable:
        raise DocumentHole(f"{_MISSING if read.has_hole else _UNREADABLE} {_MENDED}")
    plain: dict[str, Any] = json.loads(read.text)
    return plain


def load_document(program_id: str) -> Stored:
    """Return the newest snapshot and the updates after it, as of one moment. Raises NoSuchProgram.

    It is read by one statement: of two, PostgreSQL answers each as of its own moment, and rows that were folded between
    them would be in neither answer.
    """
    program = Program.objects.select_related("site").filter(pk=program_id).first()
    if program is None:
        raise NoSuchProgram("There is no such program. It may have been deleted.")
    snapshots = program.snapshots.annotate(is_snapshot=Value(True)).values_list("seq", "is_snapshot", "data")
    rows = program.updates.annotate(is_snapshot=Value(False)).values_list("seq", "is_snapshot", "data")
    parts = sorted(snapshots.order_by().union(rows.order_by(), all=True), key=itemgetter(0))
    begin = max((at for at, part in enumerate(parts) if part[1]), default=0)
    seq, is_snapshot, _ = parts[begin] if parts else (0, False, b"")
    compacted = seq if is_snapshot else 0
    last = max(program.last_seq, parts[-1][0] if parts else 0)
    updates = tuple(bytes(data) for _, _, data in parts[begin:])
    return Stored(program.site.slug, updates, last, compacted, program.stored_to)


def append_changes(program_id: str, changes: Sequence[Change], now: datetime, stored_to: str = "") -> range:
    """Append a batch; returns the numbers of its rows. Changes of one author that follow each other are one row.

    `stored_to` is kept as the entry of the room's stream up to which the rows go. Raises NoSuchProgram.
    """
    with transaction.atomic():
        program = Program.objects.select_for_update().filter(pk=program_id).first()
        if program is None:
            raise NoSuchProgram("There is no such program. It may have been deleted.")
        first = program.last_seq + 1
        rows = [
            DocumentUpdate(program=program, seq=seq, author_id=change.author, data=change.update)
            for seq, change in enumerate(_gathered(changes), first)
        ]
        DocumentUpdate.objects.bulk_create(rows)
        program.last_seq += len(rows)
        program.stored_to = stored_to or program.stored_to
        program.edited_at = now
        authors = [change.author for change in changes if change.author is not None]
        program.edited_by_id = authors[-1] if authors else program.edited_by_id
        program.drawn_by |= {str(author): program.last_seq for author in authors}
        program.save(update_fields=["last_seq", "stored_to", "edited_at", "edited_by", "drawn_by"])
        return range(first, program.last_seq + 1)


def note_stored_to(program_id: str, stored_to: str) -> None:
    """Keep the entry of the room's stream up to which the rows go."""
    Program.objects.filter(pk=program_id).update(stored_to=stored_to)


def last_row(program_id: str) -> int:
    """Return the number of a program's last row; 0 if the program is gone."""
    return Program.objects.filter(pk=program_id).values_list("last_seq", flat=True).first() or 0


def last_rows(program_ids: Iterable[str]) -> dict[str, int]:
    """Return the numbers of programs' last rows, of those that are there."""
    found = Program.objects.filter(pk__in=list(program_ids)).values_list("pk", "last_seq")
    return {str(program): seq for program, seq in found}


def _gathered(changes: Sequence[Change]) -> list[Change]:
    """Return changes of one author that follow each other as one, up to a size: merging holds all threads up."""
    gathered: list[list[Change]] = []
    size = 0
    for change in changes:
        size += len(change.update)
        if not gathered or gathered[-1][0].author != change.author or size > MOST_ROW_BYTES:
            gathered.append([])
            size = len(change.update)
        gathered[-1].append(change)
    return [Change(each[0].author, merge(change.update for change in each)) for each in gathered]


def compact_document(program_id: str, fold: Callable[[Folding], Folded] = Folding.done) -> bool:
    """Fold the rows into a snapshot; the rows go only when the snapshot holds the same and was read back.

    `fold` does the work, in another process; meanwhile rows are appended, which stay. Returns whether it was done:
    not if there are no rows, or another process was quicker. Raises SnapshotDiffers, DocumentHole, NoSuchProgram, and
    what `fold` does.
    """
    stored = load_document(program_id)
    if not stored.appended:
        return False
    folded = fold(Folding(stored.updates, stored.appended))
    if folded.has_hole:
        raise DocumentHole(f"{_MISSING} {_MENDED}")
    with transaction.atomic():
        program = Program.objects.select_for_update().filter(pk=program_id).first()
        newest = None if program is None else program.snapshots.order_by("-seq").first()
        if program is None or (newest.seq if newest else 0) != stored.compacted:
            return False
        rows = program.updates.filter(seq__gt=stored.compacted, seq__lte=stored.seq)
        writers = rows.order_by("seq").values_list("author_id", flat=True)
        authors = _with_authors(newest.authors if newest else {}, zip(writers, folded.clients, strict=False))
        written = Snapshot.objects.create(program=program, seq=stored.seq, data=folded.update, authors=authors)
        written.refresh_from_db()
        gone, _ = rows.delete()
        if not folded.is_same or bytes(written.data) != folded.update or gone != len(stored.appended):
            raise SnapshotDiffers(f"The snapshot of program {program_id} differs from its updates; they are kept.")
        program.snapshots.filter(seq__lt=stored.seq).delete()
        return True


def authors_of(program: Program) -> dict[str, int]:
    """Return whose each Yjs client is: from the last snapshot and the rows."""
    snapshot = program.snapshots.order_by("-seq").first()
    rows = program.updates.order_by("seq").values_list("author_id", "data")
    return _with_authors(
        snapshot.authors if snapshot else {}, ((author, clients_of(bytes(data))) for author, data in rows)
    )


def _with_authors(known: Mapping[str, int], rows: Iterable[tuple[int | None, Iterable[int]]]) -> dict[str, int]:
    """Return whose each client is, with those of rows: each their author and clients. The first author stays."""
    authors = dict(known)
    for author, clients in rows:
        if author is not None:
            for client in clients:
                authors.setdefault(str(client), author)
    return authors

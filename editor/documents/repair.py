"""A program whose rows leave a hole: what still fits together, and the rows as a file before any of them goes.

A row fits if nothing is missing on which it builds. What does not fit cannot be shown by any Yjs document.
"""

from __future__ import annotations

import base64
import gzip
import json
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path
from typing import Any
from uuid import UUID

from django.contrib.auth import get_user_model
from django.db import transaction
from django.utils import timezone

from editor.documents.shared_document import BadUpdate, SharedDocument, clients_of, read_update
from editor.documents.store import Change, authors_of
from editor.errors import BadRequest, NoSuchProgram
from editor.models import DocumentUpdate, Program, Snapshot

FILE_FORMAT = 1


@dataclass(frozen=True, slots=True)
class StoredRow:
    """A row of a program, or a snapshot; `author` is an address, empty for none, `size` in bytes."""

    seq: int
    is_snapshot: bool
    author: str
    at: datetime
    size: int


@dataclass(frozen=True, slots=True)
class Mending:
    """What of a program fits together, and which rows do not; `file` holds all rows where they were replaced.

    Of `told` changes that are in no row, `told_fitting` ones fit.
    """

    program: UUID
    name: str
    steps: int
    functions: int
    rows: int
    left_out: tuple[StoredRow, ...]
    told: int = 0
    told_fitting: int = 0
    file: Path | None = None


@dataclass(frozen=True, slots=True)
class _Read:
    row: StoredRow
    data: bytes


def show_mending(*, program_id: UUID | str, told: Sequence[Change] = ()) -> Mending:
    """Return what of a program's rows fits together, with changes that were told and may be in no row yet.

    Nothing is changed. Raises NoSuchProgram.
    """
    with transaction.atomic():
        return _mending(_locked(program_id), told)[0]


def mend_program(*, program_id: UUID | str, folder: Path, told: Sequence[Change] = ()) -> Mending:
    """Save all rows into a new file of the folder, then keep what fits together as the program.

    `told` are changes that may be in no row. Nothing is done to a program of which all fits.
    Raises NoSuchProgram, and OSError if the file cannot be written.
    """
    with transaction.atomic():
        program = _locked(program_id)
        mending, document = _mending(program, told)
        if not mending.left_out:
            return mending
        file = _save(program, folder)
        authors = authors_of(program) | _authors_of(told)
        program.updates.all().delete()
        program.snapshots.all().delete()
        program.last_seq += 1
        Snapshot.objects.create(program=program, seq=program.last_seq, data=document.encode(), authors=authors)
        _note_change(program)
        return _with_file(mending, file)


def restore_rows(*, file: Path, folder: Path) -> Mending:
    """Put the rows of such a file back; what the program holds now becomes one more row, and is saved before, too.

    Raises NoSuchProgram, BadRequest for a file that is none, OSError.
    """
    head, *lines = _load(file)
    with transaction.atomic():
        program = _locked(str(head.get("program", "")))
        kept = _save(program, folder)
        _, document = _mending(program)
        program.updates.all().delete()
        program.snapshots.all().delete()
        try:
            numbers = [_put_back(program, line) for line in lines]
        except (KeyError, TypeError, ValueError) as error:
            raise BadRequest(f"{file} holds a row that cannot be read. Nothing was changed.") from error
        program.last_seq = max([program.last_seq, *numbers]) + 1
        DocumentUpdate.objects.create(program=program, seq=program.last_seq, data=document.encode())
        _note_change(program)
        return _with_file(_mending(program)[0], kept)


def _note_change(program: Program) -> None:
    program.checked_against = ""
    program.edited_at = timezone.now()
    program.save(update_fields=["last_seq", "checked_against", "edited_at"])


def _with_file(mending: Mending, file: Path) -> Mending:
    return replace(mending, file=file)


def _locked(program_id: UUID | str) -> Program:
    try:
        program = Program.objects.select_for_update().filter(pk=UUID(str(program_id))).first()
    except ValueError:
        program = None
    if program is None:
        raise NoSuchProgram("There is no such program. Its id stands in the address of its page, behind /programs/.")
    return program


def _mending(program: Program, told: Sequence[Change] = ()) -> tuple[Mending, SharedDocument]:
    rows = list(_rows(program))
    document, left = _fitting(rows)
    known = document.knowledge()
    new = [change for change in told if not known.covers(read_update(change.update))]
    numbers = {row.row.seq for row in left}
    entries = [_Read(StoredRow(-number, False, "", program.edited_at, len(change.update)), change.update)
               for number, change in enumerate(new, 1)]  # fmt: skip
    if new:
        document, left = _fitting([*left, *entries], document)
    fitting = len(new) - sum(each.row.seq not in numbers for each in left)
    plain = document.to_json()
    out = tuple(each.row for each in left if each.row.seq in numbers)
    counts = len(plain["steps"]), len(plain["functions"]), len(rows)
    return Mending(program.pk, program.name, *counts, out, len(new), fitting), document


def _authors_of(told: Sequence[Change]) -> dict[str, int]:
    return {
        str(client): change.author
        for change in told
        if change.author is not None
        for client in clients_of(change.update)
    }


def _rows(program: Program) -> Iterator[_Read]:
    for snapshot in program.snapshots.order_by("seq"):
        data = bytes(snapshot.data)
        yield _Read(StoredRow(snapshot.seq, True, "", snapshot.at, len(data)), data)
    for row in program.updates.select_related("author").order_by("seq"):
        data, author = bytes(row.data), row.author
        yield _Read(StoredRow(row.seq, False, author.email if author else "", row.at, len(data)), data)


def _fitting(rows: Iterable[_Read], begin: SharedDocument | None = None) -> tuple[SharedDocument, list[_Read]]:
    """Return the document, begun with that, of all rows that fit, whatever their order, and those that do not."""
    document, left, found = begin or SharedDocument(), list(rows), True
    while found:
        tried, left, found = left, [], False
        for each in tried:
            larger = _with(document, each.data)
            if larger is None:
                left.append(each)
            else:
                document, found = larger, True
    return document, left


def _with(document: SharedDocument, update: bytes) -> SharedDocument | None:
    """Return the document with an update, None if that builds on something else, or is none."""
    try:
        larger = SharedDocument([document.encode(), update])
    except BadUpdate:
        return None
    return None if larger.has_hole([update]) else larger


def _save(program: Program, folder: Path) -> Path:
    """Write all that the database holds of a program's document into a new file."""
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / f"{program.pk}-{timezone.now():%Y%m%dT%H%M%S%f}.jsonl.gz"
    with file.open("xb") as raw:
        with gzip.open(raw, "wt", encoding="utf-8") as lines:
            for line in _lines(program):
                lines.write(json.dumps(line) + "\n")
        raw.flush()
        os.fsync(raw.fileno())
    return file


def _lines(program: Program) -> Iterator[Mapping[str, Any]]:
    yield {"vipo_rows": FILE_FORMAT, "program": str(program.pk), "name": program.name, "last_seq": program.last_seq}
    for snapshot in program.snapshots.order_by("seq"):
        told = {"snapshot": snapshot.seq, "authors": snapshot.authors, "at": snapshot.at.isoformat()}
        yield {**told, "data": base64.b64encode(bytes(snapshot.data)).decode()}
    for row in program.updates.order_by("seq"):
        told = {"row": row.seq, "author": row.author_id, "at": row.at.isoformat()}
        yield {**told, "data": base64.b64encode(bytes(row.data)).decode()}


def _load(file: Path) -> list[dict[str, Any]]:
    try:
        with gzip.open(file, "rt", encoding="utf-8") as lines:
            read = [json.loads(line) for line in lines]
    except (gzip.BadGzipFile, EOFError, ValueError) as error:
        raise BadRequest(f"{file} is no file of rows, or is not whole. Nothing was changed.") from error
    if not read or not all(isinstance(line, dict) for line in read) or read[0].get("vipo_rows") != FILE_FORMAT:
        raise BadRequest(f"{file} is no file of rows of this version of VIPO. Nothing was changed.")
    return read


def _put_back(program: Program, line: Mapping[str, Any]) -> int:
    data, at = base64.b64decode(line["data"], validate=True), datetime.fromisoformat(line["at"])
    if "snapshot" in line:
        seq = int(line["snapshot"])
        snapshot = Snapshot.objects.create(program=program, seq=seq, data=data, authors=dict(line["authors"]))
        Snapshot.objects.filter(pk=snapshot.pk).update(at=at)
        return seq
    seq, author = int(line["row"]), get_user_model().objects.filter(pk=line["author"]).first()
    row = DocumentUpdate.objects.create(program=program, seq=seq, author=author, data=data)
    DocumentUpdate.objects.filter(pk=row.pk).update(at=at)
    return seq

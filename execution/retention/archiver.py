"""Rows into a file: written, read back, and only then named as what stands in the archive.

Until the transaction at the end nothing of the rows has changed, so a process that dies at any moment before it leaves
a row of an archive that is `writing`, and maybe a file, which the next pass takes away.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any, BinaryIO
from uuid import UUID, uuid4

from django.db import transaction
from django.db.models import QuerySet

from execution.archive.folder import new_file, open_part, remove_file
from execution.archive.history_file import (
    Header,
    Row,
    UnreadableHistory,
    Written,
    digest_of,
    read_sections,
    write_section,
)
from execution.archive.rows import AT_ONCE, lines_of_run, to_line
from execution.fault_points import fault_point
from execution.models import Archive, Command, Rehearsal, Run
from execution.retention.selection import old_rows

PER_FILE = {"runs": 200, "rehearsals": 100, "calls": 5000}
SECTIONS = {"runs": "run", "rehearsals": "rehearsal", "calls": "calls"}
ROW_OF: dict[str, Any] = {"runs": Run, "rehearsals": Rehearsal}


class Overtaken(Exception):
    """Another process archives now; what this one has begun is not to be believed."""


@dataclass(frozen=True, slots=True)
class Turn:
    """A site whose histories are archived, at which time, and what is asked now and then whether this goes on.

    `go_on` raises Overtaken when another process has taken the work over.
    """

    site: int
    slug: str
    now: datetime
    go_on: Callable[[], None]


def archive_next(turn: Turn, kind: str, before: datetime) -> Archive | None:
    """Put the oldest day, or a part of it, into a file; None when nothing of the kind is old enough.

    Raises:
        OSError, UnreadableHistory: the file cannot be written, or was read back differently. All rows are as before.
        Overtaken: as `Turn` says.
    """
    chosen = list(old_rows(kind, turn.site, before).values_list("pk", "ended_at")[: PER_FILE[kind]])
    if not chosen:
        return None
    day = chosen[0][1].astimezone(UTC).date()
    ended = {pk: at for pk, at in chosen if at.astimezone(UTC).date() == day}
    number = uuid4()
    archive = Archive.objects.create(
        id=number, site_id=turn.site, kind=kind, file=f"{turn.slug}/{kind}/{day}-{number}.jsonl.gz", made_at=turn.now,
        count=len(ended), first_at=min(ended.values()), last_at=max(ended.values()),
    )  # fmt: skip
    fault_point("archive_begun")
    try:
        written = _write_file(turn, archive, list(ended))
        fault_point("archive_file")
        _read_back(archive.file, written.values(), turn.go_on)
        _say_whole(archive, written)
    except (OSError, UnreadableHistory, Overtaken) as error:
        is_mine = Archive.objects.filter(pk=number, state=Archive.State.WRITING).exists()
        with suppress(OSError):  # what cannot be removed now the next pass removes
            discard(archive) if is_mine else remove_file(archive.file)
        if not is_mine:
            raise Overtaken from error
        raise
    fault_point("archive_whole")
    return archive


def _write_file(turn: Turn, archive: Archive, keys: list[Any]) -> dict[Any, Written]:
    with new_file(archive.file) as file:
        if archive.kind == "calls":
            return {archive.pk: _write_calls(turn, archive, file, keys)}
        return {key: _write_one(turn, archive.kind, file, key) for key in keys}


def _write_one(turn: Turn, kind: str, file: BinaryIO, key: UUID) -> Written:
    row = ROW_OF[kind].objects.get(pk=key)
    lines = lines_of_run(row) if isinstance(row, Run) else iter([to_line("rehearsal", row)])
    return write_section(file, _header(turn, kind, key), _asking(lines, turn.go_on))


def _write_calls(turn: Turn, archive: Archive, file: BinaryIO, keys: list[Any]) -> Written:
    def lines() -> Iterator[Row]:
        for start in range(0, len(keys), AT_ONCE):
            rows = Command.objects.filter(pk__in=keys[start : start + AT_ONCE]).order_by("ended_at", "pk")
            yield from (to_line("command", row) for row in rows)

    return write_section(file, _header(turn, "calls", archive.pk), _asking(lines(), turn.go_on))


def _header(turn: Turn, kind: str, key: object) -> Header:
    return Header(SECTIONS[kind], turn.slug, str(key), turn.now.isoformat())


def _asking(lines: Iterator[Row], go_on: Callable[[], None]) -> Iterator[Row]:
    for number, line in enumerate(lines):
        if number % AT_ONCE == 0:
            go_on()
        yield line


def _read_back(file: str, written: Any, go_on: Callable[[], None]) -> None:
    for section in written:
        go_on()
        with open_part(file, section.offset, section.bytes) as part:
            if digest_of(part) != section.digest:
                raise UnreadableHistory("What stands in the file is not what was written.")


def _say_whole(archive: Archive, written: dict[Any, Written]) -> None:
    """Let the archive count from now on, unless somebody has discarded it meanwhile."""
    with transaction.atomic():
        total = sum(section.bytes for section in written.values())
        mine = Archive.objects.filter(pk=archive.pk, state=Archive.State.WRITING)
        if not mine.update(state=Archive.State.WHOLE, bytes=total):
            raise Overtaken
        if model := ROW_OF.get(archive.kind):
            rows = [
                model(pk=key, archive=archive, archive_offset=section.offset, archive_bytes=section.bytes)
                for key, section in written.items()
            ]
            model._default_manager.bulk_update(rows, ["archive", "archive_offset", "archive_bytes"], batch_size=AT_ONCE)
    archive.state, archive.bytes = Archive.State.WHOLE, total


def discard(archive: Archive) -> None:
    """Take away an archive that nobody has said to be whole; raises OSError if its file cannot be removed."""
    unsaid = (Archive.State.WRITING, Archive.State.DISCARDED)
    if Archive.objects.filter(pk=archive.pk, state__in=unsaid).update(state=Archive.State.DISCARDED):
        remove_file(archive.file)
        Archive.objects.filter(pk=archive.pk, state=Archive.State.DISCARDED).delete()


def check_whole(archive: Archive, go_on: Callable[[], None]) -> list[str]:
    """Read an archive once more, as before rows are deleted on its word; return the ids of its rows.

    Raises:
        UnreadableHistory: something of it is missing or was changed.
    """
    model = ROW_OF.get(archive.kind)
    places: QuerySet[Any, Any] | list[Any] = [(archive.pk, 0, archive.bytes)]
    if model is not None:
        places = model._default_manager.filter(archive=archive).values_list("pk", "archive_offset", "archive_bytes")
    found: list[str] = []
    for key, offset, length in places:
        go_on()
        with open_part(archive.file, offset, length) as part:
            found += _ids_of_section(part, str(key), one=model is not None)
    return found


def _ids_of_section(part: BinaryIO, key: str, *, one: bool) -> list[str]:
    ids: list[str] = []
    is_whole = False
    for header, row in read_sections(part):
        if header.id != key:
            raise UnreadableHistory("Another history stands where this one should be.")
        is_whole = is_whole or row is None
        if row is not None and (not one or not ids):
            ids.append(str(row.get("id")))
    if not is_whole:
        raise UnreadableHistory("A history is missing in the file.")
    return ids

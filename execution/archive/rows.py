"""Rows as lines of an archive, and lines as rows again, which are shown and never saved."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import datetime
from itertools import islice
from typing import Any, BinaryIO, TypeVar
from uuid import UUID

from django.core.exceptions import ValidationError
from django.db import models
from django.db.models import Q, QuerySet

from execution.archive.folder import open_part
from execution.archive.history_file import Row, UnreadableHistory, read_sections
from execution.errors import HistoryUnreadable
from execution.models import Command, DeadLetter, Question, Rehearsal, Run, RunEvent, RunInput, Timer

AT_ONCE = 500
_OWN = frozenset({"archive_id", "archive_offset", "archive_bytes"})
Model = TypeVar("Model", bound=models.Model)


@dataclass(frozen=True, slots=True)
class Part:
    """Rows that belong to runs: what a line of them is called, and which are those of some runs."""

    name: str
    model: type[models.Model]
    belongs: Callable[[Any], Q]

    def rows_of(self, runs: object) -> QuerySet[Any]:
        """Return the rows of these runs (their ids, or a query for these), as they were made."""
        return self.model._default_manager.filter(self.belongs(runs)).order_by("pk")


PARTS = (
    Part("event", RunEvent, lambda runs: Q(run__in=runs)),
    Part("question", Question, lambda runs: Q(run__in=runs)),
    Part("timer", Timer, lambda runs: Q(run__in=runs)),
    Part("input", RunInput, lambda runs: Q(run__in=runs)),
    Part("dead_letter", DeadLetter, lambda runs: Q(run__in=runs)),
    Part("command", Command, lambda runs: Q(run__in=runs)),
)
"""All that goes into the archive with a run and is then deleted; a new table of runs is one line here."""


def to_line(name: str, row: models.Model) -> Row:
    """Return a row as a line: all its columns by their names, times in ISO 8601."""
    fields = [field for field in row._meta.concrete_fields if field.attname not in _OWN]
    return {"row": name, **{field.attname: _plain(getattr(row, field.attname)) for field in fields}}


def _plain(value: object) -> object:
    if isinstance(value, datetime):
        return value.isoformat()
    return str(value) if isinstance(value, UUID) else value


def from_line(model: type[Model], line: Row) -> Model:
    """Return a line as a row that is not in the database; columns that it does not have are as in a new row.

    Raises:
        UnreadableHistory: a value does not fit its column.
    """
    try:
        known = [field for field in model._meta.concrete_fields if field.attname in line]
        return model(**{field.attname: field.to_python(line[field.attname]) for field in known})
    except (ValidationError, ValueError, TypeError) as error:
        raise UnreadableHistory(f"A line has a value that cannot be: {error}.") from error


def lines_of_run(run: Run) -> Iterator[Row]:
    """Yield a run and all that belongs to it, a few hundred rows in memory at a time."""
    yield to_line("run", run)
    for part in PARTS:
        yield from (to_line(part.name, row) for row in _in_slices(part.rows_of([run.pk])))


def _in_slices(rows: QuerySet[Any]) -> Iterator[Any]:
    slice_ = list(rows[:AT_ONCE])
    while slice_:
        yield from slice_
        slice_ = list(rows.filter(pk__gt=slice_[-1].pk)[:AT_ONCE]) if len(slice_) == AT_ONCE else []


def read_run(summary: Run) -> Run:
    """Return the whole run of which this is the summary. Raises HistoryUnreadable."""
    run = _first(summary, Run, "run")
    run.site, run.archive = summary.site, summary.archive
    return run


def each_event(summary: Run) -> Iterator[RunEvent]:
    """Yield the lines of an archived run's journal, one in memory at a time. Raises HistoryUnreadable."""
    with _opened(summary) as lines:
        for line in lines:
            if line["row"] == "event":
                yield from_line(RunEvent, line)


def read_events(summary: Run, after: int, before: int | None, most: int) -> list[RunEvent]:
    """Return the first lines of an archived run's journal between two numbers. Raises HistoryUnreadable."""
    with _opened(summary) as lines:
        return [from_line(RunEvent, line) for line in islice(_between(lines, after, before), most)]


def read_newest_events(summary: Run, after: int, before: int | None, most: int) -> list[RunEvent]:
    """Return the last lines of an archived journal between two numbers, in their order. Raises HistoryUnreadable."""
    with _opened(summary) as lines:
        return [from_line(RunEvent, line) for line in deque(_between(lines, after, before), most)]


def _between(lines: Iterator[Row], after: int, before: int | None) -> Iterator[Row]:
    events = (line for line in lines if line["row"] == "event" and line["seq"] > after)
    return (line for line in events if before is None or line["seq"] < before)


def read_questions(summary: Run) -> list[Question]:
    """Return what an archived run asked, the oldest first. Raises HistoryUnreadable."""
    with _opened(summary) as lines:
        found = [from_line(Question, line) for line in lines if line["row"] == "question"]
    for question in found:
        question.run = summary
    return sorted(found, key=lambda question: question.asked_at)


def read_rehearsal(summary: Rehearsal) -> Rehearsal:
    """Return the whole rehearsal of which this is the summary. Raises HistoryUnreadable."""
    rehearsal = _first(summary, Rehearsal, "rehearsal")
    rehearsal.site, rehearsal.archive = summary.site, summary.archive
    return rehearsal


def _first(summary: Run | Rehearsal, model: type[Model], name: str) -> Model:
    with _opened(summary) as lines:
        line = next(lines, None)
        if line is None or line["row"] != name:
            raise UnreadableHistory("What it begins with is missing in the file.")
        return from_line(model, line)


def _rows_of(part: BinaryIO, key: str) -> Iterator[Row]:
    for header, row in read_sections(part):
        if header.id != key:
            raise UnreadableHistory("Another history stands where this one should be.")
        if row is not None:
            yield row


@contextmanager
def _opened(summary: Run | Rehearsal) -> Iterator[Iterator[Row]]:
    """Give the lines of what was archived; what cannot be read is told as the API tells it."""
    assert summary.archive is not None
    archive = summary.archive
    try:
        with open_part(archive.file, summary.archive_offset, summary.archive_bytes) as part:
            yield _rows_of(part, str(summary.pk))
    except (UnreadableHistory, KeyError, TypeError) as error:
        raise HistoryUnreadable(
            "This history is in the archive, which cannot be read here now. Ask whoever runs this VIPO server to "
            f"look at {archive.file}: {error}",
        ) from error

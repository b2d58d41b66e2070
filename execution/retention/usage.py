"""How many bytes histories take, by program and by kind: a handful of questions, however many histories there are.

As rows the contents of columns are counted, as the database keeps them (PostgreSQL: compressed); not its indexes.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import Any
from uuid import UUID

from django.db.models import BigIntegerField, Count, F, Func, Max, OuterRef, QuerySet, Subquery, Sum, Value
from django.db.models.functions import Coalesce

from execution.models import Archive, Command, Rehearsal, Run, RunEvent

COLUMNS = {
    Run: ("document", "compiled", "plan", "state", "steps", "parameters"),
    RunEvent: ("text", "args"),
    Command: ("arguments", "result", "why"),
    Rehearsal: ("job", "document", "compiled", "result"),
}
ROW_BYTES = 100
"""About what the other columns of a row take."""
MOST_ARCHIVES = 50


class StoredBytes(Func):
    """How many bytes a column's value takes."""

    function = "pg_column_size"
    output_field = BigIntegerField()

    def as_sqlite(self, compiler: Any, connection: Any, **more: Any) -> Any:
        """Return the same for SQLite, which compresses nothing."""
        return self.as_sql(compiler, connection, template="length(CAST(%(expressions)s AS BLOB))", **more)


@dataclass(slots=True)
class ProgramBytes:
    """What the histories of a program take, in bytes."""

    name: str = ""
    runs: int = 0
    journals: int = 0
    commands: int = 0
    rehearsals: int = 0
    archived: int = 0

    @property
    def total(self) -> int:
        """All of it."""
        return self.runs + self.journals + self.commands + self.rehearsals + self.archived


@dataclass(frozen=True, slots=True)
class Usage:
    """What takes how many bytes at a site: by program, the largest first, and calls, as rows and in files."""

    programs: tuple[tuple[UUID, ProgramBytes], ...]
    calls: int
    calls_archived: int


def read_usage(*, site: str) -> Usage:
    """Return what takes how many bytes at a site."""
    found: defaultdict[UUID, ProgramBytes] = defaultdict(ProgramBytes)
    runs, rehearsals = (model.objects.filter(site__slug=site) for model in (Run, Rehearsal))
    commands = Command.objects.filter(site__slug=site)
    program = Subquery(Run.objects.filter(pk=OuterRef("run")).values("program")[:1])
    of_runs = commands.exclude(run=None).annotate(program=program).exclude(program=None)
    for name, rows in (
        ("runs", _by("program", runs)),
        ("journals", _by("run__program", RunEvent.objects.filter(run__site__slug=site))),
        ("commands", _by("program", of_runs)),
        ("rehearsals", _by("program", rehearsals)),
    ):
        for key, size in rows:
            setattr(found[key], name, size)
    for model in (Run, Rehearsal):
        rows = model.objects.filter(site__slug=site).exclude(archive=None).order_by()
        for key, size in rows.values_list("program").annotate(size=Sum("archive_bytes")):
            found[key].archived += size
    _name(found, site)
    calls = commands.filter(run=None).aggregate(size=Sum(_size(Command)))["size"] or 0
    in_files = Archive.objects.filter(site__slug=site, kind="calls").aggregate(size=Sum("bytes"))["size"] or 0
    return Usage(tuple(sorted(found.items(), key=lambda item: -item[1].total)), calls, in_files)


def _size(model: type[Any]) -> Any:
    size: Any = Value(ROW_BYTES, output_field=BigIntegerField())
    for column in COLUMNS[model]:
        size += Coalesce(StoredBytes(F(column)), 0)
    return size


def _by(program: str, rows: QuerySet[Any]) -> Any:
    return rows.order_by().values_list(program).annotate(size=Sum(_size(rows.model)))


def _name(found: dict[UUID, ProgramBytes], site: str) -> None:
    """Give programs the names that they had in their newest history."""
    for model in (Rehearsal, Run):
        rows: QuerySet[Any, Any] = model._default_manager.filter(site__slug=site)
        newest: Any = rows.order_by().values("program").annotate(at=Max("created_at")).values("at")
        for key, name in rows.filter(created_at__in=newest).values_list("program", "program_name"):
            found[key].name = name


def list_archives(*, site: str) -> tuple[tuple[Archive, ...], int, int]:
    """Return the newest files of a site's archive that are whole, how many there are, and their bytes."""
    rows = Archive.objects.filter(site__slug=site, state__in=(Archive.State.WHOLE, Archive.State.PRUNED))
    total = rows.aggregate(count=Count("pk"), size=Sum("bytes"))
    return tuple(rows.order_by("-made_at", "-last_at")[:MOST_ARCHIVES]), total["count"], total["size"] or 0

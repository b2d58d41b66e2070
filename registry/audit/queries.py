"""The record as admins read it: the newest first, by kind, in pages, or all of it as a table."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

from django.db.models import QuerySet

from registry.audit.codes import Kind
from registry.bounds.pagination import FIRST, Listed, Page, take_page
from registry.models import AuditLine
from vipo_device.protocol.csv_lines import csv_line

COLUMNS = ("at", "kind", "code", "actor_kind", "actor", "address", "agent", "facts")
_PART = Page(500)


@dataclass(frozen=True, slots=True)
class AuditView:
    """One line of the record."""

    id: int
    at: datetime
    kind: str
    code: str
    actor_kind: str
    actor: str
    address: str
    agent: str
    facts: dict[str, Any]


def list_audit(*, site: str, kind: Kind | None = None, page: Page = FIRST) -> Listed[AuditView]:
    """Return a page of what was done at a site, the newest first. Raises BadMark."""
    return take_page(rows=_rows(site, kind), by="-at", page=page, view=_view)


def list_server_audit(*, last: int) -> tuple[AuditView, ...]:
    """Return what was done at the server and at none of its sites, the newest first, so many lines."""
    return tuple(map(_view, AuditLine.objects.filter(site=None).order_by("-at", "-pk")[:last]))


def count_audit(*, site: str, kind: Kind | None = None) -> int:
    """Return of how many deeds the record tells."""
    return _rows(site, kind).count()


def write_table(*, site: str, kind: Kind | None = None) -> Iterator[str]:
    """Return the record as CSV with a head, the newest first, in parts of which each is read when it is asked for.

    The first part is read at once: what cannot be read is told before an answer has begun.
    """
    rows = _rows(site, kind)
    return _write_parts(rows, take_page(rows=rows, by="-at", page=_PART, view=_line))


def _write_parts(rows: QuerySet[AuditLine], lines: Listed[str]) -> Iterator[str]:
    yield csv_line(COLUMNS) + "".join(lines)
    while lines.rest:
        lines = take_page(rows=rows, by="-at", page=Page(_PART.limit, lines.rest), view=_line)
        yield "".join(lines)


def _line(row: AuditLine) -> str:
    facts = json.dumps(row.facts, ensure_ascii=False, sort_keys=True)
    at = row.at.astimezone(UTC).isoformat(timespec="seconds")
    return csv_line((at, row.kind, row.code, row.actor_kind, row.actor, row.address, row.agent, facts))


def _rows(site: str, kind: Kind | None) -> QuerySet[AuditLine]:
    rows = AuditLine.objects.filter(site__slug=site)
    return rows.filter(kind=kind) if kind else rows


def _view(row: AuditLine) -> AuditView:
    return AuditView(row.pk, row.at, row.kind, row.code, row.actor_kind, row.actor, row.address, row.agent, row.facts)

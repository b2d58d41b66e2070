"""Deleting the rows of what stands in a whole archive: in short transactions, with a breath between them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from datetime import datetime
from typing import Any

from django.db import transaction
from django.db.models import QuerySet

from execution.archive.rows import PARTS
from execution.fault_points import fault_point
from execution.models import Archive, Command, Rehearsal, Run

ROWS_AT_ONCE = 500
SUMMARIES_AT_ONCE = 50
"""Runs and rehearsals have documents of many kilobytes each, so fewer of them make a short transaction."""
EMPTY_RUN: dict[str, Any] = {
    "document": {}, "compiled": {}, "plan": {}, "state": None, "steps": {}, "parameters": {}, "notices": {},
}  # fmt: skip
EMPTY_REHEARSAL: dict[str, Any] = {"job": {}, "document": {}, "compiled": {}, "result": None, "course": {}}
Breathe = Callable[[], None]


def prune(archive: Archive, ids: list[str], breathe: Breathe, now: datetime) -> int:
    """Delete the rows of a whole archive, and leave summaries; begun anew it goes on. Returns how many slices it took.

    `ids` are those of its calls. `breathe` waits a moment, and may raise.
    """
    slices = 0
    for _ in _prune(archive, ids):
        fault_point("archive_slice")
        slices += 1
        breathe()
    whole = Archive.objects.filter(pk=archive.pk, state=Archive.State.WHOLE)
    whole.update(state=Archive.State.PRUNED, pruned_at=now)
    return slices


def _prune(archive: Archive, ids: list[str]) -> Iterator[None]:
    if archive.kind == "calls":
        for start in range(0, len(ids), ROWS_AT_ONCE):
            with transaction.atomic():
                Command.objects.filter(pk__in=ids[start : start + ROWS_AT_ONCE], run=None).delete()
            yield
        return
    if archive.kind == "runs":
        runs = list(Run.objects.filter(archive=archive).values_list("pk", flat=True))
        for part in PARTS:
            yield from _delete(part.rows_of(runs))
        yield from _empty(Run.objects.filter(archive=archive), EMPTY_RUN)
    else:
        yield from _empty(Rehearsal.objects.filter(archive=archive), EMPTY_REHEARSAL)


def _delete(rows: QuerySet[Any]) -> Iterator[None]:
    while True:
        with transaction.atomic():
            keys = list(rows.values_list("pk", flat=True)[:ROWS_AT_ONCE])
            if keys:
                rows.model._default_manager.filter(pk__in=keys).delete()
        if not keys:
            return
        yield


def _empty(rows: QuerySet[Any], empty: dict[str, Any]) -> Iterator[None]:
    keys = list(rows.order_by("pk").values_list("pk", flat=True))
    for start in range(0, len(keys), SUMMARIES_AT_ONCE):
        with transaction.atomic():
            rows.model._default_manager.filter(pk__in=keys[start : start + SUMMARIES_AT_ONCE]).update(**empty)
        yield

"""What the mirror measured, kept; and what a run took beside what was predicted."""

from __future__ import annotations

import logging
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from datetime import datetime
from typing import Any
from uuid import UUID

from django.db import transaction
from django.db.models import Count, Max, Min, Sum

from execution.mirror.paces import KEPT, Change, find_change
from execution.models import Command, Measurement
from simulation.mirror.device_copy import Job, Measured

log = logging.getLogger(__name__)
SHORTEST_S = 0.3
"""What is predicted to take less says more of the network than of the device."""


@dataclass(frozen=True, slots=True)
class Kept:
    """A device's method of which something was kept, and whether its pace has changed."""

    site: str
    device: str
    method: str
    change: Change | None


def keep_job(*, job: Job, at: datetime) -> list[Kept]:
    """Keep what was measured in a job; the pieces of one Move are one measurement. Says of which methods it was."""
    rows = {str(row.id): row for row in _commands(job.measured)}
    together: defaultdict[tuple[Any, ...], list[Measured]] = defaultdict(list)
    for each in job.measured:
        row = rows.get(each.command)
        if row is not None:
            moves = each.method == "move"
            together[row.site_id, row.run, row.step, each.method, "" if moves else each.command].append(each)
    found = []
    for (site_id, run, step, method, _), parts in together.items():
        real_s, predicted_s = sum(p.real_s for p in parts), sum(p.predicted_s for p in parts)
        if predicted_s < SHORTEST_S or real_s <= 0:
            continue
        made = Measurement(
            site_id=site_id, device=parts[0].device, method=method, command=parts[0].command, run=run,
            step=step, real_s=real_s, predicted_s=predicted_s, apart_m=job.apart_m, at=at,
        )  # fmt: skip
        found.append(made)
    with transaction.atomic():
        Measurement.objects.bulk_create(found, ignore_conflicts=True)  # of two mirrors the first one measures
        methods = {(m.site_id, m.device, m.method): rows[str(m.command)].site.slug for m in found}
        return [
            Kept(slug, device, method, _look(site_id, device, method))
            for (site_id, device, method), slug in methods.items()
        ]


def list_of_run(*, run: UUID | str) -> list[dict[str, Any]]:
    """Return what each step of a run took of each method of a device, and what was predicted, all of it added up.

    A step that is done a thousand times is one line; the newest `KEPT` measurements of a method count.
    """
    rows = Measurement.objects.filter(run=run).values("step", "device", "method")
    sums = rows.annotate(
        real_s=Sum("real_s"), predicted_s=Sum("predicted_s"), apart_m=Max("apart_m"), count=Count("id"), first=Min("id")
    )
    return [
        {
            "step": row["step"],
            "device": row["device"],
            "method": row["method"],
            "count": row["count"],
            "real_s": round(row["real_s"], 2),
            "predicted_s": round(row["predicted_s"], 2),
            "apart_m": None if row["apart_m"] is None else round(row["apart_m"], 2),
        }
        for row in sums.order_by("first")
    ]


def _look(site_id: int, device: str, method: str) -> Change | None:
    """Tell whether a method's pace has changed; what is older than the newest `KEPT` is forgotten."""
    rows = Measurement.objects.filter(site_id=site_id, device=device, method=method).order_by("-at", "-id")
    newest = list(rows.values_list("id", "real_s", "predicted_s")[: KEPT + 50])
    if old := [number for number, _, _ in newest[KEPT:]]:
        Measurement.objects.filter(id__in=old).delete()
    return find_change([real_s / predicted_s for _, real_s, predicted_s in reversed(newest[:KEPT])])


def _commands(measured: Iterable[Measured]) -> Iterable[Command]:
    ids = [number for each in measured if (number := _number(each.command)) is not None]
    return Command.objects.filter(id__in=ids).select_related("site").only("site__slug", "run", "step")


def _number(text: str) -> UUID | None:
    try:
        return UUID(text)
    except ValueError:
        return None

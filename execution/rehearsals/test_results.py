"""What came of tests, as rows: kept by the worker that has carried them out."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any
from uuid import UUID

from django.db.models.functions import Now

from execution.models import ProgramTest, TrialResult, TrialRun

KEPT_OF_TEST = 20
"""So many results of a test are kept, the newest; those of updates that were tried beside those of the program."""
KEPT_OF_PROGRAM = 500
"""So many runs of a program's tests are kept, the newest."""


def keep_results(*, rehearsal: UUID, found: Mapping[str, Any]) -> None:
    """Keep what the child process of `execution.trials` found; tests that were deleted meanwhile are left out."""
    run = TrialRun.objects.filter(rehearsal=rehearsal).first()
    if run is None:
        return  # its program was deleted
    there = set(ProgramTest.objects.filter(program=run.program_id).values_list("pk", flat=True))
    rows = [
        TrialResult(
            run=run, test_id=UUID(each["test"]), digest=run.digest, revision=each["revision"], status=each["status"],
            seed=each["seed"], duration_s=each["duration_s"], detail=each["detail"], taken=each["taken"], at=Now(),
        )
        for each in found["tests"]
        if UUID(each["test"]) in there
    ]  # fmt: skip
    TrialResult.objects.bulk_create(rows)
    passed = sum(row.status == TrialResult.Status.PASSED for row in rows)
    columns = {"passed": passed, "total": len(rows), "ways": found["ways"], "ended_at": Now()}
    if "changes" in found:
        tried_with = sorted([each["test"], each["revision"]] for each in found["tests"])
        columns["changes"] = {**found["changes"], "tests": tried_with}
    TrialRun.objects.filter(pk=run.pk).update(**columns)
    _forget_old(run, [row.test_id for row in rows])


def _forget_old(run: TrialRun, tests: list[UUID]) -> None:
    for test in tests:
        like = TrialResult.objects.filter(test=test, run__update__isnull=run.update is None)
        old = like.order_by("-at", "-pk").values_list("pk", flat=True)
        TrialResult.objects.filter(pk__in=list(old[KEPT_OF_TEST:])).delete()
    runs = TrialRun.objects.filter(program=run.program_id).order_by("-created_at", "-pk").values_list("pk", flat=True)
    TrialRun.objects.filter(pk__in=list(runs[KEPT_OF_PROGRAM:])).delete()

"""A process that archives is killed at each named moment; the next pass loses nothing and doubles nothing."""

from __future__ import annotations

import gzip
import json
import os
import sys
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
from django.db import connection
from django.utils import timezone

from execution import services
from execution.fault_points import ARCHIVE_POINTS, DIES_WITH
from execution.job_lease import JobLease
from execution.models import Archive, Command, Lease, Run, RunEvent
from execution.retention import pruner
from execution.retention.archiver import Overtaken, Turn, archive_next
from execution.views import event_to_json, whole_run_to_json
from tests.integration.execution.retention.histories import NOW, archive, make_command, make_run

pytestmark = [pytest.mark.django_db(transaction=True), pytest.mark.usefixtures("hall", "folder")]


def archive_in_a_process(faults: Path, moment: str = "") -> int:
    """Archive in a process of its own, which dies at the moment; return its exit code."""
    connection.close()
    if moment:
        (faults / moment).write_text("kill")
    child = os.fork()
    if child == 0:
        os.environ["VIPO_FAULTS"] = str(faults)
        try:
            archive()
        finally:
            os._exit(0 if sys.exc_info()[0] is None else 1)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


def told(run: Run) -> tuple[Any, ...]:
    whole = whole_run_to_json(services.get_run(run_id=run.pk)) | {"archived": None}
    return whole, [event_to_json(event) for event in services.list_events(run_id=run.pk)]


def count_in_files(folder: Path) -> dict[str, int]:
    """Return how often each run and command stands in the archive."""
    found: dict[str, int] = {}
    for file in folder.rglob("*.jsonl.gz"):
        for line in map(json.loads, gzip.decompress(file.read_bytes()).splitlines()):
            if line.get("row") in ("run", "command"):
                found[line["id"]] = found.get(line["id"], 0) + 1
    return found


@pytest.mark.parametrize("moment", ARCHIVE_POINTS)
def test_a_kill_at_this_moment_loses_nothing_and_doubles_nothing(
    moment: str, folder: Path, tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> None:
    faults = tmp_path_factory.mktemp("faults")
    monkeypatch.setattr(pruner, "ROWS_AT_ONCE", 3)
    monkeypatch.setattr(pruner, "SUMMARIES_AT_ONCE", 1)
    runs = [make_run(number, 31, events=4) for number in range(1, 4)]
    calls = [make_command(31, by="Ada") for _ in range(12)]
    ids = {str(key) for key in (*Command.objects.values_list("pk", flat=True), *(run.pk for run in runs))}
    before = [told(run) for run in runs]
    for _ in range(2):
        assert archive_in_a_process(faults, moment) == DIES_WITH
        assert [told(run) for run in runs] == before
        Lease.objects.all().delete()
    assert archive_in_a_process(faults) == 0
    assert [told(run) for run in runs] == before
    assert count_in_files(folder) == dict.fromkeys(ids, 1)
    assert (RunEvent.objects.count(), Command.objects.count()) == (0, 0)
    assert sorted(Archive.objects.values_list("kind", "state", "count")) == [
        ("calls", "pruned", len(calls)),
        ("runs", "pruned", len(runs)),
    ]
    assert {path.name for path in folder.rglob("*") if path.is_file()} == {
        Path(each.file).name for each in Archive.objects.all()
    }


def test_while_another_process_has_the_lease_nothing_is_archived() -> None:
    make_run(1, 31)
    assert JobLease("archive", "another").hold(timezone.now())
    archive()
    assert not Archive.objects.exists()
    Lease.objects.update(until=timezone.now() - timedelta(seconds=1))
    archive()
    assert Archive.objects.count() == 1


def test_who_was_frozen_while_it_wrote_says_nothing_of_its_archive(folder: Path) -> None:
    run = make_run(1, 31)
    before = told(run)
    asked: list[None] = []

    def frozen() -> None:
        asked.append(None)
        if len(asked) == 2:  # its file is written; meanwhile another process has made a whole pass
            archive()

    with pytest.raises(Overtaken):
        archive_next(Turn(run.site_id, "hall", NOW, frozen), "runs", NOW)
    assert len(asked) == 2
    assert count_in_files(folder)[str(run.pk)] == 1
    assert len(list(folder.rglob("*.jsonl.gz*"))) == 1
    assert told(run) == before
    assert Archive.objects.values_list("state", "count").get() == ("pruned", 1)

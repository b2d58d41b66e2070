"""What is older than its time goes into a file, leaves a summary, and is opened again as it was."""

from __future__ import annotations

import gzip
import json
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
from django.db import connection
from django.test.utils import CaptureQueriesContext

from execution import services
from execution.errors import BadKeeping, HistoryUnreadable
from execution.models import Archive, Command, InboxEvent, Keeping, Question, Rehearsal, Run, RunEvent, Timer
from execution.rehearsals.views import whole_rehearsal_to_json
from execution.retention.periods import get_keeping, set_keeping
from execution.views import event_to_json, question_to_json, whole_run_to_json
from registry.models import Device, DeviceAlert, Site
from tests.integration.execution.retention.histories import NOW, archive, make_command, make_rehearsal, make_run
from tests.kit.sites import describe

pytestmark = [pytest.mark.django_db(transaction=True), pytest.mark.usefixtures("hall", "folder")]


def seen(run: Run) -> tuple[Any, ...]:
    """Return all that the API says of a run."""
    return (
        whole_run_to_json(services.get_run(run_id=run.pk)) | {"archived": None},
        [event_to_json(event) for event in services.list_events(run_id=run.pk)],
        [event_to_json(event) for event in services.list_events(run_id=run.pk, after=2)],
        [question_to_json(question) for question in services.list_questions(site="hall", run_id=run.pk)],
    )


def lines_in(folder: Path) -> list[dict[str, Any]]:
    files = sorted(folder.rglob("*.jsonl.gz"))
    return [json.loads(line) for file in files for line in gzip.decompress(file.read_bytes()).splitlines()]


def test_an_old_run_leaves_a_summary_and_is_opened_from_its_file_as_it_was(folder: Path) -> None:
    old, young = make_run(1, 31), make_run(2, 29)
    Timer.objects.create(run=old, timer=1, due_at=NOW)
    before, of_young = seen(old), seen(young)
    assert archive() is False
    row = Run.objects.get(pk=old.pk)
    assert (row.document, row.compiled, row.plan, row.state, row.steps) == ({}, {}, {}, None, {})
    assert [each.filter(run=old.pk).count() for each in (RunEvent.objects, Question.objects, Timer.objects)] == [0] * 3
    assert Command.objects.filter(run=old.pk).count() == 0
    assert seen(old) == before
    assert seen(young) == of_young
    assert Run.objects.get(pk=young.pk).archive is None
    runs, _ = services.list_runs(site="hall")
    assert [(run.number, run.status, run.is_archived) for run in runs] == [
        (2, "finished", False),
        (1, "finished", True),
    ]
    names = [line.get("row", line.get("kind")) for line in lines_in(folder)]
    assert names == ["run", "run", "event", "event", "event", "question", "timer", "command", "end"]
    assert Archive.objects.values_list("kind", "state", "count").get() == ("runs", "pruned", 1)


def test_numbers_go_on_and_an_archived_run_stays_over() -> None:
    run = make_run(1, 31)
    archive()
    for order in (services.pause_run, services.resume_run, services.cancel_run):
        with pytest.raises(services.NotPossibleNow, match="Run 1 is over"):
            order(run_id=run.pk, by="Ada")
    prepared = services.Prepared(run.program, "hall", "Mix", 1, {}, {}, {}, {})
    assert services.start_run(prepared=prepared, by="Ada").number == 2


def test_a_rehearsal_and_calls_have_times_of_their_own(folder: Path) -> None:
    old, young = make_rehearsal(11), make_rehearsal(9)
    make_command(31, by="Ada")
    kept = make_command(29, by="Ada")
    before = whole_rehearsal_to_json(services.get_rehearsal(rehearsal_id=old.pk), None)
    archive()
    assert Rehearsal.objects.values_list("document", "result", "job").get(pk=old.pk) == ({}, None, {})
    assert whole_rehearsal_to_json(services.get_rehearsal(rehearsal_id=old.pk), None) == before
    assert Rehearsal.objects.get(pk=young.pk).archive is None
    assert [call.pk for call in Command.objects.all()] == [kept.pk]
    assert sorted(Archive.objects.values_list("kind", "count")) == [("calls", 1), ("rehearsals", 1)]
    assert [line["by"] for line in lines_in(folder) if line.get("row") == "command"] == ["Ada"]


@pytest.mark.parametrize("status", ["pending", "running", "paused"])
def test_what_is_open_is_never_archived(status: str) -> None:
    run = make_run(1, 400, status=status, ended_at=NOW - timedelta(days=400))
    make_rehearsal(400, status="queued")
    make_command(400, status="running")
    archive()
    assert not Archive.objects.exists()
    assert Run.objects.get(pk=run.pk).plan == {"p": 1}


def test_an_ended_run_waits_while_something_of_it_is_open() -> None:
    asks, commands, news, alone = (make_run(number, 31) for number in range(1, 5))
    Question.objects.filter(run=asks).update(state="open")
    Command.objects.filter(run=commands.pk).update(status="sent")
    InboxEvent.objects.create(target=f"run:{news.pk}", key="a", payload={}, created_at=NOW)
    archive()
    assert set(Run.objects.exclude(archive=None)) == {alone}


def test_what_an_open_alert_is_about_is_kept() -> None:
    describe()
    Device.objects.update(lifecycle="approved")
    alerted, before = make_run(1, 31), make_run(2, 33)
    call, older = make_command(31, status="failed"), make_command(33)
    first = NOW - timedelta(days=32)
    alert = DeviceAlert.objects.create(device_id="mixer1", code="command_failed", first_at=first, last_at=first)
    archive()
    assert set(Run.objects.exclude(archive=None)) == {before}
    assert set(Command.objects.filter(run=None)) == {call}
    assert not Command.objects.filter(pk=older.pk).exists()
    DeviceAlert.objects.filter(pk=alert.pk).update(over_at=NOW)
    archive()
    assert set(Run.objects.exclude(archive=None)) == {alerted, before}


def test_a_site_chooses_its_own_times_and_0_is_for_ever(settings: Any) -> None:
    make_run(1, 3)
    set_keeping(site="hall", chosen={"runs": 0, "rehearsals": None, "calls": 1})
    view = get_keeping(site="hall")
    assert view.days == {"runs": 0, "rehearsals": 10, "calls": 1}
    assert view.chosen == {"runs": 0, "rehearsals": None, "calls": 1}
    archive(days=100_000)
    assert not Archive.objects.filter(kind="runs").exists()
    set_keeping(site="hall", chosen={"runs": 2})
    archive()
    assert Archive.objects.filter(kind="runs").count() == 1
    for days in (-1, 36_501):
        with pytest.raises(BadKeeping):
            set_keeping(site="hall", chosen={"runs": days})
    assert get_keeping(site="hall").days["runs"] == 2


def test_one_file_has_what_ended_on_one_day_of_one_site(folder: Path) -> None:
    for number, days in enumerate((31, 31.1, 32, 33), 1):
        make_run(number, days)
    archive()
    found = [(each.file.split("/")[:2], each.file.split("/")[2][:10], each.count) for each in Archive.objects.all()]
    assert sorted(found) == [
        (["hall", "runs"], "2026-10-21", 1),
        (["hall", "runs"], "2026-10-22", 1),
        (["hall", "runs"], "2026-10-23", 2),
    ]


def test_a_folder_that_cannot_be_written_deletes_nothing_and_says_so(folder: Path) -> None:
    run = make_run(1, 31)
    before = seen(run)
    folder.parent.mkdir(exist_ok=True)
    folder.write_text("a file where the folder should be")
    archive()
    assert (Archive.objects.count(), RunEvent.objects.count()) == (0, 3)
    assert get_keeping(site="hall").trouble != ""
    assert seen(run) == before
    folder.unlink()
    archive()
    assert get_keeping(site="hall").trouble == ""
    assert seen(run) == before
    assert Archive.objects.count() == 1


def test_an_archive_that_has_gone_is_told_and_nothing_more_is_deleted_on_its_word(folder: Path) -> None:
    run = make_run(1, 31, events=5)
    archive()
    made = Archive.objects.get()
    Archive.objects.update(state="whole")
    RunEvent.objects.create(run=run, seq=9, at=NOW, t_s=1, kind="step", text="left by a process that died")
    path = folder / made.file
    whole = path.read_bytes()
    for damaged in (whole[:-9], whole[:60] + b"\0" * 20 + whole[80:], b""):
        path.write_bytes(damaged)
        archive()
        assert RunEvent.objects.count() == 1
        assert get_keeping(site="hall").trouble != ""
        with pytest.raises(HistoryUnreadable, match="archive"):
            services.list_events(run_id=run.pk)
    path.write_bytes(whole)
    archive()
    assert RunEvent.objects.count() == 0
    assert len(services.list_events(run_id=run.pk)) == 5


@pytest.mark.parametrize("file", ["../outside.jsonl.gz", "/etc/passwd", "", "."])
def test_a_row_that_names_a_file_outside_of_the_folder_opens_nothing(file: str) -> None:
    run = make_run(1, 31)
    archive()
    Archive.objects.update(file=file)
    with pytest.raises(HistoryUnreadable):
        services.get_run(run_id=run.pk)


def test_a_long_journal_is_read_in_parts_from_the_archive_too() -> None:
    run = make_run(1, 31, events=2345)
    archive()
    parts = [services.list_events(run_id=run.pk, after=after) for after in (0, 1000, 2000, 2345)]
    assert [len(part) for part in parts] == [1000, 1000, 345, 0]
    assert parts[2][-1].text == "line 2345 ü"


def test_a_sites_trouble_does_not_keep_another_site_from_its_archive(folder: Path) -> None:
    make_run(1, 31)
    shed = Site.objects.create(name="Shed", slug="shed")
    other = make_run(2, 31, site=shed)
    folder.mkdir()
    (folder / "hall").write_text("no folder")
    archive()
    assert set(Run.objects.exclude(archive=None)) == {other}
    assert list(Keeping.objects.exclude(trouble="").values_list("site__slug", flat=True)) == ["hall"]


def test_each_run_more_costs_the_same_number_of_statements() -> None:
    def cost(runs: int, days: float) -> int:
        Run.objects.all().delete()
        for number in range(runs):
            make_run(number + 1, days)
        with CaptureQueriesContext(connection) as asked:
            archive()
        return len(asked)

    archive()
    few, more, most = cost(2, 31), cost(12, 32), cost(42, 33)
    assert (more - few) / 10 == (most - more) / 30
    assert (more - few) / 10 <= 8

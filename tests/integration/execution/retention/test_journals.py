"""A run's journal is read from its end, and its timeline as one answer, whether it is in the archive or not."""

from __future__ import annotations

from typing import Any

import pytest
from django.db import connection
from django.test.utils import CaptureQueriesContext

from execution.errors import HistoryUnreadable, NotFound
from execution.models import Archive, Run, RunEvent
from execution.runs import routes
from execution.runs.history import list_newest_events, show_timeline
from registry import services as registry
from tests.integration.execution.retention.histories import NOW, archive, make_run
from tests.kit.sign_in import signed_in

pytestmark = [pytest.mark.django_db(transaction=True), pytest.mark.usefixtures("hall", "folder")]
DOCUMENT = {"steps": {"go": {"kind": "move"}, "cure": {"kind": "operate", "params": {"device": {"device": "oven"}}}}}


def get(path: str) -> Any:
    return signed_in("viewer").get(f"/api/runs/{path}")


def in_parts(run: Run, query: str) -> list[list[int]]:
    """Return the numbers of a run's lines, part after part, as the header Link leads from one to the next."""
    parts, address = [], f"/api/runs/{run.pk}/events?{query}"
    while address:
        answer = signed_in("viewer").get(address)
        parts.append([event["seq"] for event in answer.json()])
        address = answer.get("Link", "").removesuffix('>; rel="next"').removeprefix("<")
    return parts


def test_a_journal_is_read_from_its_end_part_after_part_from_the_archive_too() -> None:
    run, empty = make_run(1, 31, events=1234), make_run(2, 31, events=0)
    for _ in range(2):
        assert in_parts(run, "newest=true&limit=500") == [
            [*range(735, 1235)],
            [*range(235, 735)],
            [*range(1, 235)],
        ]
        assert in_parts(run, "newest=true&limit=617") == [[*range(618, 1235)], [*range(1, 618)]]
        assert in_parts(run, "newest=true&after=1230") == [[1231, 1232, 1233, 1234]]
        assert in_parts(run, "after=3&before=6") == [[4, 5]]
        assert in_parts(run, "limit=2") == [[1, 2]]
        assert in_parts(empty, "newest=true") == [[]]
        archive()
    assert Run.objects.exclude(archive=None).count() == 2


def tell(run: Run, lines: int) -> None:
    """Let a run's journal tell, over and over, that a robot drives, that a machine works, and something else."""
    rows = []
    for seq in range(1, lines + 1):
        told = (
            {"kind": "step", "code": "step_entered", "step": "go"},
            {"kind": "way", "code": "way", "robot": "robot1", "device": "robot1", "args": {"simulated": True}},
            {"kind": "step", "code": "step_done", "step": "go"},
            {"kind": "command", "code": "command", "step": "cure", "device": "oven", "args": {"method": "cure"}},
            {"kind": "answer", "code": "answer", "step": "cure", "device": "oven", "args": {"status": "FAILED"}},
            {"kind": "notice", "code": "told", "step": "", "args": {"level": "info"}},
        )[(seq - 1) % 6]  # fmt: skip
        rows.append(RunEvent(run=run, seq=seq, at=NOW, t_s=seq * 10, text="", **told))
    RunEvent.objects.bulk_create(rows)


def test_a_timeline_is_told_as_one_answer_and_is_the_same_from_the_archive() -> None:
    run = make_run(1, 31, events=0, document=DOCUMENT)
    tell(run, 10)
    at_work = {"kind": "work", "count": 1, "failed": False, "pending": 0}
    for _ in range(2):
        assert get(f"{run.pk}/timeline").json() == {
            "seq": 10,
            "bars": [
                {"device": "robot1", "step": "go", "started_s": 20.0, "ended_s": 30.0, **at_work},
                {"device": "oven", "step": "cure", "started_s": 40.0, "ended_s": 50.0, **at_work, "failed": True},
                {"device": "robot1", "step": "go", "started_s": 80.0, "ended_s": 90.0, **at_work},
                {"device": "oven", "step": "cure", "started_s": 100.0, "ended_s": None, **at_work, "pending": 1},
            ],
            "steps": [],
            "drives": {},
            "simulated": ["robot1"],
        }
        archive()
    Archive.objects.update(file="gone")
    with pytest.raises(HistoryUnreadable):
        show_timeline(run_id=run.pk)
    with pytest.raises(HistoryUnreadable):
        list_newest_events(run_id=run.pk)


def test_a_timeline_and_the_newest_lines_cost_as_many_statements_however_long_the_journal_is() -> None:
    short, long = make_run(1, 1, events=0, document=DOCUMENT), make_run(2, 1, events=0, document=DOCUMENT)
    tell(short, 12)
    tell(long, 12_000)
    reads = {"timeline": 4, "events?newest=true&limit=500": 3}
    for path, most in reads.items():
        client, counts, sizes = signed_in("viewer"), [], []
        for run in (short, long):
            with CaptureQueriesContext(connection) as asked:
                answer = client.get(f"/api/runs/{run.pk}/{path}")
            counts.append(sum("execution_run" in each["sql"] for each in asked.captured_queries))
            sizes.append(len(answer.content))
        assert counts == [most, most]
        assert sizes[1] < 400_000
    assert len(get(f"{long.pk}/timeline").json()["bars"]) <= 2000


def test_a_run_that_is_not_there_has_no_timeline(hall: str) -> None:
    with pytest.raises(NotFound):
        show_timeline(run_id="11111111-1111-4111-8111-111111111111")


@pytest.mark.parametrize("query", ["limit=0", "limit=1001", "before=0", "newest=perhaps", "after=x", "other=1"])
def test_what_does_not_fit_is_refused_by_name(query: str) -> None:
    run = make_run(1, 1)
    answer = get(f"{run.pk}/events?{query}")
    assert answer.status_code == 422
    assert [field["field"].split(".")[-1] for field in answer.json()["fields"]] == [query.split("=")[0]]


def test_so_many_timelines_are_read_at_once_and_who_wants_one_more_is_told_to_wait(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    run, client = make_run(1, 1, events=0, document=DOCUMENT), signed_in("viewer")
    monkeypatch.setattr(routes, "PATIENCE_S", 0.01)
    others = [registry.Claim(-person) for person in (1, 2, 3)]
    assert all(routes.timeline_slots.take(other) for other in others)
    assert client.get(f"/api/runs/{run.pk}/timeline").status_code == 200
    others.append(registry.Claim(-4))
    assert routes.timeline_slots.take(others[-1])
    try:
        answer = client.get(f"/api/runs/{run.pk}/timeline")
        assert (answer.status_code, answer.json()["code"]) == (429, "too_many_timelines")
    finally:
        for other in others:
            routes.timeline_slots.give_back(other)
    assert client.get(f"/api/runs/{run.pk}/timeline").status_code == 200

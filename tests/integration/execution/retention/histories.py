"""Histories of many ages at the site `hall`."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from typing import Any
from uuid import UUID, uuid4

from execution.models import Command, Question, Rehearsal, Run, RunEvent
from execution.retention.upkeep import archive_old
from registry.models import Site

NOW = datetime(2026, 11, 23, 12, 0, tzinfo=UTC)
PROGRAM = UUID("11111111-1111-4111-8111-111111111111")

STEP = {"status": "done", "started_at": None, "ended_at": None, "robot": None, "wait": None, "why": None, "count": 1}


def make_run(number: int, days: float, *, events: int = 3, **more: Any) -> Run:
    """Make a run that ended so many days ago, with its journal, a command and a question."""
    at = NOW - timedelta(days=days)
    site = Site.objects.get(slug="hall")
    told = {
        "site": site,
        "program": PROGRAM,
        "status": "finished",
        "ended_at": at,
        "document": {"steps": {"a": {"kind": "move"}}},
    } | more
    run = Run.objects.create(
        number=number, program_name="Mix “blue”", version=2,
        compiled={"text": "x" * 100}, plan={"p": 1}, state={"s": 1}, steps={"a": STEP},
        roles={"robot": "robot1"}, created_at=at, started_at=at, **told,
    )  # fmt: skip
    RunEvent.objects.bulk_create(
        RunEvent(run=run, seq=seq, at=at, t_s=seq / 2, kind="step", text=f"line {seq} ü", args={"seq": seq})
        for seq in range(1, events + 1)
    )
    make_command(days, run=run.pk)
    Question.objects.create(run=run, number=1, text="Go?", state="answered", value=True, asked_at=at)
    return run


def make_command(days: float, **more: Any) -> Command:
    at = NOW - timedelta(days=days)
    told = {"device": "mixer1", "method": "mix", "status": "done", "position": 1, "ended_at": at} | more
    return Command.objects.create(id=uuid4(), site=Site.objects.get(slug="hall"), send_after=at, created_at=at, **told)


def make_rehearsal(days: float, **more: Any) -> Rehearsal:
    """Make a rehearsal that ended so many days ago."""
    at = NOW - timedelta(days=days)
    told = {"status": "done", "ended_at": at, "result": {"ok": True}} | more
    return Rehearsal.objects.create(
        site=Site.objects.get(slug="hall"), program=PROGRAM, program_name="Mix", job={"plan": {}}, created_at=at,
        document={"steps": {}}, compiled={"text": "y"}, **told,
    )  # fmt: skip


def archive(days: float = 0) -> bool:
    """Archive what is old enough so many days after NOW, without a breath between slices."""
    return archive_old(now=NOW + timedelta(days=days), pause=lambda _: None)

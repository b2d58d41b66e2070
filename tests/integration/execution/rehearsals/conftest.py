"""Rehearsals that end soon or never, and a worker on a thread of this process."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from typing import Any
from uuid import uuid4

import pytest
from django.db import connection

from editor.language import plan_to_json
from editor.language.expressions.nodes import Constant
from editor.language.plan.instructions import End, Instruction, Jump, Plan, Wait
from execution import services
from execution.models import Rehearsal
from execution.rehearsals import worker
from tests.kit.programs import SITE
from tests.kit.waiting import wait_for

SHORT = Plan((Instruction(Wait(Constant(5)), "w"), Instruction(End())))
ENDLESS = Plan((Instruction(Wait(Constant(0.02)), "w"), Instruction(Jump(0))))
"""It takes a minute by the clock at least to come to the limit of what a rehearsal does."""


def queue(plan: Plan, person: int | None = 1, *, by: str = "Ada", driver: str = "physics", site: str = SITE) -> str:
    """Queue a rehearsal, as the API does."""
    prepared = services.Prepared(uuid4(), site, "Task", 1, {}, {}, plan_to_json(plan), {})
    return str(services.start_rehearsal(prepared=prepared, by=by, person=person, driver=driver).id)


def row(rehearsal: str) -> Rehearsal:
    return Rehearsal.objects.get(id=rehearsal)


def wait_until(rehearsal: str, status: str, limit_s: float = 60.0) -> Rehearsal:
    return wait_for(
        f"a rehearsal that is {status}",
        lambda: (found := row(rehearsal)).status == status and found,
        limit_s,
        story=lambda: str(Rehearsal.objects.values("status", "reason", "tries", "course")),
    ) or row(rehearsal)


@pytest.fixture
def working() -> Iterator[Callable[[], threading.Thread]]:
    """Start workers as threads; at the end of the test they give back what they have."""
    threads: list[threading.Thread] = []

    def work() -> None:
        try:
            worker.carry_out_waiting()
        finally:
            connection.close()

    def start() -> threading.Thread:
        threads.append(threading.Thread(target=work))
        threads[-1].start()
        return threads[-1]

    yield start
    worker.stopping.set()
    for thread in threads:
        thread.join(30)
    worker.stopping.clear()


@pytest.fixture
def children(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """The child processes that were started, in their order."""
    started: list[Any] = []

    class Watched(worker.RunningChild):
        def __init__(self, *told: Any) -> None:
            super().__init__(*told)
            started.append(self)

    monkeypatch.setattr(worker, "RunningChild", Watched)
    return started

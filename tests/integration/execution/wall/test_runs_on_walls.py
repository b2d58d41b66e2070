"""Which runs a wall screen shows where there are more than it has room for."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta

import pytest

from execution.models import Run
from execution.wall.picture import MOST_RUNS
from execution.wall.queries import read_picture
from registry.models import Site
from tests.kit.sites import make_hall

pytestmark = pytest.mark.django_db(transaction=True)
NOW = datetime.now(UTC)


def make(site: Site, number: int, status: str, *, begun: bool = False, in_h: int | None = None) -> None:
    at = None if in_h is None else NOW + timedelta(hours=in_h)
    Run.objects.create(
        site=site, number=number, program="00000000-0000-4000-8000-000000000000", program_name="Task", status=status,
        started_at=NOW if begun else None, not_before=at, created_at=NOW,
    )  # fmt: skip


def test_what_runs_comes_before_what_is_paused_and_that_before_what_is_planned_the_soonest_first() -> None:
    slug = make_hall()
    site = Site.objects.get(slug=slug)
    make(site, 1, "running", begun=True)
    make(site, 2, "paused", begun=True)
    make(site, 3, "running", begun=True, in_h=-1)
    for number in range(4, 20):
        make(site, number, "paused" if number == 10 else "pending", in_h=100 - number)
    make(site, 20, "pending")
    shown = [run["number"] for run in read_picture(slug)["runs"]]
    assert shown == [3, 1, 2, 20, *range(19, 19 - MOST_RUNS + 4, -1)]

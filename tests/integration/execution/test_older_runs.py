"""All runs of a site can be had, in parts, and looked for by status, program and time."""

from __future__ import annotations

from datetime import timedelta
from typing import Any
from uuid import UUID, uuid4

import pytest

from editor import services as editor
from execution.models import Run
from registry.models import Site
from tests.kit.sign_in import signed_in
from tests.kit.sites import NOW, make_hall

pytestmark = pytest.mark.django_db
MIX, PAINT = uuid4(), uuid4()


@pytest.fixture
def runs() -> None:
    """Let 120 runs have been made, one a minute, every third one of another program, the last two still going on."""
    site = Site.objects.get(slug=make_hall())
    Run.objects.bulk_create(
        Run(
            site=site,
            number=number,
            program=PAINT if number % 3 == 0 else MIX,
            status="finished" if number <= 118 else "running",
            created_at=NOW + timedelta(minutes=number),
        )
        for number in range(1, 121)
    )


def get(query: str = "") -> Any:
    return signed_in("viewer").get(f"/api/sites/hall/runs{query}")


def numbers(query: str = "") -> list[int]:
    return [run["number"] for run in get(query).json()]


def test_all_runs_can_be_had_by_following_the_links(runs: None) -> None:
    parts, address = [], "/api/sites/hall/runs"
    while address:
        answer = signed_in("viewer").get(address)
        parts.append([run["number"] for run in answer.json()])
        address = answer.get("Link", "").removesuffix('>; rel="next"').removeprefix("<")
    assert parts == [[*range(120, 70, -1)], [*range(70, 20, -1)], [*range(20, 0, -1)]]


def test_a_run_that_is_made_meanwhile_moves_no_part(runs: None) -> None:
    link = get("?limit=100")["Link"]
    assert link == '</api/sites/hall/runs?limit=100&before=21>; rel="next"'
    Run.objects.create(site=Site.objects.get(), number=121, program=MIX, created_at=NOW)
    last = get("?limit=100&before=21")
    assert [run["number"] for run in last.json()] == [*range(20, 0, -1)]
    assert "Link" not in last


def found_by(program: UUID) -> list[int]:
    return numbers(f"?limit=200&program={program}")


def test_runs_that_are_not_over_are_found_at_once_however_old_they_are(runs: None) -> None:
    Run.objects.filter(number=1).update(status="running")
    Run.objects.filter(number=3).update(status="paused")
    Run.objects.filter(number=100).update(status="pending")
    assert numbers("?state=open") == [120, 119, 100, 3, 1]
    assert get("?limit=2&state=open")["Link"] == '</api/sites/hall/runs?limit=2&state=open&before=119>; rel="next"'


def test_runs_are_found_by_status_program_and_time(runs: None) -> None:
    assert numbers("?state=running") == [120, 119]
    assert found_by(PAINT) == [*range(120, 0, -3)]
    assert found_by(uuid4()) == []
    assert numbers("?since=2026-11-21T12:10:00Z&until=2026-11-21T12:13:00Z") == [12, 11, 10]
    assert (
        get("?limit=1&state=running")["Link"] == '</api/sites/hall/runs?limit=1&state=running&before=120>; rel="next"'
    )


@pytest.mark.parametrize(
    "query",
    [
        "limit=0",
        "limit=201",
        "limit=x",
        "before=0",
        "before=99999999999999999999",
        "state=odd",
        "program=1",
        "since=2026-11-21T12:10:00",
        "until=soon",
    ],
)
def test_what_does_not_fit_is_refused_by_name(runs: None, query: str) -> None:
    answer = get(f"?{query}")
    assert answer.status_code == 422
    assert [field["field"].split(".")[-1] for field in answer.json()["fields"]] == [query.split("=")[0]]


def test_each_version_tells_how_many_runs_used_it_however_many_came_after(db: None) -> None:
    site = Site.objects.get(slug=make_hall())
    program = editor.create_program(site="hall", name="Mix").id
    versions = [1, 1, 2, 2, 2, 2, *[4] * 400, 0]
    Run.objects.bulk_create(
        Run(site=site, number=number, program=program, version=version, status="failed", created_at=NOW)
        for number, version in enumerate(versions, start=1)
    )
    Run.objects.create(site=site, number=900, program=PAINT, version=3, status="failed", created_at=NOW)

    def used(query: str) -> list[tuple[int, int, list[int]]]:
        answer = signed_in("viewer").get(f"/api/programs/{program}/version-runs?{query}").json()
        return [(each["version"], each["count"], [run["number"] for run in each["newest"]]) for each in answer]

    assert used("oldest=1&newest=50") == [(4, 400, [406, 405, 404]), (2, 4, [6, 5, 4]), (1, 2, [2, 1])]
    assert used("oldest=1&newest=2") == [(2, 4, [6, 5, 4]), (1, 2, [2, 1])]
    assert used("oldest=1&newest=201") == [(4, 400, [406, 405, 404]), (2, 4, [6, 5, 4])]
    first = signed_in("viewer").get(f"/api/programs/{program}/version-runs?oldest=1&newest=1").json()[0]["newest"][0]
    assert first == {"id": str(Run.objects.get(number=2).pk), "number": 2, "status": "failed"}
    refused = signed_in("viewer").get(f"/api/programs/{program}/version-runs?oldest=0&newest=1")
    assert refused.status_code == 422

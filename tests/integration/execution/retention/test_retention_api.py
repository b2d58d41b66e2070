"""What admins are told of bytes and archives, what they choose, and what it costs to ask."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from uuid import uuid4

import pytest
from django.db import connection
from django.test.utils import CaptureQueriesContext

from execution.models import Keeping
from execution.retention.usage import read_usage
from tests.integration.execution.retention.histories import (
    NOW,
    PROGRAM,
    archive,
    make_command,
    make_rehearsal,
    make_run,
)
from tests.kit.sign_in import find_person, signed_in

pytestmark = [pytest.mark.django_db(transaction=True), pytest.mark.usefixtures("hall", "folder")]
ADDRESS = "/api/sites/hall/retention"


def ask() -> Any:
    answer = signed_in("admin").get(ADDRESS)
    assert answer.status_code == 200, answer.content
    return answer.json()


def test_an_admin_sees_what_takes_how_much_before_and_after_it_is_archived() -> None:
    make_run(1, 31, events=200)
    make_rehearsal(11)
    make_command(31, by="Ada", arguments={"text": "z" * 300})
    (of_program,) = ask()["programs"]
    assert (of_program["program"], of_program["name"], of_program["archived"]) == (str(PROGRAM), "Mix “blue”", 0)
    assert of_program["runs"] > 200
    assert of_program["journals"] > 200 * 100
    assert of_program["commands"] > 100
    assert of_program["rehearsals"] > 100
    assert ask()["calls"] > 400
    assert ask()["archives"] == []
    archive()
    body = ask()
    (after,) = body["programs"]
    assert (after["journals"], after["commands"], body["calls"]) == (0, 0, 0)
    assert after["archived"] + body["calls_archived"] == body["archive_bytes"]
    assert 0 < after["archived"] < of_program["journals"] / 5
    assert (body["archive_count"], sorted(each["kind"] for each in body["archives"])) == (
        3,
        ["calls", "rehearsals", "runs"],
    )


def test_an_admin_chooses_times_and_nobody_chooses_nonsense() -> None:
    admin = signed_in("admin")
    chosen = {"runs": 90, "rehearsals": None, "calls": 0}
    answer = admin.put(ADDRESS, chosen, content_type="application/json")
    assert answer.status_code == 200, answer.content
    assert answer.json()["keeping"] == [
        {"kind": "runs", "days": 90, "chosen": 90, "server": 30},
        {"kind": "rehearsals", "days": 10, "chosen": None, "server": 10},
        {"kind": "calls", "days": 0, "chosen": 0, "server": 30},
    ]
    for wrong in ({"runs": -1}, {"runs": 36_501}, {"runs": 1.5}, {"runs": "9"}, {"runs": True}, {"other": 1}):
        answer = admin.put(ADDRESS, chosen | wrong, content_type="application/json")
        assert answer.status_code == 422, wrong
    assert Keeping.objects.values_list("runs_days", "rehearsals_days", "calls_days").get() == (90, None, 0)


def test_what_two_admins_choose_of_each_other_stays_and_a_whole_choice_is_taken_too() -> None:
    one, other = signed_in("admin"), signed_in("admin")
    one.put(ADDRESS, {"runs": 90, "rehearsals": None, "calls": 0}, content_type="application/json")
    one.put(ADDRESS, {"rehearsals": 5}, content_type="application/json")
    answer = other.put(ADDRESS, {"runs": None}, content_type="application/json")
    assert [each["chosen"] for each in answer.json()["keeping"]] == [None, 5, 0]


def test_a_choice_of_times_is_in_the_record_once_and_a_refused_one_is_not() -> None:
    admin = signed_in("admin")
    chosen = {"runs": 90, "rehearsals": None, "calls": 0}
    for each in (chosen, chosen, chosen | {"runs": -1}, {"runs": None, "rehearsals": None, "calls": None}):
        admin.put(ADDRESS, each, content_type="application/json")
    lines = admin.get("/api/sites/hall/audit?kind=runs").json()
    assert [(line["code"], line["actor"], line["facts"]) for line in lines] == [
        ("keeping_set", find_person("admin").display_name, {"runs": 30, "rehearsals": 10, "calls": 30}),
        ("keeping_set", find_person("admin").display_name, {"runs": 90, "rehearsals": 10, "calls": 0}),
    ]


def test_what_keeps_the_archive_from_growing_is_told_admins_alone() -> None:
    Keeping.objects.update_or_create(
        site_id=make_run(1, 1).site_id, defaults={"trouble": "No space left", "trouble_at": NOW}
    )
    assert (ask()["trouble"], ask()["trouble_at"]) == ("No space left", NOW.isoformat())
    found = signed_in("admin").get("/api/sites/hall/findings").json()
    assert [(each["code"], each["args"]) for each in found] == [("archive_failed", {"why": "No space left"})]
    assert signed_in("operator").get("/api/sites/hall/findings").json() == []


def test_a_run_of_the_archive_opens_over_http_and_says_503_while_its_file_is_away(folder: Path) -> None:
    run = make_run(1, 31)
    viewer = signed_in("viewer")
    address = f"/api/runs/{run.pk}"
    before = viewer.get(address).json(), viewer.get(f"{address}/events").json()
    archive()
    assert (viewer.get(address).json(), viewer.get(f"{address}/events").json()) == (
        before[0] | {"archived": True},
        before[1],
    )
    folder.rename(folder.with_name("elsewhere"))
    for each in (address, f"{address}/events"):
        answer = viewer.get(each)
        assert (answer.status_code, answer.json()["code"]) == (503, "history_unreadable")
    assert [each["number"] for each in viewer.get("/api/sites/hall/runs").json()] == [1]


def test_what_takes_how_much_is_a_handful_of_questions_however_much_there_is() -> None:
    asked = []
    for number in range(1, 21):
        make_run(number, 1, program=uuid4())
        if number in (2, 20):
            with CaptureQueriesContext(connection) as found:
                read_usage(site="hall")
            asked.append(len(found))
    assert asked[0] == asked[1] <= 10

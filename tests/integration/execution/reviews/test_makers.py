"""Who has made a content cannot approve it, whoever pinned it, brought it back or copied it to another program."""

from __future__ import annotations

import pytest
from django.db import connection
from django.test.utils import CaptureQueriesContext

from editor.reviews.reviews import show_review
from tests.integration.execution.reviews.conftest import Team
from tests.kit.sign_in import find_person, signed_in

pytestmark = pytest.mark.django_db(transaction=True)


def approved(team: Team) -> None:
    team.demand(1)
    assert team.say("bob", "approved").status_code == 200


def test_who_drew_before_the_last_approved_content_may_approve_what_others_drew_since(team: Team) -> None:
    approved(team)
    team.draw("bob", 8)
    assert team.say("ann", "approved", team.pin("bob")).status_code == 200
    team.draw("bob", 9)
    number = team.pin("root")
    assert [team.look(name, number)["why_not"] for name in ("ann", "bob", "root")] == ["", "own", "own"]
    assert team.look("ann", number)["compare_with"] == 2


def test_what_was_drawn_without_a_version_between_counts_as_ones_own(team: Team) -> None:
    approved(team)
    team.draw("bob", 8)
    team.draw("ann", 9)
    assert team.say("bob", "approved", team.pin("ann")).json()["args"] == {"why": "own"}


def test_nobody_approves_a_copy_of_what_they_have_drawn_whoever_copied_or_pinned_it(team: Team) -> None:
    team.demand(1)
    team.draw("ann", 9)
    number = team.pin("root")
    for who in ("ann", "bob"):
        copy = team.post(who, f"/programs/{team.program}/versions/{number}/copy", {"name": who}).json()["id"]
        again = team.post("bob", f"/programs/{copy}/review/ask", {"note": "Please."})
        assert again.status_code == 200
        said = team.post("ann", f"/programs/{copy}/review", {"version": 1, "verdict": "approved", "note": ""})
        assert (said.status_code, said.json()["args"]) == (409, {"why": "own"})
        assert team.post("olga", f"/programs/{copy}/runs", {}).status_code == 409


def test_who_drew_before_the_last_approval_of_a_program_may_approve_a_copy_of_what_others_drew_since(
    team: Team,
) -> None:
    approved(team)
    team.draw("bob", 8)
    copy = team.post("bob", f"/programs/{team.program}/versions/{team.pin('bob')}/copy", {"name": "Copy"}).json()["id"]
    team.post("olga", f"/programs/{copy}/review/ask", {"note": ""})
    told = {who: signed_in(who).get(f"/api/programs/{copy}/review?version=1").json() for who in ("ann", "bob")}
    assert {who: each["why_not"] for who, each in told.items()} == {"ann": "", "bob": "own"}


def test_what_one_has_drawn_stays_ones_own_when_somebody_else_brings_it_back(team: Team) -> None:
    team.demand(1)
    team.draw("ann", 9)
    team.pin("ann")
    team.draw("bob", 8)
    assert team.say("root", "approved", team.pin("bob")).status_code == 200
    team.draw("bob", 9)
    number = team.pin("olga")
    assert [team.look(who, number)["why_not"] for who in ("ann", "bob", "root")] == ["own", "own", ""]


def test_a_review_is_asked_of_the_database_in_as_many_statements_however_long_its_history_is(team: Team) -> None:
    team.demand(1)
    numbers = []
    for seconds in range(8, 12):
        team.draw("ann", seconds)
        numbers.append(team.pin("ann"))
        assert team.say("bob", "approved", numbers[-1]).status_code == 200

    def asked(number: int | None) -> list[int]:
        """Return how many statements ask for versions and for what was said of them."""
        with CaptureQueriesContext(connection) as captured:
            show_review(program_id=team.program, user=find_person("vera"), number=number)
            show_review(program_id=team.program, user=find_person("bob"), number=number)
        said = [each["sql"] for each in captured.captured_queries]
        return [sum(f'FROM "{table}"' in sql for sql in said) for table in ("editor_version", "editor_reviewentry")]

    assert [asked(number) for number in (numbers[0], numbers[-1])] == [[5, 4]] * 2

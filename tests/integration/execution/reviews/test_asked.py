"""Which versions wait for whom: asked for, said, approved, objected to; who may not review has none."""

from __future__ import annotations

from typing import Any

import pytest

from tests.integration.execution.reviews.conftest import Team
from tests.kit.programs import SITE
from tests.kit.sign_in import signed_in

pytestmark = pytest.mark.django_db(transaction=True)


def waiting(who: str) -> list[Any]:
    answer = signed_in(who).get(f"/api/sites/{SITE}/reviews")
    assert answer.status_code == 200
    told: list[Any] = answer.json()
    return told


def ask(team: Team, note: str = "") -> None:
    assert team.post("ann", f"/programs/{team.program}/review/ask", {"note": note}).status_code == 200


def test_a_version_waits_for_those_who_may_approve_it_and_did_not_draw_it(team: Team) -> None:
    team.demand(1)
    team.draw("ann", 7)
    ask(team, "Is the oven free?")
    told = waiting("bob")[0]
    assert told.pop("at")
    assert told == {
        "program": str(team.program),
        "program_name": "Heat",
        "number": 1,
        "compare_with": None,
        "by": "Ann Person",
        "note": "Is the oven free?",
    }
    assert {who: len(waiting(who)) for who in ("ann", "bob", "olga", "vera", "root")} == {
        "ann": 0,
        "bob": 1,
        "olga": 0,
        "vera": 0,
        "root": 1,
    }


def test_it_waits_no_longer_for_who_has_approved_it_and_for_nobody_once_it_is_approved(team: Team) -> None:
    team.demand(2)
    ask(team)
    team.say("bob", "approved")
    assert (len(waiting("bob")), len(waiting("root"))) == (0, 1)
    team.say("root", "approved")
    assert waiting("root") == []


def test_it_waits_for_nobody_while_changes_are_asked_for(team: Team) -> None:
    team.demand(1)
    ask(team)
    team.say("bob", "changes", note="Slower, please.")
    assert (waiting("bob"), waiting("root")) == ([], [])
    team.say("bob", "withdrawn")
    assert len(waiting("root")) == 1


def test_only_what_was_asked_last_waits_beside_what_was_approved_before(team: Team) -> None:
    team.demand(1)
    ask(team)
    team.say("bob", "approved")
    team.draw("ann", 8)
    ask(team)
    team.draw("ann", 9)
    ask(team)
    assert [(each["number"], each["compare_with"]) for each in waiting("bob")] == [(3, 1)]


def test_where_nothing_is_demanded_one_approval_is_what_it_waits_for(team: Team) -> None:
    ask(team)
    assert len(waiting("bob")) == 1
    team.say("bob", "approved")
    assert waiting("root") == []

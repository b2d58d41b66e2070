"""Which versions wait for whom: asked for, said, approved, objected to; who may not review has none."""

from __future__ import annotations

from typing import Any

import pytest

from editor.models import Program, ReviewEntry, Version
from tests.integration.execution.reviews.conftest import Team
from tests.kit.programs import SITE
from tests.kit.sign_in import find_person, signed_in

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


def copies(team: Team, count: int, said: str = "") -> list[str]:
    """Make as many programs that Ann has asked to review, of which Bob has said this; return them, newest first."""
    version = team.pin("ann")
    digest = Version.objects.get(program_id=team.program, number=version).digest
    first = Program.objects.get(id=team.program)
    programs = Program.objects.bulk_create(
        Program(site=first.site, name=f"Copy {n} {said}", edited_at=first.edited_at) for n in range(count)
    )
    ann, bob = find_person("ann"), find_person("bob")
    Version.objects.bulk_create(
        Version(program=each, number=1, digest=digest, author=ann, content=b"") for each in programs
    )
    for each in programs:
        for kind, person in [("asked", ann), *([(said, bob)] if said else [])]:
            ReviewEntry.objects.create(
                program=each, number=1, digest=digest, kind=kind, person=person, name=person.display_name
            )
    return [str(each.id) for each in programs][::-1]


def test_what_waits_longest_is_shown_behind_however_many_that_wait_no_more(team: Team) -> None:
    team.demand(1)
    ask(team)
    copies(team, 30, "approved")
    copies(team, 30, "changes")
    assert [each["program"] for each in waiting("root")] == [str(team.program)]
    newest = copies(team, 25)
    assert [each["program"] for each in waiting("root")] == newest[:20]
    assert waiting("ann") == []


def test_who_has_asked_for_many_reviews_is_told_in_few_statements_that_none_waits_for_them(
    team: Team, django_assert_max_num_queries: Any
) -> None:
    team.demand(1)
    copies(team, 100)
    copies(team, 100, "approved")
    with django_assert_max_num_queries(40):
        assert waiting("ann") == []

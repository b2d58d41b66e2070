"""Every way to a start on real devices, by each role, with each state of the approvals: one gate stands before all."""

from __future__ import annotations

from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from typing import Any
from uuid import UUID

import pytest
from django.test import Client

from editor.reviews import reviews
from execution import services
from execution.engine.drive import advance_site
from execution.models import ArmedProgram, DeadLetter, Rehearsal, Run
from registry import services as registry
from registry.models import AuditLine
from tests.integration.execution.reviews.conftest import Team
from tests.kit.programs import SITE, heat_oven, step
from tests.kit.sign_in import find_person, post_json, signed_in

pytestmark = pytest.mark.django_db(transaction=True)


def nothing_demanded(team: Team) -> None:
    team.demand(0)


def nothing_said(team: Team) -> None:
    team.demand(1)


def asked_alone(team: Team) -> None:
    team.demand(1)
    assert team.post("ann", f"/programs/{team.program}/review/ask", {"note": "Please look."}).status_code == 200


def approved(team: Team) -> None:
    team.demand(1)
    assert team.say("bob", "approved").status_code == 200


def edited_since(team: Team) -> None:
    approved(team)
    team.draw("ann", 7)


def edit_undone(team: Team) -> None:
    edited_since(team)
    team.pin()
    team.draw("ann", 5)


def withdrawn(team: Team) -> None:
    approved(team)
    assert team.say("bob", "withdrawn").status_code == 200


def changes_asked(team: Team) -> None:
    approved(team)
    assert team.say("root", "changes", note="The oven is being mended.").status_code == 200


def more_demanded(team: Team) -> None:
    approved(team)
    team.demand(2)


def twice_by_one(team: Team) -> None:
    more_demanded(team)
    assert team.say("bob", "approved").status_code == 200


def two_approved(team: Team) -> None:
    more_demanded(team)
    assert team.say("root", "approved").status_code == 200


def admins_demanded(team: Team) -> None:
    approved(team)
    team.demand(1, "admin")


def approver_removed(team: Team) -> None:
    approved(team)
    registry.remove_member(site=SITE, email="bob@vipo.example")


def approver_lowered(team: Team) -> None:
    approved(team)
    registry.set_member(site=SITE, email="bob@vipo.example", role="operator")


STATES: dict[Callable[[Team], None], bool] = {
    nothing_demanded: True,
    nothing_said: False,
    asked_alone: False,
    approved: True,
    edited_since: False,
    edit_undone: True,
    withdrawn: False,
    changes_asked: False,
    more_demanded: False,
    twice_by_one: False,
    two_approved: True,
    admins_demanded: False,
    approver_removed: False,
    approver_lowered: False,
}
"""How the program may stand, and whether a run of it may start then."""


def runs_of(team: Team, client: Client, **body: Any) -> int:
    return int(post_json(client, f"/api/programs/{team.program}/runs", body).status_code)


def by_page(team: Team, client: Client) -> int:
    return runs_of(team, client)


def of_a_version(team: Team, client: Client) -> int:
    return runs_of(team, client, version=team.pin())


def for_later(team: Team, client: Client) -> int:
    return runs_of(team, client, not_before=(datetime.now(UTC) + timedelta(hours=1)).isoformat())


def by_repeated_request(team: Team, client: Client) -> int:
    path, key = f"/api/programs/{team.program}/runs", {"Idempotency-Key": "once"}
    seen = {client.post(path, {}, content_type="application/json", headers=key).status_code for _ in range(2)}
    assert len(seen) == 1
    return seen.pop()


def by_arming(team: Team, client: Client) -> int:
    status = post_json(client, f"/api/programs/{team.program}/arm", {"on": True}).status_code
    assert ArmedProgram.objects.count() == (status == 200)
    return 202 if status == 200 else status


WAYS = (by_page, of_a_version, for_later, by_repeated_request, by_arming)
STARTERS = {"vera": 403, "olga": 202, "ann": 202, "root": 202}


@pytest.mark.parametrize("way", WAYS, ids=lambda way: way.__name__)
@pytest.mark.parametrize("state", STATES, ids=lambda state: state.__name__)
def test_each_way_is_open_to_each_role_exactly_where_the_content_is_approved(
    team: Team, state: Callable[[Team], None], way: Callable[[Team, Client], int]
) -> None:
    state(team)
    for name, granted in STARTERS.items():
        wanted = granted if STATES[state] or granted == 403 else 409
        assert (name, way(team, signed_in(name))) == (name, wanted)
        assert wanted == 202 or (Run.objects.count(), ArmedProgram.objects.count()) == (0, 0)
        Run.objects.all().delete()
        ArmedProgram.objects.all().delete()


@pytest.mark.parametrize("state", [approved, edited_since], ids=lambda state: state.__name__)
def test_a_token_passes_the_same_gate_and_approves_nothing(
    team: Team, bearer: Callable[[str], Client], state: Callable[[Team], None]
) -> None:
    state(team)
    assert runs_of(team, bearer("olga")) == (202 if STATES[state] else 409)
    said = post_json(
        bearer("bob"), f"/api/programs/{team.program}/review", {"version": team.pin(), "verdict": "approved"}
    )
    assert (said.status_code, said.json()["code"]) == (403, "not_for_tokens")


def test_a_refusal_names_what_is_missing_and_how_to_mend_it(team: Team) -> None:
    more_demanded(team)
    refused = team.start()
    assert refused["Content-Type"] == "application/problem+json"
    told = refused.json()
    assert (told["code"], told["args"]) == (
        "not_approved", {"why": "approvals", "needed": 2, "given": 1, "by": ["Bob Person"]},
    )  # fmt: skip
    assert told["detail"] == (
        "What runs on this site's devices needs approvals: 2. For the program as it is there are 1. "
        "Ask for a review of it, then start it again."
    )


def test_rehearsals_need_no_approval(team: Team) -> None:
    team.demand(1)
    assert team.post("olga", f"/programs/{team.program}/rehearsals", {}).status_code == 202
    assert Rehearsal.objects.count() == 1


def test_a_copy_and_another_version_of_an_approved_program_are_reviewed_by_themselves(team: Team) -> None:
    approved(team)
    copy = team.post("ann", f"/programs/{team.program}/versions/1/copy", {"name": "Copy"}).json()["id"]
    assert team.post("olga", f"/programs/{copy}/runs", {}).status_code == 409
    team.draw("ann", 9)
    second = team.pin()
    assert (team.start(version=1).status_code, team.start(version=second).status_code) == (202, 409)


def test_what_stands_in_a_function_is_part_of_the_content(team: Team) -> None:
    cool = {"g": {"name": "cool", "parameters": []}}
    team.change("ann", lambda now: {"functions": cool, "steps": {**now["steps"], "c": step("call", function="g")}})
    team.change("ann", lambda now: {"steps": {**now["steps"], "b": step("wait", ("g", "body"), duration=1)}})
    approved(team)
    assert team.start().status_code == 202
    team.change("ann", lambda now: {"steps": {**now["steps"], "b": step("wait", ("g", "body"), duration=600)}})
    assert team.start().json()["code"] == "not_approved"
    team.change("ann", lambda now: {"steps": {**now["steps"], "b": step("wait", ("g", "body"), duration=1)}})
    assert team.start().status_code == 202


def test_the_checker_is_asked_only_where_something_is_reviewed(team: Team) -> None:
    assert (team.look()["may_run"], team.look()["errors"], team.look()["warnings"]) == (True, None, None)
    team.demand(1)
    assert (team.look()["may_run"], team.look()["errors"]) == (False, 0)


def test_who_says_much_about_one_content_is_stopped_and_may_still_withdraw(
    team: Team, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reviews, "MOST_WORDS", 2)
    team.demand(1)
    number = team.pin()
    said = [team.say("bob", verdict, number).status_code for verdict in ("approved", "withdrawn", "approved")]
    assert said == [200, 200, 422]
    team.draw("ann", 7)
    number = team.pin("ann")
    said = [team.say("bob", verdict, number).status_code for verdict in ("approved", "withdrawn")]
    assert said == [200, 200], "another content"


@pytest.mark.parametrize("state", [approved, withdrawn, more_demanded], ids=lambda state: state.__name__)
def test_an_armed_program_is_looked_at_again_at_each_firing(team: Team, state: Callable[[Team], None]) -> None:
    approved(team)
    heat_oven(20)
    assert by_arming(team, signed_in("olga")) == 202
    state(team)
    heat_oven(90)
    fires = STATES[state]
    assert services.start_armed(now=datetime.now(UTC)) == fires
    assert (Run.objects.count(), ArmedProgram.objects.count()) == (fires, fires)
    assert AuditLine.objects.filter(code="armed_run_not_approved").count() == (not fires)


def test_an_armed_program_starts_what_was_armed_though_it_is_drawn_on_since(team: Team) -> None:
    approved(team)
    heat_oven(20)
    assert by_arming(team, signed_in("olga")) == 202
    team.draw("ann", 99)
    heat_oven(90)
    assert services.start_armed(now=datetime.now(UTC)) == 1
    assert Run.objects.get().document["steps"]["w"]["params"]["duration"] == 5


def test_a_run_that_began_lawfully_goes_on_after_its_approval_is_gone(team: Team, factory: Any) -> None:
    approved(team)
    run = team.start().json()
    assert run["permit"] == {"needed": 1, "approved_by": ["Bob Person"], "emergency": ""}
    withdrawn_now = team.say("bob", "withdrawn")
    assert withdrawn_now.status_code == 200
    factory.work()
    for order in ("pause", "resume"):
        assert team.post("olga", f"/runs/{run['id']}/{order}", {}).status_code == 200
        factory.work()
    factory.go(lambda: Run.objects.get().status == "finished", limit_s=30)


def come(run: str) -> Run:
    """Let the time of a planned run come; return what has become of it."""
    Run.objects.filter(pk=run).update(not_before=datetime.now(UTC))
    for _ in range(2):
        advance_site(SITE)
    return Run.objects.get(pk=run)


def plan(team: Team, who: str = "olga", **more: Any) -> str:
    later = (datetime.now(UTC) + timedelta(hours=1)).isoformat()
    return str(team.start(who, not_before=later, **more).json()["id"])


def withdraw(team: Team) -> None:
    assert team.say("bob", "withdrawn").status_code == 200


def demand_more(team: Team) -> None:
    team.demand(2)


@pytest.mark.parametrize("change", [withdraw, demand_more, approver_removed])
def test_a_planned_run_whose_approval_has_gone_never_begins(team: Team, change: Callable[[Team], None]) -> None:
    approved(team)
    run = plan(team)
    change(team)
    row = come(run)
    assert (row.status, row.started_at, row.state) == ("cancelled", None, None)
    assert row.reason == "When its time came, approvals that the site demands were missing"
    assert signed_in("olga").get(f"/api/runs/{run}").json()["cause"]["code"] == "approval_gone"


def test_a_run_planned_where_nothing_was_demanded_is_looked_at_when_its_time_comes(team: Team) -> None:
    nothing_demanded(team)
    run = plan(team)
    team.demand(1)
    assert come(run).status == "cancelled"


def test_a_planned_run_of_which_nobody_can_tell_stops_itself_and_not_the_site(team: Team) -> None:
    approved(team)
    odd, good = plan(team), plan(team)
    Run.objects.filter(pk=odd).update(document=[7])
    Run.objects.update(not_before=datetime.now(UTC))
    for _ in range(2):
        advance_site(SITE)
    assert {str(run.pk): run.status for run in Run.objects.all()} == {odd: "paused", good: "running"}
    assert DeadLetter.objects.get().run_id == UUID(odd)


@pytest.mark.parametrize("emergency", [False, True])
def test_a_planned_run_that_may_begin_does(team: Team, emergency: bool) -> None:
    team.demand(1)
    if not emergency:
        assert team.say("bob", "approved").status_code == 200
    run = plan(team, "root", emergency="The oven burns.") if emergency else plan(team)
    team.draw("ann", 99)
    assert come(run).status == "running"


def test_only_an_admin_starts_in_an_emergency_and_says_why(team: Team) -> None:
    team.demand(1)
    for name in ("olga", "ann"):
        assert team.start(name, emergency="The oven burns.").status_code == 403
    assert team.start("root", emergency="   ").status_code == 409
    run = team.start("root", emergency="The oven burns.").json()
    assert run["permit"] == {"needed": 1, "approved_by": [], "emergency": "The oven burns."}
    line = AuditLine.objects.get(code="run_started_in_emergency")
    assert (line.actor, line.facts) == (
        "Root Person", {"number": 1, "program": "Heat", "reason": "The oven burns."},
    )  # fmt: skip


def test_a_reason_is_not_kept_where_nothing_was_missing(team: Team) -> None:
    approved(team)
    run = team.start("root", emergency="Quick.").json()
    assert run["permit"] == {"needed": 1, "approved_by": ["Bob Person"], "emergency": ""}
    assert not AuditLine.objects.filter(code="run_started_in_emergency").exists()


def test_no_member_below_the_role_reviews_and_nobody_their_own(team: Team) -> None:
    team.demand(1)
    number = team.pin("ann")
    told = {name: team.say(name, "approved", number) for name in ("vera", "olga", "ann", "bob")}
    assert {name: answer.status_code for name, answer in told.items()} == {
        "vera": 403, "olga": 409, "ann": 409, "bob": 200,
    }  # fmt: skip
    assert [told[name].json()["args"] for name in ("olga", "ann")] == [{"why": "role"}, {"why": "own"}]


def test_changes_are_asked_for_with_a_sentence_and_only_what_was_said_is_withdrawn(team: Team) -> None:
    team.demand(1)
    assert team.say("bob", "changes").status_code == 422
    assert team.say("bob", "withdrawn").status_code == 422
    assert team.say("bob", "changes", note="Slower, please.").status_code == 200
    refused = team.start().json()
    assert (refused["args"]["why"], refused["args"]["by"]) == ("changes", ["Bob Person"])
    assert team.say("bob", "approved").status_code == 200
    assert team.start().status_code == 202


def test_a_review_names_people_who_are_gone(team: Team) -> None:
    approver_removed(team)
    assert [(word["name"], word["kind"], word["counts"]) for word in team.look()["history"]] == [
        ("Bob Person", "approved", False)
    ]
    find_person("bob").delete()
    assert [word["name"] for word in team.look()["history"]] == ["Bob Person"]

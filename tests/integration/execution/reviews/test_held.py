"""Planned runs that somebody holds before they begin: they pass the gate when they are let go on."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta

import pytest

from execution import services
from execution.engine.drive import advance_site, forget_all
from execution.models import DeadLetter, Run
from registry import services as registry
from tests.integration.execution.reviews.conftest import Team
from tests.kit.programs import SITE
from tests.kit.sign_in import signed_in

pytestmark = pytest.mark.django_db(transaction=True)


def come(run: str) -> Run:
    """Let the time of a planned run come; return what has become of it."""
    Run.objects.filter(pk=run).update(not_before=datetime.now(UTC))
    forget_all()
    for _ in range(2):
        advance_site(SITE)
    return Run.objects.get(pk=run)


@pytest.fixture
def run(team: Team) -> str:
    """A run of an approved program that is planned for later."""
    team.demand(1)
    assert team.say("bob", "approved").status_code == 200
    later = (datetime.now(UTC) + timedelta(hours=1)).isoformat()
    return str(team.start(not_before=later).json()["id"])


def order(team: Team, path: str) -> None:
    assert team.post("olga", path, {}).status_code == 200


def withdraw(team: Team) -> None:
    assert team.say("bob", "withdrawn").status_code == 200


@pytest.mark.parametrize("is_due", [True, False], ids=["resumed when its time is past", "resumed before"])
@pytest.mark.parametrize("hold", ["pause", "stop"])
def test_a_held_run_whose_approval_has_gone_never_begins(team: Team, run: str, hold: str, is_due: bool) -> None:
    where = f"/runs/{run}" if hold == "pause" else f"/sites/{SITE}"
    order(team, f"{where}/{hold}")
    advance_site(SITE)
    withdraw(team)
    if is_due:
        assert come(run).status == "paused"
    if hold == "stop":
        order(team, f"{where}/stop/reset")
    order(team, f"/runs/{run}/resume")
    row = come(run)
    assert (row.status, row.started_at, row.state) == ("cancelled", None, None)
    assert signed_in("olga").get(f"/api/runs/{run}").json()["cause"]["code"] == "approval_gone"


def test_a_run_of_which_nobody_could_tell_whether_it_may_begin_is_looked_at_when_that_is_retried(
    team: Team, run: str
) -> None:
    document = Run.objects.get().document
    Run.objects.update(document=[7])
    assert come(run).status == "paused"
    Run.objects.update(document=document)
    withdraw(team)
    services.retry_dead_letter(letter_id=DeadLetter.objects.get().id, by="Root")
    assert come(run).status == "cancelled"


def test_a_held_run_that_may_begin_does_with_the_places_of_its_site(team: Team, run: str) -> None:
    order(team, f"/runs/{run}/pause")
    advance_site(SITE)
    assert come(run).status == "paused"
    order(team, f"/runs/{run}/resume")
    row = come(run)
    places = {place.id for place in registry.list_places(site=SITE)}
    assert (row.status, {place["id"] for place in row.places or ()}) == ("running", places)

"""What happens while a run is being started, in two sessions of one PostgreSQL: no gap between look and start."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
from django.db import transaction
from pytest_django import DjangoDbBlocker

from editor import services as editor
from editor.errors import NotApproved
from editor.reviews.rules import Rule, get_rule, set_rule
from execution import services
from execution.models import Run
from execution.runs.programs import prepare
from registry import services as registry
from tests.integration.execution.reviews.conftest import PEOPLE, Team
from tests.kit.databases import Aside, on_database, one_waits
from tests.kit.programs import SITE, document, step
from tests.kit.sign_in import add_person, find_person
from tests.kit.waiting import wait_for
from vipo_site.settings import postgres

pytestmark = pytest.mark.servers
WAITS = document({"w": step("wait", duration=5)})


@pytest.fixture
def team(database_url: str, django_db_blocker: DjangoDbBlocker) -> Iterator[Team]:
    """The people of the gate's tests and their approved program, on a PostgreSQL."""
    with django_db_blocker.unblock(), on_database(**postgres(database_url)):
        registry.create_site(name="Painting Factory", slug=SITE)
        for name, role in PEOPLE.items():
            registry.set_member(site=SITE, email=add_person(name).email, role=role)
        made = editor.create_program(site=SITE, name="Wait", document=WAITS, user=find_person("ann"))
        team = Team(made.id)
        team.demand(1)
        assert team.say("bob", "approved").status_code == 200
        yield team


def start(team: Team) -> str:
    """Start a run as the API does; return how that ended."""
    prepared = prepare(program_id=team.program, user=find_person("olga"), parameters={})
    try:
        services.start_run(prepared=prepared, by="Olga Person")
    except NotApproved:
        return "refused"
    return "started"


def withdraw(team: Team) -> None:
    assert team.say("bob", "withdrawn", 1).status_code == 200


def demand_more(team: Team) -> None:
    set_rule(site=SITE, approvals=2)


def test_two_admins_who_choose_a_part_of_the_rule_at_once_turn_nothing_back(team: Team, aside: Aside) -> None:
    with transaction.atomic():
        set_rule(site=SITE, approvals=2)
        choosing = aside(lambda: set_rule(site=SITE, least_role="admin"))
        wait_for("the other waits", one_waits)
    assert choosing.result(60) == get_rule(site=SITE) == Rule(2, "admin")


@pytest.mark.parametrize("change", [withdraw, demand_more], ids=lambda change: change.__name__)
def test_a_start_waits_for_a_change_that_is_being_made_and_heeds_it(
    team: Team, aside: Aside, change: Callable[[Team], None]
) -> None:
    with transaction.atomic():
        change(team)
        starting = aside(lambda: start(team))
        wait_for("the start waits", one_waits)
        assert not starting.done()
    assert starting.result(60) == "refused"
    assert Run.objects.count() == 0


@pytest.mark.parametrize("change", [withdraw, demand_more], ids=lambda change: change.__name__)
def test_a_change_waits_for_a_start_that_was_let_through(
    team: Team, aside: Aside, change: Callable[[Team], None]
) -> None:
    with transaction.atomic():
        assert start(team) == "started"
        changing = aside(lambda: change(team))
        wait_for("the change waits", one_waits)
        assert not changing.done()
    changing.result(60)
    assert (Run.objects.count(), start(team)) == (1, "refused")


def test_a_run_carries_out_what_the_gate_looked_at_though_it_is_drawn_on_between(team: Team) -> None:
    prepared = prepare(program_id=team.program, user=find_person("olga"), parameters={})
    team.draw("ann", 99)
    services.start_run(prepared=prepared, by="Olga Person")
    assert Run.objects.get().document["steps"]["w"]["params"] == {"duration": 5}
    assert start(team) == "refused"


def test_what_was_made_ready_unapproved_is_refused_though_the_program_is_approved_again(team: Team) -> None:
    team.draw("ann", 99)
    prepared = prepare(program_id=team.program, user=find_person("olga"), parameters={})
    team.draw("ann", 5)
    with pytest.raises(NotApproved):
        services.start_run(prepared=prepared, by="Olga Person")
    assert start(team) == "started"

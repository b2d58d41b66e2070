"""How many rehearsals a person and a site may have, who may cancel them, and what lists show."""

from __future__ import annotations

from uuid import uuid4

import pytest

from editor import services as editor
from execution import services
from execution.errors import TooManyRehearsals
from execution.models import Rehearsal
from execution.rehearsals import worker
from registry import services as registry
from tests.integration.execution.rehearsals.conftest import SHORT, queue, row
from tests.kit.programs import SITE, TASK
from tests.kit.sign_in import ROLES, below_role, find_person, join_and_sign_in, post_json

pytestmark = pytest.mark.django_db(transaction=True)


@pytest.fixture
def program(factory):
    return editor.create_program(site=SITE, name="Task", document=TASK).id


def test_a_person_may_have_so_many_and_is_told_what_to_do(program, settings):
    settings.VIPO_REHEARSALS_OF_PERSON = 2
    client = join_and_sign_in("operator", SITE)
    first, _ = (post_json(client, f"/api/programs/{program}/rehearsals").json() for _ in range(2))
    refused = post_json(client, f"/api/programs/{program}/rehearsals")
    assert (refused.status_code, refused.json()["code"], refused["Retry-After"]) == (429, "too_many_rehearsals", "30")
    assert refused.json()["args"] == {"why": "person", "number": 2, "most": 2}
    assert refused.json()["detail"].endswith("Wait until one is over, or cancel one.")
    assert Rehearsal.objects.count() == 2
    assert post_json(client, f"/api/rehearsals/{first['id']}/cancel").status_code == 200
    assert post_json(client, f"/api/programs/{program}/rehearsals").status_code == 202
    other = join_and_sign_in("admin", SITE)
    assert post_json(other, f"/api/programs/{program}/rehearsals").status_code == 202


def test_a_site_may_have_so_many_and_another_one_is_not_held_up(factory, settings):
    settings.VIPO_REHEARSALS_OF_SITE = 3
    registry.create_site(name="Hall", slug="hall")
    registry.save_map(site="hall", grid=registry.get_map(site=SITE).grid, source="test")
    for person in (1, 2, 3):
        queue(SHORT, person)
    with pytest.raises(TooManyRehearsals) as refused:
        queue(SHORT, 4)
    assert refused.value.facts == {"why": "site", "number": 3, "most": 3}
    assert Rehearsal.objects.count() == 3
    queue(SHORT, 4, site="hall")


def test_what_is_over_does_not_count(factory, settings):
    settings.VIPO_REHEARSALS_OF_PERSON = 1
    for status in ("done", "failed", "cancelled"):
        Rehearsal.objects.filter(id=queue(SHORT)).update(status=status)
    queue(SHORT)
    with pytest.raises(TooManyRehearsals):
        queue(SHORT)


def test_places_are_told_in_the_order_in_which_they_are_taken(factory):
    mine = [queue(SHORT, 1, driver="kinematic") for _ in range(3)]
    other = queue(SHORT, 2, by="Bob", driver="kinematic")
    shown = {str(view.id): view.place for view in services.list_open_rehearsals(site=SITE)}
    assert shown == {mine[0]: 1, other: 2, mine[1]: 3, mine[2]: 4}
    taken = [str(worker.claim_next().id)]
    assert services.get_rehearsal(rehearsal_id=other).place == 1
    for _ in range(3):
        Rehearsal.objects.filter(status="running").update(status="done")
        taken.append(str(worker.claim_next().id))
    assert taken == [mine[0], other, mine[1], mine[2]]


def test_a_list_has_those_that_are_not_over_without_their_programs(program):
    client, operator = join_and_sign_in("viewer", SITE), join_and_sign_in("operator", SITE)
    waits, over = (post_json(operator, f"/api/programs/{program}/rehearsals").json()["id"] for _ in range(2))
    Rehearsal.objects.filter(id=over).update(status="done")
    [shown] = client.get(f"/api/sites/{SITE}/rehearsals").json()
    facts = ("id", "program_name", "status", "place", "mine", "course", "tries")
    assert tuple(shown[fact] for fact in facts) == (waits, "Task", "queued", 1, False, None, 0)
    assert shown.keys().isdisjoint({"document", "compiled", "result", "job"})
    assert operator.get(f"/api/sites/{SITE}/rehearsals").json()[0]["mine"] is True


@pytest.mark.parametrize("role", ["stranger", *ROLES])
def test_an_operator_may_cancel_anybodys_and_others_their_own(program, role):
    starter = join_and_sign_in("operator" if role != "operator" else "admin", SITE)
    rehearsal = post_json(starter, f"/api/programs/{program}/rehearsals").json()["id"]
    client = join_and_sign_in(role, SITE)
    wanted = 404 if role == "stranger" else 403 if role in below_role("operator") else 200
    assert post_json(client, f"/api/rehearsals/{rehearsal}/cancel").status_code == wanted
    assert row(rehearsal).status == ("cancelled" if wanted == 200 else "queued")


def test_who_was_made_a_viewer_may_still_cancel_what_they_have_started(program):
    client = join_and_sign_in("operator", SITE)
    rehearsal = post_json(client, f"/api/programs/{program}/rehearsals").json()["id"]
    person = find_person("operator")
    registry.set_member(site=SITE, email=person.email, role="viewer")
    assert post_json(client, f"/api/programs/{program}/rehearsals").status_code == 403
    assert post_json(client, f"/api/rehearsals/{rehearsal}/cancel").json()["status"] == "cancelled"
    assert post_json(client, f"/api/rehearsals/{uuid4()}/cancel").status_code == 404

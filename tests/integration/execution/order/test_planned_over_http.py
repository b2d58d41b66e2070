"""Starting a run on terms, over HTTP: what is taken, refused, repeated and shown."""

import json
from datetime import UTC, datetime, timedelta

import pytest

from editor import services as editor
from execution.models import Run
from tests.kit.programs import SITE, TASK
from tests.kit.sign_in import join_and_sign_in

pytestmark = pytest.mark.django_db(transaction=True)


def later(**span):
    return (datetime.now(UTC) + timedelta(**span)).isoformat()


def start(client, program, key=None, **body):
    headers = {"Idempotency-Key": key} if key else {}
    path = f"/api/programs/{program}/runs"
    return client.post(path, json.dumps(body), content_type="application/json", headers=headers)


@pytest.fixture
def program(factory):
    return editor.create_program(site=SITE, name="Task", document=TASK).id


@pytest.fixture
def operator():
    return join_and_sign_in("operator", SITE)


def test_terms_are_kept_and_shown_to_who_may_look(factory, program, operator):
    begin, due = later(hours=1), later(hours=2)
    answer = start(operator, program, priority="high", not_before=begin, deadline=due)
    assert answer.status_code == 202, answer.content
    run = answer.json()
    told = {"priority": "high", "not_before": begin, "deadline": due}
    assert told.items() <= run.items()
    viewer = join_and_sign_in("viewer", SITE)
    assert told.items() <= viewer.get(f"/api/runs/{run['id']}").json().items()
    (listed,) = viewer.get(f"/api/sites/{SITE}/runs").json()
    assert (listed["status"], listed["started_at"]) == ("pending", None)
    assert told.items() <= listed.items()


def test_a_run_without_terms_is_as_ever(factory, program, operator):
    run = start(operator, program).json()
    assert (run["priority"], run["not_before"], run["deadline"]) == ("normal", None, None)


def test_a_viewer_plans_nothing_and_cancels_nothing(factory, program, operator):
    viewer = join_and_sign_in("viewer", SITE)
    assert start(viewer, program, not_before=later(hours=1)).status_code == 403
    run = start(operator, program, not_before=later(hours=1)).json()["id"]
    assert viewer.post(f"/api/runs/{run}/cancel").status_code == 403
    assert join_and_sign_in("author", SITE).post(f"/api/runs/{run}/cancel").status_code == 200
    factory.work()
    assert [row.status for row in Run.objects.all()] == ["cancelled"]


def test_the_same_start_sent_again_plans_one_run_also_when_its_time_is_past(factory, program, operator):
    begin = later(hours=1)
    first = start(operator, program, "k1", not_before=begin)
    Run.objects.update(not_before=datetime.now(UTC) - timedelta(hours=2))
    again = start(operator, program, "k1", not_before=begin)
    assert (first.json()["id"], Run.objects.count()) == (again.json()["id"], 1)


@pytest.mark.parametrize(
    ("body", "why"),
    [
        ({"not_before": "2001-01-01T00:00:00Z"}, "start_past"),
        ({"deadline": "2001-01-01T00:00:00Z"}, "deadline_past"),
        ({"not_before": "9999-12-31T23:59:59Z"}, "too_far"),
        ({"deadline": "9999-12-31T23:59:59-14:00"}, "too_far"),
        ({"not_before": later(hours=2), "deadline": later(hours=1)}, "deadline_first"),
    ],
)
def test_absurd_times_are_refused_by_name(factory, program, operator, body, why):
    answer = start(operator, program, **body)
    assert (answer.status_code, answer.json()["code"], answer.json()["args"]) == (422, "bad_terms", {"why": why})
    assert Run.objects.count() == 0


@pytest.mark.parametrize(
    "body",
    [
        {"priority": "urgent"},
        {"priority": 1},
        {"priority": None},
        {"not_before": "2026-11-23T14:30:00"},
        {"not_before": "tomorrow"},
        {"deadline": "2026-13-01T00:00:00Z"},
        {"deadline": 1e300},
        {"deadline": -1},
        {"deadline": True},
        {"earliest": later(hours=1)},
    ],
)
def test_what_is_no_term_is_refused(factory, program, operator, body):
    assert start(operator, program, **body).status_code == 422
    assert Run.objects.count() == 0

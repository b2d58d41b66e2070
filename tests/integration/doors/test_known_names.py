"""What stands in an address and that its call does not know is refused by name, at every operation."""

from __future__ import annotations

from typing import Any

import pytest

from registry.models import Site
from registry.thing_directory import property_values
from tests.kit.api_calls import make_one_of_each, undone
from tests.kit.api_rights import OPERATIONS
from tests.kit.sign_in import post_json, signed_in
from tests.kit.sites import make_hall

pytestmark = pytest.mark.django_db


@pytest.fixture
def hall(monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.setattr(property_values, "MOST_POLL_S", 0.0)
    return make_hall()


def test_a_name_that_is_misspelt_is_refused_and_those_that_are_known_are_said(hall: str) -> None:
    answer = signed_in("viewer").get("/api/sites/hall/runs?limti=3&limit=2")
    assert (answer.status_code, answer.json()["code"]) == (422, "bad_request")
    (field,) = answer.json()["fields"]
    known = "before, limit, program, since, state, until"
    assert field == {"field": "limti", "message": f"There is no such name here; known are {known}."}


def test_a_call_without_names_says_that_it_takes_none_and_changes_nothing(hall: str) -> None:
    answer = post_json(signed_in("admin"), "/api/sites/hall/stop?force=1")
    assert (answer.status_code, answer.json()["fields"][0]["message"]) == (
        422, "There is no such name here; the address takes none."
    )  # fmt: skip
    assert Site.objects.get(slug="hall").stop_active is False


def test_strangers_are_told_that_they_are_strangers_first(hall: str) -> None:
    assert signed_in("nobody").get("/api/sites/hall/runs?limti=3").status_code == 401


def test_no_operation_takes_a_name_that_it_does_not_know(hall: str) -> None:
    ids = {**make_one_of_each("hall"), "token_id": "0" * 16}
    client, odd = signed_in("admin"), {}
    for path, calls in OPERATIONS.items():
        for method, call in calls.items():
            with undone():
                answer: Any = getattr(client, method)(path.format(**ids) + "?unheard=1")
            if answer.status_code not in (400, 422):
                odd[call["operationId"]] = answer.status_code
    assert odd == {}

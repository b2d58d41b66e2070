"""What people are called, and whether they hear by e-mail: theirs to change, told to those who see them, on record."""

from __future__ import annotations

from typing import Any

import pytest
from django.test import Client

from registry import services
from registry.models import AuditLine, User
from tests.kit.sign_in import find_person, signed_in

pytestmark = pytest.mark.django_db


def rename(client: Client, name: Any) -> Any:
    return client.put("/api/me/name", {"name": name}, content_type="application/json")


def test_a_new_name_is_told_to_who_sees_one_and_is_in_the_record_of_each_site(hall: str) -> None:
    services.create_site(name="Shed", slug="shed")
    services.set_member(site="shed", email="author@vipo.example", role="viewer")
    client = signed_in("author")
    before = client.get("/api/me").json()["user"]["name"]
    answer = rename(client, "  Ada   von Meyer ")
    assert (answer.status_code, answer.json()["user"]["name"], answer.json()["user"]["initials"]) == (
        200,
        "Ada von Meyer",
        "AM",
    )
    assert client.get("/api/me").json()["user"]["name"] == "Ada von Meyer"
    members = signed_in("admin").get(f"/api/sites/{hall}/members").json()
    assert "Ada von Meyer" in {each["name"] for each in members}
    lines = AuditLine.objects.filter(code="renamed").order_by("site__slug")
    told = [(line.site.slug, line.facts["before"], line.facts["person"]) for line in lines if line.site]
    assert told == [("hall", before, "Ada von Meyer"), ("shed", before, "Ada von Meyer")]
    assert rename(client, "Ada von Meyer").status_code == 200
    assert AuditLine.objects.filter(code="renamed").count() == 2


@pytest.mark.parametrize("name", ["", "   ", "x" * 101, "Ada\nMeyer", "Ada\0", 7, None, ["Ada"]])
def test_what_is_no_name_is_refused(hall: str, name: Any) -> None:
    before = find_person("author").display_name
    assert rename(signed_in("author"), name).status_code == 422
    assert User.objects.get(email="author@vipo.example").display_name == before


def test_strangers_and_tokens_change_no_name(hall: str) -> None:
    assert rename(Client(), "Somebody").status_code == 401
    assert Client().put("/api/me/mail", {"wanted": False}, content_type="application/json").status_code == 401
    assert not AuditLine.objects.filter(code="renamed").exists()


def test_the_initials_of_any_name_fit(hall: str) -> None:
    user = rename(signed_in("author"), "\ufb03 \ufb03").json()["user"]
    assert user["initials"] == "FF"


def test_who_has_no_password_is_told_who_gives_one(hall: str) -> None:
    person, client = find_person("author"), signed_in("author")
    person.set_unusable_password()
    person.save()
    client.force_login(person)
    answer = client.post("/api/me/password", {"old": "", "new": "long enough for all"}, content_type="application/json")
    assert (answer.status_code, answer.json()["code"]) == (409, "no_password")
    assert "vipo account EMAIL --new-password" in answer.json()["detail"]

"""A second factor that a site or the server demands: who lacks it looks only, by every way in, until it is set up."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Any

import pyotp
import pytest
from django.contrib.auth import BACKEND_SESSION_KEY
from django.test import Client
from pytest_django import Settings

from registry import services
from registry.models import AuditLine, SecondFactor, SignOn, User
from registry.people.backends import TWO_FACTORS
from registry.people.sessions import Session, read_standings
from registry.people.tokens import read_standing_roles
from registry.sites.invitations import LinkOver, look_at_link
from tests.kit.api_calls import ask_each, make_one_of_each
from tests.kit.api_rights import RIGHTS
from tests.kit.sign_in import PASSWORD, find_person, post_json, signed_in

RULE = "/api/sites/hall/second-factor"
NOW = datetime(2026, 11, 25, tzinfo=UTC)


def give_factor(name: str) -> None:
    SecondFactor.objects.create(user=find_person(name), secret="-", confirmed_at=NOW)


def demand(least: str | None) -> Any:
    if not SecondFactor.objects.filter(user=find_person("admin")).exists():
        give_factor("admin")
    return signed_in("admin").put(RULE, {"demanded_from": least}, content_type="application/json")


def vouched_session(name: str) -> Client:
    """Return a browser whose session a provider began that vouched for a second factor."""
    client = signed_in(name)
    session = client.session
    session[BACKEND_SESSION_KEY] = TWO_FACTORS
    session.save()
    return client


def standing(client: Client, name: str) -> dict[str, str]:
    session = Session(str(client.session.session_key), find_person(name).pk)
    return dict(read_standings([session])[session].roles)


def make_token(name: str, *scopes: str) -> tuple[int, dict[str, str]]:
    view, text = services.create_token(
        user=find_person(name), site="hall", name="Desk", scopes=scopes, days=1, now=datetime.now(UTC)
    )
    row = User.objects.get(email=f"{name}@vipo.example").memberships.get().tokens.get(public_id=view.id)
    return row.pk, {"HTTP_AUTHORIZATION": f"Bearer {text}"}


def how(answer: Any) -> tuple[int, str]:
    return answer.status_code, answer.json().get("code", "")


def test_an_admin_demands_it_from_a_role_on_and_the_record_tells(hall: str) -> None:
    without = signed_in("admin").put(RULE, {"demanded_from": "operator"}, content_type="application/json")
    assert how(without) == (409, "own_factor_first")
    assert demand("operator").json() == {"demanded_from": "operator", "of_server": None}
    assert signed_in("admin").get(RULE).json()["demanded_from"] == "operator"
    assert how(demand("viewer"))[0] == 422
    roles = {name: signed_in(name).get("/api/sites/hall").json() for name in ("viewer", "commenter", "operator")}
    assert {name: (told["role"], told["held_role"]) for name, told in roles.items()} == {
        "viewer": ("viewer", None),
        "commenter": ("commenter", None),
        "operator": ("viewer", "operator"),
    }
    assert [site["held_role"] for site in signed_in("operator").get("/api/sites").json()] == ["operator"]
    assert demand(None).json()["demanded_from"] is None
    assert signed_in("operator").get("/api/sites/hall").json()["role"] == "operator"
    lines = AuditLine.objects.filter(code="second_factor_demanded").order_by("pk")
    assert [line.facts["role"] for line in lines] == ["operator", ""]


@pytest.mark.usefixtures("impatient")
@pytest.mark.parametrize("way", ["session", "token"])
def test_every_operation_refuses_who_lacks_it_all_that_viewers_may_not(hall: str, way: str) -> None:
    ids = make_one_of_each("hall")
    client = signed_in("admin")
    if way == "token":
        _, bearer = make_token("admin", "admin")
        client = Client(**bearer)
    services.set_member(site="hall", email=find_person("author").email, role="admin")
    give_factor("author")
    put = signed_in("author").put(RULE, {"demanded_from": "operator"}, content_type="application/json")
    assert put.status_code == 200
    odd, refused = {}, 0
    for name, answer in ask_each(client, {**ids, "token_id": "0", "session": "0"}):
        right = RIGHTS[name]
        if not right.is_of_site or (way == "token" and right.scope == "session"):
            continue
        is_refused = answer.status_code == 403 and answer.json()["code"] == "second_factor_demanded"
        refused += is_refused
        if is_refused != (right.role != "viewer"):
            odd[name] = (right.role, answer.status_code, answer.getvalue()[:200])
    assert odd == {}
    assert refused > 40


def test_looking_and_stop_all_stay(hall: str) -> None:
    demand("commenter")
    client = signed_in("operator")
    assert client.get("/api/sites/hall/devices").status_code == 200
    assert post_json(client, "/api/sites/hall/stop").status_code in (200, 201, 204)
    assert how(client.delete("/api/sites/hall/stop"))[1] in {"second_factor_demanded", "no_such_method"}


def test_sockets_and_streams_take_what_the_session_is_good_for(hall: str) -> None:
    client, other = signed_in("author"), vouched_session("author")
    demand("operator")
    assert standing(client, "author") == {"hall": "viewer"}
    assert standing(other, "author") == {"hall": "author"}, "its provider vouched for this session"
    assert (client.get("/api/sites/hall").json()["role"], other.get("/api/sites/hall").json()["role"]) == (
        "viewer",
        "author",
    )
    give_factor("author")
    assert standing(client, "author") == {"hall": "author"}


def test_tokens_do_no_more_than_their_person_may(hall: str) -> None:
    pk, bearer = make_token("operator", "operate")
    demand("operator")
    assert how(Client(**bearer).post("/api/sites/hall/alerts/seen"))[1] in {"second_factor_demanded", "not_found"}
    assert read_standing_roles(token_ids=[pk], now=datetime.now(UTC)) == {pk: {"hall": "viewer"}}
    made = post_json(signed_in("operator"), "/api/sites/hall/tokens", {"name": "Other", "scopes": ["operate"]})
    assert how(made) == (403, "second_factor_demanded")
    read = post_json(signed_in("operator"), "/api/sites/hall/tokens", {"name": "Other", "scopes": ["read"]})
    assert read.status_code == 201
    SignOn.objects.create(user=find_person("operator"), provider="acme", issuer="i", subject="s", linked_at=NOW)
    assert read_standing_roles(token_ids=[pk], now=datetime.now(UTC)) == {pk: {"hall": "viewer"}}
    SignOn.objects.update(had_factor=True)
    assert read_standing_roles(token_ids=[pk], now=datetime.now(UTC)) == {pk: {"hall": "operator"}}


def test_links_of_an_admin_who_lacks_it_let_nobody_in(hall: str) -> None:
    code = post_json(signed_in("admin"), "/api/sites/hall/invitations", {"role": "viewer"}).json()["link"][-32:]
    assert look_at_link(code=code, address="192.0.2.1", now=datetime.now(UTC)).site == "hall"
    demand("operator")
    assert look_at_link(code=code, address="192.0.2.1", now=datetime.now(UTC)).site == "hall"
    SecondFactor.objects.all().delete()
    with pytest.raises(LinkOver):
        look_at_link(code=code, address="192.0.2.1", now=datetime.now(UTC))


def test_setting_one_up_lifts_it_at_once(hall: str) -> None:
    demand("operator")
    client = signed_in("operator")
    secret = post_json(client, "/api/me/second-factor", {"password": PASSWORD}).json()["secret"]
    proof = {"password": PASSWORD, "code": pyotp.TOTP(secret).now()}
    assert post_json(client, "/api/me/second-factor/confirm", proof).status_code == 200
    told = client.get("/api/sites/hall").json()
    assert (told["role"], told["held_role"]) == ("operator", None)


def test_the_server_demands_it_at_all_sites_and_of_who_makes_one(hall: str, settings: Settings) -> None:
    settings.VIPO_SECOND_FACTOR = "author"
    assert signed_in("author").get("/api/sites/hall").json()["held_role"] == "author"
    assert signed_in("operator").get("/api/sites/hall").json()["held_role"] is None
    services.set_site_quota(email=find_person("viewer").email, sites=1)
    made = signed_in("viewer").post("/api/sites", {"name": "Mine"})
    assert how(made) == (403, "second_factor_demanded")
    demand("operator")
    assert signed_in("operator").get("/api/sites/hall").json()["held_role"] == "operator", "a site may demand more"
    assert demand("admin").json() == {"demanded_from": "admin", "of_server": "author"}
    assert signed_in("author").get("/api/sites/hall").json()["held_role"] == "author", "and not less"

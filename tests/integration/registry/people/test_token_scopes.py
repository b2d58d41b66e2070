"""Every operation of the API with a token of each scope: what it may do, and that it does nothing anywhere else."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime
from typing import Any

import pytest
from django.test import Client

from registry import services
from registry.models import ApiToken, Device
from registry.people.access import ROLES, SCOPES, NotAllowed
from tests.kit.api_calls import ask_each, make_one_of_each
from tests.kit.api_rights import RIGHTS
from tests.kit.sign_in import find_person
from tests.kit.sites import ROBOT, describe

pytestmark = pytest.mark.usefixtures("impatient")


@pytest.fixture
def ids(hall: str) -> dict[str, str]:
    """What stands in the addresses: one of each thing at the hall; its admin is one of the shed, too."""
    services.create_site(name="Shed", slug="shed")
    services.set_member(site="shed", email="admin@vipo.example", role="admin")
    services.expect_device(site="shed", device_id="there", credential="t" * 32)
    describe(replace(ROBOT, id="there", site="shed"))
    Device.objects.filter(pk="there").update(lifecycle="approved")
    return {**make_one_of_each("hall"), "token_id": "0" * 16}


def make_token(*scopes: str, site: str = "hall", person: str = "admin", days: int = 1) -> str:
    made = services.create_token(
        user=find_person(person), site=site, name="A program", scopes=scopes, days=days, now=datetime.now(UTC)
    )
    return made[1]


def answers(token: str, ids: dict[str, str]) -> dict[str, Any]:
    """Return what each operation answers a token."""
    return dict(ask_each(Client(enforce_csrf_checks=True, headers={"Authorization": f"Bearer {token}"}), ids))


@pytest.mark.parametrize("scopes", [*((scope,) for scope in SCOPES), ("operate", "run")])
def test_a_token_does_what_its_scopes_say_and_no_more(ids: dict[str, str], scopes: tuple[str, ...]) -> None:
    odd = {}
    for name, answer in answers(make_token(*scopes), ids).items():
        needed = RIGHTS[name].scope
        if needed == "session":
            fits = (answer.status_code, answer.json()["code"]) == (403, "not_for_tokens")
        elif needed in ("anybody", "read", *scopes) or "admin" in scopes:
            fits = needed == "anybody" or answer.status_code not in (401, 403, 500)
        else:
            fits = (answer.status_code, answer.json()["code"]) == (403, "insufficient_scope")
            fits = fits and answer["WWW-Authenticate"] == 'Bearer error="insufficient_scope"'
        if not fits:
            odd[name] = (needed, answer.status_code, answer.content[:200])
    assert odd == {}


@pytest.mark.parametrize(
    ("scopes", "role"),
    [(("read",), "viewer"), (("operate",), "operator"), (("run",), "author"), (("operate", "run"), "author"),
     (("admin",), "admin")],
)  # fmt: skip
def test_a_scope_stretches_to_the_highest_role_whose_deeds_need_it(
    hall: str, scopes: tuple[str, ...], role: str
) -> None:
    client = Client(headers={"Authorization": f"Bearer {make_token(*scopes)}"})
    assert client.get("/api/sites/hall").json()["role"] == role


def test_commenters_give_tokens_for_programs_that_comment_and_viewers_do_not(hall: str) -> None:
    client = Client(headers={"Authorization": f"Bearer {make_token('run', person='commenter')}"})
    assert client.get("/api/sites/hall").json()["role"] == "commenter"
    with pytest.raises(NotAllowed, match="a token for run needs the role commenter"):
        make_token("run", person="viewer")


@pytest.mark.parametrize("role", ROLES[:-1])
def test_a_token_may_no_more_than_its_person_may_at_that_moment(ids: dict[str, str], role: str) -> None:
    token = make_token("admin")
    services.set_member(site="hall", email="admin@vipo.example", role=role)
    seen = answers(token, ids)
    refused = {name for name in seen if RIGHTS[name].role != "anybody" and seen[name].status_code == 403}
    beyond = ROLES[ROLES.index(role) + 1 :]
    assert refused == {name for name, right in RIGHTS.items() if right.scope == "session" or right.role in beyond}


def test_at_other_sites_of_its_person_a_token_is_a_strangers(ids: dict[str, str]) -> None:
    token = make_token("admin", site="shed")
    seen = answers(token, ids)
    listed = {name for name, answer in seen.items() if answer.status_code == 200}
    assert listed == {"show_me", "list_sites", "search_library", "list_rights", "list_sign_on_providers"}
    assert [site["slug"] for site in seen["list_sites"].json()] == ["shed"]
    others = {name for name, right in RIGHTS.items() if right.scope not in ("session", "anybody")} - listed
    assert {seen[name].status_code for name in others} == {404}
    client = Client(headers={"Authorization": f"Bearer {token}"})
    assert [thing["id"] for thing in client.get("/things").json()] == ["urn:vipo:device:there"]
    assert (client.get("/things/robot-hall").status_code, client.get("/things/there").status_code) == (404, 200)


@pytest.mark.parametrize("end", ["expired", "revoked", "removed", "closed", "another secret"])
def test_a_token_that_has_ended_opens_nothing(ids: dict[str, str], end: str) -> None:
    token = make_token("admin")
    if end == "expired":
        ApiToken.objects.update(expires_at=datetime.now(UTC))
    elif end == "revoked":
        services.revoke_token(token_id=token.split("_")[1])
    elif end == "removed":
        services.remove_member(site="hall", email="admin@vipo.example")
        services.set_member(site="hall", email="admin@vipo.example", role="admin")
    elif end == "closed":
        person = find_person("admin")
        person.is_active = False
        person.save()
    else:
        token = token[:-1] + ("a" if token[-1] != "a" else "b")
    odd = {}
    for name, answer in answers(token, ids).items():
        if RIGHTS[name].scope not in ("anybody", "session") and (
            answer.status_code,
            answer["Content-Type"],
            answer.json()["code"],
            answer.get("WWW-Authenticate"),
        ) != (401, "application/problem+json", "invalid_token", 'Bearer error="invalid_token"'):
            odd[name] = (answer.status_code, answer.content[:100])
    assert odd == {}

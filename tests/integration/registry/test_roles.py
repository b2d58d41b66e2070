"""Every operation of the API, asked by everybody and a wall screen about what is theirs and another site's."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Any

import pytest
from django.test import Client

from registry import services
from registry.floorplan.plan import Grid
from registry.models import SignOn
from registry.people.access import ROLES
from registry.people.wall_screens import COOKIE, key_of
from tests.kit.api_calls import ask_each, make_one_of_each
from tests.kit.api_rights import OPERATIONS, RIGHTS
from tests.kit.sign_in import add_person, find_person, signed_in

ASKERS = {
    "nobody": ("", ""),
    "wall": ("", ""),
    "shed-viewer": ("shed", "viewer"),
    "shed-admin": ("shed", "admin"),
    **{role: ("hall", role) for role in ROLES},
}
"""Who asks: their site and role; nobody, and a wall screen of the hall, have none."""
NO_SESSION = ("nobody", "wall")
SIGNING_IN = ("sign_in", "begin_provider_sign_on", "finish_provider_sign_on", "end_sessions_of_provider")
pytestmark = pytest.mark.usefixtures("impatient")


@pytest.fixture
def sites(hall: str) -> dict[str, dict[str, str]]:
    """Two sites with one of each thing, and what stands in addresses that name them."""
    services.create_site(name="Shed", slug="shed")
    services.save_map(site="shed", grid=Grid(4, 3, 1.0, 0.0, 0.0, bytes(12)))
    for role in ("viewer", "admin"):
        email = add_person(f"shed-{role}").email
        services.set_member(site="shed", email=email, role=role)
    return {slug: make_one_of_each(slug) for slug in ("hall", "shed")}


def token_of(person: str, site: str) -> str:
    """Return the id of a token of this person at the site."""
    made = services.create_token(
        user=find_person(person), site=site, name="Mine", scopes=["read"], days=1, now=datetime.now(UTC)
    )
    return made[0].id


def own_session(client: Client, person: str) -> str:
    """Return the id of the session of who asks."""
    return "0" if person in NO_SESSION else str(client.get("/api/me/sessions").json()[0]["id"])


def own_sign_on(person: str) -> str:
    """Return the number of an account of a provider that who asks is linked with."""
    if person in NO_SESSION:
        return "0"
    told = {"provider": "none", "issuer": "https://none.example", "subject": person, "linked_at": datetime.now(UTC)}
    return str(SignOn.objects.create(user=find_person(person), **told).pk)


def expected(name: str, person: str, site: str) -> int:
    """Return the status with which somebody is refused, by the one table; 0 if they get through."""
    right, (home, role) = RIGHTS[name], ASKERS[person]
    if right.role == "anybody":
        return 0
    if person in NO_SESSION:
        return 401
    if not right.is_of_site:
        return 403 if right.role == "maker" else 0
    if home != site:
        return 404
    return 0 if ROLES.index(role) >= ROLES.index(right.role) else 403


def refusal(name: str, answer: Any) -> int:
    """Return the status if it says who may not; a wrong password, or a provider that is none, at signing in is none."""
    return answer.status_code if answer.status_code in (401, 403, 404, 405) and name not in SIGNING_IN else 0


def test_every_operation_stands_in_the_table_once() -> None:
    named = [call["operationId"] for calls in OPERATIONS.values() for call in calls.values()]
    assert sorted(named) == sorted(RIGHTS)


@pytest.mark.parametrize("site", ["hall", "shed"])
@pytest.mark.parametrize("person", ASKERS)
def test_each_person_and_a_wall_screen_may_do_what_the_table_says_and_nothing_else(
    sites: dict[str, dict[str, str]], person: str, site: str
) -> None:
    mine = person not in NO_SESSION and ASKERS[person][0] == site
    token = token_of(person if mine else "admin" if site == "hall" else "shed-admin", site)
    client, odd, asked = signed_in("nobody" if person == "wall" else person), {}, 0
    if person == "wall":
        client.cookies[COOKIE] = key_of(sites["hall"]["wall_code"])
    named = {**sites[site], "token_id": token, "session": own_session(client, person)}
    named["sign_on"] = own_sign_on(person)
    for name, answer in ask_each(client, named):
        asked += 1
        told = (refusal(name, answer), answer.status_code < 500)
        if told != (expected(name, person, site), True):
            odd[name] = (expected(name, person, site), answer.status_code, answer.getvalue()[:200])
    assert odd == {}
    assert asked == len(RIGHTS)

"""Two people at once at members, tokens and invitations."""

from __future__ import annotations

import pytest
from django.test import Client

from registry import services
from registry.models import (
    ApiToken,
    AuditLine,
    Invitation,
    Membership,
)
from tests.integration.registry.at_once.presses import (
    OF_INVITATION,
    OF_MEMBER,
    OF_SITE,
    SITE,
    Press,
    press_together,
    told,
)
from tests.kit.sign_in import add_person, find_person, post_json, signed_in

pytestmark = pytest.mark.servers


def make_token(who: str) -> Press:
    client = signed_in(who)
    return lambda: post_json(client, f"{SITE}/tokens", {"name": "Display", "scopes": ["read"]})


def remove(who: str) -> Press:
    return lambda: services.remove_member(site="hall", email=f"{who}@vipo.example")


def shown(token: str) -> int:
    return Client(headers={"Authorization": f"Bearer {token}"}).get(SITE).status_code


def test_a_member_who_makes_a_token_while_they_are_removed_is_removed_with_it(url: str) -> None:
    made, removed = press_together(url, OF_MEMBER, make_token("viewer"), remove("viewer"))
    assert (made.status_code, removed) == (201, None)
    assert (shown(made.json()["token"]), ApiToken.objects.count()) == (401, 0)
    assert not Membership.objects.filter(user=find_person("viewer")).exists()


def test_a_member_who_was_removed_makes_no_token(url: str) -> None:
    removed, made = press_together(url, OF_MEMBER, remove("viewer"), make_token("viewer"))
    assert (removed, told([made])) == (None, [(404, "not_found")])
    assert ApiToken.objects.count() == 0


def set_role(who: str, role: str) -> Press:
    return lambda: services.set_member(site="hall", email=f"{who}@vipo.example", role=role)


def test_a_role_that_is_changed_before_a_member_is_removed_does_not_bring_them_back(url: str) -> None:
    assert press_together(url, OF_MEMBER, set_role("viewer", "admin"), remove("viewer")) == [None, None]
    assert not Membership.objects.filter(user=find_person("viewer")).exists()


def test_a_role_that_is_given_after_a_member_was_removed_is_given_anew_without_their_tokens(url: str) -> None:
    token = make_token("viewer")().json()["token"]
    assert press_together(url, OF_MEMBER, remove("viewer"), set_role("viewer", "admin")) == [None, None]
    assert Membership.objects.get(user=find_person("viewer")).role == "admin"
    assert (shown(token), ApiToken.objects.count()) == (401, 0)


def test_two_roles_that_are_given_at_once_are_one(url: str) -> None:
    assert press_together(url, OF_MEMBER, set_role("viewer", "author"), set_role("viewer", "operator")) == [None] * 2
    assert Membership.objects.get(user=find_person("viewer")).role == "operator"


def change_role(who: str, whose: str, role: str) -> Press:
    client, path = signed_in(who), f"{SITE}/members/{find_person(whose).pk}"
    return lambda: client.patch(path, {"role": role}, content_type="application/json")


def leave(who: str) -> Press:
    client = signed_in(who)
    return lambda: post_json(client, f"{SITE}/leave")


@pytest.mark.parametrize(
    ("way", "refusal"),
    [
        ("lower each other", (403, "not_allowed")),
        ("lower themselves", (409, "last_admin")),
        ("leave", (409, "last_admin")),
        ("remove each other", (404, "not_found")),
    ],
)
def test_of_two_admins_who_both_go_at_once_one_stays(url: str, way: str, refusal: object) -> None:
    admin, chief = signed_in("admin"), signed_in("chief")
    people = {who: f"{SITE}/members/{find_person(who).pk}" for who in ("admin", "chief")}
    presses = {
        "lower each other": (change_role("admin", "chief", "viewer"), change_role("chief", "admin", "viewer")),
        "lower themselves": (change_role("admin", "admin", "viewer"), change_role("chief", "chief", "viewer")),
        "leave": (leave("admin"), leave("chief")),
        "remove each other": (lambda: admin.delete(people["chief"]), lambda: chief.delete(people["admin"])),
    }[way]
    answers = press_together(url, OF_SITE, *presses)
    assert answers[0].status_code in (200, 204)
    assert told(answers[1:]) == [refusal]
    assert Membership.objects.filter(role="admin").count() == 1


def use_link(who: str, code: str) -> Press:
    client = signed_in(who)
    return lambda: post_json(client, "/api/invitations/accept", {"code": code})


def make_link(uses: int) -> tuple[int, str]:
    made = post_json(signed_in("chief"), f"{SITE}/invitations", {"role": "author", "uses": uses}).json()
    return made["id"], made["link"].partition("#")[2]


def test_the_last_use_of_a_link_is_one_persons(url: str) -> None:
    add_person("guest")
    _, code = make_link(1)
    answers = press_together(url, OF_INVITATION, use_link("stranger", code), use_link("guest", code))
    assert told(answers) == [200, (410, "link_over")]
    assert Invitation.objects.get().used == 1
    assert not Membership.objects.filter(user=find_person("guest")).exists()


def test_one_person_who_opens_a_link_twice_uses_it_once(url: str) -> None:
    _, code = make_link(5)
    answers = press_together(url, OF_INVITATION, use_link("stranger", code), use_link("stranger", code))
    assert told(answers) == [200, (409, "already_member")]
    assert (Invitation.objects.get().used, AuditLine.objects.filter(code="joined").count()) == (1, 1)


def test_a_link_that_is_revoked_while_it_is_used_lets_nobody_in_afterwards(url: str) -> None:
    number, code = make_link(5)
    client = signed_in("admin")
    answers = press_together(
        url,
        OF_INVITATION,
        lambda: client.delete(f"{SITE}/invitations/{number}"),
        use_link("stranger", code),
    )
    assert told(answers) == [204, (410, "link_over")]
    assert not Membership.objects.filter(user=find_person("stranger")).exists()


def test_who_joins_while_whoever_invited_them_is_lowered_was_first(url: str) -> None:
    _, code = make_link(5)
    answers = press_together(url, OF_INVITATION, use_link("stranger", code), change_role("admin", "chief", "author"))
    assert told(answers) == [200, 200]
    assert Membership.objects.get(user=find_person("stranger")).role == "author"
    assert Invitation.objects.get().revoked_at is not None

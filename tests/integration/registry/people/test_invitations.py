"""Invitations: a link lets in whom it was made for, as often and as long as was said, and tells strangers nothing."""

from __future__ import annotations

import re
from datetime import UTC, datetime, timedelta
from typing import Any

import pytest
from django.core import mail
from django.test import Client
from pytest_django import Settings

from registry import services
from registry.models import AuditLine, Invitation, Membership, User
from registry.people import throttle
from registry.sites.invitations import prune_invitations
from tests.kit.sign_in import add_person, find_person, post_json, signed_in

SITE = "/api/sites/hall"
INVITATIONS = f"{SITE}/invitations"


def invite(who: str = "admin", **wanted: Any) -> Any:
    return post_json(signed_in(who), INVITATIONS, {"role": "author", **wanted})


def code_of(answer: Any) -> str:
    return str(answer.json()["link"]).partition("#")[2]


def look(code: str, client: Client | None = None) -> Any:
    return post_json(client or Client(), "/api/invitations/look", {"code": code})


def accept(who: str, code: str) -> Any:
    return post_json(signed_in(who), "/api/invitations/accept", {"code": code})


def join(code: str, name: str = "nora", client: Client | None = None, **other: str) -> Any:
    person = {"name": f"{name.title()} Lind", "email": f"{name}@fab.example", "password": "four odd words here"}
    return post_json(client or Client(), "/api/invitations/join", {"code": code, **person, **other})


def listed() -> list[tuple[str, int, list[str]]]:
    found = signed_in("admin").get(INVITATIONS).json()["invitations"]
    return [(each["state"], each["used"], each["people"]) for each in found]


def test_a_link_is_told_once_and_its_hash_alone_is_kept(hall: str) -> None:
    made = invite()
    code = code_of(made)
    assert made.json()["link"] == f"http://testserver/invitation#{code}"
    assert (made["Cache-Control"], len(code)) == ("no-store", 32)
    kept = " ".join(map(str, Invitation.objects.values_list().get()))
    assert code not in kept
    assert code not in signed_in("admin").get(INVITATIONS).content.decode()
    assert code not in str(list(AuditLine.objects.values()))


def test_a_link_says_what_it_offers(hall: str) -> None:
    said = look(code_of(invite(role="operator"))).json()
    assert (said["site_name"], said["role"], said["invited_by"]) == ("Hall", "operator", "Admin Person")


def test_somebody_who_is_signed_in_joins_by_a_link(hall: str) -> None:
    code = code_of(invite())
    assert accept("stranger", code).json() == {"site": "hall"}
    member = Membership.objects.get(user=find_person("stranger"))
    assert (member.role, member.joined_at is not None) == ("author", True)
    assert listed() == [("used_up", 1, ["Stranger Person"])]
    line = AuditLine.objects.get(code="joined")
    assert (line.actor_kind, line.actor, line.person_id) == ("person", "Stranger Person", member.user_id)
    assert line.facts == {"role": "author", "invited_by": "Admin Person"}
    members = {each["name"]: each["came_by"] for each in signed_in("admin").get(f"{SITE}/members").json()}
    assert members["Stranger Person"] == "Admin Person"


def test_somebody_new_makes_an_account_by_a_link_and_is_in(hall: str) -> None:
    client = Client()
    answer = join(code_of(invite()), client=client)
    assert (answer.status_code, answer.json()) == (201, {"site": "hall"})
    assert client.get("/api/me").json()["user"]["name"] == "Nora Lind"
    assert post_json(client, f"{SITE}/programs", {"name": "First"}).status_code == 201
    line = AuditLine.objects.get(code="joined")
    assert (line.actor, line.address) == ("Nora Lind", "127.0.0.1")


@pytest.mark.parametrize(
    ("other", "code"),
    [
        ({"password": "short"}, "bad_password"),
        ({"email": "no address"}, "bad_person"),
        ({"email": "Viewer@vipo.example"}, "bad_person"),
    ],
)
def test_an_account_that_cannot_be_made_uses_nothing_of_the_link(hall: str, other: dict[str, str], code: str) -> None:
    link = code_of(invite())
    answer = join(link, **other)
    assert (answer.status_code, answer.json()["code"]) == (422, code)
    assert (listed(), User.objects.filter(email="nora@fab.example").exists()) == ([("open", 0, [])], False)
    assert join(link).status_code == 201


def test_a_link_is_good_for_so_many_people(hall: str) -> None:
    code = code_of(invite(uses=2))
    assert [join(code, name).status_code for name in ("nora", "tom", "mira")] == [201, 201, 410]
    assert look(code).json()["detail"] == "This invitation was used as often as it may be. Ask for another one."
    assert not User.objects.filter(email="mira@fab.example").exists()
    assert listed() == [("used_up", 2, ["Nora Lind", "Tom Lind"])]


@pytest.mark.parametrize(
    ("end", "why"),
    [
        ("expired", "expired"),
        ("revoked", "revoked"),
        ("its maker was lowered", "revoked"),
        ("its maker's account was closed", "revoked"),
        ("its maker's access ended", "revoked"),
    ],
)
def test_a_link_that_is_over_says_so_and_not_whose_it_was(hall: str, end: str, why: str) -> None:
    services.set_member(site="hall", email=add_person("chief").email, role="admin")
    made = invite("chief")
    code = code_of(made)
    if end == "expired":
        Invitation.objects.update(expires_at=datetime.now(UTC))
    elif end == "revoked":
        assert signed_in("admin").delete(f"{INVITATIONS}/{made.json()['id']}").status_code == 204
    elif end == "its maker was lowered":
        services.set_member(site="hall", email="chief@vipo.example", role="author")
    elif end == "its maker's account was closed":
        services.close_account(email="chief@vipo.example")
    else:
        Membership.objects.filter(user=find_person("chief")).update(ends_at=datetime.now(UTC))
    for answer in (look(code), accept("stranger", code), join(code)):
        assert (answer.status_code, answer.json()["code"]) == (410, "link_over")
        assert answer.json()["args"] == {"why": why}
        assert not re.search("hall|chief", answer.content.decode(), re.IGNORECASE)
    assert Membership.objects.filter(user=find_person("stranger")).count() == 0


def test_a_wrong_code_is_refused_alike_whatever_there_is_and_counted(hall: str) -> None:
    code = code_of(invite(uses=5))
    wrong = [ending for ending in "0123456789" if ending != code[-1]][:8]
    refusals = [look(f"{code[:-1]}{ending}") for ending in wrong]
    assert {(each.status_code, each.json()["code"]) for each in refusals} == {(404, "unknown_link")}
    held = look(code)
    assert (held.status_code, held.json()["args"]["why"], held.json()["args"]["minutes"]) == (429, "link", 15)
    assert accept("stranger", code).status_code == 429
    assert look(code, Client(REMOTE_ADDR="10.1.2.3")).status_code == 200
    assert AuditLine.objects.filter(code="sign_in_locked").count() == 0
    throttle.SignInFailure.objects.update(at=datetime.now(UTC) - throttle.WINDOW)
    assert look(code).status_code == 200


def test_links_that_are_over_do_not_hold_up_who_opens_them(hall: str) -> None:
    code = code_of(invite())
    Invitation.objects.update(expires_at=datetime.now(UTC))
    assert {look(code).status_code for _ in range(12)} == {410}


def test_a_member_uses_nothing_of_a_link(hall: str) -> None:
    code = code_of(invite())
    answer = accept("viewer", code)
    assert (answer.status_code, answer.json()["code"]) == (409, "already_member")
    assert (Membership.objects.get(user=find_person("viewer")).role, listed()) == ("viewer", [("open", 0, [])])


def test_whose_access_has_ended_comes_back_by_a_link(hall: str) -> None:
    Membership.objects.filter(user=find_person("viewer")).update(ends_at=datetime.now(UTC))
    assert accept("viewer", code_of(invite(role="operator"))).status_code == 200
    member = Membership.objects.get(user=find_person("viewer"))
    assert (member.role, member.ends_at) == ("operator", None)


@pytest.mark.parametrize("wanted", [{"days": 0}, {"days": 91}, {"uses": 0}, {"uses": 101}, {"role": "owner"}])
def test_an_invitation_has_bounds(hall: str, wanted: dict[str, Any]) -> None:
    assert invite(**wanted).status_code == 422
    assert Invitation.objects.count() == 0


def test_a_site_has_so_many_open_invitations(hall: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("registry.sites.invitations.MOST_OPEN", 1)
    first = invite()
    assert invite().json()["code"] == "too_many_invitations"
    signed_in("admin").delete(f"{INVITATIONS}/{first.json()['id']}")
    assert invite().status_code == 201


def test_invitations_that_ended_long_ago_are_forgotten(hall: str) -> None:
    accept("stranger", code_of(invite()))
    assert prune_invitations(now=datetime.now(UTC) + timedelta(days=36)) == 0
    assert prune_invitations(now=datetime.now(UTC) + timedelta(days=38)) == 1
    assert Membership.objects.filter(user=find_person("stranger")).exists()


def test_an_invitation_is_sent_by_mail_where_the_server_can(hall: str, settings: Settings) -> None:
    settings.EMAIL_HOST, settings.DEFAULT_FROM_EMAIL = "mail.example", "vipo@fab.example"
    assert signed_in("admin").get(INVITATIONS).json()["can_mail"] is True
    made = invite(email="Nora@fab.example").json()
    assert (made["mailed"], made["email"]) == (True, "nora@fab.example")
    sent = mail.outbox[0]
    assert (sent.to, sent.from_email) == (["nora@fab.example"], "vipo@fab.example")
    assert (made["link"] in sent.body, "Admin Person" in sent.subject) == (True, True)
    assert join(code_of_link(made["link"])).status_code == 201


def code_of_link(link: str) -> str:
    return link.partition("#")[2]


def test_a_mail_server_that_does_not_answer_is_told_and_the_link_holds(hall: str, settings: Settings) -> None:
    settings.EMAIL_HOST, settings.EMAIL_PORT, settings.EMAIL_USE_TLS = "127.0.0.1", 1, False
    settings.EMAIL_BACKEND = "django.core.mail.backends.smtp.EmailBackend"
    made = invite(email="nora@fab.example")
    assert (made.status_code, made.json()["mailed"]) == (201, False)
    assert look(code_of(made)).status_code == 200


def test_without_a_mail_server_the_link_is_the_only_way(hall: str) -> None:
    assert signed_in("admin").get(INVITATIONS).json()["can_mail"] is False
    answer = invite(email="nora@fab.example")
    assert (answer.status_code, answer.json()["code"]) == (422, "bad_invitation")


@pytest.mark.parametrize("address", ["look", "join"])
def test_a_foreign_page_cannot_use_a_link_for_somebody(hall: str, address: str) -> None:
    code = code_of(invite())
    client = Client(enforce_csrf_checks=True)
    answer = look(code, client) if address == "look" else join(code, client=client)
    assert answer.status_code == 403
    assert Invitation.objects.get().used == 0

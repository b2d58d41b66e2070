"""Members over HTTP: seen, changed at once, with an end of access, removed with all that is theirs; one admin stays."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from typing import Any

import pytest
from django.test import Client

from registry import services
from registry.models import ApiToken, AuditLine, Invitation, Membership
from registry.people.seen import Seen, note_seen
from registry.people.sessions import Session, read_standings
from registry.people.wall_screens import make_wall_screen
from registry.sites.invitations import Wanted, make_invitation
from tests.kit.sign_in import add_person, find_person, post_json, signed_in

SITE = "/api/sites/hall"
MEMBERS = f"{SITE}/members"


def path_of(name: str) -> str:
    return f"{MEMBERS}/{find_person(name).pk}"


def change(who: str, name: str, **change: Any) -> Any:
    return signed_in(who).patch(path_of(name), change, content_type="application/json")


def make_token(who: str) -> str:
    made = services.create_token(
        user=find_person(who), site="hall", name=f"Display of {who}", scopes=["read"], days=1, now=datetime.now(UTC)
    )
    return made[1]


def invite(who: str) -> None:
    make_invitation(site="hall", by=find_person(who), wanted=Wanted("viewer", 7, 1), now=datetime.now(UTC))


def role_of(name: str) -> str:
    return Membership.objects.get(user=find_person(name)).role


def acts(kind: str = "roles") -> list[tuple[str, str, dict[str, Any]]]:
    """Return who did what since the site was made, the first one first."""
    lines = AuditLine.objects.filter(kind=kind, site__slug="hall").exclude(code="member_added").order_by("pk")
    return [(line.actor, line.code, line.facts) for line in lines]


def test_an_admin_sees_all_members_and_others_see_themselves(hall: str) -> None:
    seen = signed_in("admin").get(MEMBERS).json()
    assert [(member["name"], member["role"], member["me"]) for member in seen] == [
        ("Admin Person", "admin", True),
        ("Author Person", "author", False),
        ("Commenter Person", "commenter", False),
        ("Operator Person", "operator", False),
        ("Viewer Person", "viewer", False),
    ]
    own = signed_in("author").get(MEMBERS).json()
    assert [(member["email"], member["me"]) for member in own] == [("author@vipo.example", True)]


def test_a_role_that_is_changed_holds_at_once_and_is_written_down(hall: str) -> None:
    viewer = signed_in("viewer")
    assert post_json(viewer, f"{SITE}/programs", {"name": "Mine"}).status_code == 403
    answer = change("admin", "viewer", role="author")
    assert (answer.status_code, answer.json()["role"]) == (200, "author")
    assert post_json(viewer, f"{SITE}/programs", {"name": "Mine"}).status_code == 201
    assert acts() == [
        ("Admin Person", "role_changed", {"person": "Viewer Person", "before": "viewer", "after": "author"})
    ]


def test_a_role_that_is_given_again_is_no_change(hall: str) -> None:
    assert change("admin", "viewer", role="viewer").status_code == 200
    assert acts() == []


@pytest.mark.parametrize("way", ["lowered", "given an end", "removed", "leaving"])
def test_the_last_admin_stays(hall: str, way: str) -> None:
    client = signed_in("admin")
    tomorrow = (datetime.now(UTC) + timedelta(days=1)).isoformat()
    answer = {
        "lowered": lambda: change("admin", "admin", role="author"),
        "given an end": lambda: change("admin", "admin", ends_at=tomorrow),
        "removed": lambda: client.delete(path_of("admin")),
        "leaving": lambda: post_json(client, f"{SITE}/leave"),
    }[way]()
    assert (answer.status_code, answer.json()["code"]) == (409, "last_admin")
    assert answer.json()["detail"].startswith("Admin Person is the last admin of this site. Make somebody else")
    assert (role_of("admin"), acts()) == ("admin", [])


@pytest.mark.parametrize("other", ["with an end", "closed"])
def test_an_admin_who_will_not_stay_does_not_count_as_another_one(hall: str, other: str) -> None:
    services.set_member(site="hall", email=add_person("chief").email, role="admin")
    if other == "closed":
        services.close_account(email="chief@vipo.example")
    else:
        Membership.objects.filter(user=find_person("chief")).update(ends_at=datetime.now(UTC) + timedelta(days=1))
    assert post_json(signed_in("admin"), f"{SITE}/leave").json()["code"] == "last_admin"


def test_an_admin_beside_another_one_may_go(hall: str) -> None:
    services.set_member(site="hall", email=add_person("chief").email, role="admin")
    assert post_json(signed_in("admin"), f"{SITE}/leave").status_code == 204
    assert signed_in("admin").get(SITE).status_code == 404
    assert acts()[-1] == ("Admin Person", "member_left", {"person": "Admin Person", "tokens": []})


def test_removal_says_beforehand_what_it_ends_and_ends_that(hall: str) -> None:
    services.set_member(site="hall", email=add_person("chief").email, role="admin")
    token, session = make_token("chief"), signed_in("chief")
    invite("chief")
    key = Session(str(session.session.session_key), find_person("chief").pk)
    wall = {"site": "hall", "days": 1, "now": datetime.now(UTC)}
    make_wall_screen(**wall, by=find_person("chief"), name="East wall")
    make_wall_screen(**wall, by=find_person("admin"), name="West wall")
    ending = {"tokens": ["Display of chief"], "invitations": 1, "signs_out": True, "wall_screens_left": ["East wall"]}
    admin = signed_in("admin")
    assert admin.get(path_of("chief")).json()["ending"] == ending
    assert admin.delete(path_of("chief")).json() == ending
    assert Client(headers={"Authorization": f"Bearer {token}"}).get(SITE).status_code == 401
    assert ApiToken.objects.count() == 0
    assert Invitation.objects.get().revoked_at is not None
    assert (session.get("/api/me/sessions").status_code, read_standings([key])) == (401, {})
    assert admin.get(path_of("chief")).status_code == 404
    assert acts()[-1] == (
        "Admin Person",
        "member_removed",
        {"person": "Chief Person", "tokens": ["Display of chief"]},
    )


def test_whoever_has_another_site_stays_signed_in_there(hall: str) -> None:
    services.create_site(name="Shed", slug="shed")
    services.set_member(site="shed", email="viewer@vipo.example", role="viewer")
    viewer = signed_in("viewer")
    assert signed_in("admin").delete(path_of("viewer")).json()["signs_out"] is False
    assert (viewer.get(SITE).status_code, viewer.get("/api/sites/shed").status_code) == (404, 200)


def test_who_may_invite_no_more_has_no_open_invitations(hall: str) -> None:
    services.set_member(site="hall", email=add_person("chief").email, role="admin")
    invite("chief")
    assert change("admin", "chief", role="author").status_code == 200
    assert Invitation.objects.get().revoked_at is not None


def test_access_ends_when_it_was_said_also_of_tokens_and_open_pages(hall: str) -> None:
    token, viewer = make_token("viewer"), signed_in("viewer")
    key = Session(str(viewer.session.session_key), find_person("viewer").pk)
    until = datetime.now(UTC) + timedelta(days=1)
    assert change("admin", "viewer", ends_at=until.isoformat()).status_code == 200
    assert viewer.get(SITE).status_code == 200
    assert read_standings([key])[key].allows("hall", "viewer")
    Membership.objects.filter(user=find_person("viewer")).update(ends_at=datetime.now(UTC))
    assert (viewer.get(SITE).status_code, viewer.get("/api/sites").json()) == (404, [])
    assert not read_standings([key])[key].allows("hall", "viewer")
    assert Client(headers={"Authorization": f"Bearer {token}"}).get(SITE).status_code == 401
    assert make_token_answer(viewer) == 404
    assert change("admin", "viewer", ends_at=None).json()["ends_at"] is None
    assert viewer.get(SITE).status_code == 200
    told = [(code, facts["until"]) for _, code, facts in acts()]
    assert told == [("access_end_set", until.isoformat(timespec="minutes")), ("access_end_set", None)]


def make_token_answer(client: Client) -> int:
    return int(post_json(client, f"{SITE}/tokens", {"name": "Late", "scopes": ["read"]}).status_code)


@pytest.mark.parametrize("days", [-1, 4000])
def test_an_end_that_is_past_or_too_far_is_refused(hall: str, days: int) -> None:
    answer = change("admin", "viewer", ends_at=(datetime.now(UTC) + timedelta(days=days)).isoformat())
    assert (answer.status_code, answer.json()["code"]) == (422, "bad_end")
    assert Membership.objects.get(user=find_person("viewer")).ends_at is None


@pytest.mark.parametrize("end", ["2027-01-01T00:00:00", "2027-01-01"])
def test_an_end_without_a_time_zone_is_refused_at_its_field(hall: str, end: str) -> None:
    answer = change("admin", "viewer", ends_at=end)
    assert (answer.status_code, answer.json()["fields"]) == (
        422,
        [{"field": "body.ends_at", "message": "Input should have timezone info"}],
    )
    assert Membership.objects.get(user=find_person("viewer")).ends_at is None


def test_who_serves_vipo_may_take_the_last_admin_away(hall: str) -> None:
    services.set_member(site="hall", email="admin@vipo.example", role="viewer")
    services.remove_member(site="hall", email="admin@vipo.example")
    assert [line[:2] for line in acts()] == [("", "role_changed"), ("", "member_removed")]


def test_who_looks_is_noted_once_a_minute(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = [1000.0]
    monkeypatch.setattr("registry.people.seen.time.monotonic", lambda: clock[0])
    seen = Seen()
    assert seen.take_due({(1, "hall")}) == {(1, "hall")}
    clock[0] += 59
    assert seen.take_due({(1, "hall"), (2, "hall")}) == {(2, "hall")}
    clock[0] += 1
    assert seen.take_due({(1, "hall"), (2, "hall")}) == {(1, "hall"), (2, "hall")}


def test_that_somebody_looks_is_told_to_admins(hall: str) -> None:
    note_seen({(find_person("viewer").pk, "hall"), (find_person("stranger").pk, "hall")})
    seen = {member["name"]: member["seen_at"] for member in signed_in("admin").get(MEMBERS).json()}
    assert [name for name, at in seen.items() if at is not None] == ["Viewer Person"]

"""Two people at each decision at once, on PostgreSQL: one wins, nothing is half done, the other is told what happened.

Both press while the test holds the row or table that they need, in a known order, and then it lets go.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from datetime import UTC, datetime
from typing import Any

import psycopg
import pytest
from django.core.files.uploadedfile import SimpleUploadedFile
from django.db import connection
from django.test import Client
from pytest_django import DjangoDbBlocker

from editor import services as editor
from editor.models import LibraryFunction
from registry import services
from registry.models import (
    ApiToken,
    AuditLine,
    Device,
    DeviceEvent,
    Invitation,
    Membership,
    Site,
    ThingEvent,
    TopicClaim,
)
from tests.kit.databases import on_database
from tests.kit.programs import document
from tests.kit.sign_in import add_person, find_person, post_json, signed_in
from tests.kit.sites import MIXER, approve, describe, make_hall, may_come_in
from tests.kit.waiting import wait_for
from vipo_device.protocol.description import MethodSpec
from vipo_site.settings import postgres

pytestmark = pytest.mark.servers
SITE = "/api/sites/hall"
MIXER_PATH = f"{SITE}/devices/{MIXER.id}"
OF_DEVICE = f"SELECT 1 FROM registry_device WHERE id = '{MIXER.id}' FOR UPDATE"
OF_MEMBER = "SELECT 1 FROM registry_membership FOR UPDATE"
OF_INVITATION = "SELECT 1 FROM registry_invitation FOR UPDATE"
OF_SITE = "SELECT 1 FROM registry_site FOR UPDATE"
OF_PERSON = "SELECT 1 FROM registry_user FOR UPDATE"
ANY_DEVICE = "LOCK TABLE registry_device IN EXCLUSIVE MODE"
WAITING = "SELECT count(*) FROM pg_stat_activity WHERE datname = current_database() AND wait_event_type = 'Lock'"
Press = Callable[[], Any]


@pytest.fixture
def url(database_url: str, django_db_blocker: DjangoDbBlocker) -> Iterator[str]:
    """A site of which there are two admins, on a PostgreSQL that other threads reach, too."""
    with django_db_blocker.unblock(), on_database(**postgres(database_url)):
        make_hall()
        services.set_member(site="hall", email=add_person("chief").email, role="admin")
        yield database_url


def press_together(url: str, held: str, *presses: Press) -> list[Any]:
    """Let all press while this is held, one after the other; return what each is told, or the exception."""
    with (
        psycopg.connect(url) as holder,
        psycopg.connect(url, autocommit=True) as looking,
        ThreadPoolExecutor(len(presses)) as pool,
    ):
        holder.execute(held)
        pressed = []
        for number, press in enumerate(presses, 1):
            pressed.append(pool.submit(run_in_thread, press))
            wait_for("who waits", lambda wanted=number: looking.execute(WAITING).fetchone() == (wanted,))
        holder.commit()
        return [each.result(60) for each in pressed]


def run_in_thread(press: Press) -> Any:
    try:
        return press()
    finally:
        connection.close()


def decide(who: str, what: str, body: Any = None) -> Press:
    """Return what presses a button of the mixer's page."""
    client = signed_in(who)
    return lambda: post_json(client, f"{MIXER_PATH}/{what}", body)


def told(answers: list[Any]) -> list[Any]:
    """Return the status of each that was done, and of the others what they were told."""
    return [
        answer.status_code if answer.status_code < 300 else (answer.status_code, answer.json()["code"])
        for answer in answers
    ]


def history() -> list[str]:
    kinds = DeviceEvent.objects.filter(device=MIXER.id).exclude(kind="described").order_by("pk")
    return list(kinds.values_list("code", flat=True))


@pytest.mark.parametrize(
    ("first", "second", "now"),
    [("approve", "reject", "approved"), ("reject", "approve", "retired"), ("approve", "approve", "approved")],
)
def test_a_device_that_waits_is_decided_once(url: str, first: str, second: str, now: str) -> None:
    describe()
    answers = press_together(url, OF_DEVICE, decide("admin", first), decide("chief", second))
    assert told(answers) == [200, (409, "not_pending")]
    assert answers[1].json()["detail"] == f"mixer1 does not wait for a decision; it is {now}."
    assert Device.objects.get().lifecycle == now
    assert len(history()) == 1
    if first == "approve":
        assert may_come_in(answers[0].json()["credential"])


def test_a_device_gets_one_new_key_and_the_other_is_told_to_ask_for_it(url: str) -> None:
    old = approve()
    answers = press_together(url, OF_DEVICE, decide("admin", "credential"), decide("chief", "credential"))
    assert told(answers) == [200, (409, "key_changed")]
    assert answers[1].json()["detail"].startswith("Somebody else ")
    assert (may_come_in(old), may_come_in(answers[0].json()["credential"])) == (False, True)
    assert history() == ["approved", "credential"]


def test_a_key_that_is_taken_away_while_another_is_made_stays_away(url: str) -> None:
    approve()
    client = signed_in("chief")
    rotated, revoked = press_together(
        url, OF_DEVICE, decide("admin", "credential"), lambda: client.delete(f"{MIXER_PATH}/credential")
    )
    assert revoked.status_code == 200
    assert rotated.status_code in (200, 409)
    if rotated.status_code == 200:
        assert not may_come_in(rotated.json()["credential"])
    assert Device.objects.get().credential_hash == Device.objects.get().broker_hash == ""
    assert history()[-1] == "revoked"


def rename(who: str, name: str) -> Press:
    client = signed_in(who)
    return lambda: client.patch(MIXER_PATH, {"name": name}, content_type="application/json")


def test_a_device_that_was_taken_out_is_renamed_no_more(url: str) -> None:
    approve()
    answers = press_together(url, OF_DEVICE, decide("admin", "retire"), rename("chief", "Oven"))
    assert told(answers) == [200, (409, "not_approved")]
    assert "retired" in answers[1].json()["detail"]
    assert (Device.objects.get().name_override, history()) == ("", ["approved", "retired"])
    assert ThingEvent.objects.order_by("pk").last().kind == "thing_deleted"  # type: ignore[union-attr]


def test_a_device_that_was_renamed_can_be_taken_out(url: str) -> None:
    approve()
    answers = press_together(url, OF_DEVICE, rename("chief", "Oven"), decide("admin", "retire"))
    assert told(answers) == [200, 200]
    assert (Device.objects.get().lifecycle, history()) == ("retired", ["approved", "renamed", "retired"])


def test_a_device_is_taken_out_once(url: str) -> None:
    approve()
    answers = press_together(url, OF_DEVICE, decide("admin", "retire"), decide("chief", "retire"))
    assert told(answers) == [200, (409, "not_approved")]
    answers = press_together(url, OF_DEVICE, decide("admin", "readmit"), decide("chief", "readmit"))
    assert told(answers) == [200, (409, "not_retired")]
    assert history() == ["approved", "retired", "readmitted"]


def decide_topic(who: str, what: str) -> Press:
    return decide(who, f"topics/{what}", {"topic": "plant/mix"})


@pytest.mark.parametrize(
    ("first", "second", "refusal", "granted"),
    [
        ("confirm", "confirm", (409, "topic_not_asked"), {"mix": "plant/mix"}),
        ("confirm", "withdraw", 200, {}),
        ("withdraw", "confirm", 200, {"mix": "plant/mix"}),
    ],
)
def test_a_topic_is_confirmed_and_withdrawn_in_turn(
    url: str, first: str, second: str, refusal: object, granted: dict[str, str]
) -> None:
    approve(replace(MIXER, methods=(MethodSpec("mix", "plant/mix"),)))
    answers = press_together(url, OF_DEVICE, decide_topic("admin", first), decide_topic("chief", second))
    done = (409, "topic_not_asked") if first == "withdraw" else 200
    assert told(answers) == [done, refusal]
    assert Device.objects.get().granted == granted


def test_a_topic_of_a_device_that_was_taken_out_is_not_confirmed(url: str) -> None:
    approve(replace(MIXER, methods=(MethodSpec("mix", "plant/mix"),)))
    answers = press_together(url, OF_DEVICE, decide("admin", "retire"), decide_topic("chief", "confirm"))
    assert told(answers) == [200, (409, "topic_not_asked")]
    assert "does not take part; it is retired" in answers[1].json()["detail"]
    assert (Device.objects.get().granted, TopicClaim.objects.count()) == ({}, 0)


def test_two_who_make_a_join_key_are_told_the_same_one(url: str) -> None:
    services.set_enrolment_key(site="hall", key="j" * 32)
    Site.objects.update(join_key_at=datetime(2026, 11, 21, tzinfo=UTC))
    clients = [signed_in(who) for who in ("admin", "chief")]
    answers = press_together(url, OF_SITE, *(lambda c=client: post_json(c, f"{SITE}/join-key") for client in clients))
    keys = [answer.json()["join_key"] for answer in answers]
    assert keys[0] == keys[1]
    assert (may_come_in(keys[0], "join:hall"), may_come_in("j" * 32, "join:hall")) == (True, False)


@pytest.mark.parametrize("again", [False, True])
def test_of_two_who_add_a_device_of_one_id_one_is_told_its_key_and_the_other_who_has_it(url: str, again: bool) -> None:
    clients = {who: signed_in(who) for who in ("admin", "chief")}
    answers = press_together(
        url,
        ANY_DEVICE,
        *(
            lambda c=client: post_json(c, f"{SITE}/newcomers", {"id": "mixer1", "again": again})
            for client in clients.values()
        ),
    )
    assert sorted(map(str, told(answers))) == ["(409, 'already_reserved')", "201"]
    winner = next(answer for answer in answers if answer.status_code == 201)
    loser = next(answer for answer in answers if answer.status_code == 409)
    name = "Admin Person" if winner is answers[0] else "Chief Person"
    assert loser.json()["detail"].startswith(name)
    assert may_come_in(winner.json()["credential"])
    assert history() == ["expected"]


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


def make_sites(url: str, *names: str) -> list[Any]:
    """Let the author make sites of these names at once, each out of a map."""
    yaml = "image: map.pgm\nresolution: 1\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.25\n"

    def upload(client: Client, name: str) -> Any:
        files = {
            "yaml": SimpleUploadedFile("map.yaml", yaml.encode()),
            "image": SimpleUploadedFile("map.pgm", b"P5 2 2 255\n" + bytes([254] * 4)),
        }
        return client.post("/api/sites", {"name": name, **files})

    clients = [(signed_in("author"), name) for name in names]
    return press_together(url, OF_PERSON, *(lambda c=client, n=name: upload(c, n) for client, name in clients))


def test_who_may_make_one_more_site_makes_one(url: str) -> None:
    services.set_site_quota(email="author@vipo.example", sites=1)
    answers = make_sites(url, "A", "B")
    made = told(answers).index(201)
    assert told(answers)[1 - made] == (403, "site_quota_reached")
    assert list(Site.objects.exclude(slug="hall").values_list("name", flat=True)) == ["AB"[made]]


def test_who_makes_two_sites_of_one_name_at_once_makes_one(url: str) -> None:
    services.set_site_quota(email="author@vipo.example", sites=2)
    answers = make_sites(url, "Shed", "shed")
    assert sorted(told(answers), key=str) == [(409, "name_taken"), 201]
    assert Site.objects.exclude(slug="hall").count() == 1


def test_of_two_who_publish_one_name_at_once_one_is_told_to_take_another(url: str) -> None:
    services.set_member(site="hall", email=add_person("second").email, role="author")
    drawn = document({}, functions={"f": {"name": "Greet", "parameters": []}})
    body = {"program": str(editor.create_program(site="hall", name="Source", document=drawn).id), "function": "f"}
    first, second = signed_in("author"), signed_in("second")
    answers = press_together(
        url,
        "LOCK TABLE editor_libraryfunction IN EXCLUSIVE MODE",
        lambda: post_json(first, f"{SITE}/library", {**body, "name": "Greet"}),
        lambda: post_json(second, f"{SITE}/library", {**body, "name": "Greet"}),
    )
    winner = ["author", "second"][[answer.status_code for answer in answers].index(201)]  # the lock lets both go on
    assert sorted(told(answers), key=str) == [(409, "name_taken"), 201]
    function = LibraryFunction.objects.get()
    assert (function.author, function.last_version) == (find_person(winner), 1)


def test_a_zone_is_opened_while_an_admin_draws_it_anew_and_both_are_done(url: str) -> None:
    zone = services.ZoneChange(name="Gate", rule="release", points=[(0.5, 0.5), (2.5, 0.5), (2.5, 1.5)])
    services.add_zone(site="hall", zone=zone)
    operator, admin = signed_in("operator"), signed_in("admin")
    opened, drawn = press_together(
        url,
        "SELECT 1 FROM registry_sitezone FOR UPDATE",
        lambda: operator.put(f"{SITE}/zones/gate/opening", {"minutes": 5}, content_type="application/json"),
        lambda: admin.patch(f"{SITE}/zones/gate", {"name": "The gate"}, content_type="application/json"),
    )
    assert told([opened, drawn]) == [200, 200]
    assert (drawn.json()["name"], drawn.json()["open_until"]) == ("The gate", opened.json()["open_until"])

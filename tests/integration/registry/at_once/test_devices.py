"""Two people who decide about a device at once: one wins, nothing is half done, the other is told what happened."""

from __future__ import annotations

import json
import signal
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from datetime import UTC, datetime
from typing import Any

import psycopg
import pytest
from django.db import transaction

from registry import services
from registry.broker.accounts import accounts
from registry.models import (
    Device,
    DeviceEvent,
    Site,
    ThingEvent,
    TopicClaim,
)
from tests.integration.registry.at_once.presses import (
    ANY_DEVICE,
    MIXER_PATH,
    OF_DEVICE,
    OF_SITE,
    SITE,
    WAITING,
    Press,
    press_together,
    run_in_thread,
    told,
)
from tests.kit.databases import Aside, one_waits
from tests.kit.servers import Mosquitto
from tests.kit.sign_in import find_person, post_json, signed_in
from tests.kit.sites import MIXER, NOW, approve, describe, may_come_in
from tests.kit.waiting import wait_for
from vipo_device.protocol.description import MethodSpec

pytestmark = pytest.mark.servers


def decide(who: str, what: str, body: Any = None) -> Press:
    """Return what presses a button of the mixer's page."""
    client = signed_in(who)
    return lambda: post_json(client, f"{MIXER_PATH}/{what}", body)


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


def test_a_key_that_is_taken_away_while_its_device_enrols_again_with_it_stays_away(
    url: str, mosquitto: Mosquitto
) -> None:
    hello = {"site": "hall", "device_id": MIXER.id, "payload": json.dumps({"key": "k" * 32}).encode(), "at": NOW}
    services.enrol_device(**hello)
    describe()
    services.approve_device(site="hall", device_id=MIXER.id, by=None, at=NOW)
    client = signed_in("admin")
    assert mosquitto.process is not None
    with psycopg.connect(url, autocommit=True) as looking, ThreadPoolExecutor(2) as pool:
        mosquitto.process.send_signal(signal.SIGSTOP)
        try:
            enrolling = pool.submit(run_in_thread, lambda: services.enrol_device(**hello))
            wait_for("the lock", lambda: looking.execute(f"{OF_DEVICE} SKIP LOCKED").fetchone() is None)
            revoking = pool.submit(run_in_thread, lambda: client.delete(f"{MIXER_PATH}/credential"))
            wait_for("who revokes it", lambda: looking.execute(WAITING).fetchone() == (1,))
        finally:
            mosquitto.process.send_signal(signal.SIGCONT)
        assert (enrolling.result(60), revoking.result(60).status_code) == (False, 200)
    assert MIXER.id not in (accounts().names() or ())
    with pytest.raises(services.BadDevice, match="key was revoked"):
        services.enrol_device(**hello)
    assert MIXER.id not in (accounts().names() or ())


def reserve() -> None:
    services.reserve_device(site="hall", device_id="mixer1", by=find_person("admin"), at=NOW)


def enrol() -> None:
    services.enrol_device(site="hall", device_id="mixer1", payload=json.dumps({"key": "k" * 32}).encode(), at=NOW)


def join() -> None:
    services.renew_enrolment_key(site="hall")


@pytest.mark.parametrize("is_kept", [True, False])
@pytest.mark.parametrize(("decision", "name"), [(reserve, "mixer1"), (enrol, "mixer1"), (join, "join:hall")])
def test_a_gateway_that_comes_while_an_account_is_made_takes_it_away_only_if_nothing_comes_of_it(
    url: str, mosquitto: Mosquitto, aside: Aside, decision: Callable[[], None], name: str, is_kept: bool
) -> None:
    with transaction.atomic():
        decision()
        assert name in (accounts().names() or ())
        looking = aside(services.reconcile_accounts)
        wait_for("the gateway", lambda: looking.done() or one_waits())
        assert not looking.done()
        transaction.set_rollback(not is_kept)
    removed, missing = looking.result(60)
    assert (name in removed, name in missing) == (not is_kept, False)
    assert (name in (accounts().names() or ())) == is_kept
    assert Device.objects.filter(pk=name).exists() == (is_kept and name == "mixer1")


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

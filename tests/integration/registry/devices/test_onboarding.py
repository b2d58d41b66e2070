"""Devices that an admin adds before they come, a look at a description, and all devices as one Turtle file."""

from __future__ import annotations

import json
from dataclasses import replace
from datetime import timedelta
from typing import Any

import pytest
from django.test import override_settings
from rdflib import Graph

from registry import services
from registry.devices.enrolment import FORGOTTEN_AFTER, MOST_PENDING, reserve_device
from registry.models import Device, DeviceEvent, Site
from registry.services import BadDevice
from tests.kit.sign_in import ROLES, post_json, signed_in
from tests.kit.sites import MIXER, NOW, ROBOT, come, describe, may_come_in
from vipo_device.descriptions.reader import read_description, write_description
from vipo_device.protocol.errors import VipoError

SITE = "/api/sites/hall"
CALLS = {
    "newcomers": {"id": "mixer1"},
    "join-key": {},
    "describe": {"text": "id: x"},
}


def send(who: str, call: str, body: Any = None) -> Any:
    return post_json(signed_in(who), f"{SITE}/{call}", CALLS[call] if body is None else body)


@pytest.mark.parametrize("who", [*ROLES, "stranger", "nobody"])
def test_admins_add_devices_and_members_look_at_descriptions(hall: str, who: str) -> None:
    outside = {"stranger": 404, "nobody": 401}
    told = {call: send(who, call).status_code for call in CALLS}
    assert told == {
        "newcomers": outside.get(who, 201 if who == "admin" else 403),
        "join-key": outside.get(who, 200 if who == "admin" else 403),
        "describe": outside.get(who, 200),
    }
    assert signed_in(who).get(f"{SITE}/devices.ttl").status_code == outside.get(who, 200)


@override_settings(VIPO_BROKER_URL="mqtts://broker.example:8883/")
def test_an_added_device_comes_in_with_its_key_and_waits_for_approval(hall: str) -> None:
    told = send("admin", "newcomers").json()
    assert (told["id"], told["site"], told["broker"]) == ("mixer1", "hall", "mqtts://broker.example:8883/")
    assert may_come_in(told["credential"], "mixer1")
    assert services.list_devices(site="hall") == ()
    describe()
    (device,) = services.list_devices(site="hall")
    assert device.lifecycle == "pending"
    assert told["credential"] not in json.dumps(list(Device.objects.values("credential_hash", "broker_hash")))


def test_an_added_device_stays_at_the_site_whose_admin_added_it(hall: str) -> None:
    services.create_site(name="Yard", slug="yard")
    assert send("admin", "newcomers").status_code == 201
    describe(replace(MIXER, site="yard"))
    assert services.list_devices(site="yard") == ()
    assert [device.id for device in services.list_devices(site="hall")] == ["mixer1"]


def test_an_added_device_that_comes_before_it_describes_itself_stays_there_too(hall: str, settings: Any) -> None:
    services.create_site(name="Yard", slug="yard")
    assert send("admin", "newcomers").status_code == 201
    settings.VIPO_DEFAULT_SITE = "yard"
    assert come() is None
    assert describe().site == "hall"


def test_a_key_that_somebody_was_told_ends_only_if_an_admin_says_so_and_not_within_seconds(hall: str) -> None:
    first = send("admin", "newcomers").json()["credential"]
    refused = send("admin", "newcomers")
    assert (refused.status_code, refused.json()["code"]) == (409, "already_reserved")
    assert refused.json()["detail"].startswith("Admin Person added mixer1 at 20")
    at_once = send("admin", "newcomers", {"id": "mixer1", "again": True})
    assert (at_once.status_code, at_once.json()["code"]) == (409, "already_reserved")
    assert "another key would end it" in at_once.json()["detail"]
    assert may_come_in(first, "mixer1")
    DeviceEvent.objects.update(at=NOW)
    second = send("admin", "newcomers", {"id": "mixer1", "again": True}).json()["credential"]
    assert (may_come_in(first, "mixer1"), may_come_in(second, "mixer1")) == (False, True)
    describe()
    refused = send("admin", "newcomers", {"id": "mixer1", "again": True})
    assert (refused.status_code, refused.json()["code"]) == (422, "bad_device")
    assert may_come_in(second, "mixer1")


def test_a_key_that_a_device_brought_itself_is_not_ended_by_adding_it(hall: str) -> None:
    services.enrol_device(site="hall", device_id="mixer1", payload=json.dumps({"key": "k" * 32}).encode(), at=NOW)
    refused = send("admin", "newcomers")
    assert (refused.status_code, refused.json()["code"]) == (409, "already_reserved")
    assert refused.json()["detail"].startswith("mixer1 brought a key of its own at 2026-11-21 12:00 (UTC)")
    assert may_come_in("k" * 32, "mixer1")


def test_ids_of_other_sites_and_ids_that_cannot_be_are_refused(hall: str) -> None:
    services.create_site(name="Yard", slug="yard")
    services.expect_device(site="yard", device_id="crane", credential="c" * 32, approved=False)
    for name in ("crane", "server", "a/b", "#", "", "x" * 64 + "y"):
        assert send("admin", "newcomers", {"id": name}).status_code == 422, name
    assert may_come_in("c" * 32, "crane")


def test_who_does_not_come_is_forgotten_and_no_more_than_two_hundred_wait(hall: str, person: Any) -> None:
    who = {"site": "hall", "by": person("admin")}
    reserve_device(device_id="early", at=NOW - FORGOTTEN_AFTER - timedelta(minutes=1), **who)
    Device.objects.bulk_create(
        Device(pk=f"w{n}", site=Device.objects.get().site, first_seen_at=NOW) for n in range(MOST_PENDING - 1)
    )
    reserve_device(device_id="last", at=NOW, **who)
    assert not Device.objects.filter(pk="early").exists()
    with pytest.raises(BadDevice):
        reserve_device(device_id="one-too-many", at=NOW, **who)


def _refused_description(hall: str, *, last_seen_at: Any, online: bool = False) -> None:
    """Let a device enrol and come, whose description nobody could read."""
    services.enrol_device(site=hall, device_id="mixer1", payload=json.dumps({"key": "k" * 32}).encode(), at=NOW)
    with pytest.raises(VipoError):
        services.ingest_description(device_id="mixer1", payload=b"no description", at=NOW)
    assert come(boot=7, online=True, at=NOW) is None
    if not online:
        assert come(boot=7, online=False, at=last_seen_at) is None


def test_whose_description_was_refused_is_forgotten_a_day_after_it_was_last_seen(hall: str) -> None:
    _refused_description(hall, last_seen_at=NOW + timedelta(hours=20))
    within = NOW + timedelta(hours=20) + FORGOTTEN_AFTER
    reserve_device(site=hall, device_id="one", by=None, at=within)
    assert may_come_in("k" * 32, "mixer1")
    reserve_device(site=hall, device_id="two", by=None, at=within + timedelta(seconds=1))
    assert not Device.objects.filter(pk="mixer1").exists()
    assert not may_come_in("k" * 32, "mixer1")


def test_what_has_described_itself_or_was_expected_by_its_own_key_is_never_forgotten(hall: str) -> None:
    describe(ROBOT)
    services.expect_device(site=hall, device_id="mixer1", credential="c" * 32, approved=False)
    assert come() is None
    reserve_device(site=hall, device_id="one", by=None, at=NOW + timedelta(days=30))
    assert {"mixer1", "robot1"} <= set(Device.objects.values_list("pk", flat=True))
    assert may_come_in("c" * 32, "mixer1")


def test_whose_description_was_refused_can_be_added_anew_once_it_is_gone(hall: str) -> None:
    _refused_description(hall, last_seen_at=NOW)
    assert send("admin", "newcomers").json()["code"] == "already_reserved"
    told = send("admin", "newcomers", {"id": "mixer1", "again": True})
    assert told.status_code == 201
    assert (may_come_in("k" * 32), may_come_in(told.json()["credential"])) == (False, True)
    row = Device.objects.get()
    assert (row.last_seen_at, row.boot, row.seq, row.presence_boot) == (None, -1, -1, -1)
    come(boot=1)  # another board, which counts its starts from the beginning
    assert Device.objects.get().online
    assert describe().lifecycle == "pending"


def test_what_is_there_is_not_added_anew_though_its_description_was_refused(hall: str) -> None:
    _refused_description(hall, last_seen_at=NOW, online=True)
    for again in (False, True):
        refused = send("admin", "newcomers", {"id": "mixer1", "again": again})
        assert (refused.status_code, refused.json()["code"]) == (422, "bad_device")
        assert refused.json()["detail"].startswith("mixer1 is connected just now")
    assert may_come_in("k" * 32)


def test_a_new_join_key_ends_the_old_one(hall: str) -> None:
    services.set_enrolment_key(site="hall", key="j" * 32)
    Site.objects.update(join_key_at=NOW)
    answer = send("admin", "join-key")
    told = answer.json()
    assert answer["Cache-Control"] == "no-store"
    assert send("admin", "join-key").json()["join_key"] == told["join_key"]
    assert may_come_in(told["join_key"], "join:hall")
    assert not may_come_in("j" * 32, "join:hall")


def test_a_look_at_a_description_says_what_it_is_and_keeps_nothing(hall: str) -> None:
    told = send("viewer", "describe", {"text": write_description(MIXER, "td")}).json()
    assert (told["form"], told["faults"], told["description"]["name"]) == ("td", [], "Mixer One")
    assert read_description(told["turtle"].encode()) == MIXER
    assert not Device.objects.exists()


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("@prefix a: <urn:a> .\na:b a:c", "line"),
        ('<?xml version="1.0"?><rdf:RDF/>', "RDF/XML"),
        ("x" * 20_000, "16384"),
        ("", ""),
    ],
)
def test_a_broken_description_is_told_its_faults(hall: str, text: str, word: str) -> None:
    answer = send("viewer", "describe", json.dumps({"text": text}))
    assert answer.status_code == 200
    assert answer.json()["faults"]
    assert word.lower() in json.dumps(answer.json()["faults"]).lower()


@pytest.mark.parametrize("text", ["x" * 70_000, "\ud800"])
def test_what_can_be_no_text_of_a_description_is_refused(hall: str, text: str) -> None:
    assert send("viewer", "describe", json.dumps({"text": text})).status_code == 422


def test_all_devices_are_one_turtle_file(hall: str) -> None:
    describe(MIXER)
    describe(replace(ROBOT, name='Robot "One"'))
    answer = signed_in("viewer").get(f"{SITE}/devices.ttl")
    assert answer["Content-Disposition"] == 'attachment; filename="hall-devices.ttl"'
    graph = Graph().parse(data=answer.content.decode(), format="turtle")
    names = {str(name) for name in graph.objects(None, next(p for p in set(graph.predicates()) if p.endswith("title")))}
    assert {"Mixer One", 'Robot "One"'} <= names

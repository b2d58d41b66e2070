"""Two sites on one server: neither learns of the other's ids, keys and topics, nor takes them."""

from __future__ import annotations

import json
from dataclasses import replace
from datetime import timedelta
from typing import Any

import pytest
from django.utils import timezone

from registry import services
from registry.devices.authentication import Login
from registry.devices.rows import BadDevice
from registry.models import Device, DeviceAlert, DeviceEvent, TopicClaim
from registry.services import NotOfSite, TopicTaken
from tests.kit.sign_in import add_person, find_person, post_json, signed_in
from tests.kit.sites import MIXER, NOW, approve, come, describe, describe_later
from vipo_device.protocol.credentials import secret_hash
from vipo_device.protocol.description import MethodSpec
from vipo_device.protocol.messages import BadMessage

HALL, YARD, KEY = "h" * 32, "y" * 32, "k" * 32


@pytest.fixture
def yard(hall: str) -> str:
    services.create_site(name="Yard", slug="yard")
    add_person("keeper")
    services.set_member(site="yard", email="keeper@vipo.example", role="admin")
    services.set_enrolment_key(site="hall", key=HALL)
    services.set_enrolment_key(site="yard", key=YARD)
    return "yard"


def enrol(device_id: str, site: str = "yard", key: str = KEY) -> bool:
    return services.enrol_device(site=site, device_id=device_id, payload=json.dumps({"key": key}).encode(), at=NOW)


def comes_in(device_id: str, key: str) -> str:
    found = services.check_device_password(username=device_id, password=key)
    return found.site if found else ""


def test_another_sites_id_and_one_that_nobody_has_are_refused_in_the_same_words(yard: str) -> None:
    approve()
    client = signed_in("keeper")
    told = []
    for name in ("mixer1", "mixer9"):
        answer = post_json(client, "/api/sites/yard/newcomers", {"id": name})
        assert (answer.status_code, answer.json()["code"]) == (422, "bad_device")
        told.append(json.dumps(answer.json()).replace(name, "ID"))
    assert told[0] == told[1]
    assert "such as yard.ID." in told[0]
    assert list(Device.objects.values_list("pk", "site__slug")) == [("mixer1", "hall")]
    assert post_json(client, "/api/sites/yard/newcomers", {"id": "yard.mixer1"}).status_code == 201


def test_the_first_site_gives_plain_ids_and_none_of_another_sites(yard: str) -> None:
    client = signed_in("admin")
    assert post_json(client, "/api/sites/hall/newcomers", {"id": "plc.3"}).status_code == 201
    assert post_json(client, "/api/sites/hall/newcomers", {"id": "yard.3"}).status_code == 422
    assert comes_in("yard.3", HALL) == ""


def test_a_site_alone_gives_any_id(hall: str) -> None:
    assert post_json(signed_in("admin"), "/api/sites/hall/newcomers", {"id": "yard.3"}).status_code == 201


def test_a_new_site_gets_no_name_that_ids_or_topics_begin_with_already(hall: str) -> None:
    describe(replace(MIXER, id="yard.3", methods=()))
    describe(replace(MIXER, id="m2", methods=(MethodSpec("mix", "dock/mix"),)))
    assert services.create_site(name="Yard").slug == "yard-2"
    assert services.create_site(name="Dock").slug == "dock-2"


def test_whoever_enrols_at_another_site_takes_no_id_and_its_owner_hears_nothing(yard: str) -> None:
    approve()
    services.flush_alerts()
    before = (DeviceEvent.objects.count(), DeviceAlert.objects.count())
    for name in ("mixer1", "mixer9", "hall.mixer9"):
        with pytest.raises(NotOfSite, match=f"{name} cannot be a new id here"):
            enrol(name)
    services.flush_alerts()
    assert (DeviceEvent.objects.count(), DeviceAlert.objects.count()) == before
    assert enrol("yard.mixer1")
    assert Device.objects.get(pk="yard.mixer1").site.slug == "yard"


def test_ids_that_cannot_be_a_sites_are_told_whether_somebody_has_them_or_not(yard: str) -> None:
    approve()
    services.expect_device(site="yard", device_id="old", credential=KEY)
    ids = ("yard.new", "old", "mixer9", "mixer1", "hall.mixer1")
    assert services.list_strange_ids(site="yard", ids=ids) == ("hall.mixer1", "mixer1", "mixer9")
    assert services.list_strange_ids(site="hall", ids=ids) == ("old", "yard.new")
    with pytest.raises(services.NotAMember):
        services.list_strange_ids(site="nowhere", ids=ids)


def test_a_key_that_is_none_is_refused_at_another_sites_id_as_a_proper_one_is(yard: str) -> None:
    approve()
    told = []
    for key in (KEY, "short"):
        with pytest.raises(NotOfSite) as refused:
            enrol("mixer1", key=key)
        told.append(refused.value.detail)
    assert told[0] == told[1]
    with pytest.raises(BadMessage):
        enrol("yard.mixer9", key="short")


def test_a_join_key_opens_its_own_site_only(yard: str) -> None:
    describe(replace(MIXER, id="waiting", methods=()))
    assert (comes_in("waiting", YARD), comes_in("waiting", HALL)) == ("", "hall")
    assert (comes_in("new1", YARD), comes_in("yard.new1", YARD)) == ("", "yard")
    assert (comes_in("join:hall", YARD), comes_in("join:yard", HALL)) == ("", "")
    assert not Device.objects.filter(pk="new1").exists()


def test_who_came_by_a_sites_join_key_stays_there_whatever_it_says(yard: str) -> None:
    assert comes_in("yard.new1", YARD) == "yard"
    assert describe(replace(MIXER, id="yard.new1", site="hall", methods=())).site == "yard"
    assert [device.id for device in services.list_devices(site="hall")] == []


def test_two_hundred_new_devices_of_one_site_leave_room_at_another(yard: str) -> None:
    site = find_person("keeper").memberships.get().site
    Device.objects.bulk_create(Device(pk=f"yard.n{n}", site=site, first_seen_at=NOW) for n in range(200))
    Device.objects.filter(site=site).update(last_seen_at=timezone.now())  # who was heard within a day stays
    assert (comes_in("yard.more", YARD), comes_in("more", HALL)) == ("", "hall")


def test_another_sites_topic_and_one_that_nobody_has_are_refused_in_the_same_words(yard: str) -> None:
    describe(replace(MIXER, methods=(MethodSpec("mix", "plant/mix"),)))
    thief = replace(MIXER, id="yard.thief", site="yard")
    told = []
    for topic in ("plant/mix", "plant/heat"):
        with pytest.raises(TopicTaken) as refused:
            describe(replace(thief, methods=(MethodSpec("mix", topic),)))
        told.append(refused.value.detail.replace(topic, "TOPIC"))
    assert told[0] == told[1]
    assert list(TopicClaim.objects.values_list("topic", "device__site__slug")) == [("plant/mix", "hall")]
    view = describe(replace(thief, methods=(MethodSpec("mix", "yard/plant/mix"),)))
    assert [method.topic for method in view.asks] == ["yard/plant/mix"]
    with pytest.raises(TopicTaken):
        describe(replace(MIXER, id="m2", methods=(MethodSpec("mix", "yard/plant/heat"),)))


def test_what_another_site_has_from_before_is_refused_like_what_nobody_has(yard: str) -> None:
    site: Any = find_person("keeper").memberships.get().site
    Device.objects.create(pk="old", site=site, first_seen_at=NOW)
    answer = post_json(signed_in("admin"), "/api/sites/hall/newcomers", {"id": "old"})
    assert (answer.status_code, answer.json()["detail"]) == (
        422,
        "old cannot be a new id here. Several sites share this server: new ids of this one begin with hall., such as "
        "hall.old.",
    )
    assert comes_in("old", HALL) == ""


def test_a_newcomer_that_was_forgotten_has_to_come_in_anew_and_comes_up_at_no_other_site(
    yard: str, settings: Any
) -> None:
    settings.VIPO_DEFAULT_SITE = "hall"
    assert comes_in("yard.ghost", YARD) == "yard"
    logins = {"yard.ghost": Login("", NOW), "join:yard": Login(secret_hash(YARD), NOW)}
    assert services.find_ended(logins=logins) == frozenset()
    Device.objects.update(first_seen_at=NOW - timedelta(hours=25))
    assert enrol("yard.mixer1")
    assert services.find_ended(logins=logins) == {"yard.ghost"}
    for site in ("hall", "nowhere"):
        with pytest.raises(BadDevice, match=r"yard\.ghost cannot be a new id here"):
            describe(replace(MIXER, id="yard.ghost", site=site, methods=()))
    with pytest.raises(BadDevice, match=r"yard\.ghost cannot be a new id here"):
        come("yard.ghost")
    assert list(Device.objects.values_list("pk", "site__slug")) == [("yard.mixer1", "yard")]


def test_of_many_that_come_at_once_only_those_with_ids_of_their_site_are_taken(yard: str) -> None:
    said = [
        describe_later(replace(MIXER, id=name, site=site, methods=()))
        for name, site in (("plain", "hall"), ("yard.1", "yard"), ("yard.2", "hall"), ("odd", "yard"))
    ]
    fates = services.ingest_descriptions(descriptions=said)
    assert [isinstance(fate, BadDevice) for fate in fates] == [False, False, True, True]
    assert list(Device.objects.order_by("pk").values_list("pk", "site__slug")) == [
        ("plain", "hall"),
        ("yard.1", "yard"),
    ]

"""Descriptions of many devices at once: each has its own fate, and many cost no more statements than a few."""

from __future__ import annotations

from dataclasses import replace
from datetime import timedelta
from typing import Any

from django.db import connection
from django.test.utils import CaptureQueriesContext

from registry import services
from registry.models import Device, DeviceEvent
from registry.services import BadDevice, DescriptionMessage, DeviceView, TopicTaken
from tests.kit.sites import LATER, MIXER, NOW, ROBOT, come, describe, describe_later
from vipo_device.descriptions.forms import BadDescription
from vipo_device.protocol.description import MethodSpec


def many(count: int, name: str) -> list[DescriptionMessage]:
    return [describe_later(replace(MIXER, id=f"mixer{n:02}", name=f"{name} {n}", methods=())) for n in range(count)]


def test_each_description_has_its_own_fate(heard: list[Any], django_capture_on_commit_callbacks: Any) -> None:
    describe()
    describe(ROBOT)
    pending = replace(ROBOT, id="robot2", name="Robot Two")
    with django_capture_on_commit_callbacks(execute=True):
        fates = services.ingest_descriptions(
            descriptions=[
                describe_later(pending),
                DescriptionMessage("robot1", b"not RDF", LATER),
                describe_later(MIXER, "foreign"),
                describe_later(replace(MIXER, name="Mixer New"), form="td"),
                describe_later(replace(MIXER, id="server")),
            ]
        )
    fresh, broken, foreign, changed, reserved = fates
    assert [type(fate) for fate in (broken, foreign, reserved)] == [BadDescription, BadDescription, BadDevice]
    assert (fresh, changed) == tuple(services.get_device(site="hall", device_id=i) for i in ("robot2", "mixer1"))
    assert isinstance(changed, DeviceView)
    assert (changed.name, changed.last_seen_at) == ("Mixer New", LATER)
    assert {message["device"]["id"]: len(message["device"]) > 5 for _, message in heard} == {
        "robot2": True,
        "mixer1": False,
    }
    lines = DeviceEvent.objects.filter(at=LATER).order_by("device").values_list("device", "kind", "text")
    assert list(lines) == [
        ("mixer1", "described", "Calls itself Mixer New"),
        ("robot2", "described", "Described itself for the first time: Robot Two, turtlebot"),
    ]
    assert services.get_device(site="hall", device_id="robot1").name == "Robot One"
    assert not Device.objects.filter(pk__in=["foreign", "server"]).exists()


def test_many_cost_no_more_statements_than_a_few(hall: str) -> None:
    counts = []
    for count in (3, 30):
        services.ingest_descriptions(descriptions=many(count, "First"))
        Device.objects.update(lifecycle=Device.Lifecycle.APPROVED)
        with CaptureQueriesContext(connection) as asked:
            services.ingest_descriptions(descriptions=many(count, f"Again {count}"))
        written = [query for query in asked.captured_queries if "UPDATE registry_device" not in query["sql"]]
        counts.append(len(written))
    assert counts[0] == counts[1] <= 14
    assert DeviceEvent.objects.filter(text__startswith="Calls itself Again 30").count() == 30


def test_one_that_the_registry_refuses_while_it_is_kept_spoils_no_other(hall: str, settings: Any) -> None:
    settings.VIPO_DEFAULT_SITE = ""
    asking = replace(MIXER, id="holder", methods=(MethodSpec("mix", "plant/mix"),))
    describe(asking)
    greedy = replace(asking, id="greedy")
    homeless = replace(MIXER, id="stranger", site="nowhere", methods=())
    late, stranger, fine = services.ingest_descriptions(
        descriptions=[describe_later(greedy), describe_later(homeless), describe_later(MIXER)]
    )
    assert isinstance(late, TopicTaken)
    assert isinstance(stranger, BadDevice)
    assert isinstance(fine, DeviceView)
    assert Device.objects.get(pk="greedy").description is None
    assert not Device.objects.filter(pk="stranger").exists()
    assert [line.text for line in services.list_device_events(site="hall", device_id="mixer1")] == [
        "Described itself for the first time: Mixer One, mixer"
    ]


def test_a_device_that_was_taken_out_stays_out_whatever_it_says(hall: str) -> None:
    services.ingest_descriptions(descriptions=many(3, "First"))
    Device.objects.filter(pk="mixer01").update(lifecycle=Device.Lifecycle.RETIRED)
    services.ingest_descriptions(descriptions=many(3, "Second"))
    assert {d.id: d.name for d in services.list_devices(site="hall")} == {"mixer00": "Second 0", "mixer02": "Second 2"}
    assert Device.objects.get(pk="mixer01").lifecycle == "retired"


def test_what_changed_besides_is_not_overwritten(hall: str) -> None:
    describe()
    come()
    Device.objects.filter(pk="mixer1").update(name_override="Ada's mixer", properties={"jobStatus": 3}, dropped=2)
    (view,) = services.ingest_descriptions(descriptions=[describe_later(replace(MIXER, capacity=4))])
    assert isinstance(view, DeviceView)
    assert (view.name, view.canonical.capacity, view.online, view.dropped) == ("Ada's mixer", 4, True, 2)
    assert dict(view.readings) == {"jobStatus": 3}


def test_a_history_that_grows_by_many_is_cut_to_the_newest_100_of_their_kind(hall: str) -> None:
    services.ingest_descriptions(descriptions=many(2, "First"))
    device = Device.objects.get(pk="mixer01")
    DeviceEvent.objects.bulk_create(DeviceEvent(device=device, at=NOW, kind="described", text="x") for _ in range(119))
    later = [replace(each, at=NOW + timedelta(hours=1)) for each in many(2, "Second")]
    services.ingest_descriptions(descriptions=later)
    assert DeviceEvent.objects.filter(device="mixer01").count() == 100
    newest = services.list_device_events(site="hall", device_id="mixer01", limit=1)[0]
    assert newest.text == "Calls itself Second 1"
    assert DeviceEvent.objects.filter(device="mixer00").count() == 2

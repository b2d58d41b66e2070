"""A site as an MTConnect agent: each document holds against the schema, and numbers lead on from one to the next."""

from __future__ import annotations

from dataclasses import replace
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
from django.test import Client
from django.utils import timezone
from lxml import etree

from registry import samples, services
from registry.capability import PropertySpec
from registry.models import Device, User
from registry.mtconnect_items import MEASURES
from registry.samples import SampleBuffer

from .conftest import MIXER, ROBOT, ROLES, come, describe, say

SCHEMAS = Path(__file__).parents[2] / "fixtures" / "mtconnect"
ADDRESS = "/api/sites/hall/mtconnect"
PROPERTIES = (
    *(PropertySpec(f"in_{unit.replace('-', '_')}", "number", unit) for unit in MEASURES),
    PropertySpec("lid", "text"),
    PropertySpec("wet", "boolean"),
    PropertySpec("stock", "number"),
)
START = timezone.now() - timedelta(minutes=10)


class Plant:
    """A site with one device, 7.a, that can be made to speak."""

    def __init__(self) -> None:
        self.client = Client()
        self.client.force_login(User.objects.get(email="viewer@vipo.example"))
        self.seq = 0

    def say(self, seconds: float, *, done: bool = True, **readings: Any) -> None:
        self.seq += 1
        at = START + timedelta(seconds=seconds)
        view = say("7.a", at=at, seq=self.seq, done=done, props=readings)
        services.note_samples(view=view, at=at)
        services.flush_samples(all_of_it=True)

    def ask(self, call: str, status: int = 200, **query: Any) -> Any:
        answer = self.client.get(f"{ADDRESS}/{call}", {name.rstrip("_"): value for name, value in query.items()})
        assert (answer.status_code, answer["Content-Type"]) == (status, "application/xml")
        root = etree.fromstring(answer.content)
        name = etree.QName(root).localname
        etree.XMLSchema(etree.parse(SCHEMAS / f"{name}_1.2.xsd")).assertValid(root)
        return root


@pytest.fixture
def plant(hall: str, monkeypatch: pytest.MonkeyPatch) -> Plant:
    monkeypatch.setattr(samples, "_buffer", SampleBuffer())
    topic = "vipo/v1/dev/7.a/down/mix"
    describe(replace(MIXER, id="7.a", properties=PROPERTIES, methods=(replace(MIXER.methods[0], topic=topic),)))
    Device.objects.update(lifecycle="approved")
    come("7.a", at=START)
    return Plant()


def texts(root: Any, *names: str) -> list[str]:
    return [e.text for e in root.iter() if etree.QName(e).localname in names]


def header(root: Any) -> dict[str, int]:
    found = root.find("{*}Header")
    return {name: int(found.get(f"{name}Sequence")) for name in ("first", "last", "next")}


def test_probe_lists_what_each_device_tells_with_units(plant: Plant) -> None:
    root = plant.ask("probe")
    device = root.find(".//{*}Device")
    assert (device.get("name"), device.get("uuid"), device.get("id")) == ("7.a", "urn:vipo:device:7.a", "d_7.a")
    items = {item.get("name") or item.get("type"): item for item in root.iter("{*}DataItem")}
    assert {"AVAILABILITY", "EXECUTION", "SYSTEM", "lid", "in_DEG_C"} <= set(items)
    assert [items["in_DEG_C"].get(key) for key in ("category", "type", "units")] == ["SAMPLE", "TEMPERATURE", "CELSIUS"]
    assert [items["stock"].get(key) for key in ("category", "type", "units")] == ["EVENT", "MESSAGE", None]


def test_current_says_how_devices_are_in_the_units_of_the_standard(plant: Plant) -> None:
    plant.say(1, done=False, in_DEG_C=61.5, in_M=1.25, in_MIN=2, lid="a\x01<&>", wet=True, stock=24)
    root = plant.ask("current")
    assert texts(root, "Availability", "Execution") == ["AVAILABLE", "ACTIVE"]
    assert texts(root, "Temperature") == ["61.5"]
    assert sorted(texts(root, "Displacement")) == ["1250.0", "UNAVAILABLE", "UNAVAILABLE"]
    assert sorted(texts(root, "AccumulatedTime")) == ["120.0", "UNAVAILABLE", "UNAVAILABLE"]
    assert texts(root, "Message") == ["a\ufffd<&>", "true", "24"]
    assert len(texts(root, "Normal")) == 1


def test_a_robot_says_where_it_is_in_millimetres(plant: Plant) -> None:
    describe(ROBOT)
    Device.objects.update(lifecycle="approved")
    assert texts(plant.ask("current"), "PathPosition") == ["UNAVAILABLE"]
    come("robot1", at=START)
    say("robot1", at=START, loc=[1.25, -0.5, 0, 1])
    assert texts(plant.ask("current"), "PathPosition") == ["1250.0 -500.0 0.0"]
    places = [item.get("units") for item in plant.ask("probe").iter("{*}DataItem") if item.get("id") == "p_robot1"]
    assert places == ["MILLIMETER_3D"]


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"online": False}, ["UNAVAILABLE", "UNAVAILABLE", "Unavailable"]),
        ({"properties": {"error": "Lid open"}}, ["AVAILABLE", "STOPPED", "Fault"]),
        ({"properties": {"warning": "Low"}}, ["AVAILABLE", "READY", "Warning"]),
        ({"done": False}, ["AVAILABLE", "ACTIVE", "Normal"]),
    ],
)
def test_what_a_device_reports_becomes_execution_and_condition(
    plant: Plant, changes: dict[str, Any], expected: list[str]
) -> None:
    Device.objects.update(**changes)
    root = plant.ask("current")
    condition = etree.QName(root.find(".//{*}Condition")[0]).localname
    assert [*texts(root, "Availability", "Execution"), condition] == expected


def test_samples_lead_on_from_one_answer_to_the_next(plant: Plant) -> None:
    for seconds in range(0, 300, 60):
        plant.say(seconds, in_DEG_C=20 + seconds / 60)
    root = plant.ask("sample", count=3)
    assert header(root)["first"] == 1
    seen = []
    while True:
        seen += [(int(e.get("sequence")), e.text) for e in root.iter("{*}Temperature")]
        if header(root)["next"] > header(root)["last"]:
            break
        root = plant.ask("sample", from_=header(root)["next"], count=3)
    assert [text for _, text in seen] == ["20.0", "21.0", "22.0", "23.0", "24.0"]
    assert [number for number, _ in seen] == sorted({number for number, _ in seen})
    assert plant.ask("sample", from_=header(root)["next"]).findall(".//{*}ComponentStream") == []
    plant.say(330, in_DEG_C=30)
    assert texts(plant.ask("sample", from_=header(root)["next"]), "Temperature") == ["30.0"]


@pytest.mark.parametrize(
    ("query", "code"),
    [
        ({"from_": 0}, "OUT_OF_RANGE"),
        ({"from_": 10_000}, "OUT_OF_RANGE"),
        ({"from_": "x"}, "INVALID_REQUEST"),
        ({"from_": "9" * 40}, "INVALID_REQUEST"),
        ({"count": 0}, "OUT_OF_RANGE"),
        ({"count": -1}, "OUT_OF_RANGE"),
        ({"count": 5_001}, "OUT_OF_RANGE"),
        ({"count": "many"}, "INVALID_REQUEST"),
        ({"interval": 100}, "UNSUPPORTED"),
    ],
)
def test_what_is_asked_wrongly_is_answered_in_the_standards_own_way(
    plant: Plant, query: dict[str, Any], code: str
) -> None:
    plant.say(0, in_DEG_C=20)
    root = plant.ask("sample", 400, **query)
    assert [error.get("errorCode") for error in root.iter("{*}Error")] == [code]


def test_a_site_without_devices_says_so(plant: Plant) -> None:
    Device.objects.update(lifecycle="pending")
    for call in ("probe", "current", "sample"):
        assert [e.get("errorCode") for e in plant.ask(call, 404).iter("{*}Error")] == ["NO_DEVICE"]


@pytest.mark.parametrize("role", [*ROLES, "stranger", "nobody"])
def test_every_member_may_read_and_strangers_learn_nothing(plant: Plant, role: str) -> None:
    client = Client()
    if role != "nobody":
        client.force_login(User.objects.get(email=f"{role}@vipo.example"))
    expected = {"stranger": 404, "nobody": 401}.get(role, 200)
    answers = [client.get(f"{ADDRESS}/{call}") for call in ("probe", "current", "sample")]
    assert [answer.status_code for answer in answers] == [expected] * 3
    assert role != "stranger" or answers[0].json()["code"] == "not_found"

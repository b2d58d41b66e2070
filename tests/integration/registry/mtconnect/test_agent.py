"""A site as an MTConnect agent: each document holds against the schema, and numbers lead on from one to the next."""

from __future__ import annotations

from dataclasses import replace
from datetime import timedelta
from typing import Any

import pytest
from django.utils import timezone
from lxml import etree

from registry import services
from registry.devices import samples
from registry.devices.samples import SampleBuffer
from registry.models import Device, Sample, SampleClock
from registry.mtconnect.data_items import MEASURES
from tests.kit.files import ROOT
from tests.kit.sign_in import ROLES, signed_in
from tests.kit.sites import MIXER, ROBOT, come, describe, say
from vipo_device.protocol.description import PropertySpec

SCHEMAS = ROOT / "tests" / "fixtures" / "mtconnect"
ADDRESS = "/api/sites/hall/mtconnect"
SHED = "/api/sites/shed/mtconnect"
OTHER_TEMPERATURES = {"DEG_F", "K"}
PROPERTIES = (
    *(
        PropertySpec(f"in_{unit.replace('-', '_')}", "number", unit)
        for unit in MEASURES
        if unit not in OTHER_TEMPERATURES
    ),
    PropertySpec("lid", "text"),
    PropertySpec("wet", "boolean"),
    PropertySpec("stock", "number"),
    PropertySpec("error", "text"),
)
START = timezone.now() - timedelta(minutes=10)


class Plant:
    """A site with one device, 7.a, that can be made to speak."""

    def __init__(self) -> None:
        self.client = signed_in("viewer")
        self.seq = 0

    def say(self, seconds: float, *, done: bool = True, **readings: Any) -> None:
        self.seq += 1
        at = START + timedelta(seconds=seconds)
        say("7.a", at=at, seq=self.seq, done=done, props=readings)
        services.flush_samples(all_of_it=True)

    def ask(self, call: str, status: int = 200, address: str = ADDRESS, **query: Any) -> Any:
        answer = self.client.get(f"{address}/{call}", {name.rstrip("_"): value for name, value in query.items()})
        assert (answer.status_code, answer["Content-Type"]) == (status, "application/xml")
        root = etree.fromstring(answer.content)
        name = etree.QName(root).localname
        etree.XMLSchema(etree.parse(SCHEMAS / f"{name}_1.2.xsd")).assertValid(root)
        return root


@pytest.fixture
def plant(hall: str, monkeypatch: pytest.MonkeyPatch) -> Plant:
    topic = "vipo/v1/dev/7.a/down/mix"
    describe(replace(MIXER, id="7.a", properties=PROPERTIES, methods=(replace(MIXER.methods[0], topic=topic),)))
    Device.objects.update(lifecycle="approved")
    come("7.a", at=START)
    monkeypatch.setattr(samples, "_buffer", SampleBuffer())
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
    assert {"AVAILABILITY", "EXECUTION", "error", "warning", "lid", "in_DEG_C"} <= set(items)
    assert [items["in_DEG_C"].get(key) for key in ("category", "type", "units")] == ["SAMPLE", "TEMPERATURE", "CELSIUS"]
    assert [items["stock"].get(key) for key in ("category", "type", "units")] == ["EVENT", "MESSAGE", None]


def test_current_says_how_devices_are_in_the_units_of_the_standard(plant: Plant) -> None:
    plant.say(1, done=False, in_DEG_C=61.5, in_M=1.25, in_MIN=2, lid="a<&>", wet=True, stock=24)
    root = plant.ask("current")
    assert texts(root, "Availability", "Execution") == ["AVAILABLE", "ACTIVE"]
    assert texts(root, "Temperature") == ["61.5"]
    assert sorted(texts(root, "Displacement")) == ["1250.0", "UNAVAILABLE", "UNAVAILABLE"]
    assert sorted(texts(root, "AccumulatedTime")) == ["120.0", "UNAVAILABLE", "UNAVAILABLE"]
    assert texts(root, "Message") == ["a<&>", "true", "24"]
    assert [element.get("name") for element in root.iter("{*}Normal")] == ["error", "warning"]


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
        ({"online": False}, ["UNAVAILABLE", "UNAVAILABLE", "Unavailable", "Unavailable"]),
        ({"properties": {"error": "Lid open"}}, ["AVAILABLE", "STOPPED", "Fault", "Normal"]),
        ({"properties": {"warning": "Low"}}, ["AVAILABLE", "READY", "Normal", "Warning"]),
        ({"done": False}, ["AVAILABLE", "ACTIVE", "Normal", "Normal"]),
        ({"properties": {"in_M": 1e308}}, ["AVAILABLE", "READY", "Normal", "Normal"]),
    ],
)
def test_what_a_device_reports_becomes_execution_and_condition(
    plant: Plant, changes: dict[str, Any], expected: list[str]
) -> None:
    Device.objects.update(**changes)
    root = plant.ask("current")
    conditions = [etree.QName(element).localname for element in root.find(".//{*}Condition")]
    assert [*texts(root, "Availability", "Execution"), *conditions] == expected


def test_samples_lead_on_from_one_answer_to_the_next(plant: Plant) -> None:
    for seconds in range(0, 300, 60):
        plant.say(seconds, in_DEG_C=20 + seconds / 60)
    root = plant.ask("sample", count=3)
    assert header(root)["first"] == Sample.objects.earliest("seq").seq
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
        ({"interval": "soon"}, "INVALID_REQUEST"),
        ({"interval": -1}, "OUT_OF_RANGE"),
        ({"interval": 100, "heartbeat": 0}, "OUT_OF_RANGE"),
        ({"interval": 100, "from_": 10_000}, "OUT_OF_RANGE"),
        ({"path": "//DataItem["}, "INVALID_PATH"),
        ({"path": "//Axes"}, "INVALID_PATH"),
        ({"path": "count(//DataItem) > 0"}, "INVALID_PATH"),
    ],
)
def test_what_is_asked_wrongly_is_answered_in_the_standards_own_way(
    plant: Plant, query: dict[str, Any], code: str
) -> None:
    plant.say(0, in_DEG_C=20)
    root = plant.ask("sample", 400, **query)
    assert [error.get("errorCode") for error in root.iter("{*}Error")] == [code]


@pytest.mark.parametrize(
    ("query", "code"),
    [
        ({"at": 0}, "OUT_OF_RANGE"),
        ({"at": 10_000}, "OUT_OF_RANGE"),
        ({"at": "x"}, "INVALID_REQUEST"),
        ({"at": 1, "interval": 100}, "INVALID_REQUEST"),
        ({"path": "//" * 600}, "INVALID_PATH"),
    ],
)
def test_current_is_asked_wrongly(plant: Plant, query: dict[str, Any], code: str) -> None:
    plant.say(0, in_DEG_C=20)
    assert [e.get("errorCode") for e in plant.ask("current", 400, **query).iter("{*}Error")] == [code]


def test_numbers_go_on_where_a_backup_knows_only_older_ones(plant: Plant) -> None:
    plant.say(0, in_DEG_C=20)
    before = header(plant.ask("sample"))["next"]
    SampleClock.objects.update(next=7)
    plant.say(60, in_DEG_C=21)
    assert texts(plant.ask("sample", from_=before), "Temperature") == ["21.0"]


def test_a_site_that_was_silent_goes_on_from_the_number_it_gave(plant: Plant) -> None:
    services.create_site(name="Shed", slug="shed")
    services.set_member(site="shed", email="viewer@vipo.example", role="viewer")
    services.expect_device(site="shed", device_id="8.b", credential="k" * 32, approved=True)
    describe(replace(MIXER, id="8.b", site="shed", properties=PROPERTIES, methods=()))
    plant.say(0, in_DEG_C=20)
    begun = header(plant.ask("current", address=SHED))["next"]
    plant.say(60, in_DEG_C=21)
    come("8.b", at=START)
    say("8.b", at=START, props={"in_DEG_C": 22})
    services.flush_samples(all_of_it=True)
    assert texts(plant.ask("sample", address=SHED, from_=begun), "Temperature") == ["22.0"]


def test_a_path_chooses_among_what_devices_tell(plant: Plant) -> None:
    plant.say(0, in_DEG_C=20, in_M=1, lid="open")
    for path, expected in {
        '//DataItem[@type="TEMPERATURE"]': ["20.0"],
        "//DataItem[@category='SAMPLE' and @name='in_M']|//DataItem[@name='lid']": ["1000.0", "open"],
        "//m:Device[@name='7.a']//DataItem[@name='in_DEG_C']": ["20.0"],
    }.items():
        for call in ("current", "sample"):
            root = plant.ask(call, path=path)
            assert [e.text for e in root.iter("{*}Temperature", "{*}Displacement", "{*}Message")] == expected
            assert root.find(".//{*}Availability") is None
    root = plant.ask("sample", path="//DataItem[@name='lid']", count=1)
    assert header(root)["next"] == int(root.find(".//{*}Message").get("sequence")) + 1


def test_current_tells_how_devices_were_when_an_observation_was_made(plant: Plant) -> None:
    for minute, (heat, done, error) in enumerate([(20, True, ""), (21, False, ""), (22, True, "Lid open")]):
        plant.say(60 * minute, done=done, in_DEG_C=heat, error=error)
    root = plant.ask("sample")
    heats = [int(e.get("sequence")) for e in root.iter("{*}Temperature")]
    told = []
    for number in (heats[1] - 1, heats[2] - 1, header(root)["last"]):
        root = plant.ask("current", at=number)
        told.append((*texts(root, "Temperature", "Execution"), len(texts(root, "Fault"))))
    assert told == [("20.0", "READY", 0), ("21.0", "ACTIVE", 0), ("22.0", "STOPPED", 1)]


def test_a_device_has_addresses_of_its_own(plant: Plant) -> None:
    describe(ROBOT)
    Device.objects.update(lifecycle="approved")
    for name in ("7.a", "urn:vipo:device:7.a"):
        assert [d.get("name") for d in plant.ask(f"{name}/probe").iter("{*}Device")] == ["7.a"]
        assert [d.get("name") for d in plant.ask(f"{name}/current").iter("{*}DeviceStream")] == ["7.a"]
        assert [d.get("name") for d in plant.ask(f"{name}/sample").iter("{*}DeviceStream")] == ["7.a"]
    assert [e.get("errorCode") for e in plant.ask("8.b/current", 404).iter("{*}Error")] == ["NO_DEVICE"]


def test_conditions_come_and_go_in_samples(plant: Plant) -> None:
    plant.say(0, error="Lid open")
    plant.say(60, error="")
    conditions = plant.ask("sample", path="//DataItem[@category='CONDITION']").find(".//{*}Condition")
    assert [(etree.QName(e).localname, e.get("name"), e.text) for e in conditions] == [
        ("Fault", "error", "Lid open"),
        ("Normal", "error", None),
    ]


def test_a_site_without_devices_says_so(plant: Plant) -> None:
    Device.objects.update(lifecycle="pending")
    for call in ("probe", "current", "sample"):
        assert [e.get("errorCode") for e in plant.ask(call, 404).iter("{*}Error")] == ["NO_DEVICE"]


@pytest.mark.parametrize("role", [*ROLES, "stranger", "nobody"])
def test_every_member_may_read_and_strangers_learn_nothing(plant: Plant, role: str) -> None:
    client = signed_in(role)
    expected = {"stranger": 404, "nobody": 401}.get(role, 200)
    calls = ("probe", "current", "sample", "7.a/probe", "7.a/current", "7.a/sample", "sample?interval=1000")
    answers = [client.get(f"{ADDRESS}/{call}") for call in calls]
    assert [answer.status_code for answer in answers] == [expected] * len(calls)
    assert role != "stranger" or answers[0].json()["code"] == "not_found"


def test_what_has_not_changed_for_eight_days_is_how_it_was_then_too(plant: Plant) -> None:
    Device.objects.update(last_seen_at=None)
    plant.say(-8 * 86_400, in_DEG_C=60)
    plant.say(-8 * 86_400 + 60, in_M=1)
    services.prune_samples(now=START)
    plant.say(0, in_M=2)
    first = header(plant.ask("current"))["first"]
    assert first == header(plant.ask("current"))["last"]  # from there on everything is kept
    then = plant.ask("current", at=first)
    assert (texts(then, "Availability"), texts(then, "Temperature")) == (["AVAILABLE"], ["60.0"])

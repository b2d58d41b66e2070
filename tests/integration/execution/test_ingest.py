"""Messages are taken in each device's own order, and each is acknowledged once."""

from __future__ import annotations

import json
import threading
from collections import Counter
from typing import Any

import pytest
from django.db import DatabaseError

from execution.gateway.ingest import ENROLMENT, Ingester
from execution.gateway.queue import Entry
from registry import services
from registry.models import DeviceEvent
from vipo_device.descriptions.reader import write_description
from vipo_device.protocol.description import Description, Pose, Size
from vipo_device.protocol.mqtt_client import Message

pytestmark = pytest.mark.django_db


class Post:
    """Makes messages of devices, and notes which of them were acknowledged."""

    def __init__(self) -> None:
        self.acknowledged: list[int] = []
        self.made = 0

    def __call__(self, device: str, kind: str, body: Any) -> Entry:
        number, self.made = self.made, self.made + 1
        payload = body if isinstance(body, bytes) else json.dumps(body).encode()
        acknowledge = lambda: self.acknowledged.append(number)  # noqa: E731
        return Entry(Message(f"vipo/v1/dev/{device}/up/{kind}", payload, False, acknowledge), device, kind)


def description(device: str, name: str = "") -> bytes:
    pose, size = Pose(1, 1), Size(1, 1, 1)
    return write_description(Description(device, name or device, "machine", "mixer", pose, size, site="hall")).encode()


def state(seq: int, **more: Any) -> dict[str, Any]:
    return {"boot": 1, "seq": seq, "done": True, **more}


@pytest.fixture
def notes() -> list[tuple[str, str]]:
    services.create_site(name="Hall", slug="hall")
    return []


@pytest.fixture
def ingester(notes: list[tuple[str, str]]) -> Ingester:
    return Ingester(lambda device, line, _: notes.append((device, line)), Counter())


def readings(device: str) -> dict[str, Any]:
    return dict(services.get_device(site="hall", device_id=device).readings)


def test_a_device_that_describes_itself_and_speaks_in_one_breath_is_known_and_heard(ingester: Ingester) -> None:
    post = Post()
    entries = [post(device, "desc", description(device)) for device in ("a", "b")]
    entries += [post(device, "state", state(1, props={"stock": 3})) for device in ("a", "b")]
    ingester.ingest_all(entries, threading.Event())
    assert readings("a") == readings("b") == {"stock": 3}
    assert sorted(post.acknowledged) == [0, 1, 2, 3]


def test_states_of_one_device_are_taken_in_their_order(ingester: Ingester) -> None:
    post = Post()
    entries = [post("a", "desc", description("a")), post("a", "state", state(1, props={"stock": 1}))]
    entries += [post("b", "desc", description("b")), post("a", "state", state(2, props={"stock": 2}))]
    ingester.ingest_all(entries, threading.Event())
    assert readings("a") == {"stock": 2}
    assert sorted(post.acknowledged) == [0, 1, 2, 3]


def test_what_cannot_be_read_is_noted_and_harms_no_other(ingester: Ingester, notes: list[tuple[str, str]]) -> None:
    post = Post()
    ingester.ingest_all([post(device, "desc", description(device)) for device in ("a", "b")], threading.Event())
    ingester.ingest_all([post("a", "state", b"{"), post("b", "state", state(1, props={"stock": 5}))], threading.Event())
    assert readings("b") == {"stock": 5}
    assert [device for device, _ in notes] == ["a"]
    assert notes[0][1].startswith("state: ")
    assert sorted(post.acknowledged) == [0, 1, 2, 3]


def test_an_unchanged_description_is_acknowledged_and_a_changed_one_taken(ingester: Ingester) -> None:
    post = Post()
    ingester.ingest_all([post(device, "desc", description(device)) for device in ("a", "b")], threading.Event())
    ingester.ingest_all(
        [post("a", "desc", description("a")), post("b", "desc", description("b", "B2"))], threading.Event()
    )
    names = [services.get_device(site="hall", device_id=device).name for device in ("a", "b")]
    assert (names, sorted(post.acknowledged)) == (["a", "B2"], [0, 1, 2, 3])


def test_when_a_batch_cannot_be_kept_each_message_is_tried_by_itself(
    ingester: Ingester, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(**_: Any) -> Any:
        raise DatabaseError("The batch is too large.")

    post = Post()
    ingester.ingest_all([post(device, "desc", description(device)) for device in ("a", "b")], threading.Event())
    monkeypatch.setattr(services, "ingest_states", refuse)
    monkeypatch.setattr(services, "find_unchanged", refuse)
    entries = [post("a", "desc", description("a")), post("b", "state", state(1, props={"stock": 7}))]
    ingester.ingest_all(entries, threading.Event())
    assert readings("b") == {"stock": 7}
    assert sorted(post.acknowledged) == [0, 1, 2, 3]


def test_a_description_that_is_refused_is_noted_and_harms_no_other(
    ingester: Ingester, notes: list[tuple[str, str]]
) -> None:
    post = Post()
    entries = [post("a", "desc", description("a")), post("b", "desc", b"no RDF"), post("c", "desc", description("d"))]
    ingester.ingest_all([*entries, post("d", "desc", description("d"))], threading.Event())
    assert [d.id for d in services.list_devices(site="hall")] == ["a", "d"]
    assert [device for device, _ in notes] == ["b", "c"]
    assert all(line.startswith("desc: ") for _, line in notes)
    assert sorted(post.acknowledged) == [0, 1, 2, 3]


def test_what_is_refused_stands_in_the_history_with_its_faults_for_readers_of_every_language() -> None:
    services.create_site(name="Hall", slug="hall")
    ingester = Ingester(
        lambda device, line, facts: services.record_problem(device_id=device, text=line, facts=facts), Counter()
    )
    post = Post()
    ingester.ingest_all([post("a", "desc", description("a")), post("a", "desc", b'{"id": "a",}')], threading.Event())
    line = DeviceEvent.objects.get(device="a", kind="problem")
    (fault,) = line.args["faults"]
    assert (line.code, line.args["kind"], fault["code"], fault["line"], fault["column"]) == (
        "problem", "desc", "json_key", 1, 12,
    )  # fmt: skip
    assert line.text == f"desc: {fault['text']} See line 1, column 12."


def test_descriptions_that_cannot_be_kept_together_are_kept_one_by_one_and_then_acknowledged(
    ingester: Ingester, monkeypatch: pytest.MonkeyPatch
) -> None:
    tried: list[int] = []

    def refuse(*, descriptions: Any) -> Any:
        tried.append(len(descriptions))
        assert post.acknowledged == []
        raise DatabaseError("The batch is too large.")

    post = Post()
    monkeypatch.setattr(services, "ingest_descriptions", refuse)
    ingester.ingest_all([post(device, "desc", description(device)) for device in ("a", "b")], threading.Event())
    assert [d.id for d in services.list_devices(site="hall")] == ["a", "b"]
    assert (tried, sorted(post.acknowledged)) == ([2], [0, 1])


@pytest.mark.parametrize("body", [{"key": "short"}, {"key": "k" * 32}, b"{"])
def test_whoever_asks_to_be_enrolled_by_another_sites_id_writes_nothing_into_its_history(
    notes: list[tuple[str, str]], ingester: Ingester, body: Any
) -> None:
    services.create_site(name="Shed", slug="shed")
    services.expect_device(site="shed", device_id="shed.robot", credential="r" * 32)
    payload = body if isinstance(body, bytes) else json.dumps(body).encode()
    for site in ("hall", "shed"):
        asked = Message(f"vipo/v1/join/{site}/shed.robot", payload, False, lambda: None)
        ingester.ingest_all([Entry(asked, "shed.robot", ENROLMENT)], threading.Event())
    assert [device for device, _ in notes] == ["join:hall", "shed.robot"]

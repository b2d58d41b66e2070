"""Alerts about commands and messages, raised and ended by the ticker and the ingester that also serve the product."""

import json
import threading
from collections import Counter
from datetime import UTC, datetime, timedelta
from uuid import uuid4

import pytest
from django.db import OperationalError, connection

from execution import services
from execution.gateway.gateway import note_complaint
from execution.gateway.ingest import Ingester
from execution.gateway.queue import Entry
from execution.models import Command, Run
from execution.ticker.ticker import Ticker
from registry import services as registry
from registry.alerts import buffer
from registry.alerts.buffer import NoteBuffer
from registry.models import Device, Site
from vipo_device.descriptions.reader import write_description
from vipo_device.protocol.description import Description, Pose, Size
from vipo_device.protocol.mqtt_client import Message

MIXER = Description("mixer", "Mixer", "machine", "mixer", Pose(1, 1), Size(1, 1, 1), site="hall")
NOW = datetime.now(UTC)


@pytest.fixture
def hall(db, monkeypatch):
    monkeypatch.setattr(buffer, "_buffer", NoteBuffer())
    registry.create_site(name="Hall", slug="hall")
    describe(MIXER)
    Device.objects.update(lifecycle="approved", online=True)
    return Site.objects.get(slug="hall")


def describe(description):
    payload = write_description(description).encode()
    return registry.ingest_description(device_id="mixer", payload=payload, at=NOW)


def add(site, method="mix", **more):
    return Command.objects.create(
        id=uuid4(), site=site, position=Command.objects.count(), device="mixer", method=method, send_after=NOW,
        created_at=NOW, **more,
    )  # fmt: skip


def answer(command, status, seconds=0, why=""):
    at = NOW + timedelta(seconds=seconds)
    services.record_ack(device="mixer", command_id=str(command.id), status=status, why=why, result={}, at=at)


@pytest.fixture
def tick(hall):
    ticker = Ticker()
    ticker.tick(NOW - timedelta(hours=1))
    return lambda seconds: ticker.tick(NOW + timedelta(seconds=seconds))


def alerts(state=None):
    return [(a.code, dict(a.args), a.count) for a in registry.list_alerts(site="hall", state=state)]


def test_commands_that_go_wrong_are_told_until_the_same_is_done(hall, tick):
    wrong = [add(hall), add(hall), add(hall, "heat")]
    answer(wrong[0], "REJECTED", 1, "Lid open")
    tick(2)
    tick(3)
    assert alerts() == [("command_rejected", {"method": "mix", "why": "Lid open"}, 1)]
    answer(wrong[1], "REJECTED", 4, "Lid still open")
    answer(wrong[2], "FAILED", 5)
    tick(6)
    tick(7)
    assert alerts() == [
        ("command_failed", {"method": "heat"}, 1),
        ("command_rejected", {"method": "mix", "why": "Lid still open"}, 2),
    ]
    answer(add(hall), "DONE", 8)
    tick(9)
    assert alerts() == [("command_failed", {"method": "heat"}, 1)]


def test_what_nobody_answers_is_told_and_what_people_ended_is_not(hall, tick):
    late = add(hall, by="Ada", status="sent")
    Command.objects.filter(id=late.id).update(created_at=NOW - timedelta(minutes=5))
    answer(add(hall), "CANCELED", 1)
    answer(add(hall, "pause"), "REJECTED", 1)
    answer(add(hall, "move", piece=True), "REJECTED", 1)
    tick(2)
    tick(4)
    (told,) = alerts()
    assert (told[0], told[1]["method"], told[2]) == ("command_timed_out", "mix", 1)


@pytest.mark.parametrize("needed", ["command", "run"])
def test_who_is_needed_and_gone_is_told(hall, tick, needed):
    if needed == "command":
        add(hall, status="running")
    else:
        Run.objects.create(
            site=hall, number=1, program=uuid4(), roles={"robot": "mixer"}, status="paused", created_at=NOW
        )
    registry.ingest_presence(device_id="mixer", payload=b'{"s": "offline", "boot": 1}', at=NOW)
    tick(3)
    assert alerts() == []
    tick(8)
    assert alerts() == [("offline_at_work", {}, 1)]


def test_refused_messages_are_told_until_better_ones_come(hall, tick):
    ingester = Ingester(note_complaint, Counter())

    def send(kind, payload):
        entry = Entry(Message(f"vipo/v1/dev/mixer/up/{kind}", payload, False, lambda: None), "mixer", kind)
        ingester.ingest_all([entry], threading.Event())
        registry.flush_alerts()

    send("desc", b"not a description")
    send("state", json.dumps({"boot": -1}).encode())
    assert sorted(code for code, _, _ in alerts()) == ["description_refused", "messages_refused"]
    assert all(args["why"] for _, args, _ in alerts())
    assert {args["faults"][0]["code"] for _, args, _ in alerts()} == {"rdf_subject", "state_done"}
    send("desc", write_description(MIXER).encode())
    assert [code for code, _, _ in alerts()] == ["messages_refused"]
    note_complaint("mixer", "too many messages: some were dropped")
    note_complaint("mixer", "knock/: nobody's")
    registry.flush_alerts()
    assert sorted(code for code, _, _ in alerts()) == ["messages_dropped", "messages_refused"]
    tick(48 * 3600)  # long after, also where this module was read an hour before its tests ran
    assert [code for code, _, _ in alerts()] == ["offline"]


def _hear(payload):
    """Let a gateway that has just been started hear a description, and write its alerts."""
    entry = Entry(Message("vipo/v1/dev/mixer/up/desc", payload, False, lambda: None), "mixer", "desc")
    Ingester(note_complaint, Counter()).ingest_all([entry], threading.Event())
    registry.flush_alerts()


def test_a_refused_description_is_over_once_any_gateway_hears_the_former_one_again(hall, monkeypatch):
    good = write_description(MIXER).encode()
    _hear(b"not a description")
    assert [code for code, _, _ in alerts()] == ["description_refused"]
    monkeypatch.setattr(buffer, "_buffer", NoteBuffer())  # another gateway, or this one started anew
    _hear(good)
    assert alerts() == []
    _hear(b"not a description")
    assert [code for code, _, _ in alerts()] == ["description_refused"]


def test_a_good_description_is_not_the_end_of_a_later_refusal(hall, monkeypatch):
    one, two = NoteBuffer(), NoteBuffer()
    monkeypatch.setattr(buffer, "_buffer", one)
    registry.note_mended(devices=["mixer"], code="description_refused")
    monkeypatch.setattr(buffer, "_buffer", two)
    _hear(b"not a description")
    monkeypatch.setattr(buffer, "_buffer", one)
    registry.flush_alerts()
    assert [code for code, _, _ in alerts()] == ["description_refused"]


def test_that_a_description_was_taken_outlasts_a_database_that_is_away(hall):
    _hear(b"not a description")
    registry.note_mended(devices=["mixer"], code="description_refused")

    def away(*_):
        raise OperationalError("server closed the connection unexpectedly")

    with connection.execute_wrapper(away):
        registry.flush_alerts()
    registry.flush_alerts()
    assert alerts() == []


def test_what_failed_again_after_it_was_done_stays_an_alert_though_both_were_seen_at_once(hall, tick):
    first, second, third = add(hall), add(hall), add(hall)
    answer(first, "FAILED", 1, "Lid open")
    tick(2)
    answer(second, "DONE", 2.3)
    answer(third, "FAILED", 2.7, "Jam")
    for seconds in (3.1, 4.2, 90):
        tick(seconds)
        assert alerts() == [("command_failed", {"method": "mix", "why": "Jam"}, 2)]

"""A device that knows only the paper's done flag: what comes of a command is read from the flag's edges."""

import json
import threading
from collections import Counter
from datetime import UTC, datetime, timedelta
from uuid import uuid4

import pytest

from execution import database, services
from execution.gateway.ingest import Ingester
from execution.gateway.queue import Entry, Inbox
from execution.models import Command
from registry import services as registry
from tests.kit.files import FIGURE_5
from vipo_device.protocol.mqtt_client import Message

FIGURE = FIGURE_5 + b"site: hall\n"
NAME = "paintMixer02"


@pytest.fixture
def mixer(db):
    registry.create_site(name="Hall", slug="hall")
    registry.ingest_description(device_id=NAME, payload=FIGURE, at=datetime.now(UTC))
    registry.approve_device(site="hall", device_id=NAME, by=None, at=datetime.now(UTC))
    return Mixer()


class Mixer:
    def __init__(self):
        self.seq, self.problems = 0, []
        self.counts = Counter()
        self.ingester = Ingester(lambda device, reason, _: self.problems.append(reason), self.counts)

    def say(self, kind, *bodies):
        """Say messages of a kind; several come while the gateway is busy, and wait together."""
        topic, inbox = f"vipo/v1/dev/{NAME}/up/{kind}", Inbox()
        for body in bodies:
            payload = body if isinstance(body, bytes) else json.dumps(body).encode()
            assert inbox.put(Entry(Message(topic, payload, False, lambda: None), NAME, kind))
        self.ingester.ingest_all(inbox.get_all(0, 200), threading.Event())
        assert self.problems == []

    def say_done(self, *flags):
        first, self.seq = self.seq + 1, self.seq + len(flags)
        self.say("state", *({"boot": 1, "seq": first + number, "done": done} for number, done in enumerate(flags)))


def send(method="mixPaint", position=1):
    now = datetime.now(UTC) - timedelta(seconds=1)
    site = registry.find_device(device_id=NAME)
    row = Command(id=uuid4(), position=position, device=NAME, method=method, send_after=now, created_at=now)
    row.site_id = Command._meta.get_field("site").related_model.objects.get(slug=site.site).pk
    row.save()
    (going,) = services.claim_commands(limit=10)
    services.mark_sent(sent={going.id: database.now()})
    return row


def status(row):
    row.refresh_from_db()
    return row.status


def test_a_command_is_done_when_the_flag_falls_and_rises_again(mixer):
    mixer.say_done(True)
    row = send()
    mixer.say_done(True)
    assert status(row) == "sent"
    mixer.say_done(False)
    assert (status(row), row.why) == ("running", "Seen at work by its done flag.")
    mixer.say_done(False)
    mixer.say_done(True)
    assert (status(row), row.why) == ("done", "")
    assert row.ended_at is not None


def test_a_job_is_done_though_its_beginning_and_end_waited_together(mixer):
    mixer.say_done(True)
    row = send()
    mixer.say_done(False, False, True, True)
    assert (status(row), row.why) == ("done", "")


def test_of_two_jobs_that_waited_together_both_are_done(mixer):
    mixer.say_done(True)
    rows = [send(position=1), send(position=2)]
    mixer.say_done(False, True, False, True)
    assert [status(row) for row in rows] == ["done", "done"]


def test_work_that_was_under_way_before_does_not_count(mixer):
    mixer.say_done(False)
    row = send()
    mixer.say_done(True)
    assert status(row) == "sent"


def test_it_is_sent_once_since_the_device_would_do_it_again(mixer):
    row = send()
    mixer.say_done(False)
    Command.objects.filter(id=row.id).update(created_at=datetime.now(UTC) - timedelta(hours=1))
    mixer.say("presence", {"s": "online", "boot": 1})
    row.refresh_from_db()
    assert row.tries == 1
    assert row.send_after > datetime.now(UTC) + timedelta(days=1)
    assert services.claim_commands(limit=10) == ()


def test_the_flag_in_the_papers_message_counts_as_well(mixer):
    row = send()
    assert b"done: False" in FIGURE
    mixer.say("desc", FIGURE.replace(b"done: False", b"done: True"))
    mixer.say("desc", FIGURE)
    assert status(row) == "running"
    mixer.say("desc", FIGURE.replace(b"done: False", b"done: True"))
    assert status(row) == "done"


def test_whoever_answers_is_judged_by_the_answers(mixer):
    row = send()
    mixer.say("ack", {"id": str(row.id), "st": "ACCEPTED"})
    mixer.say_done(False)
    mixer.say_done(True)
    assert status(row) == "accepted"
    mixer.say("ack", {"id": str(row.id), "st": "FAILED", "why": "Empty"})
    assert (status(row), row.why) == ("failed", "Empty")


def test_that_a_device_comes_is_no_word_of_its_done_flag(mixer):
    mixer.say_done(False)
    row = send()
    mixer.say("presence", {"s": "online", "boot": 1})
    assert status(row) == "sent"
    mixer.say_done(True)
    assert status(row) == "sent"


def test_messages_of_kinds_that_nobody_knows_are_one_count(mixer):
    for number in range(100):
        mixer.say("x" * (number + 1), {"a": 1})
    assert dict(mixer.counts) == {"topic up": 100}

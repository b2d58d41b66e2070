"""What many devices say at once comes to the same as what they say one after the other."""

from __future__ import annotations

import json
from dataclasses import replace
from datetime import timedelta
from typing import Any

import pytest

from registry import services
from registry.devices.views import changed_fields, changed_state
from registry.models import Device, DeviceEvent
from registry.services import BadDevice, StateMessage
from tests.kit.sites import MIXER, NOW, ROBOT, come, describe
from vipo_device.descriptions.reader import write_description
from vipo_device.protocol.messages import BadMessage


def state(seq: int, **more: Any) -> bytes:
    return json.dumps({"boot": 1, "seq": seq, "done": True, **more}).encode()


def said(device_id: str, payload: bytes, *, retained: bool = False) -> StateMessage:
    return StateMessage(device_id, payload, NOW, retained)


@pytest.fixture
def three(hall: str) -> None:
    for description in (MIXER, ROBOT, replace(ROBOT, id="robot2", name="Robot Two")):
        describe(description)
        come(description.id)
    Device.objects.update(lifecycle=Device.Lifecycle.APPROVED)


def test_states_of_several_devices_are_kept_and_told(
    three: None, heard: list[Any], django_capture_on_commit_callbacks: Any
) -> None:
    with django_capture_on_commit_callbacks(execute=True):
        outcomes = services.ingest_states(
            states=[
                said("robot2", state(1, loc=[1, 2, 0, 0.5], props={"load": "box:2"})),
                said("mixer1", state(1, done=False, props={"jobStatus": 40})),
            ]
        )
    assert outcomes == tuple(services.get_device(site="hall", device_id=name) for name in ("robot2", "mixer1"))
    told = {message["device"]["id"]: message["device"] for _, message in heard}
    assert told["robot2"] == {
        "id": "robot2", "doing": "Carrying 2 boxes", "carrying": {"box": 2},
        "activity": {"code": "carrying", "args": {"box": 2}},
        "location": {"x": 1.0, "y": 2.0, "z": 0.0, "theta": 0.5},
    }  # fmt: skip
    assert (told["mixer1"]["status"], told["mixer1"]["properties"][0]["value"]) == ("busy", 40)
    assert len(heard) == 2


def test_each_message_has_its_own_fate(three: None) -> None:
    services.ingest_states(states=[said("robot1", state(5, props={"battery": 50}))])
    old, broken, unknown, fine = services.ingest_states(
        states=[
            said("robot1", state(5, props={"battery": 99})),
            said("mixer1", b'{"boot": 1}'),
            said("nobody", state(1)),
            said("robot2", state(1, props={"battery": 80})),
        ]
    )
    assert old is None
    assert unknown is None
    assert isinstance(broken, BadMessage)
    assert isinstance(fine, services.DeviceView)
    assert fine.readings == {"battery": 80}
    assert services.get_device(site="hall", device_id="robot1").readings == {"battery": 50}
    assert not Device.objects.filter(pk="nobody").exists()


def test_a_retained_state_does_not_bring_a_device_online(hall: str) -> None:
    describe()
    services.ingest_states(states=[said("mixer1", state(1), retained=True)])
    assert not services.get_device(site="hall", device_id="mixer1").online
    services.ingest_states(states=[said("mixer1", state(2))])
    assert services.get_device(site="hall", device_id="mixer1").online


def test_a_device_without_a_description_is_kept_and_told_to_nobody(three: None, heard: list[Any]) -> None:
    Device.objects.create(pk="silent", site=Device.objects.get(pk="robot1").site)
    assert services.ingest_states(states=[said("silent", state(1)), said("robot1", state(1))])[0] is None
    assert (Device.objects.get(pk="silent").seq, Device.objects.get(pk="robot1").seq) == (1, 1)


def test_an_error_among_many_states_is_written_into_that_devices_history(three: None) -> None:
    services.ingest_states(states=[said("robot1", state(1, props={"error": "stuck"})), said("robot2", state(1))])
    services.ingest_states(states=[said("robot1", state(2, props={"error": ""})), said("robot2", state(2))])
    lines = DeviceEvent.objects.filter(kind__in=("error", "recovered")).order_by("pk")
    assert [(line.device_id, line.text) for line in lines] == [
        ("robot1", "Reports an error: stuck"),
        ("robot1", "Reports no error any more"),
    ]


def test_what_is_told_of_a_state_is_what_differs(three: None) -> None:
    before = services.get_device(site="hall", device_id="robot1")
    payload = state(1, done=False, loc=[3, 1, 0, 0], props={"battery": 10, "load": "can:1", "jobStatus": 7})
    services.ingest_state(device_id="robot1", payload=payload, at=NOW + timedelta(seconds=1))
    after = services.get_device(site="hall", device_id="robot1")
    assert changed_state(before, after) == changed_fields(before, after)


def test_descriptions_that_say_nothing_new_are_found(hall: str) -> None:
    describe()
    describe(ROBOT)
    own = {d.id: write_description(d).encode() for d in (MIXER, replace(ROBOT, name="Other"))}
    later = NOW + timedelta(seconds=60)
    assert services.find_unchanged(descriptions={**own, "nobody": b"x"}, at=later) == {"mixer1"}
    assert services.get_device(site="hall", device_id="mixer1").last_seen_at == later
    assert services.get_device(site="hall", device_id="robot1").last_seen_at == NOW


def test_who_counts_as_offline_and_says_old_states_only_is_refused_with_the_reason(three: None) -> None:
    services.ingest_states(states=[said("robot1", state(5))])
    assert services.ingest_states(states=[said("robot1", state(1))]) == (None,)
    Device.objects.update(online=False)
    assert services.ingest_states(states=[said("robot1", state(1), retained=True)]) == (None,)
    (refused,) = services.ingest_states(states=[said("robot1", state(1))])
    assert isinstance(refused, BadDevice)
    assert "state 1 of start 1, but state 5 of start 1 was heard before" in refused.detail
    (fault,) = refused.facts["faults"]
    assert (fault["code"], fault["args"]) == ("old_state", {"seq": 1, "boot": 1, "last": 5, "start": 1})


def test_a_device_whose_key_was_taken_away_is_not_blamed_for_what_was_on_its_way(three: None) -> None:
    services.ingest_states(states=[said("robot1", state(5))])
    services.revoke_credential(site="hall", device_id="robot1", by=None, at=NOW)
    assert services.ingest_states(states=[said("robot1", state(5))]) == (None,)

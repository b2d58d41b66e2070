"""`vipo devices` and `vipo approve`."""

from __future__ import annotations

import json
from dataclasses import replace
from datetime import timedelta

import pytest

from registry import services
from registry.models import Site
from tests.kit.command_line import run_vipo
from tests.kit.sites import MIXER, NOW, ROBOT, come, describe
from vipo_device.protocol.description import MethodSpec


def test_devices_are_listed_with_their_state(hall: str, capsys: pytest.CaptureFixture[str]) -> None:
    describe()
    describe(ROBOT)
    come("robot1")
    services.approve_device(site="hall", device_id="mixer1", by=None, at=NOW)
    assert run_vipo(capsys, "devices", "--site", "hall") == (
        0,
        "id      name       site  kind     life      state    last seen\n"
        "mixer1  Mixer One  hall  machine  approved  offline  2026-11-21T12:00:00+00:00\n"
        "robot1  Robot One  hall  robot    pending   pending  2026-11-21T12:00:00+00:00\n",
        "",
    )
    code, out, _ = run_vipo(capsys, "devices", "--json")
    assert (code, [(d["id"], d["site"], d["lifecycle"]) for d in json.loads(out)]) == (
        0,
        [("mixer1", "hall", "approved"), ("robot1", "hall", "pending")],
    )
    assert run_vipo(capsys, "devices", "--site", "nowhere") == (2, "", "There is no site 'nowhere'.\n")
    code, out, err = run_vipo(capsys, "devices", "--site", "nowhere", "--json")
    assert (code, json.loads(out)["detail"] + "\n", err) == (2, err, "There is no site 'nowhere'.\n")


def test_a_device_is_approved_and_its_key_is_printed_once(hall: str, capsys: pytest.CaptureFixture[str]) -> None:
    describe()
    code, out, err = run_vipo(capsys, "approve", "mixer1")
    first, second, third = out.splitlines()
    assert (code, err) == (0, "")
    assert first == "Mixer One (mixer1) takes part at hall from now on."
    assert services.check_device_password(username="mixer1", password=second.removeprefix("Its key, shown this once: "))
    assert third == "Type it into the device, as its password."
    again = "mixer1 does not wait for a decision; it is approved.\n"
    assert run_vipo(capsys, "approve", "mixer1") == (2, "", again)
    unknown = "No device 'nothing' has described itself. Try: vipo devices\n"
    assert run_vipo(capsys, "approve", "nothing") == (2, "", unknown)


def test_a_devices_own_words_do_not_move_the_terminal(hall: str, capsys: pytest.CaptureFixture[str]) -> None:
    describe()
    services.raise_alert(device_id="mixer1", code="error", at=NOW, args={"why": "hot\n\x1b[2Jerror  hall"})
    code, out, _ = run_vipo(capsys, "alerts")
    assert (code, len(out.splitlines())) == (0, 2)
    assert out.endswith("It reports an error: hot\ufffd\ufffd[2Jerror  hall\n")


def test_one_with_a_key_of_its_own_keeps_it(hall: str, capsys: pytest.CaptureFixture[str]) -> None:
    services.expect_device(site="hall", device_id="mixer1", credential="k" * 32, approved=False)
    describe()
    code, out, _ = run_vipo(capsys, "approve", "mixer1", "--json")
    assert (code, json.loads(out)) == (0, {"device": "mixer1", "credential": None, "taken": False})


@pytest.mark.parametrize("command", ["enrolment-key", "join-key"])
def test_the_enrolment_key_is_shown_and_only_a_new_one_ends_it(
    command: str, hall: str, capsys: pytest.CaptureFixture[str]
) -> None:
    code, first, err = run_vipo(capsys, command, "hall")
    assert (code, err, run_vipo(capsys, command, "hall")) == (0, "", (0, first, ""))
    assert services.check_device_password(username="join:hall", password=first.strip())
    services.set_enrolment_key(site="hall", key="j" * 32)
    Site.objects.update(join_key_sealed="")
    told = run_vipo(capsys, command, "hall")
    assert told[0] == 2
    assert told[2].startswith("The enrolment key of hall cannot be shown")
    assert services.check_device_password(username="join:hall", password="j" * 32)
    services.set_enrolment_key(site="hall", key="j" * 32)
    assert [run_vipo(capsys, command, "hall") for _ in range(2)] == [(0, "j" * 32 + "\n", "")] * 2
    assert services.check_device_password(username="join:hall", password="j" * 32)
    Site.objects.update(join_key_at=NOW)
    code, out, err = run_vipo(capsys, command, "hall", "--new")
    assert (code, err) == (0, "")
    assert services.check_device_password(username="join:hall", password=out.strip())
    assert services.check_device_password(username="join:hall", password="j" * 32) is None
    assert run_vipo(capsys, command, "nowhere") == (2, "", "There is no site 'nowhere'.\n")


def test_a_legacy_topic_is_confirmed_by_its_name(hall: str, capsys: pytest.CaptureFixture[str]) -> None:
    describe(replace(MIXER, methods=(MethodSpec("mix", "plant/mix"),)))
    assert run_vipo(capsys, "approve", "mixer1", "--topic", "plant/mix")[0] == 2
    run_vipo(capsys, "approve", "mixer1")
    assert run_vipo(capsys, "approve", "mixer1", "--topic", "plant/mix") == (
        0,
        "Mixer One (mixer1) is told on plant/mix from now on.\n",
        "",
    )
    assert services.list_granted_topics() == {"mixer1": ("plant/mix",)}
    withdraw = ("approve", "mixer1", "--withdraw-topic", "plant/mix")
    assert run_vipo(capsys, *withdraw, "--json") == (
        0,
        '{"device": "mixer1", "topic": "plant/mix", "confirmed": false}\n',
        "",
    )
    assert services.list_granted_topics() == {}
    code, _, complaint = run_vipo(capsys, *withdraw)
    assert (code, "nothing is to be done" in complaint) == (2, True)


def test_alerts_of_all_sites_are_listed_with_the_latest_first(hall: str, capsys: pytest.CaptureFixture[str]) -> None:
    services.create_site(name="Shed", slug="shed")
    describe()
    services.expect_device(site="shed", device_id="robot1", credential="r" * 32)
    describe(replace(ROBOT, site="shed"))
    for minutes, device in ((0, "robot1"), (5, "mixer1"), (10, "robot1")):
        code = "error" if minutes == 0 else "warning"
        services.raise_alert(device_id=device, code=code, at=NOW + timedelta(minutes=minutes), args={"why": "hot"})
    _, out, _ = run_vipo(capsys, "alerts", "--json")
    assert [(a["site"], a["code"]) for a in json.loads(out)] == [
        ("shed", "warning"),
        ("hall", "warning"),
        ("shed", "error"),
    ]

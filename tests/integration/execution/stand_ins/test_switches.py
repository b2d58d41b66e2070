"""Devices that are simulated in place of the real ones: who may switch them, when, and for whom commands are then."""

import json
from datetime import UTC, datetime

import pytest

from execution import services
from execution.commands.claim import claim_commands
from execution.engine.drive import advance_site
from execution.floor.layouts import get_layout
from execution.models import Command
from execution.stand_ins.switches import simulate_device
from registry import services as registry
from registry.models import AuditLine, Device
from tests.integration.execution.test_calls import CURE
from tests.kit.programs import CARRY, SITE
from tests.kit.sign_in import EVERYBODY, ROLES, from_role, join_and_sign_in

pytestmark = pytest.mark.django_db(transaction=True)
MIXER = "paintMixer01"
PATH = f"/api/sites/{SITE}/devices/{MIXER}/stand-in"
HERE = b'{"s": "online", "boot": 1}'
NOW = datetime(2026, 11, 27, 12, 0, tzinfo=UTC)


def switch(device=MIXER, *, simulated=True):
    return simulate_device(site=SITE, device_id=device, simulated=simulated, by=None)


def said(boot, seq, **more):
    return json.dumps({"boot": boot, "seq": seq, "done": True, "cmd": "", "props": {}, **more}).encode()


def finish(factory, run):
    factory.go(lambda: services.get_run(run_id=run).run.status == "finished", dt_s=10.0)


@pytest.mark.parametrize("role", EVERYBODY)
def test_operators_and_above_switch_and_every_member_sees_it(factory, role):
    client = join_and_sign_in(role, SITE)
    allowed = role in from_role("operator")
    refused = {"stranger": 404, "nobody": 401}.get(role, 403)
    assert client.put(PATH).status_code == (200 if allowed else refused)
    assert Device.objects.get(pk=MIXER).stand_in is allowed
    if role in ROLES:
        assert client.get(f"/api/sites/{SITE}/devices/{MIXER}").json()["stand_in"] is allowed
    assert client.delete(PATH).status_code == (200 if allowed else refused)
    assert not Device.objects.get(pk=MIXER).stand_in
    codes = [] if not allowed else ["device_real_again", "device_simulated"]
    assert sorted(AuditLine.objects.filter(code__startswith="device_").values_list("code", flat=True)) == codes


def test_what_is_not_there_or_not_approved_is_not_simulated(factory):
    client = join_and_sign_in("operator", SITE)
    assert client.put(f"/api/sites/{SITE}/devices/nobody/stand-in").status_code == 404
    Device.objects.filter(pk=MIXER).update(lifecycle="pending")
    answer = client.put(PATH)
    assert (answer.status_code, answer.json()["code"]) == (409, "not_possible_now")
    assert "waits for approval" in answer.json()["detail"]


def test_a_device_that_a_run_holds_is_not_switched_and_the_answer_says_which(factory):
    run = factory.start(CURE)
    factory.go(lambda: Command.objects.filter(method="mixPaint").exists())
    answer = join_and_sign_in("operator", SITE).put(PATH)
    told = "Paint Mixer A is held by run 1 of “Task”. Wait until it is over, or cancel it."
    assert (answer.status_code, answer.json()["detail"]) == (409, told)
    finish(factory, run)
    assert switch().stand_in


def test_commands_are_for_the_one_that_counts_when_they_are_written(factory):
    first = factory.start(CURE)
    finish(factory, first)  # the site's owner knows it by now
    switch()
    Device.objects.filter(pk=MIXER).update(online=True)  # its stand-in is there
    second = factory.start(CURE)
    finish(factory, second)
    for run, simulated in ((first, False), (second, True)):
        told = {c.device: c.stand_in for c in Command.objects.filter(run=run)}
        assert told[MIXER] is simulated
        assert not any(stand_in for device, stand_in in told.items() if device != MIXER)
    events = services.list_events(run_id=second)
    marked = {(e.kind, e.device) for e in events if e.args.get("simulated")}
    assert marked == {("command", MIXER), ("answer", MIXER)}
    assert not any(e.args.get("simulated") for e in services.list_events(run_id=first))


def test_the_journal_says_of_each_line_about_a_simulated_robot_that_it_is(factory):
    finish(factory, factory.start(CURE))  # the site's owner knows all by now
    for number in (1, 2, 3):
        switch(f"robot0{number}")
    Device.objects.update(online=True)  # their stand-ins are there
    run = factory.start(CARRY)
    finish(factory, run)
    marked = {(e.kind, e.device) for e in services.list_events(run_id=run) if e.args.get("simulated")}
    assert {kind for kind, _ in marked} == {"way", "command", "answer"}
    assert all(device.startswith("robot") for _, device in marked)


def test_a_stand_in_is_told_on_its_own_topic_and_never_on_a_legacy_one(factory):
    Device.objects.filter(pk=MIXER).update(granted={"mixPaint": "old/mixer/mix"})
    for simulated, topic in ((False, "old/mixer/mix"), (True, f"vipo/v1/sim/{MIXER}/down/mixPaint")):
        switch(simulated=simulated)
        Device.objects.filter(pk=MIXER).update(online=True)
        services.call_method(site=SITE, device_id=MIXER, method="mixPaint", arguments={"time": 1}, by="Ada")
        (outgoing,) = claim_commands(limit=10)
        assert outgoing.topic == topic
        Command.objects.update(status="done")
        advance_site(SITE)


def test_a_call_to_one_that_is_not_there_says_where_to_look(factory):
    switch()
    with pytest.raises(services.NotPossibleNow, match="stand_ins"):
        services.call_method(site=SITE, device_id=MIXER, method="mixPaint", arguments={"time": 1}, by="Ada")


def test_what_a_real_device_says_meanwhile_counts_once_it_is_real_again(factory):
    registry.ingest_presence(device_id=MIXER, payload=b'{"s": "online", "boot": 3}', at=NOW)
    registry.ingest_state(device_id=MIXER, payload=said(3, 5), at=NOW)
    switch()
    registry.ingest_state(device_id=MIXER, payload=said(3, 6, done=False), at=NOW)
    registry.ingest_state(device_id=MIXER, payload=said(3, 4), at=NOW)  # late
    registry.ingest_presence(device_id=MIXER, payload=b'{"s": "offline", "boot": 2}', at=NOW)  # of another start
    row = Device.objects.get(pk=MIXER)
    assert (row.online, row.done, row.boot) == (False, True, -1)
    registry.ingest_presence(device_id=MIXER, payload=HERE, at=NOW, stand_in=True)
    registry.ingest_state(device_id=MIXER, payload=said(1, 9), at=NOW, stand_in=True)
    row = Device.objects.get(pk=MIXER)
    assert (row.online, row.done, row.boot, row.seq) == (True, True, 1, 9)
    switch(simulated=False)
    row = Device.objects.get(pk=MIXER)
    assert (row.online, row.done, row.boot, row.seq, row.aside) == (True, False, 3, 6, None)
    assert registry.ingest_state(device_id=MIXER, payload=said(1, 10), at=NOW, stand_in=True) is None
    assert registry.ingest_presence(device_id=MIXER, payload=HERE, at=NOW, stand_in=True) is None
    assert Device.objects.get(pk=MIXER).seq == 6


def test_a_stand_in_of_a_device_that_nobody_knows_makes_none(factory):
    assert registry.ingest_presence(device_id="ghost", payload=HERE, at=NOW, stand_in=True) is None
    assert not Device.objects.filter(pk="ghost").exists()


def test_a_key_that_is_revoked_meanwhile_ends_the_real_one_and_not_its_stand_in(factory):
    registry.ingest_presence(device_id=MIXER, payload=b'{"s": "online", "boot": 3}', at=NOW)
    Device.objects.filter(pk=MIXER).update(credential_hash="x")
    switch()
    registry.ingest_presence(device_id=MIXER, payload=HERE, at=NOW, stand_in=True)
    registry.revoke_credential(site=SITE, device_id=MIXER, by=None, at=NOW)
    row = Device.objects.get(pk=MIXER)
    assert (row.online, row.aside["online"]) == (True, False)
    registry.ingest_state(device_id=MIXER, payload=said(1, 1), at=NOW, stand_in=True)
    registry.ingest_presence(device_id=MIXER, payload=b'{"s": "online", "boot": 4}', at=NOW)  # it was on its way
    row = Device.objects.get(pk=MIXER)
    assert (row.online, row.aside["online"]) == (True, False)


def test_a_device_is_not_retired_while_it_is_simulated(factory):
    switch()
    with pytest.raises(registry.IsSimulated, match="Use the real device again first"):
        registry.retire_device(site=SITE, device_id=MIXER, by=None, at=NOW)
    switch(simulated=False)
    registry.retire_device(site=SITE, device_id=MIXER, by=None, at=NOW)


def test_others_keep_out_of_where_the_real_robot_stands(factory):
    Device.objects.filter(pk="robot01").update(pose={"x": 5.0, "y": -8.0, "z": 0.0, "theta": 0.0})
    assert not get_layout(SITE).bodies
    switch("robot01")
    Device.objects.filter(pk="robot01").update(pose={"x": 9.0, "y": -8.0, "z": 0.0, "theta": 0.0})
    (body,) = get_layout(SITE).bodies
    assert (body.key, body.name, body.rule) == ("body/robot01", "TurtleBot 1", "keep_out")
    assert sum(x for x, _ in body.points) / len(body.points) == pytest.approx(5.0, abs=0.03)
    assert get_layout(SITE) is get_layout(SITE)
    switch("robot01", simulated=False)
    assert not get_layout(SITE).bodies
    assert Device.objects.get(pk="robot01").pose["x"] == 5.0

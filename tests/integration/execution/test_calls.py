"""A person tells a device to do something, outside of any run."""

import io
import json
from contextlib import redirect_stderr, redirect_stdout, suppress
from datetime import UTC, datetime, timedelta
from threading import Event, Thread
from uuid import uuid4

import pytest
from django.db import OperationalError

from editor.language.expressions.nodes import Constant, PlaceRef
from editor.language.plan.instructions import Call, End, Instruction, Move, Plan, RoleBinding
from execution import services
from execution.commands.manual_calls import NO_ANSWER, expire_calls
from execution.commands.outbox import end_commands_of_those_out
from execution.engine.drive import advance_site
from execution.models import Command, InboxEvent
from registry import services as registry
from registry.demo.devices import DEVICES
from registry.models import Device
from tests.kit.programs import SITE, describe_anew
from tests.kit.sign_in import EVERYBODY, ROLES, from_role, join_and_sign_in, post_json
from vipo_site.cli.main import main

pytestmark = pytest.mark.django_db(transaction=True)
MIXER = f"/api/sites/{SITE}/devices/paintMixer01/call"
MIX = {"method": "mixPaint", "args": {"time": 2}}


def ask(client, body=MIX, path=MIXER):
    return post_json(client, path, body)


def call(device="paintMixer01", method="mixPaint", **arguments):
    return services.call_method(site=SITE, device_id=device, method=method, arguments=arguments, by="Ada")


def state(made):
    return services.get_call(site=SITE, call_id=made.id)


def test_a_call_is_carried_out_and_its_outcome_can_be_read(factory):
    made = call(time=2)
    assert (made.status, made.is_over, made.by, made.arguments) == ("pending", False, "Ada", {"time": 2})
    factory.go(lambda: state(made).is_over, dt_s=10.0)
    over = state(made)
    assert (over.status, over.why, over.result) == ("done", "", {})
    assert over.expires_at > over.created_at < over.ended_at
    assert Command.objects.filter(device="paintMixer01").count() == 1
    assert call(time=1).status == "pending"


@pytest.mark.parametrize("role", EVERYBODY)
def test_operators_and_above_may_call_and_every_member_may_follow(factory, role):
    client = join_and_sign_in(role, SITE)
    allowed = role in from_role("operator")
    refused = 200 if allowed else {"stranger": 404, "nobody": 401}.get(role, 403)
    assert ask(client).status_code == (202 if allowed else refused)
    assert Command.objects.count() == (1 if allowed else 0)
    made = Command.objects.first() or Command.objects.get(id=call(time=2).id)
    path = f"/api/sites/{SITE}/calls/{made.id}"
    assert client.get(path).status_code == (200 if role in ROLES else refused)
    listed = client.get(f"/api/sites/{SITE}/calls")
    assert listed.status_code == (200 if role in ROLES else refused)
    assert role not in ROLES or [each["id"] for each in listed.json()] == [str(made.id)]
    assert client.post(f"{path}/cancel").status_code == refused
    assert InboxEvent.objects.filter(key=f"call-cancel:{made.id}").exists() is allowed


def test_what_is_under_way_is_listed_oldest_first_and_what_is_over_is_not(factory):
    first, second = call(time=2), call("paintMachine01", "paint", time=1)
    client = join_and_sign_in("viewer", SITE)

    def listed():
        return [each["id"] for each in client.get(f"/api/sites/{SITE}/calls").json()]

    assert listed() == [str(first.id), str(second.id)]
    factory.go(lambda: state(second).is_over, dt_s=10.0)
    assert str(second.id) not in listed()
    factory.go(lambda: state(first).is_over, dt_s=10.0)
    assert listed() == []


@pytest.mark.parametrize(
    ("body", "told"),
    [
        ({"method": "fly", "args": {}}, "Paint Mixer A has no method 'fly'. It can: mixPaint, dispense."),
        ({"method": "pause", "args": {}}, "Paint Mixer A has no method 'pause'. It can: mixPaint, dispense."),
        ({"method": "mixPaint", "args": {}}, "time: give a value, mixPaint needs it."),
        ({"method": "mixPaint", "args": {"time": None}}, "time: give a value, mixPaint needs it."),
        ({"method": "mixPaint", "args": {"time": 61}}, "time: give a number from 1 to 60 MIN, not 61."),
        ({"method": "mixPaint", "args": {"time": "2"}}, "time: give a number in MIN."),
        ({"method": "mixPaint", "args": {"time": True}}, "time: give a number in MIN."),
        (
            {"method": "mixPaint", "args": {"time": 2, "shade": "red"}},
            "mixPaint takes no argument 'shade'. It takes: time.",
        ),
        (
            {"method": "dispense", "args": {"object": 7, "value": [1]}},
            "object: give a text of 1 to 256 characters in one line. value: give a number.",
        ),
    ],
)
def test_what_the_description_does_not_allow_is_refused_by_name(factory, body, told):
    answer = ask(join_and_sign_in("operator", SITE), body)
    assert (answer.status_code, answer.json()["code"], answer.json()["detail"]) == (422, "bad_arguments", told)
    assert Command.objects.count() == 0


def test_of_many_misfits_the_first_are_named(factory):
    answer = ask(join_and_sign_in("operator", SITE), {"method": "mixPaint", "args": {f"x{n}": n for n in range(5_000)}})
    assert answer.status_code == 422
    assert answer.json()["detail"].count("mixPaint takes no argument") == 5


def test_a_device_that_is_not_there_is_not_found(factory):
    client = join_and_sign_in("operator", SITE)
    assert ask(client, path=f"/api/sites/{SITE}/devices/nothing/call").json()["code"] == "no_such_device"
    assert client.get(f"/api/sites/{SITE}/calls/{uuid4()}").status_code == 404


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"online": False}, "Paint Mixer A is offline. Switch it on, or look at its connection."),
        ({"lifecycle": "pending"}, "Paint Mixer A waits for approval. An admin of the site can approve it."),
    ],
)
def test_a_device_that_cannot_act_now_is_not_asked(factory, changes, told):
    Device.objects.filter(id="paintMixer01").update(**changes)
    answer = ask(join_and_sign_in("operator", SITE))
    assert (answer.status_code, answer.json()["code"], answer.json()["detail"]) == (409, "not_possible_now", told)
    assert Command.objects.count() == 0


def test_nothing_is_called_while_the_site_is_stopped_and_a_stop_ends_what_is_under_way(factory):
    made = call(time=2)
    factory.work()
    factory.send()
    services.press_stop(site=SITE, by="Ada")
    factory.work()
    told = Command.objects.filter(method__in=["pause", "cancel"])
    assert {(c.device, c.arguments["command"]) for c in told} == {("paintMixer01", str(made.id))}
    answer = ask(join_and_sign_in("operator", SITE), path=f"/api/sites/{SITE}/devices/curingOven01/call")
    assert answer.status_code == 422
    body = {"method": "curePaint", "args": {"time": 2}}
    answer = ask(join_and_sign_in("author", SITE), body, f"/api/sites/{SITE}/devices/curingOven01/call")
    assert (answer.status_code, answer.json()["detail"]) == (409, "The site is stopped. Reset the stop first.")
    services.reset_stop(site=SITE, by="Ada")
    factory.go(lambda: state(made).is_over, dt_s=10.0)
    assert state(made).status == "cancelled"


def test_a_call_that_went_out_a_moment_ago_and_is_not_marked_yet_is_taken_back_at_the_device(factory):
    made = call(time=2)
    factory.work()
    assert [outgoing.id for outgoing in services.claim_commands(limit=100)] == [str(made.id)]
    assert Command.objects.get(id=made.id).status == "pending"
    services.press_stop(site=SITE, by="Ada")
    factory.work()
    told = Command.objects.filter(method__in=["pause", "cancel"])
    assert {(c.device, c.arguments["command"]) for c in told} == {("paintMixer01", str(made.id))}
    assert not state(made).is_over


def test_a_device_does_one_thing_at_a_time(factory):
    call(time=2)
    answer = ask(join_and_sign_in("operator", SITE))
    told = "Paint Mixer A still carries out mixPaint. Wait until it is done."
    assert (answer.status_code, answer.json()["detail"]) == (409, told)


CURE = Plan(
    (
        Instruction(Move("robot", PlaceRef(device="paintMixer01")), "s1", 1),
        Instruction(Call(PlaceRef(device="paintMixer01"), "mixPaint", {"time": Constant(2)}, "robot"), "s2", 2),
        Instruction(End()),
    ),
    {"robot": RoleBinding("robot", None, ("move",))},
)


def test_a_robot_explores_only_while_no_run_is_open_and_no_run_starts_meanwhile(factory):
    robot = Device.objects.get(pk="robot03")
    method = {**robot.description["methods"][0], "name": "explore", "parameters": []}
    robot.description["methods"].append(method)
    describe_anew("robot03", robot.description)
    run = factory.start(CURE)
    told = (
        f"{robot.description['name']} drives where it likes while it explores. Wait until run 1 of “Task” is over, or "
        "cancel it."
    )
    with pytest.raises(services.NotPossibleNow) as refused:
        call("robot03", "explore")
    assert str(refused.value) == told
    assert not Command.objects.filter(method="explore").exists()
    factory.go(lambda: services.get_run(run_id=run).run.status == "finished", dt_s=10.0)
    assert call("robot03", "explore").status == "pending"
    with pytest.raises(services.NotPossibleNow, match="explores the floor"):
        factory.start(CURE)


def test_what_a_run_holds_is_not_lent_and_the_answer_says_which_run(factory):
    run = factory.start(CURE)
    factory.go(lambda: Command.objects.filter(method="mixPaint").exists())
    client = join_and_sign_in("operator", SITE)
    answer = ask(client)
    told = "Paint Mixer A is held by run 1 of “Task”. Wait until it is over, or cancel it."
    assert (answer.status_code, answer.json()["detail"]) == (409, told)
    robot = Command.objects.filter(method="move").first().device
    pick = {"method": "pick", "args": {"object": "box", "value": 1}}
    answer = ask(client, pick, f"/api/sites/{SITE}/devices/{robot}/call")
    assert answer.json()["detail"].endswith("is held by run 1 of “Task”. Wait until it is over, or cancel it.")
    assert Command.objects.exclude(run=None).filter(method="pick").count() == 0
    services.cancel_run(run_id=run, by="Ada")


def test_a_run_waits_for_a_device_that_somebody_uses_by_hand(factory):
    made = call(time=2)
    run = factory.start(CURE)
    factory.go(lambda: "Ada, by hand" in str(services.get_run(run_id=run).run.steps))
    assert not state(made).is_over
    factory.go(lambda: services.get_run(run_id=run).run.status == "finished", dt_s=3.0)
    assert state(made).status == "done"


@pytest.mark.parametrize("method", ["move", "mixPaint"])
def test_a_run_whose_device_is_taken_out_ends_and_the_floor_goes_on(factory, method):
    run = factory.start(CURE)
    factory.go(lambda: Command.objects.filter(method=method, status__in=("sent", "accepted", "running")).exists())
    device = Command.objects.filter(method=method).first().device
    registry.retire_device(site=SITE, device_id=device, by=None, at=datetime.now(UTC))
    end_commands_of_those_out(datetime.now(UTC))
    factory.go(lambda: services.get_run(run_id=run).run.status == "failed", limit_s=5.0)
    assert services.get_run(run_id=run).run.cause == {"code": "no_device", "args": {"device": device}}
    assert advance_site(SITE)


def test_a_method_whose_topic_is_not_confirmed_says_so(factory):
    said = (DEVICES / "paintMixer01.ttl").read_text().replace("vipo/v1/dev/paintMixer01/down/mixPaint", "plant/mix")
    registry.ingest_description(device_id="paintMixer01", payload=said.encode(), at=datetime.now(UTC))
    answer = ask(join_and_sign_in("operator", SITE))
    assert (answer.status_code, answer.json()["code"]) == (409, "not_possible_now")
    told = "mixPaint waits until an admin confirms its topic plant/mix on Paint Mixer A's page."
    assert answer.json()["detail"] == told
    registry.confirm_topic(site=SITE, device_id="paintMixer01", topic="plant/mix", by=None, at=datetime.now(UTC))
    assert call(time=2).status == "pending"


@pytest.mark.parametrize(
    ("method", "change"),
    [("mixPaint", {"size": {"x": 100.0, "y": 100.0, "z": 1.0}}), ("move", {"radius_m": 10.0})],
)
def test_a_device_that_says_it_fills_the_whole_floor_does_not_end_its_traffic(factory, method, change):
    run = factory.start(CURE)
    factory.go(lambda: Command.objects.filter(method=method, status__in=("sent", "accepted", "running")).exists())
    row = Device.objects.get(id=Command.objects.filter(method=method).first().device)
    describe_anew(row.id, {**row.description, **change})
    for _ in range(3):
        factory.work()
        assert advance_site(SITE)
    describe_anew(row.id, row.description)
    factory.go(lambda: services.get_run(run_id=run).run.status in ("finished", "failed"), dt_s=3.0)


def test_a_robot_drives_only_in_programs(factory):
    path = f"/api/sites/{SITE}/devices/robot01/call"
    answer = ask(join_and_sign_in("operator", SITE), {"method": "move", "args": {}}, path)
    assert answer.status_code == 409
    assert answer.json()["detail"].startswith("TurtleBot 1 drives only in a program, where its way is kept free")


def test_a_call_that_nobody_answers_is_given_up_and_the_device_is_free_again(factory):
    factory.offline = {"paintMixer01"}
    made = call(time=2)
    factory.work()
    factory.send()
    assert expire_calls(now=datetime.now(UTC) + timedelta(seconds=29)) == 0
    assert expire_calls(now=datetime.now(UTC) + timedelta(seconds=31)) == 1
    assert (state(made).status, state(made).why) == ("timed_out", NO_ANSWER)
    factory.work()
    assert Command.objects.get(method="cancel").arguments == {"command": str(made.id)}
    assert call(time=1).status == "pending"


def test_what_a_device_was_told_ends_when_it_is_taken_out_and_nobody_else_hears_of_it(factory):
    made, now = call(time=20), datetime.now(UTC)
    factory.send()
    who = {"site": SITE, "device_id": "paintMixer01", "by": None, "at": now}
    registry.retire_device(**who)
    registry.readmit_device(**who)
    Command.objects.update(send_after=now - timedelta(seconds=1))
    assert services.claim_commands(limit=5) == ()
    end_commands_of_those_out(now)
    told = "There is no approved device called “paintMixer01” on this site."
    assert (state(made).status, state(made).why, state(made).cause["code"]) == ("failed", told, "no_device")
    done = {"device": "paintMixer01", "command_id": str(made.id), "status": "DONE", "why": "", "result": {}, "at": now}
    assert not services.record_ack(**done)
    factory.work()
    registry.approve_device(**who)
    Device.objects.filter(id="paintMixer01").update(online=True)
    assert call("paintMixer01", time=1).status == "pending"


def test_a_call_can_be_cancelled_while_it_is_carried_out(factory):
    made = call(time=60)
    factory.work()
    factory.send()
    factory.pass_time(1)
    assert state(made).status in {"accepted", "running"}
    services.cancel_call(site=SITE, call_id=made.id)
    factory.go(lambda: state(made).is_over, dt_s=10.0)
    assert state(made).status == "cancelled"


def vipo(*words):
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err):
        code = main(["call", *words])
    return code, out.getvalue(), err.getvalue()


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("nothing", "mixPaint"), "There is no device 'nothing'. Try: vipo devices"),
        (("paintMixer01", "mixPaint", "time"), "'time' is no argument. Write each once, as name=value."),
        (("paintMixer01", "mixPaint", "time=x"), "time=x is no number. Write 5 or 2.5."),
        (("paintMixer01", "mixPaint", "{"), "The arguments are not JSON: "),
        (("paintMixer01", "mixPaint", '{"time": ' + "[" * 9000), "The arguments are nested too deep."),
        (("paintMixer01", "mixPaint"), "time: give a value, mixPaint needs it."),
        (("paintMixer01", "mixPaint", "time=5", "--site", "hall"), "There is no device 'paintMixer01' at the site"),
    ],
)
def test_the_command_line_says_why_it_cannot_call(factory, words, told):
    code, out, err = vipo(*words)
    assert (code, out) == (2, "")
    assert err.startswith(told)
    assert Command.objects.count() == 0


def finish(status):
    """What a gateway and a device do, once there is a command."""
    from django.db import connection

    deadline, pause, is_done = datetime.now(UTC) + timedelta(seconds=60), Event(), False
    while not is_done and datetime.now(UTC) < deadline:
        with suppress(OperationalError):  # both threads use one database in memory, which does not wait for locks
            row = Command.objects.first()
            if row is not None:
                services.record_ack(device=row.device, command_id=str(row.id), status=status, why="",
                                    result={"shade": 3}, at=datetime.now(UTC))  # fmt: skip
                is_done = True
        pause.wait(0.05)
    connection.close()


@pytest.mark.parametrize(("status", "code"), [("DONE", 0), ("FAILED", 1)])
def test_the_command_line_waits_for_the_outcome(factory, status, code):
    device = Thread(target=finish, args=(status,))
    device.start()
    found, out, err = vipo("paintMixer01", "mixPaint", "time=2", "--json")
    device.join(60)
    assert (found, err) == (code, "")
    assert (json.loads(out)["status"], json.loads(out)["result"]) == (status.lower(), {"shade": 3})


def test_a_call_that_nothing_sends_is_given_up_by_the_command_line_itself(factory, monkeypatch):
    monkeypatch.setattr("execution.commands.manual_calls.EXPIRY_S", 0.05)
    monkeypatch.setattr("vipo_site.cli.call.GRACE", timedelta())
    told = "paintMixer01: mixPaint is timed out: It was never sent. Look whether VIPO and its gateway run.\n"
    assert vipo("paintMixer01", "mixPaint", "time=2") == (1, told, "")
    assert Command.objects.get().status == "timed_out"


def test_who_interrupts_the_command_line_learns_that_the_device_may_go_on(factory, monkeypatch):
    def press_ctrl_c(_seconds):
        raise KeyboardInterrupt

    monkeypatch.setattr("vipo_site.cli.call.time.sleep", press_ctrl_c)
    code, out, err = vipo("paintMixer01", "mixPaint", "time=2")
    made = Command.objects.get()
    cancel = f"POST /api/sites/{SITE}/calls/{made.id}/cancel"
    assert (code, out, made.status) == (130, "", "pending")
    assert err == f"paintMixer01 may go on with mixPaint. Its page can end that, and so can {cancel}.\n"

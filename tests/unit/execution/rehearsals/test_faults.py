"""Faults on purpose in a rehearsal: what a program meets, by the real machine, and always the same."""

import json
import subprocess
import sys
from dataclasses import replace

import pytest

from editor.language.expressions.nodes import Constant, Operation, PlaceRef, Reading
from editor.language.plan.instructions import (
    Branch,
    Call,
    Drop,
    End,
    Instruction,
    Move,
    Pick,
    Plan,
    RoleBinding,
    TryBegin,
    TryEnd,
    Wait,
)
from execution.rehearsals.child_process import scene_from_json, scene_to_json
from execution.rehearsals.open_commands import OpenCommands
from execution.rehearsals.rehearsal import Conditions, rehearse
from execution.traffic.messages import SendCommand
from simulation.services import make_world
from simulation.world import Ack, Fault, FaultBegan
from tests.kit import demo_floor
from vipo_device.protocol.description import PropertySpec

KINEMATIC = Conditions("kinematic")
SHELF, MIXER = PlaceRef(device="paintInventory01"), PlaceRef(device="paintMixer02")
CAN, ONE = Constant("can"), Constant(1)
CARRY = (
    Instruction(Move("robot", SHELF), "s1", 1),
    Instruction(Pick("robot", SHELF, CAN, ONE), "s2", 2),
    Instruction(Drop("robot", MIXER, CAN, ONE), "s3", 3),
)
ROLES = {"robot": RoleBinding("robot", "robot01", ("move", "pick", "drop"))}
BATTERY = PropertySpec("battery", "number", "PERCENT", 0, 100)
MIX = Instruction(Call(MIXER, "mixPaint", {"time": ONE}), "mix", 1)


def carried(*faults, seed=0):
    plan = Plan((*CARRY, Instruction(End())), ROLES)
    scene = replace(demo_floor.scene(faults=faults), seed=seed)
    return rehearse(plan, scene, places=demo_floor.places(), conditions=KINEMATIC)


def mixed(*faults, times=1, seed=0):
    plan = Plan((*[MIX] * times, Instruction(End())))
    return rehearse(plan, replace(demo_floor.scene(faults=faults), seed=seed), conditions=KINEMATIC)


def said(result):
    codes = ((line["t"], line["code"]) for line in result["log"])
    return [(t, code.removeprefix("fault_")) for t, code in codes if code.startswith("fault_")]


def test_a_late_answer_makes_a_step_longer_by_as_much():
    assert mixed()["duration_s"] == pytest.approx(60, abs=1)
    late = mixed(Fault("paintMixer02", "late", after_s=7.0))
    assert (late["ok"], late["duration_s"] - mixed()["duration_s"]) == (True, pytest.approx(7, abs=0.6))


def test_a_dead_device_says_nothing_and_a_deaf_one_begins_nothing():
    for kind in ("dead", "deaf"):
        result = mixed(Fault("paintMixer02", kind))
        assert (result["ok"], result["errors"][0]["kind"]) == (False, "timed_out")
        assert result["machines"]["paintMixer02"]["busy_s"] == 0


def test_a_device_that_was_dead_for_a_while_goes_on_where_it_was():
    result = mixed(Fault("paintMixer02", "dead", at_s=10.0, for_s=20.0))
    assert (result["ok"], result["duration_s"]) == (True, pytest.approx(80, abs=1))


def test_a_command_or_an_answer_that_is_lost_is_asked_for_again_as_by_gateways():
    lost = mixed(Fault("paintMixer02", "lose_ack"))
    assert (lost["ok"], lost["duration_s"] - mixed()["duration_s"]) == (True, pytest.approx(15, abs=15))
    for kind in ("deaf", "offline", "dead"):
        result = mixed(Fault("paintMixer02", kind, for_s=5.0), times=2)
        assert (result["ok"], result["duration_s"] - mixed(times=2)["duration_s"]) == (True, pytest.approx(6, abs=1))
    driven = carried(Fault("robot01", "deaf", for_s=5.0))
    assert (driven["ok"], driven["duration_s"] - carried()["duration_s"]) == (True, pytest.approx(6, abs=1.5))


def told_at(monkeypatch, *faults, **scene):
    """Return when a mixer is told a command that it takes 60 s for, in the first 50 s."""
    world = make_world(scene=demo_floor.scene(faults=faults, **scene), driver="kinematic")
    commands, times, tell = OpenCommands(world, faults, scene.get("idless", ())), [], world.command
    monkeypatch.setattr(world, "command", lambda *said: (times.append(round(world.time_s, 2)), tell(*said)))
    commands.send(SendCommand("c1", "paintMixer02", "mixPaint", {"time": 1}))
    for step_s in (0.0, *[0.25] * 200):  # it answers at once
        for event in world.advance(step_s):
            if isinstance(event, Ack):
                commands.answered(event)
        commands.send_due()
    return times


def test_a_device_is_asked_at_the_seconds_at_which_gateways_ask(monkeypatch):
    deaf_later = Fault("paintMixer02", "deaf", at_s=1.0)
    assert told_at(monkeypatch, deaf_later) == [0, 5, 15, 30, 45], "it had accepted the command"
    assert told_at(monkeypatch, Fault("paintMixer02", "deaf")) == [0, 2, 6, 14, 29, 44]


def test_a_device_that_knows_no_command_by_its_id_is_told_each_once(monkeypatch):
    for fault in (Fault("paintMixer02", "deaf"), Fault("paintMixer02", "deaf", at_s=1.0)):
        assert told_at(monkeypatch, fault, idless=frozenset({"paintMixer02"})) == [0]
        assert len(told_at(monkeypatch, fault, idless=frozenset({"paintMixer01"}))) > 1
    plan = Plan((Instruction(TryBegin(3)), MIX, Instruction(TryEnd()), MIX, Instruction(End())))
    scene = demo_floor.scene(faults=(Fault("paintMixer02", "deaf", for_s=5.0),), idless=frozenset({"paintMixer02"}))
    result = rehearse(plan, scene, conditions=KINEMATIC)
    assert (result["ok"], [error["kind"] for error in result["errors"]]) == (True, ["timed_out"])


def test_a_command_that_is_asked_for_again_is_one_for_chance():
    by_odds = (Fault("paintMixer02", "fail_next", odds=0.5), Fault("paintMixer02", "lose_ack"))
    assert said(mixed(*by_odds, times=1)) == [(0.0, "answer_lost")]


@pytest.mark.parametrize("kind", ["deaf", "offline", "dead"])
def test_a_command_that_is_not_heard_is_one_for_chance_however_often_it_comes(kind):
    fault = Fault("paintMixer02", kind, odds=0.25, for_s=5.0)
    world = make_world(scene=replace(demo_floor.scene(faults=(fault,)), seed=0), driver="kinematic")
    commands, struck = OpenCommands(world, (fault,)), []
    for number in range(1, 13):
        commands.send(SendCommand(f"c{number}", "paintMixer02", "dispense", {"object": "can", "value": 1}))
        answered = False
        while not answered:
            for event in world.advance(0.25):
                struck += [number] if isinstance(event, FaultBegan) else []
                if isinstance(event, Ack):
                    commands.answered(event)
                    answered |= event.is_final
            commands.send_due()
    assert struck == [4, 8, 12]


def test_an_answer_said_twice_changes_nothing_for_the_program():
    twice = mixed(Fault("paintMixer02", "doubled"), times=2)
    assert (twice["ok"], twice["duration_s"]) == (True, mixed(times=2)["duration_s"])


def test_a_device_fails_with_the_error_that_is_asked_for_at_the_second_time_of_a_step():
    pause = Instruction(Wait(Constant(1)), "pause")
    plan = Plan((MIX, pause, MIX, pause, MIX, Instruction(End())))
    faults = (Fault("paintMixer02", "fail_next", step="mix", nth=2, error="The lid is open."),)
    failed = rehearse(plan, demo_floor.scene(faults=faults), conditions=KINEMATIC)
    assert (failed["ok"], [e["message"] for e in failed["errors"]]) == (False, ["The lid is open."])
    assert [s["status"] for s in failed["steps"]] == ["done", "done", "failed"]
    assert said(failed) == [(pytest.approx(61, abs=2), "fails")]


def test_what_a_robot_drops_on_its_way_is_missing_where_it_should_be_left():
    result = carried(Fault("robot01", "drops", step="s3"))
    assert (result["ok"], result["errors"][0]["step"]) == (False, "s3")
    assert [load for _, load in result["carrying"]["robot01"]] == [{}, {"can": 1}, {}]


def test_a_low_battery_runs_out_on_the_way():
    devices = [replace(d, properties=(*d.properties, BATTERY)) for d in demo_floor.devices()]
    scene = replace(demo_floor.scene(faults=(Fault("robot01", "battery", value=0.0, at_s=5.0),)), devices=devices)
    result = rehearse(Plan((*CARRY, Instruction(End())), ROLES), scene, conditions=KINEMATIC)
    assert (result["ok"], result["errors"][0]["message"]) == (
        False, "The battery of TurtleBot 1 is empty; charge it.",
    )  # fmt: skip


def test_a_robot_stops_before_a_thing_that_is_on_no_map_and_goes_on_when_it_is_gone():
    x, y, _ = carried()["frames"]["robots"]["robot01"][60]
    blocked = carried(Fault("", "obstacle", x=x, y=y))
    assert (blocked["ok"], blocked["collisions"]) == (False, [])
    assert "something that is not on the map is in its way" in blocked["errors"][0]["message"]
    passed = carried(Fault("", "obstacle", x=x, y=y, for_s=15.0))
    assert passed["ok"] is True
    assert passed["duration_s"] > carried()["duration_s"]
    thing = {"x": x, "y": y, "size_m": 0.5}
    assert (blocked["obstacles"], passed["obstacles"]) == ([_lay(None) | thing], [_lay(15.0) | thing])
    assert carried()["obstacles"] == []


def _lay(until: float | None) -> dict[str, float | None]:
    return {"t": pytest.approx(0.0, abs=0.1), "until": until and pytest.approx(until, abs=0.1)}


def test_a_wrong_reading_is_shown_for_as_long_as_asked_and_the_true_one_after():
    result = mixed(Fault("paintMixer02", "wrong_value", 5.0, name="temperature", value=-40.0, for_s=10.0))
    shown = [(t, v) for t, name, v in result["properties"]["paintMixer02"] if name == "temperature"]
    assert (5.0, -40.0) in [(round(t), v) for t, v in shown]
    assert [v for t, v in shown if 5.5 < t < 14.5] == []
    assert min(v for t, v in shown if t > 15.5) > 0


def test_of_two_wrong_readings_the_one_that_lasts_longer_is_shown_again():
    wrong = {"kind": "wrong_value", "name": "temperature"}
    faults = (
        Fault("paintMixer02", value=90.0, **wrong),
        Fault("paintMixer02", at_s=5.0, value=-40.0, for_s=5.0, **wrong),
    )
    shown = mixed(*faults)["properties"]["paintMixer02"]
    assert [(round(t), v) for t, name, v in shown if name == "temperature" and t > 0] == [(5, -40.0), (10, 90.0)]


def test_a_fault_from_the_first_moment_on_is_there_when_the_program_first_looks():
    hot = Operation(">", (Reading(Constant("paintMixer02"), "temperature"), Constant(60)))
    plan = Plan(
        (Instruction(Branch(hot, 3), "if"), Instruction(Wait(ONE), "wait"), Instruction(End()), MIX, Instruction(End()))
    )
    fault = Fault("paintMixer02", "wrong_value", name="temperature", value=90.0)
    result = rehearse(plan, demo_floor.scene(faults=(fault,)), conditions=KINEMATIC)
    assert [step["step"] for step in result["steps"]] == ["wait"]
    assert (said(result), result["log"][0]["code"]) == ([(0.0, "wrong_value")], "fault_wrong_value")


def test_chance_strikes_as_the_seed_says_and_evenly_without_one():
    fault = Fault("paintMixer02", "late", odds=0.5, after_s=5.0, for_s=10.0)
    even = mixed(Fault("paintMixer02", "doubled", odds=0.5), times=4)
    assert len(said(even)) == 2
    courses = {json.dumps(said(mixed(fault, times=4, seed=seed))) for seed in range(1, 6)}
    assert len(courses) > 1
    assert json.dumps(mixed(fault, times=4, seed=3)) == json.dumps(mixed(fault, times=4, seed=3))


def test_faults_that_never_come_leave_every_byte_as_it_was():
    never = (Fault("robot01", "fail_next", step="nowhere"), Fault("paintMixer02", "dead", at_s=1e6))
    assert json.dumps(carried(*never, seed=7)) == json.dumps(carried(seed=7))


def test_a_catch_takes_the_failure_that_a_fault_makes():
    plan = Plan((Instruction(TryBegin(3)), MIX, Instruction(TryEnd()), Instruction(End())))
    result = rehearse(plan, demo_floor.scene(faults=(Fault("paintMixer02", "fail_next"),)), conditions=KINEMATIC)
    assert (result["ok"], len(result["errors"])) == (True, 1)


def test_faults_come_to_the_process_that_rehearses():
    faults = (Fault("robot01", "late", step="s1", nth=2, after_s=3.0, for_s=9.0), Fault("", "obstacle", x=1.0, y=2.0))
    scene, _, _ = scene_from_json(json.loads(json.dumps(scene_to_json(demo_floor.scene(faults=faults), ()))))
    assert scene.faults == faults


def test_who_knows_no_command_by_its_id_comes_to_the_process_that_rehearses():
    idless = frozenset({"robot01", "paintMixer02"})
    job = json.loads(json.dumps(scene_to_json(demo_floor.scene(idless=idless), ())))
    assert scene_from_json(job)[0].idless == idless


def test_the_process_that_rehearses_with_faults_cannot_speak_to_a_broker():
    code = "import sys, execution.rehearsals.child_process, simulation.fault_form; print(sorted(sys.modules))"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert [name for name in ("paho", "socketserver", "redis", "django") if f"'{name}'" in loaded] == []

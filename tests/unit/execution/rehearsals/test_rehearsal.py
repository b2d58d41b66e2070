import json

import pytest

from editor.language.expressions.nodes import (
    AnswerSpec,
    Constant,
    Located,
    Operation,
    PlaceRef,
    Reading,
    Variable,
    Zone,
)
from editor.language.plan.instructions import (
    AskPerson,
    Branch,
    Drop,
    End,
    EventEnd,
    EventEntry,
    Fork,
    Instruction,
    Join,
    Jump,
    Move,
    Notify,
    Pick,
    Plan,
    RoleBinding,
    Wait,
    WaitUntil,
)
from execution.rehearsals.footprint_monitor import FootprintMonitor
from execution.rehearsals.rehearsal import Conditions, rehearse
from simulation.world import Fault
from tests.kit import demo_floor

KINEMATIC = Conditions("kinematic")
SHELF, MIXER = PlaceRef(device="paintInventory01"), PlaceRef(device="paintMixer02")
CAN, ONE = Constant("can"), Constant(1)
CARRY = (
    Instruction(Move("robot", SHELF), "s1", 1),
    Instruction(Pick("robot", SHELF, CAN, ONE), "s1", 2),
    Instruction(Drop("robot", MIXER, CAN, ONE), "s1", 3),
)
ROLES = {"robot": RoleBinding("robot", None, ("move", "pick", "drop"))}


def test_a_can_is_carried_and_everything_is_recorded():
    result = rehearse(
        Plan((*CARRY, Instruction(End())), ROLES), demo_floor.scene(), places=demo_floor.places(), conditions=KINEMATIC
    )
    assert (result["ok"], result["errors"], result["collisions"], result["near_misses"]) == (True, [], [], [])
    assert [(s["step"], s["status"], s["robot"], s["device"]) for s in result["steps"]] == [
        ("s1", "done", "robot01", "paintInventory01")
    ]
    assert [load for _, load in result["carrying"]["robot01"]] == [{}, {"can": 1}, {}]
    frames = result["frames"]
    assert len(frames["robots"]["robot01"]) == int(result["duration_s"] / frames["dt_s"]) + 1
    assert 20 < result["robots"]["robot01"]["distance_m"] < 30
    assert json.loads(json.dumps(result)) == result


def test_the_same_rehearsal_twice_gives_the_same_bytes():
    plan = Plan((*CARRY, Instruction(End())), ROLES)
    first, second = (
        json.dumps(rehearse(plan, demo_floor.scene(), places=demo_floor.places(), conditions=KINEMATIC))
        for _ in range(2)
    )
    assert first == second


def test_two_robots_to_one_machine_wait_for_each_other_and_do_not_touch():
    roles = {name: RoleBinding(name, None, ("move", "pick", "drop")) for name in ("a", "b")}
    plan = Plan(
        (
            Instruction(Fork((2, 5), 1)),
            Instruction(End()),
            Instruction(Pick("a", SHELF, CAN, ONE), "a1"),
            Instruction(Drop("a", MIXER, CAN, ONE), "a2"),
            Instruction(Join()),
            Instruction(Pick("b", SHELF, CAN, ONE), "b1"),
            Instruction(Drop("b", MIXER, CAN, ONE), "b2"),
            Instruction(Join()),
        ),
        roles,
    )
    result = rehearse(plan, demo_floor.scene(), places=demo_floor.places(), conditions=KINEMATIC)
    assert (result["ok"], result["errors"], result["collisions"], result["near_misses"]) == (True, [], [], [])
    assert any("Paint Inventory serves" in wait["reason"] for wait in result["waits"])


def test_an_error_of_the_real_run_is_met_in_rehearsal():
    plan = Plan((Instruction(Pick("robot", PlaceRef(device="curingOven01"), CAN, ONE), "p"), Instruction(End())), ROLES)
    result = rehearse(plan, demo_floor.scene(), places=demo_floor.places(), conditions=KINEMATIC)
    assert result["ok"] is False
    assert [(e["step"], e["kind"]) for e in result["errors"]] == [("p", "refused")]
    assert result["steps"][0]["status"] == "failed"


def test_a_robot_that_stops_on_purpose_is_noticed():
    plan = Plan(
        (Instruction(Move("robot", SHELF), "m"), Instruction(End())), {"robot": RoleBinding("robot", "robot01")}
    )
    faults = (Fault("robot01", "stop", 5.0),)
    result = rehearse(plan, demo_floor.scene(faults=faults), places=demo_floor.places(), conditions=KINEMATIC)
    assert [(e["step"], e["kind"]) for e in result["errors"]] == [("m", "timed_out")]


@pytest.mark.parametrize("body", [Jump(0), Wait(Constant(1))])
def test_a_program_that_never_ends_is_stopped_with_a_reason(body):
    plan = Plan((Instruction(body), Instruction(Jump(0))))
    result = rehearse(
        plan, demo_floor.scene(), places=demo_floor.places(), conditions=Conditions("kinematic", limit_s=360)
    )
    assert result["ok"] is False
    assert result["errors"][0]["message"] == (
        "The program was stopped after 0.1 h of simulated time; it may never end."
    )


def test_a_condition_looks_at_the_readings_of_the_pretend_devices():
    hot = Operation(">", (Reading(Constant("curingOven01"), "temperature"), Constant(1000)))
    plan = Plan((Instruction(Branch(hot, 2)), Instruction(Jump(0)), Instruction(End())))
    result = rehearse(plan, demo_floor.scene(), places=demo_floor.places(), conditions=KINEMATIC)
    assert (result["ok"], result["duration_s"]) == (True, 0.0)


def test_questions_are_answered_by_the_rehearsal_which_says_so():
    pieces = AnswerSpec("number", minimum=3, maximum=5)
    plan = Plan(
        (
            Instruction(AskPerson(Constant("Dry?"), AnswerSpec(), "dry", True), "q"),
            Instruction(AskPerson(Constant("How many?"), pieces, "many", True), "q2"),
            Instruction(Branch(Variable("dry"), 0)),
            Instruction(Wait(Operation("*", (Variable("many"), Constant(10)))), "w"),
            Instruction(Notify(Constant("Done"), "info"), "n"),
            Instruction(End()),
        )
    )
    result = rehearse(plan, demo_floor.scene(), places=demo_floor.places(), conditions=KINEMATIC)
    assert (result["ok"], result["duration_s"]) == (True, 32.0)
    assert [line["text"] for line in result["log"]] == [
        "Asked: Dry?", "The rehearsal answers by itself: yes", "Asked: How many?",
        "The rehearsal answers by itself: 3", "Told: Done",
    ]  # fmt: skip
    assert [(line["code"], line["args"]) for line in result["log"]] == [
        ("asked", {"text": "Dry?"}), ("answered_itself", {"value": True}), ("asked", {"text": "How many?"}),
        ("answered_itself", {"value": 3}), ("told", {"text": "Done"}),
    ]  # fmt: skip


def test_a_program_that_asks_for_ever_is_stopped():
    plan = Plan((Instruction(AskPerson(Constant("Go on?"), AnswerSpec())), Instruction(Jump(0))))
    result = rehearse(
        plan, demo_floor.scene(), places=demo_floor.places(), conditions=Conditions("kinematic", limit_s=60)
    )
    assert result["ok"] is False
    assert [(error["code"], error["args"]) for error in result["errors"]] == [("too_long", {"hours": 0.017})]


def test_a_rehearsal_begins_at_eight_and_knows_where_robots_are():
    late = Operation(">=", (Operation("now", ()), Constant(8 * 3600 + 20)))
    near = Operation("<", (Operation("distance", (Located(role="robot"), Located(device="paintInventory01"))),
                           Constant(2)))  # fmt: skip
    plan = Plan(
        (
            Instruction(WaitUntil(late, None), "late"),
            Instruction(Move("robot", SHELF), "m"),
            Instruction(Branch(near, 0)),
            Instruction(End()),
        ),
        ROLES,
    )
    result = rehearse(plan, demo_floor.scene(), places=demo_floor.places(), conditions=KINEMATIC)
    assert (result["ok"], result["errors"]) == (True, [])
    assert [step["ended_s"] for step in result["steps"] if step["step"] == "late"] == [20.0]
    assert len(result["steps"]) == 2


def test_robots_drive_slowly_in_a_slow_zone():
    points = ((0.0, -14.0), (30.0, -14.0), (30.0, 0.0), (0.0, 0.0))
    zones = (Zone("z", "Everywhere", "slow", points, 0.2),)
    body = (Instruction(Move("robot", SHELF), "m"), Instruction(End()))
    quick, slow = (
        rehearse(Plan(body, ROLES, zones=z), demo_floor.scene(), places=demo_floor.places(), conditions=KINEMATIC)
        for z in ((), zones)
    )
    distance_m = slow["robots"]["robot01"]["distance_m"]
    assert distance_m == quick["robots"]["robot01"]["distance_m"]
    assert slow["duration_s"] > max(distance_m / 0.2, 1.5 * quick["duration_s"])


def test_an_event_of_the_program_happens_in_a_rehearsal_too():
    late = Operation(">=", (Operation("now", ()), Constant(8 * 3600 + 5)))
    plan = Plan(
        (
            Instruction(Wait(Constant(20)), "w"),
            Instruction(End()),
            Instruction(Notify(Constant("Five seconds past"), "info"), "n"),
            Instruction(EventEnd()),
        ),
        events=(EventEntry("e", 2, late),),
    )
    result = rehearse(plan, demo_floor.scene(), places=demo_floor.places(), conditions=KINEMATIC)
    assert [(line["t"], line["text"]) for line in result["log"]] == [(5.0, "Told: Five seconds past")]


def test_the_monitor_finds_robots_that_pass_too_near_between_two_looks():
    monitor = FootprintMonitor({"a": 0.18, "b": 0.18})
    monitor.look(0.0, {"a": (0.0, 0.0), "b": (2.0, 0.3)})
    monitor.look(1.0, {"a": (2.0, 0.0), "b": (0.0, 0.3)})
    assert [(e["a"], e["b"], e["distance_m"]) for e in monitor.encounters] == [("a", "b", -0.06)]

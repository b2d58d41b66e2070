"""States and messages that databases have kept from before are read, whatever their parts are called since."""

import json

from editor.language.plan.json_form import plan_from_json
from execution.machine import machine
from execution.machine import messages as m
from execution.machine.floor_task import Target, TaskOrder
from execution.machine.state import FLOOR_TASK
from execution.traffic import floor
from execution.traffic.floor_state import Door, FloorTask, Robot, Sent
from execution.traffic.messages import FloorZone, Reason

RUN = "21d39520-eca2-4d7a-be85-ebfe640e5d9f"
ORDER = {"kind": "pick", "target": {"id": "itemInventory01", "point": None}, "role": "robot", "object": "box",
         "quantity": 1, "method": "", "arguments": {}, "route": [], "step": "s1", "line": 2}  # fmt: skip
FLOOR = {
    "namespace": "b242a73c-ee3b-4cfe-a4d9-f9522f38a48f", "now": 1795361342.35, "next_seq": 55, "stopped": False,
    "robots": [{"id": "robot01", "x": 20.8, "y": -4.2, "theta": 1.5, "way": ["itemInventory01", 1055, 1005],
                "passed": 1, "released": 2, "held": [1005, 1055], "online": True, "run": RUN, "evading": "",
                "yields_to": "", "yields_since": 0.0, "blocked_since": None, "idle_since": 1795361333.9,
                "progress_at": 1795361342.3, "refusals": 0}],
    "jobs": [{"run": RUN, "mission": 4, "seq": 29, "order": ORDER, "wants": "", "can": ["move", "pick", "drop"],
              "run_name": "run 1", "robot": "robot01", "command": "", "arrived": False,
              "wait": {"code": "machine_busy", "text": "It is busy.", "args": {"device": "itemInventory01"}},
              "absent_since": None}],
    "sent": [{"id": "1acf4267", "device": "robot01", "run": RUN, "mission": -1, "upto": 2, "at": 1795361341.0,
              "limit_s": 0.0, "held_up": False}],
    "calls": {"itemInventory01": RUN}, "stations": {}, "roles": {f"{RUN}/robot": "robot01"}, "names": {RUN: "run 1"},
    "paused": [], "offline": {"paintMixer01": 1795361300.0},
    "zones": {RUN: [{"key": "p/z", "name": "Aisle", "rule": "slow", "points": [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]],
                     "speed_m_s": 0.2}]},
    "locks": {}, "format": 1,
}  # fmt: skip
RUN_STATE = {
    "format": 2, "status": "running", "reason": "",
    "threads": [{"id": 0, "at": 4, "guards": [], "open": [], "leaf": "s1", "waits_for": "mission", "waits_id": 5,
                 "wake": None, "parent": None, "pending": [], "event": -1,
                 "calls": [{"frame": 0, "back_to": -1, "result": None, "open": 0, "shared": False}]}],
    "frames": {"0": {}}, "facts": [["$role", "robot", "robot01"]], "next_id": 6, "truths": [], "ending": None,
}  # fmt: skip


def as_stored(state):
    """Return the state as the database gives it back: lists for tuples."""
    return json.loads(json.dumps(floor.to_json(state)))


def test_a_kept_floor_is_read_by_the_names_of_today():
    state = floor.from_json(FLOOR)
    robot = state.robots["robot01"]
    assert (type(robot), robot.path, robot.held) == (Robot, ("itemInventory01", 1055, 1005), (1005, 1055))
    order = TaskOrder("pick", Target("itemInventory01"), "robot", "box", 1, step="s1", line=2)
    wait = Reason("machine_busy", "It is busy.", {"device": "itemInventory01"})
    can = ("move", "pick", "drop")
    assert state.tasks == (FloorTask(RUN, 4, 29, order, "", can, "run 1", "robot01", wait=wait),)
    assert state.sent["1acf4267"] == Sent("1acf4267", "robot01", RUN, upto=2, at=1795361341.0)
    outline = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0))
    assert state.zones == {RUN: (FloorZone("p/z", "Aisle", "slow", outline, 0.2),)}


def test_a_floor_is_kept_in_the_words_that_the_version_before_reads():
    assert as_stored(floor.from_json(FLOOR)) == FLOOR


def test_a_floor_kept_before_there_were_zones_is_read():
    before = {key: value for key, value in FLOOR.items() if key not in {"zones", "locks"}}
    assert floor.from_json(before).zones == {}


def test_a_floor_that_knows_doors_is_read_as_it_was_kept_and_one_without_says_nothing_of_them():
    zone = {"key": "p/d", "name": "Ward", "rule": "door", "points": [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]],
            "speed_m_s": None, "door": "gate01"}  # fmt: skip
    door = {"id": "gate01", "is_open": True, "ours": True, "command": "", "robots": ["robot01"], "shut_since": None,
            "needed_at": 1795361342.0, "moved_at": 1795361340.0, "retry_at": 0.0, "why": ""}  # fmt: skip
    kept = {**FLOOR, "passages": [zone], "doors": [door], "zones": {RUN: [zone]}}
    state = floor.from_json(kept)
    outline = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0))
    assert state.passages == (FloorZone("p/d", "Ward", "door", outline, door="gate01"),)
    assert state.doors["gate01"] == Door("gate01", True, True, "", ("robot01",), None, 1795361342.0, 1795361340.0)
    assert as_stored(state) == kept
    assert {"passages", "doors"}.isdisjoint(as_stored(floor.from_json(FLOOR)))


def test_a_kept_run_that_waits_for_the_floor_is_read_and_kept_the_same():
    state = machine.from_json(RUN_STATE)
    assert (state.threads[0].waits_for, state.threads[0].waits_id) == (FLOOR_TASK, 5)
    kept = machine.to_json(state)
    assert kept["threads"][0]["waits_for"] == "mission"
    assert machine.from_json(kept) == state


def test_a_kept_run_in_a_try_goes_on_in_the_catch_of_a_plan_that_knew_no_failures():
    def instruction(do, step="", **fields):
        return {"do": do, "step": step, "line": 1, "enters": [], "leaves": [], **fields}

    steps = [
        instruction("TryBegin", "t", handler=4, kinds=[], final=False),
        instruction("Move", "s1", role="robot", to={"device": "itemInventory01"}, route=[]),
        instruction("TryEnd"),
        instruction("Jump", to=5),
        instruction("Notify", "n", message={"const": "Caught."}, level="info"),
        instruction("End"),
    ]
    plan = plan_from_json({"format": 2, "instructions": steps, "roles": {}, "parameters": {}, "reads": []})
    guard = {"handler": 4, "kinds": [], "calls": 1, "open": 0, "final": False}
    thread = {**RUN_STATE["threads"][0], "at": 1, "guards": [guard]}
    state = machine.from_json({**RUN_STATE, "threads": [thread]})
    state, actions = machine.step(plan, state, m.TaskFailed(5, "blocked", "No way."))
    assert ([a.text for a in actions if isinstance(a, m.Tell)], state.status) == (["Caught."], "finished")

"""What runs and the floor say to each other: the rows that databases have are read, and written the same."""

import json

import pytest

from editor.language.plan.instructions import RoleBinding
from execution import floor_protocol as protocol
from execution.floor_protocol import AskingRun, UnreadableMessage
from execution.machine import messages as r
from execution.machine.floor_task import Target, TaskOrder
from execution.traffic import messages as m

RUN = "21d39520-eca2-4d7a-be85-ebfe640e5d9f"
COMMAND = "1acf4267-2d09-55d4-b5f6-18a2aa891dda"
MOVE = {"kind": "move", "target": {"id": "", "point": [1.5, 2.0]}, "role": "robot", "object": "", "quantity": 1,
        "method": "", "arguments": {}, "route": [[0.0, 1.0], [1.0, 1.0]], "step": "s1", "line": 1}  # fmt: skip
ZONE = {"key": "p/z", "name": "Aisle", "rule": "slow", "points": [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]],
        "speed_m_s": None}  # fmt: skip
ASKED = {"type": "mission_asked", "run": RUN, "run_name": "run 1", "mission": 1, "order": MOVE, "wants": "",
         "can": ["move", "pick"], "zones": [ZONE]}  # fmt: skip
ORDER = TaskOrder("move", Target(point=(1.5, 2.0)), "robot", route=((0.0, 1.0), (1.0, 1.0)), step="s1", line=1)
AISLE = m.FloorZone("p/z", "Aisle", "slow", ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0)))
TO_FLOOR = [
    (ASKED, m.TaskAsked(RUN, 1, ORDER, "", ("move", "pick"), "run 1", (AISLE,))),
    (
        {**ASKED, "priority": -1, "due": 1795361342.5},
        m.TaskAsked(RUN, 1, ORDER, "", ("move", "pick"), "run 1", (AISLE,), priority=-1, due=1795361342.5),
    ),
    ({"type": "mission_cancelled", "run": RUN, "mission": 1}, m.TaskCancelled(RUN, 1)),
    ({"type": "run_paused", "run": RUN}, m.RunPaused(RUN)),
    ({"type": "run_resumed", "run": RUN}, m.RunResumed(RUN)),
    ({"type": "run_over", "run": RUN}, m.RunOver(RUN)),
    (
        {"type": "answered", "command": COMMAND, "status": "DONE", "why": "", "result": {"weight": 2.5, "lid": None}},
        m.CommandAnswered(COMMAND, "DONE", "", {"weight": 2.5, "lid": None}),
    ),
    (
        {"type": "call_sent", "command": COMMAND, "device": "mixer", "method": "mix",
         "arguments": {"time": 3, "to": [1.0, 2.0]}, "name": "Ada, by hand"},
        m.CallSent(COMMAND, "mixer", "mix", {"time": 3, "to": [1.0, 2.0]}, "Ada, by hand"),
    ),
    ({"type": "call_cancelled", "command": COMMAND, "given_up": True}, m.CallCancelled(COMMAND, given_up=True)),
    ({"type": "stop_pressed"}, m.StopPressed()),
    ({"type": "stop_reset"}, m.StopReset()),
    ({"type": "robot_let_in", "zone": "site/z", "robot": "robot01"}, m.RobotLetIn("site/z", "robot01")),
]  # fmt: skip
BUSY = {"code": "machine_busy", "text": "It is busy.", "args": {"device": "mixer"}}
TO_RUN = [
    ({"type": "mission_over", "mission": 1, "kind": "", "why": "", "result": {"weight": 2.5}},
     protocol.TaskEnded(1, result={"weight": 2.5})),
    ({"type": "mission_over", "mission": 1, "kind": "offline", "why": "Gone.", "result": {}},
     protocol.TaskEnded(1, "offline", "Gone.")),
    ({"type": "role_bound", "role": "robot", "robot": "robot01"}, protocol.RoleFilled("robot", "robot01")),
    ({"type": "role_released", "role": "robot", "robot": "robot01", "bound": True},
     protocol.RoleEmptied("robot", "robot01", bound=True)),
    ({"type": "wait", "step": "s1", "robot": "robot01", "reason": BUSY},
     protocol.WaitNoted("s1", "robot01", m.Reason("machine_busy", "It is busy.", {"device": "mixer"}))),
    ({"type": "wait", "step": "s1", "robot": "", "reason": None}, protocol.WaitNoted("s1", "", None)),
    ({"type": "told", "step": "s1", "robot": "robot01",
      "reason": {"code": "covered", "text": "All.", "args": {"percent": 97}}},
     protocol.TaskNoted("s1", "robot01", m.Reason("covered", "All.", {"percent": 97}))),
    ({"type": "command", "device": "mixer", "method": "mix", "step": "s1", "arguments": {"time": 3}},
     protocol.CommandGiven("mixer", "mix", "s1", {"time": 3})),
    ({"type": "answer", "device": "mixer", "method": "mix", "step": "s1", "status": "FAILED", "why": "Lid open"},
     protocol.CommandEnded("mixer", "mix", "s1", "FAILED", "Lid open")),
    ({"type": "way", "robot": "robot01", "path": [[15.78, -11.75], [15.78, -8]]},
     protocol.RobotSetsOut("robot01", ((15.78, -11.75), (15.78, -8)))),
    ({"type": "deadline"}, protocol.DeadlinePassed()),
    ({"type": "timer", "timer": 4}, r.TimerFired(4)),
    ({"type": "pause", "reason": "Ada paused it"}, r.PauseAsked("Ada paused it")),
    ({"type": "resume", "by": "Ada"}, protocol.ResumeAsked("Ada")),
    ({"type": "cancel", "reason": "Ada cancelled it"}, r.CancelAsked("Ada cancelled it")),
    ({"type": "answered", "question": 3, "value": True, "by": "Ada", "step": "q"},
     protocol.QuestionAnswered(3, True, "Ada", "q")),
]  # fmt: skip


@pytest.mark.parametrize(("row", "message"), TO_FLOOR)
def test_a_row_for_the_floor_is_read_and_written_the_same(row, message):
    assert protocol.floor_message_from_json(row) == message
    assert json.loads(json.dumps(protocol.to_json(message))) == row


@pytest.mark.parametrize(("row", "message"), TO_RUN)
def test_a_row_for_a_run_is_read_and_written_the_same(row, message):
    assert protocol.run_message_from_json(row) == message
    assert json.loads(json.dumps(protocol.to_json(message))) == row


def test_every_kind_of_message_has_its_row_here():
    assert {row["type"] for row, _ in TO_FLOOR} == set(protocol.TO_FLOOR)
    assert {row["type"] for row, _ in TO_RUN} == set(protocol.TO_RUN)


def test_a_row_from_before_there_were_zones_is_read():
    row = {key: value for key, value in ASKED.items() if key != "zones"}
    assert protocol.floor_message_from_json(row) == m.TaskAsked(RUN, 1, ORDER, "", ("move", "pick"), "run 1")


@pytest.mark.parametrize(
    ("row", "said"),
    [
        ({"type": "mission_done"}, "There is no message of type 'mission_done'. Known are: mission_asked"),
        ({"run": RUN}, "There is no message of type None."),
        ({"type": "timer", "timer": 1}, "There is no message of type 'timer'."),
        ({"type": "run_over", "run": RUN, "why": ""}, "'run_over' has no part called 'why'."),
        ({"type": "mission_cancelled", "run": RUN}, "'mission_cancelled' lacks 'mission'."),
        ({"type": "mission_cancelled", "run": RUN, "mission": "1"}, "mission is '1', which is no int."),
        ({"type": "call_cancelled", "command": COMMAND, "given_up": 1}, "given_up is 1, which is no bool."),
        ({**ASKED, "order": {**MOVE, "speed": 1}}, "'mission_asked'.order has no part called 'speed'."),
        ({**ASKED, "order": {**MOVE, "kind": "fly"}}, "'mission_asked'.order.kind is 'fly'"),
        ({**ASKED, "order": {**MOVE, "target": {"point": [1.0]}}}, "order.target.point is [1.0], which is no tuple"),
        ({**ASKED, "zones": [1]}, "'mission_asked'.zones is 1 where an object is needed."),
    ],
)  # fmt: skip
def test_what_is_no_message_of_today_is_refused_with_a_reason(row, said):
    with pytest.raises(UnreadableMessage) as refusal:
        protocol.floor_message_from_json(row)
    assert said in str(refusal.value)


def test_yes_is_no_number_of_a_question():
    with pytest.raises(UnreadableMessage, match="question is True, which is no int"):
        protocol.run_message_from_json({"type": "answered", "question": True, "value": 1, "by": "", "step": ""})


ASKING = AskingRun(
    RUN, "run 1", {"any": RoleBinding("any", None, ("move",)), "one": RoleBinding("one", "r1")}, (AISLE,)
)


def test_a_task_is_asked_with_the_robot_or_the_abilities_that_its_role_wants():
    for role, wants, can in (("any", "", ("move",)), ("one", "r1", ()), ("", "", ())):
        order = TaskOrder("move", Target("shelf"), role)
        assert protocol.to_floor(ASKING, r.Ask(7, order)) == m.TaskAsked(RUN, 7, order, wants, can, "run 1", (AISLE,))
    assert protocol.to_floor(ASKING, r.Cancel(7)) == m.TaskCancelled(RUN, 7)
    assert protocol.to_floor(ASKING, r.Finished("finished", "")) == m.RunOver(RUN)


@pytest.mark.parametrize(
    ("action", "told", "event"),
    [
        (m.TaskOver(RUN, 1), protocol.TaskEnded(1), r.TaskDone(1)),
        (m.TaskOver(RUN, 1, "failed", "No."), protocol.TaskEnded(1, "failed", "No."), r.TaskFailed(1, "failed", "No.")),
        (m.RoleBound(RUN, "any", "r1"), protocol.RoleFilled("any", "r1"), r.Facts({("$role", "any"): "r1"})),
        (m.RoleReleased(RUN, "any", "r1"), protocol.RoleEmptied("any", "r1"), r.Facts({("$role", "any"): ""})),
        (m.RoleReleased(RUN, "one", "r1", bound=True), protocol.RoleEmptied("one", "r1", bound=True), None),
        (m.WaitChanged(RUN, 1, "s", "r1", None), protocol.WaitNoted("s", "r1", None), None),
        (m.SendCommand("c", "d", "mix", {}, RUN, "s"), protocol.CommandGiven("d", "mix", "s", {}), None),
        (m.PathPlanned("r1", RUN, ((0.0, 1.0),)), protocol.RobotSetsOut("r1", ((0.0, 1.0),)), None),
    ],
)
def test_what_traffic_does_reaches_the_machine_of_its_run(action, told, event):
    assert protocol.to_run(action) == (RUN, told)
    assert protocol.to_machine(told) == event


@pytest.mark.parametrize(
    "action",
    [
        m.SendCommand("c", "r1", "move", {}, RUN, "s", piece=True),
        m.SendCommand("c", "mixer", "cancel", {}, RUN),
        m.SendCommand("c", "mixer", "mix", {}),
        m.PathPlanned("r1", "", ()),
    ],
)
def test_pieces_of_path_controls_and_what_belongs_to_no_run_are_told_to_nobody(action):
    assert protocol.to_run(action) is None


@pytest.mark.parametrize(
    ("message", "event"),
    [
        (protocol.QuestionAnswered(3, "red", "Ada", "q"), r.Answered(3, "red")),
        (protocol.ResumeAsked("Ada"), r.Resumed()),
        (r.TimerFired(4), r.TimerFired(4)),
        (r.PauseAsked("Ada paused it"), r.PauseAsked("Ada paused it")),
        (r.CancelAsked("Ada cancelled it"), r.CancelAsked("Ada cancelled it")),
        (protocol.CommandEnded("d", "mix", "s", "DONE", ""), None),
    ],
)
def test_what_others_say_reaches_the_machine(message, event):
    assert protocol.to_machine(message) == event

"""Time limits in a rehearsal: by its own clock, robots stop and machines let go of what took too long."""

import pytest

from editor.language import Surroundings, compile_document
from editor.language.expressions.nodes import PlaceRef
from editor.language.plan.instructions import Instruction, Jump, Move, Plan, RoleBinding, TryBegin, TryEnd
from editor.language.site.surroundings import DeviceFacts
from execution.machine import messages as r
from execution.rehearsals.rehearsal import Conditions, rehearse
from simulation.world import Scene
from tests.kit import demo_floor
from tests.kit.programs import document, operate, step

OVEN, SHELF = {"device": "curingOven01"}, {"device": "itemInventory01"}
TRY, LIMIT = ("t", "body"), ("l", "body")
TELL = step("notify", ("t", "catch"), message={"param": "problem.text"}, level="warning")


def rehearsed(steps):
    devices = demo_floor.devices()
    compiled = compile_document(document(steps), Surroundings({d.id: DeviceFacts(d) for d in devices}))
    assert [d.message for d in compiled.diagnostics if d.severity == "error"] == []
    scene = Scene(demo_floor.grid(), devices, seed=1)
    return rehearse(compiled.plan, scene, places=demo_floor.places(), conditions=Conditions("kinematic"))


def spans(result):
    """Return each step's status with the seconds that it took."""
    return {s["step"]: (s["status"], round(s["ended_s"] - s["started_s"], 1)) for s in result["steps"]}


def test_a_drive_that_takes_too_long_is_called_off_and_the_robot_drives_elsewhere():
    result = rehearsed(
        {
            "t": step("try", kinds=["timed_out"]),
            "l": step("limit", TRY, duration=5),
            "m": step("move", LIMIT, role="robot", to=OVEN),
            "n": TELL,
            "b": step("move", ("t", "catch"), "2V", role="robot", to=SHELF),
        }
    )
    assert result["ok"], result["errors"]
    found = spans(result)
    assert found["m"] == ("failed", 5.0)
    assert found["l"] == ("failed", 5.0)
    assert found["b"][0] == "done"


def test_a_machine_that_takes_too_long_is_called_off_and_can_be_used_at_once():
    result = rehearsed(
        {
            "t": step("try", kinds=["timed_out"]),
            "l": step("limit", TRY, duration={"quantity": [2, "MIN"]}),
            "m": operate("curingOven01", "curePaint", LIMIT, time={"quantity": [30, "MIN"]}),
            "n": TELL,
            "b": {**operate("curingOven01", "curePaint", ("t", "catch"), time={"quantity": [1, "MIN"]}),
                  "place": ["t", "catch", "2V"]},
        }
    )  # fmt: skip
    assert result["ok"], result["errors"]
    assert spans(result)["m"] == ("failed", 120.0)
    assert spans(result)["b"][0] == "done"


def test_a_limit_that_nobody_catches_ends_the_program_with_its_sentence():
    result = rehearsed({"l": step("limit", duration=5), "m": step("move", LIMIT, role="robot", to=OVEN)})
    assert result["ok"] is False
    assert {error["message"] for error in result["errors"]} == {"The time limit of 5 s was over."}


def test_a_wait_as_long_as_its_limit_is_ended_by_the_limit():
    result = rehearsed({"l": step("limit", duration=60), "w": step("wait", LIMIT, duration=60)})
    assert result["ok"] is False
    assert spans(result) == {"l": ("failed", 60.0), "w": ("failed", 60.0)}


def test_what_is_done_in_time_is_not_touched():
    result = rehearsed({"l": step("limit", duration=3600), "m": step("move", LIMIT, role="robot", to=OVEN)})
    assert result["ok"], result["errors"]
    assert {status for status, _ in spans(result).values()} == {"done"}


class Counting:
    """Counts what a rehearsal's run does, and ends one that would never end."""

    def __init__(self):
        self.asked = 0

    def carried(self, thread, at, to):
        pass

    def did(self, action):
        self.asked += isinstance(action, r.Ask)
        assert self.asked < 10_000

    def ended(self, stocks):
        pass


@pytest.mark.parametrize("place", ["nowhere", "curingOven01"])
def test_a_program_that_asks_again_for_what_ends_at_once_rests_so_that_time_goes_on(place):
    loop = (TryBegin(3), Move("robot", PlaceRef(device=place)), TryEnd(), Jump(0))
    plan = Plan(tuple(map(Instruction, loop, ("", "m", "", ""))), {"robot": RoleBinding("robot", can=("move",))})
    scene, seen = Scene(demo_floor.grid(), demo_floor.devices(), seed=1), Counting()
    result = rehearse(plan, scene, conditions=Conditions("kinematic", limit_s=120, observer=seen))
    assert [error["message"] for error in result["errors"]][-1].startswith("The program was stopped after 0.033 h")
    arrived_s = 0 if place == "nowhere" else 60
    assert 15 * (120 - arrived_s) / 2 < seen.asked <= 16 * 122

"""Robots' own methods in a rehearsal: simulated robots carry out whatever they describe, in the time that it takes."""

from dataclasses import replace

from editor.language import Surroundings, compile_document
from editor.language.site.surroundings import DeviceFacts
from execution.rehearsals.rehearsal import Conditions, rehearse
from simulation.world import Scene
from tests.kit import demo_floor
from vipo_device.protocol.description import MethodSpec, ParameterSpec

HONK = MethodSpec("honk", "t/honk", parameters=(ParameterSpec("times", "number", "", 1, 10),))
GRIP = MethodSpec(
    "openGripper",
    "t/grip",
    parameters=(
        ParameterSpec("width", "number", "CentiM", 0, 8),
        ParameterSpec("time", "number", "SEC", 1, 60),
    ),
)


def rehearsed(*steps):
    """Rehearse Operates of the program's robot, where TurtleBot 2 honks and TurtleBot 3 honks and grips."""
    more = {"robot02": (HONK,), "robot03": (HONK, GRIP)}
    devices = tuple(replace(d, methods=(*d.methods, *more.get(d.id, ()))) for d in demo_floor.devices())
    document = {
        "format": 2,
        "start_pos": [0, 0],
        "steps": {
            f"s{number}": {
                "kind": "operate",
                "place": ["program", "body", str(number)],
                "pos": [number, -1],
                "params": {"device": {"role": "robot"}, "method": method, "args": arguments},
            }
            for number, (method, arguments) in enumerate(steps, 1)
        },
    }
    compiled = compile_document(document, Surroundings({d.id: DeviceFacts(d) for d in devices}))
    assert [d.message for d in compiled.diagnostics] == []
    scene = Scene(demo_floor.grid(), devices, seed=1)
    return rehearse(compiled.plan, scene, places=demo_floor.places(), conditions=Conditions("kinematic"))


def test_a_robot_that_can_honk_honks_where_it_stands():
    result = rehearsed(("honk", {"times": 5}))
    assert (result["ok"], result["errors"]) == (True, [])
    assert [(s["step"], s["status"], s["robot"]) for s in result["steps"]] == [("s1", "done", "robot02")]
    assert "TurtleBot 2: honk times 5" in [line["text"] for line in result["log"]]
    assert result["robots"]["robot02"]["distance_m"] == 0
    assert 2 <= result["duration_s"] < 5


def test_the_robot_is_the_one_that_can_do_all_of_it_and_takes_the_time_that_is_said():
    result = rehearsed(("honk", {"times": 1}), ("openGripper", {"width": 5, "time": {"quantity": [0.5, "MIN"]}}))
    assert (result["ok"], result["errors"]) == (True, [])
    assert {s["robot"] for s in result["steps"]} == {"robot03"}
    assert "TurtleBot 3: openGripper time 30, width 5" in [line["text"].replace("30.0", "30") for line in result["log"]]
    assert 32 <= result["duration_s"] < 36

"""Any sequence of commands: a device never breaks, and every command gets exactly one final answer."""

from __future__ import annotations

from collections import Counter
from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st

from simulation.kinematic import KinematicDriver
from simulation.simulated_world import SimulatedWorld
from simulation.world import Ack
from tests.unit.simulation.stage_set import scene

ODD: st.SearchStrategy[Any] = st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5)
POINT = st.lists(st.floats(0.5, 11.5), min_size=2, max_size=2) | st.just([3.0, 6.0]) | st.just([3.0, 6.2])
PATH = st.lists(POINT, max_size=4) | ODD | st.lists(ODD, max_size=3)
DEVICE = st.sampled_from(["shelf", "oven", "rollers", "robot", "nothing", ""]) | ODD
ARGUMENTS = st.fixed_dictionaries(
    {},
    optional={
        "path": PATH,
        "theta": st.floats(-4, 4) | ODD,
        "device": DEVICE,
        "object": st.sampled_from(["box", "can"]) | ODD,
        "value": st.integers(-1, 4) | ODD,
        "time": st.floats(0, 70) | ODD,
        "command": st.sampled_from(["c0", "c1", "c2", "c3"]) | ODD,
        "mode": st.sampled_from(["slow", "fast"]) | ODD,
    },
)
METHODS = ["move", "pick", "drop", "wave", "pause", "resume", "cancel", "curePaint", "dispense", "weld", "cool", "fly"]
COMMANDS = st.tuples(
    st.sampled_from(["robot", "robot", "robot", "shelf", "oven", "rollers", "bench"]),
    st.sampled_from(METHODS),
    ARGUMENTS,
    st.floats(0, 5),
)


@settings(max_examples=60, deadline=None)
@given(st.lists(COMMANDS, max_size=14))
def test_every_command_gets_exactly_one_final_answer(commands: list[tuple[str, str, dict[str, Any], float]]) -> None:
    world = SimulatedWorld(scene(), KinematicDriver)
    events = []
    for i, (device, method, arguments, seconds) in enumerate(commands):
        world.command(device, method, arguments, f"c{i}")
        events += world.advance(seconds)
    for device in ("robot", "shelf", "oven", "rollers", "bench"):
        world.command(device, "resume", {}, f"resume-{device}")
    for _ in range(400):
        events += world.advance(30.0)
        if not any(world.busy().values()):
            break
    assert not any(world.busy().values())
    finals = Counter(
        (e.device, e.command) for e in events if isinstance(e, Ack) and e.status not in {"ACCEPTED", "RUNNING"}
    )
    asked = {(device, f"c{i}") for i, (device, *_) in enumerate(commands)}
    given_answers = {key for key in finals if key[1].startswith("c")}
    # A command that was cancelled before it was given counts as over already; it is answered when it comes.
    assert given_answers == asked
    assert set(finals.values()) <= {1}
    assert [e.t_s for e in events] == sorted(e.t_s for e in events)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(st.sampled_from(["pick", "drop"]), st.integers(1, 3)), max_size=8))
def test_objects_are_neither_made_nor_lost(handling: list[tuple[str, int]]) -> None:
    world = SimulatedWorld(scene(), KinematicDriver)
    world.command("robot", "move", {"path": [[3.0, 6.15]]}, "go")
    world.advance(20)
    for i, (method, count) in enumerate(handling):
        world.command("robot", method, {"device": "shelf", "object": "box", "value": count}, f"c{i}")
        world.advance(3)
        held = world.stocks()["shelf"]["box"] + world.robots()["robot"].carrying.get("box", 0)
        assert held == 24
        assert world.robots()["robot"].carrying.get("box", 0) <= 2


def test_a_way_that_begins_elsewhere_is_refused_and_not_driven() -> None:
    world = SimulatedWorld(scene(), KinematicDriver)
    here = world.robots()["robot"].pose
    world.command("robot", "move", {"path": [[3.0, 6.0]], "from": [here.x + 2.0, here.y]}, "astray")
    (refusal,) = [e for e in world.advance(1.0) if isinstance(e, Ack)]
    assert (refusal.status, refusal.command) == ("REJECTED", "astray")
    assert "begins 2.0 m from where" in refusal.why
    assert world.robots()["robot"].pose == here
    world.command("robot", "move", {"path": [[3.0, 6.0]], "from": [here.x, here.y]}, "first")
    world.command("robot", "move", {"path": [[3.0, 6.2]], "from": [3.0, 6.0]}, "second")
    finals = {e.command: e.status for e in world.advance(60.0) if isinstance(e, Ack)}
    assert finals == {"first": "DONE", "second": "DONE"}

"""On a site with small and large robots a program without a message does what it says, whichever robot is near."""

from dataclasses import replace
from typing import Any

import pytest

from editor.language import Surroundings, compile_document, plan_from_json, plan_to_json
from editor.language.site.surroundings import DeviceFacts
from execution.rehearsals.rehearsal import Conditions, rehearse
from simulation.world import Scene
from tests.kit import demo_floor

CANS, MIXER = {"device": "paintInventory01"}, {"device": "paintMixer02"}


def rehearsed(capacities: dict[str, int], *picks: int) -> tuple[dict[str, Any], set[str]]:
    """Rehearse a program that takes so many cans and leaves all of them, with the plan as runs keep it."""
    loads = [("pick", CANS, quantity) for quantity in picks] + [("drop", MIXER, sum(picks))]
    steps = {
        f"s{number}": {
            "kind": kind,
            "place": ["program", "body", f"{number}V"],
            "pos": [number, -1],
            "params": {"role": "robot", "at": at, "object": "can", "quantity": quantity},
        }
        for number, (kind, at, quantity) in enumerate(loads)
    }
    devices = tuple(replace(d, capacity=capacities.get(d.id, d.capacity)) for d in demo_floor.devices())
    roles = {"robot": {"name": "robot", "can": []}}
    site = Surroundings({d.id: DeviceFacts(d) for d in devices})
    compiled = compile_document({"format": 2, "start_pos": [0, 0], "roles": roles, "steps": steps}, site)
    assert [d.message for d in compiled.diagnostics] == []
    assert compiled.plan is not None
    scene = Scene(demo_floor.grid(), devices, seed=1)
    plan = plan_from_json(plan_to_json(compiled.plan))
    result = rehearse(plan, scene, places=demo_floor.places(), conditions=Conditions("kinematic", limit_s=900))
    return result, {step["robot"] for step in result["steps"]} - {""}


@pytest.mark.parametrize("picks", [(2,), (1, 1)])
@pytest.mark.parametrize("large", ["robot01", "robot02", "robot03"])
def test_the_robot_that_comes_holds_all_that_the_program_picks(large: str, picks: tuple[int, ...]) -> None:
    capacities = {"robot01": 1, "robot02": 1, "robot03": 1, large: 2}
    result, robots = rehearsed(capacities, *picks)
    assert (result["ok"], result["errors"], robots) == (True, [], {large})
    assert [load for _, load in result["carrying"][large]][-2:] == [{"can": 2}, {}]


@pytest.mark.parametrize("picks", [(3,), (1, 2)])
def test_a_robot_that_does_not_say_how_much_it_holds_holds_what_the_program_picks(picks: tuple[int, ...]) -> None:
    result, robots = rehearsed({"robot01": 0, "robot02": 0, "robot03": 0}, *picks)
    (robot,) = robots
    assert (result["ok"], result["errors"]) == (True, [])
    assert [load for _, load in result["carrying"][robot]][-2:] == [{"can": 3}, {}]


def test_a_program_that_any_robot_can_carry_out_takes_the_nearest_though_it_is_small() -> None:
    near = rehearsed({}, 1)[1]
    (small,) = near
    result, robots = rehearsed({small: 1}, 1)
    assert (result["ok"], result["errors"], robots) == (True, [], near)

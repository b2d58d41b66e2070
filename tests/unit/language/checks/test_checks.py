from __future__ import annotations

from dataclasses import replace
from typing import Any

from editor.language import PlaceFacts, compile_document, parse_script
from editor.language.plan.instructions import Call, Drop, Fork, Invoke, Jump, Move, Pick
from tests.kit.demo_site import codes, factory


class WallInTheMiddle:
    """A floor 20 m wide with a wall at x = 10 and a hole in the floor around the origin."""

    known_m = 0.0, -14.0, 20.0, 0.0

    def is_inside(self, x_m: float, y_m: float) -> bool:
        return 0 <= x_m <= 20 and -14 <= y_m <= 0

    def is_free(self, x_m: float, y_m: float, radius_m: float) -> bool:
        return abs(x_m - 10) > radius_m

    def is_reachable(self, from_xy: tuple[float, float], to_xy: tuple[float, float], radius_m: float) -> bool:
        return (from_xy[0] < 10) == (to_xy[0] < 10)

    def can_stop(self, x_m: float, y_m: float, radius_m: float) -> bool:
        return self.is_inside(x_m, y_m) and self.is_free(x_m, y_m, radius_m)

    def why_not_covered(self, outline: tuple[tuple[float, float], ...], lane_m: float, radius_m: float) -> str:
        return "" if any(self.can_stop(x, y, radius_m) for x, y in outline) else "nothing"

    def has_machine(self, device_id: str) -> bool:
        return True

    def station(self, device_id: str, radius_m: float) -> tuple[float, float] | None:
        return (12.0, -3.0) if device_id == "paintMixer01" else (3.0, -3.0)


def moves(*places: dict[str, Any]) -> dict[str, Any]:
    steps = {
        f"m{i}": {"kind": "move", "place": ["program", "body", f"{i}V"], "params": {"to": place}}
        for i, place in enumerate(places)
    }
    return {"format": 1, "steps": steps}


def test_places_are_checked_against_the_floor() -> None:
    place = PlaceFacts("here", "Here", "point", 15.0, -3.0)
    site = replace(factory(), floor=WallInTheMiddle(), places={"here": place})
    document = moves({"point": [30, 0]}, {"point": [10, -3]}, {"point": [3, -3]}, {"place": "here"}, {"place": "gone"})
    assert codes(document, site) == [
        ("m0", "place_outside"),
        ("m1", "place_blocked"),
        ("m2", "place_unreachable"),
        ("m4", "unknown_place"),
    ]


def test_without_a_map_nothing_is_said_of_walls() -> None:
    assert codes(moves({"point": [300, 0]}), factory()) == []


def test_a_machine_dispenses_before_the_pick_and_accepts_before_the_drop() -> None:
    params = {"source": {"device": "paintMixer01"}, "target": {"device": "dropOff01"}, "object": "can", "quantity": 1}
    site = factory()
    drop_off = site.devices["dropOff01"]
    takes_cans = replace(drop_off, description=replace(drop_off.description, takes=("can",)))
    site = replace(site, devices={**site.devices, "dropOff01": takes_cans})
    document = {"steps": {"a": {"kind": "pick_and_drop", "place": ["program", "body", "V"], "params": params}}}
    plan = compile_document(document, site).plan
    assert plan is not None
    actions = [instruction.do for instruction in plan.instructions[:-1]]
    assert [type(action) for action in actions] == [Move, Call, Pick, Move, Call, Drop]
    assert [(a.method, a.serves) for a in actions if isinstance(a, Call)] == [
        ("dispense", "robot"),
        ("accept", "robot"),
    ]


def test_steps_open_and_close_around_what_they_hold() -> None:
    document: dict[str, Any] = {
        "steps": {
            "p": {"kind": "parallel", "place": ["program", "body", "V"], "params": {}},
            "w": {"kind": "wait", "place": ["p", "a", "V"], "params": {"seconds": 1}},
            "c": {"kind": "call", "place": ["p", "b", "V"], "params": {"function": "f"}},
            "x": {"kind": "wait", "place": ["f", "body", "V"], "params": {"seconds": 2}},
        },
        "functions": {"f": {"name": "pause"}},
    }
    plan = compile_document(document, factory()).plan
    assert plan is not None
    fork, invoke = plan.instructions[0], plan.instructions[3]
    assert (fork.do, fork.enters, fork.leaves) == (Fork((1, 3), 5), ("p",), ("p",))
    assert invoke.do == Invoke(6, "pause", {})
    assert (invoke.enters, invoke.leaves) == (("c",), ("c",))
    assert plan.instructions[6].leaves == ("x",)
    assert not any(isinstance(instruction.do, Jump) for instruction in plan.instructions)


def test_many_functions_that_call_each_other_twice_are_checked_in_no_time() -> None:
    steps = {}
    for index in range(60):
        for twice in "12":
            call = {"function": f"f{index + 1}"}
            steps[f"c{index}-{twice}"] = {"kind": "call", "place": [f"f{index}", "body", twice], "params": call}
    steps["start"] = {"kind": "call", "place": ["program", "body", "V"], "params": {"function": "f0"}}
    functions = {f"f{index}": {"name": f"f{index}"} for index in range(61)}
    assert codes({"steps": steps, "functions": functions}, factory()) == []


def test_a_chain_of_steps_that_is_too_deep_ends_in_a_draft() -> None:
    steps = {"s000": {"kind": "while", "place": ["program", "body", "V"], "params": {"condition": True}}}
    for index in range(1, 900):
        place = [f"s{index - 1:03}", "body", "V"]
        steps[f"s{index:03}"] = {"kind": "while", "place": place, "params": {"condition": True}}
    compiled = compile_document({"steps": steps}, factory())
    assert ("s030", "too_deep") in [(d.step, d.code) for d in compiled.diagnostics]
    assert len(compiled.numbers) == 30
    assert len(compiled.order) == 900
    assert parse_script(compiled.script, factory()).tree == compiled.tree

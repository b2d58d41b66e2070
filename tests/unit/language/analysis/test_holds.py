"""How much a role's robot must hold is found along the paths and stands in the plan, so that none is too small."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from editor.language import Surroundings, compile_document, plan_from_json, plan_to_json
from editor.language.compiler import EditedProgram
from tests.kit.demo_site import factory
from tests.unit.language.analysis.test_positions import BOOTH, SHELF, document

HOT = {"op": ">", "args": [{"property": ["curingOven01", "temperature"]}, 60]}


def fleet(*capacities: int) -> Surroundings:
    """Return the factory whose robots hold so many objects each."""
    site = factory()
    robots = {f"robot0{number}": capacity for number, capacity in enumerate(capacities, 1)}
    devices = {
        name: replace(facts, description=replace(facts.description, capacity=robots[name])) if name in robots else facts
        for name, facts in site.devices.items()
        if name in robots or facts.description.kind != "robot"
    }
    return replace(site, devices=devices)


def load(kind: str, quantity: Any, role: str = "robot") -> tuple[str, dict[str, Any]]:
    at = {"device": SHELF if kind == "pick" else BOOTH}
    return kind, {"at": at, "object": "box", "quantity": quantity, "role": role}


def pick(quantity: Any, role: str = "robot") -> tuple[str, dict[str, Any]]:
    return load("pick", quantity, role)


def holds(site: Surroundings, *program: Any, **roles: Any) -> dict[str, int] | None:
    """Return what each role of the plan must hold; None where there is no plan."""
    plan = compile_document(document([*program], **roles), site).plan
    return plan and {name: role.holds for name, role in plan.roles.items() if role.holds}


ASKED = {"question": "How many?", "answer": {"type": "number", "minimum": 1, "maximum": 3}, "variable": "n"}
AGAIN = ("repeat", {"times": 3}, {"body": [pick(1)]})


@pytest.mark.parametrize(
    ("program", "needed"),
    [
        ([pick(1)], {}),
        ([pick(3)], {"robot": 3}),
        ([pick(1), pick(1)], {"robot": 2}),
        ([pick(3), load("drop", 3), pick(1)], {"robot": 3}),
        ([pick(1), load("drop", 1), pick(1)], {}),
        ([("if", {"condition": HOT}, {"then": [pick(2)], "else": [pick(3)]})], {"robot": 3}),
        ([AGAIN], {"robot": 3}),
        ([("ask", ASKED), pick({"param": "n"})], {"robot": 3}),
        ([("if", {"condition": HOT}, {"then": [pick(1)]}), pick(2)], {"robot": 3}),
        ([("while", {"condition": HOT}, {"body": [pick(1)]})], {"robot": 4}),
        ([("try", {"kinds": []}, {"body": [pick(3)], "catch": []}), pick(1)], {"robot": 3}),
        ([pick(5)], None),
    ],
)
def test_a_role_needs_the_most_that_its_robot_may_carry_at_once(program: list[Any], needed: dict[str, int]) -> None:
    assert holds(fleet(1, 4, 1), *program) == needed
    assert holds(fleet(4, 4), *program) == needed


def test_a_role_that_is_bound_needs_nothing_and_is_checked_against_its_robot() -> None:
    bound = {"robot": {"name": "robot", "device": "robot02"}}
    assert holds(fleet(1, 4), pick(3), **bound) == {}
    assert holds(fleet(4, 1), pick(3), **bound) is None


def test_a_robot_that_does_not_say_how_much_it_holds_may_hold_enough() -> None:
    assert holds(fleet(0, 0), pick(3)) == {}
    assert holds(fleet(0, 4), pick(3)) == {"robot": 3}


def test_roles_that_both_need_the_only_large_robot_are_told() -> None:
    roles = {name: {"name": name, "can": ["pick"]} for name in "ab"}
    program = (pick(2, "a"), pick(2, "b"), load("drop", 2, "a"), load("drop", 2, "b"))

    def told(site: Surroundings, *steps: Any) -> list[str]:
        found = compile_document(document([*steps], **roles), site).diagnostics
        return [f"{each.step} {each.code} {each.args['count']}" for each in found if each.severity == "error"]

    assert told(fleet(2, 1, 1), *program) == ["s1 too_few_robots 1", "s3 too_few_robots 1"]
    assert told(fleet(2, 1, 2), *program) == []
    assert told(fleet(2, 1, 0), *program) == []
    assert told(fleet(2, 1), pick(2, "a"), pick(1, "b"), load("drop", 2, "a"), load("drop", 1, "b")) == []
    assert told(fleet(2, 1), *program[::2], ("release", {"role": "a"}), *program[1::2]) == []


def test_what_a_role_needs_is_kept_with_the_plan_and_is_nothing_in_one_of_before() -> None:
    plan = compile_document(document([pick(2)]), fleet(1, 2)).plan
    assert plan is not None
    body = plan_to_json(plan)
    assert body["roles"]["robot"] == {"device": None, "can": ["pick", "drop"], "holds": 2}
    assert plan_from_json(body) == plan
    del body["roles"]["robot"]["holds"]
    assert plan_from_json(body).roles["robot"].holds == 0
    one = compile_document(document([pick(1)]), fleet(1, 2)).plan
    assert one is not None
    assert plan_to_json(one)["roles"]["robot"] == {"device": None, "can": ["pick", "drop"]}


def test_after_an_edit_a_role_needs_what_the_whole_program_does() -> None:
    program, site = EditedProgram(), fleet(1, 3)
    for first, needed in ((1, 3), (0, 2), (2, 3), (1, 3)):
        inner = ("if", {"condition": HOT}, {"then": [pick(2)], "else": [pick(1)]})
        edited = document([pick(first) if first else ("wait", {"duration": 1}), inner, ("wait", {"duration": 3})])
        found = program.look(edited, site)
        assert found.holds == {"robot": needed}

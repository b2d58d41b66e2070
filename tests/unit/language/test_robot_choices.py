"""The condition by which a role's robot is chosen: how it is said and drawn, what it may look at, and what is told."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import pytest

from editor.language import Surroundings, compile_document, parse_script, plan_from_json, plan_to_json, tree_to_document
from editor.language.expressions.nodes import Constant, Located, Operation, Reading
from tests.kit.demo_site import factory
from tests.unit.language.test_robot_readings import VOLTS, script, site

CHARGED = {"op": ">", "args": [{"property": [{"role": "robot"}, "battery"]}, 30]}
INSTEAD = 'Write ctx.any("pick", where=lambda robot: robot.battery > 30).'
STAND = 'self.notify("Here", level="info")'


def chosen(where: str) -> str:
    return script(STAND, f'ctx.any("move", where=lambda robot: {where})')


def document(where: Any, role: str = "robot") -> dict[str, Any]:
    step = {"kind": "move", "place": ["program", "body", "1"], "params": {"role": role, "to": {"point": [1, -2]}}}
    return {"format": 2, "steps": {"s": step}, "roles": {role: {"name": "arm", "can": ["pick"], "where": where}}}


def codes(where: Any, surroundings: Surroundings | None = None) -> list[str]:
    return [each.code for each in compile_document(document(where), surroundings or factory()).diagnostics]


@pytest.mark.parametrize(
    ("where", "said"),
    [
        ("robot.battery > 30", "battery > 30 %"),
        ("30 < robot.battery", "30 % < battery"),
        ("robot.battery > 2 * 15", "battery > 2 * 15"),
        ('robot.battery > 30 and robot.load in ("", "box")', 'battery > 30 % and load in ("", "box")'),
        ('not robot.load == "box"', 'not load == "box"'),
        ('robot.battery > quantity(30, "%")', "battery > 30 %"),
    ],
)
def test_a_choice_is_said_in_the_script_drawn_back_and_put_into_words(where: str, said: str) -> None:
    tree = parse_script(chosen(where), factory()).tree
    assert tree is not None
    drawn = json.loads(json.dumps(tree_to_document(tree, factory())))
    compiled = compile_document(drawn, factory())
    assert (compiled.diagnostics, compiled.tree, compiled.script) == ((), tree, chosen(where))
    assert tree_to_document(compiled.tree, factory(), drawn) == drawn
    assert compiled.plan is not None
    assert compiled.plan.roles["robot"].said == said
    assert plan_from_json(json.loads(json.dumps(plan_to_json(compiled.plan)))) == compiled.plan


def test_the_parameter_may_have_any_name_and_a_robot_may_be_asked_for_what_has_no_python_name() -> None:
    tree = parse_script(chosen("robot.battery > 30").replace("robot:", "r:").replace("robot.b", "r.b"), factory()).tree
    assert tree == parse_script(chosen("robot.battery > 30"), factory()).tree
    slips = site(robot01=(replace(VOLTS, name="wheel slip", unit="PERCENT"), replace(VOLTS, name="wheelSlip")))
    found = parse_script(chosen('robot.read("wheel slip") > 3'), slips).tree
    assert found is not None
    compiled = compile_document(tree_to_document(found, slips), slips)
    assert compiled.script == chosen('robot.read("wheel slip") > 3')
    assert compiled.plan is not None
    assert compiled.plan.roles["robot"].said == '"wheel slip" > 3 %'


def test_the_plan_knows_the_role_by_its_id() -> None:
    where = {"op": "<", "args": [{"property": [{"role": "r7"}, "battery"]}, {"quantity": [0.5, "UNITLESS"]}]}
    plan = compile_document(document({**where, "args": [where["args"][0], 50]}, "r7"), factory()).plan  # type: ignore[index]
    assert plan is not None
    assert plan.roles["r7"].where == Operation("<", (Reading(Located(role="r7"), "battery"), Constant(50)))
    assert plan_to_json(plan)["roles"]["r7"]["said"] == "battery < 50 %"


def test_a_plan_without_a_choice_is_kept_as_before() -> None:
    plan = compile_document(document(None), factory()).plan
    assert plan is not None
    assert plan_to_json(plan)["roles"] == {"robot": {"device": None, "can": ["pick", "move"]}}


READ = {"property": [{"role": "robot"}, "battery"]}


@pytest.mark.parametrize(
    ("where", "told"),
    [
        (CHARGED, []),
        ({"op": ">", "args": [READ, 130]}, ["never_chosen"]),
        ({"op": "and", "args": [CHARGED, {"op": "<", "args": [READ, 20]}]}, ["never_chosen"]),
        (False, ["never_chosen"]),
        ({"op": ">=", "args": [READ, 0]}, ["always_true_in_range"]),
        (READ, ["wrong_type"]),
        ({"op": ">", "args": [READ, "full"]}, ["not_comparable"]),
        ({"op": ">", "args": [READ, {"quantity": [1, "MIN"]}]}, ["wrong_unit"]),
        ({"op": ">", "args": [{"property": [{"role": "robot"}, "nix"]}, 3]}, ["no_robot_tells"]),
        ({"op": ">", "args": [READ, None]}, ["missing_condition"]),
        ({"op": ">", "args": [READ, {"param": "minutes"}]}, ["choice_looks_elsewhere"]),
        ({"op": ">", "args": [{"property": ["curingOven01", "temperature"]}, 3]}, ["choice_looks_elsewhere"]),
        ({"op": ">", "args": [{"property": [{"role": "other"}, "battery"]}, 3]}, ["choice_looks_elsewhere"]),
        ({"op": "in", "args": [{"at": {"role": "robot"}}, {"zone": "z"}]}, ["choice_looks_elsewhere"]),
        ({"op": "<", "args": [{"op": "now", "args": []}, 3]}, ["choice_looks_elsewhere"]),
        ({"at": {"role": "robot"}}, ["choice_looks_elsewhere"]),
        ("battery > 30", ["wrong_type"]),
        ({"op": "exec", "args": ["x"]}, []),
        (["x"], ["wrong_type"]),
        ([], []),
        (7, ["wrong_type"]),
    ],
)
def test_what_a_condition_may_be_is_told_before_the_run(where: Any, told: list[str]) -> None:
    assert codes(where) == told


def test_a_robot_that_does_not_report_what_it_is_chosen_by_is_not_warned_of() -> None:
    silent = site(robot02=())
    assert codes(CHARGED, silent) == []
    read = {
        "kind": "notify",
        "place": ["program", "body", "2"],
        "params": {"message": {"op": "text", "args": ["", READ]}},
    }
    for where, told in ((CHARGED, []), (None, ["may_not_tell"])):
        program = document(where)
        program["steps"]["t"] = read
        assert [each.code for each in compile_document(program, silent).diagnostics] == told


def test_a_role_that_is_one_robot_has_no_choice() -> None:
    program = document(CHARGED)
    program["roles"]["robot"]["device"] = "robot01"
    compiled = compile_document(program, factory())
    assert (compiled.diagnostics, "lambda" in compiled.script) == ((), False)


@pytest.mark.parametrize(
    ("given", "instead"),
    [
        ('ctx.any("move", where="battery > 30")', INSTEAD),
        ('ctx.any("move", where=lambda: True)', INSTEAD),
        ('ctx.any("move", where=lambda a, b: a.battery > 3)', INSTEAD),
        ('ctx.get("robot01", where=lambda robot: True)', INSTEAD),
        ('ctx.any("move", where=lambda robot: robot)', "Say what it reports: robot.battery > 30."),
        ('ctx.any("move", where=lambda robot: robot.batery > 3)', "What can be read here: battery, load."),
        ('ctx.any("move", where=lambda robot: self.oven.temperature > 3)', "such as robot.battery > 30."),
        ('ctx.any("move", where=lambda robot: now() > 3)', "such as robot.battery > 30."),
        ('ctx.any("move", where=lambda robot: [x for x in robot])', "such as robot.battery > 30."),
        ('ctx.any("move", where=lambda self: self.battery > 3)', "ctx.parameter(\"battery\", 0, Number)."),
    ],
)  # fmt: skip
def test_what_is_written_otherwise_is_answered_with_what_to_write(given: str, instead: str) -> None:
    parsed = parse_script(script(STAND, given), factory())
    assert parsed.tree is None
    assert parsed.diagnostics[0].message.endswith(instead)
    assert parsed.diagnostics[0].messages["de"] != parsed.diagnostics[0].messages["en"]

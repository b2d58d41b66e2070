"""Readings of a role's robot: how they are said, drawn, checked and compiled, and what a run makes of them."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import pytest

from editor.language import Surroundings, compile_document, parse_script, plan_from_json, plan_to_json, tree_to_document
from editor.language.expressions.nodes import Constant, Located, Reading
from editor.language.plan.instructions import WaitUntil
from editor.language.site.surroundings import DeviceFacts
from editor.language.tree import nodes as n
from execution.machine import machine
from execution.machine import messages as m
from execution.machine.needs import needs_of
from execution.machine.places import ROLE
from tests.kit.demo_site import factory
from tests.unit.language.checks.test_told_before import HOT, document_of, program, told
from vipo_device.protocol.description import PropertySpec

GO = "self.robot.move(self.dock.location)"
CHARGED = "self.wait(until=self.robot.battery > 30)"
BRANCHES = "def branch_1a(self):\n    {}\ndef branch_1b(self):\n    {}".format


def site(**told_by: tuple[PropertySpec, ...]) -> Surroundings:
    """Return the factory in which some robots report just this."""
    return replace(factory(), devices={key: _changed(facts, told_by) for key, facts in factory().devices.items()})


def _changed(facts: DeviceFacts, told_by: dict[str, tuple[PropertySpec, ...]]) -> DeviceFacts:
    description = facts.description
    return replace(
        facts, description=replace(description, properties=told_by.get(description.id, description.properties))
    )


def script(line: str, given: str = 'ctx.any("move")') -> str:
    run = f"    def run(self, ctx):\n        self.robot = {given}\n        self.new_task()\n"
    return f"class Task(object):\n    def new_task(self):\n        self.robot.move((1, -2))\n        {line}\n\n{run}"


@pytest.mark.parametrize("given", ['ctx.any("move")', 'ctx.get("robot01")'])
@pytest.mark.parametrize(
    "line",
    [
        "self.wait(until=self.robot.battery > 30)",
        'self.notify(f"It has {self.robot.battery}", level="info")',
        "self.charge = self.robot.battery",
        'self.wait(until=self.robot.read("wheel slip") > 30, timeout=60)',
    ],
)
def test_what_a_robot_tells_is_said_in_the_script_and_drawn_back(line: str, given: str) -> None:
    tree = parse_script(script(line, given), factory()).tree
    assert tree is not None
    drawn = tree_to_document(tree, factory())
    compiled = compile_document(json.loads(json.dumps(drawn)), factory())
    assert (compiled.script, compiled.tree) == (script(line, given), tree)
    assert tree_to_document(compiled.tree, factory(), drawn) == drawn


def test_a_reading_of_a_role_that_is_bound_speaks_of_the_role_and_is_known_from_the_start() -> None:
    document = document_of(script(CHARGED, 'ctx.get("robot01")'))
    compiled = compile_document(document, factory())
    waits = [node for node in compiled.tree.body if isinstance(node, n.WaitUntil)]
    assert Reading(Located(role="robot"), "battery") in [arg for w in waits for arg in w.condition.arguments]  # type: ignore[union-attr]
    assert compiled.plan is not None
    assert compiled.plan.reads == (("robot01", "battery"),)
    assert needs_of(compiled.plan).things == frozenset({"robot01"})


def test_a_role_that_no_step_drives_is_the_device_that_it_is_bound_to() -> None:
    value = {"property": [{"role": "watched"}, "battery"]}
    document = {
        "format": 2,
        "steps": {
            "s": {
                "kind": "wait",
                "place": ["program", "body", "1"],
                "params": {"until": {"op": ">", "args": [value, 3]}},
            }
        },
        "roles": {"watched": {"name": "watched", "device": "robot02"}},
    }
    (node,) = compile_document(document, factory()).tree.body
    assert isinstance(node, n.WaitUntil)
    assert node.condition.arguments[0] == Reading(Constant("robot02"), "battery")  # type: ignore[union-attr]


@pytest.mark.parametrize(
    ("parts", "codes"),
    [
        ((f"{GO}\n{CHARGED}",), []),
        ((f"{CHARGED}\n{GO}",), ["no_robot_yet"]),
        ((f"if {HOT}:\n    {GO}\nself.notify(f'{{self.robot.battery}}')",), ["perhaps_no_robot_yet"]),
        (("self.parallel(self.branch_1a, self.branch_1b)", BRANCHES(GO, CHARGED)), []),
        ((f"{GO}\nself.wait(until=self.robot.battery > 130)",), ["waits_for_ever"]),
        ((f"{GO}\nif self.robot.battery > 130:\n    self.end()",), ["never_true_in_range"]),
        ((f"{GO}\nif self.robot.battery > 30 and self.robot.battery < 20:\n    self.end()",), ["contradiction"]),
        ((f"{GO}\nif self.robot.load > 3:\n    self.end()",), ["not_comparable"]),
        ((f"{GO}\nself.wait(self.robot.battery)",), ["wrong_unit"]),
        ((f"{GO}\nself.wait(quantity(1, 'min') * self.robot.battery)",), []),
        ((f"{GO}\nself.robot.honk(self.robot.battery)",), []),
    ],
)  # fmt: skip
def test_what_is_wrong_is_told_before_the_run(parts: tuple[str, ...], codes: list[str]) -> None:
    assert [each.split()[0] for each in told(*parts)] == codes


VOLTS = PropertySpec("battery", "number", "V", 0, 24)
FULL = PropertySpec("battery", "number", "PERCENT", 20, 200)


@pytest.mark.parametrize(
    ("where", "codes"),
    [
        (site(robot02=(VOLTS,)), ["readings_differ"]),
        (site(robot02=(replace(VOLTS, type="text", unit=""),)), ["readings_differ"]),
        (site(robot02=()), ["may_not_tell"]),
        (site(robot01=(), robot02=(), robot03=()), ["no_robot_tells"]),
        (site(robot01=(FULL,)), []),
        (Surroundings(), ["no_robot_can"]),
    ],
)
def test_all_robots_that_may_have_the_role_report_it_alike(where: Surroundings, codes: list[str]) -> None:
    document = document_of(script('self.notify(f"{self.robot.battery}")'))
    assert [each.code for each in compile_document(document, where).diagnostics] == codes


def test_the_range_is_that_of_all_of_them() -> None:
    where, document = site(robot01=(FULL,)), document_of(script("self.wait(until=self.robot.battery > 150)"))
    assert compile_document(document, where).plan is not None
    assert [each.code for each in compile_document(document, factory()).diagnostics] == ["waits_for_ever"]


@pytest.mark.parametrize(
    ("line", "where", "instead"),
    [
        (
            "self.wait(until=self.robot.batery > 3)",
            factory(),
            "Did you mean battery? What can be read here: battery, load.",
        ),
        ("self.wait(until=self.robot.honk > 3)", factory(), "Write it on a line of its own: self.robot.honk(…)."),
        ("self.wait(until=self.robot.battery() > 3)", factory(), "Write it without brackets: self.robot.battery."),
        (
            "self.wait(until=self.robot.bat_tery > 3)",
            site(robot02=(replace(VOLTS, name="bat tery"),), robot03=(replace(VOLTS, name="batTery"),)),
            "Did you mean battery? What can be read here: battery, load.",
        ),
    ],
)
def test_what_is_written_otherwise_is_answered_with_what_can_be_read(
    line: str, where: Surroundings, instead: str
) -> None:
    parsed = parse_script(script(line), where)
    assert parsed.tree is None
    assert parsed.diagnostics[0].message.endswith(instead)


def test_a_run_reads_the_robot_that_the_role_has_found_also_after_it_was_put_away() -> None:
    document = document_of(program(f"{GO}\n{CHARGED}\nself.notify(f'{{self.robot.battery}} left')"))
    compiled = compile_document(document, factory())
    assert compiled.plan is not None
    plan = plan_from_json(json.loads(json.dumps(plan_to_json(compiled.plan))))
    low = {("robot01", "battery"): 90, ("robot02", "battery"): 10}
    state, (*_, asked) = machine.start(plan, {}, low)
    assert isinstance(asked, m.Ask)
    state, _ = machine.step(plan, state, m.Facts({(ROLE, "robot"): "robot02"}))
    state, _ = machine.step(plan, state, m.TaskDone(asked.task))
    assert isinstance(plan.instructions[state.threads[0].at].do, WaitUntil)
    state = machine.from_json(json.loads(json.dumps(machine.to_json(state))))
    state, actions = machine.step(plan, state, m.Facts({("robot01", "battery"): 95}))
    assert state.status == "running"
    state, actions = machine.step(plan, state, m.Facts({("robot02", "battery"): 31}))
    assert [each.text for each in actions if isinstance(each, m.Tell)] == ["31 left"]
    assert state.status == "finished"


def test_a_robot_that_does_not_say_it_fails_the_step_and_leaves_an_event_alone() -> None:
    lines = [f"{GO}", "if self.robot.battery > 30:\n    self.end()"]
    document = document_of(program("\n".join(lines)))
    plan = compile_document(document, factory()).plan
    assert plan is not None
    state, (*_, asked) = machine.start(plan, {}, {})
    assert isinstance(asked, m.Ask)
    state, _ = machine.step(plan, state, m.Facts({(ROLE, "robot"): "robot02"}))
    state, _ = machine.step(plan, state, m.TaskDone(asked.task))
    assert (state.status, state.reason) == ("failed", "robot02 has not reported its battery yet.")


def test_an_event_on_a_robot_that_is_not_known_yet_is_not_true() -> None:
    steps: dict[str, Any] = {
        "go": {
            "kind": "move",
            "place": ["program", "body", "1"],
            "params": {"role": "robot", "to": {"point": [1, -2]}},
        },
        "low": {
            "kind": "on_event",
            "place": ["program", "events", "1"],
            "params": {"condition": {"op": "<", "args": [{"property": [{"role": "robot"}, "battery"]}, 20]}},
        },
        "say": {"kind": "notify", "place": ["low", "body", "1"], "params": {"message": "Low"}},
    }
    compiled = compile_document({"format": 2, "steps": steps}, factory())
    assert (compiled.diagnostics, compiled.plan is None) == ((), False)
    assert compiled.plan is not None
    assert "ctx.when(self.robot.battery < 20, self.when_e1)" in compiled.script
    state, actions = machine.start(compiled.plan, {}, {("robot01", "battery"): 5})
    assert not any(isinstance(each, m.Tell) for each in actions)
    _, actions = machine.step(compiled.plan, state, m.Facts({(ROLE, "robot"): "robot01"}))
    assert [each.text for each in actions if isinstance(each, m.Tell)] == ["Low"]

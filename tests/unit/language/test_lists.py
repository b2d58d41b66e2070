"""Lists as values: their types and units, what the checks know of them, and what a run does with them."""

from __future__ import annotations

import json
from typing import Any

import pytest

from editor.language import compile_document, parse_script, plan_from_json, plan_to_json, tree_to_document
from editor.language.expressions.nodes import Constant, Operation
from editor.language.expressions.values import MOST_ITEMS, read_value
from execution.machine import machine
from execution.machine import messages as m
from execution.machine.evaluation import EvaluationError, evaluate
from tests.kit.demo_site import factory
from tests.unit.language.checks.test_told_before import program, told

GROWS = "self.a = []\nwhile self.oven.temperature > 40:\n    self.a = self.a + [1]\n    self.wait(60)\n"
CURE = "m.operate('curePaint', {'time': 3})"
SHOW = "self.notify(f'{nth(self.a, 1)}')"


@pytest.mark.parametrize(
    ("body", "codes"),
    [
        ("self.a = [1, 2]\nself.notify(f'{nth(self.a, 2)}')", []),
        ("self.a = [1, 2]\nself.notify(f'{nth(self.a, 0)}')", ["no_such_item"]),
        ("self.a = [1, 2]\nself.notify(f'{nth(self.a, 1.5)}')", ["no_such_item"]),
        ("self.a = [1, 2] + [3]\nself.notify(f'{nth(self.a, 3)}')", []),
        (f"{GROWS}{SHOW}", ["may_be_no_such_item"]),
        (f"{GROWS}if len(self.a) > 0:\n    {SHOW}", []),
        (f"{GROWS}if len(self.a) >= 2:\n    self.notify(f'{{nth(self.a, 3)}}')", ["may_be_no_such_item"]),
        ("self.a = []\nfor x in [1, 2]:\n    self.a = self.a + [x]\nself.notify(f'{nth(self.a, 2)}')", []),
        ("self.a = ['red']\nself.a = [1]\nself.notify(f'{self.a}')", ["wrong_type"]),
        ("self.a = [1]\nself.wait(self.a)", ["wrong_type"]),
        ("self.a = [1]\nfor x in self.a:\n    self.notify(x)", ["wrong_type"]),
        ("self.a = ['x']\nself.wait(len(self.a) * quantity(1, 's'))", []),
        ("self.a = [quantity(1, 'min')]\nself.wait(nth(self.a, 1))", []),
        ("self.a = [1]\nself.wait(nth(self.a, 1))", ["plain_number"]),
        ("self.a = [quantity(1, 'min'), quantity(2, 'm')]\nself.notify(f'{self.a}')", ["wrong_unit"]),
        ("self.a = [quantity(1, 'min')]\nself.a = [2]\nself.wait(nth(self.a, 1))", ["plain_number"]),
        ("self.a = [quantity(1, 'min')]\nself.a = []\nself.notify(f'{self.a}')", []),
        ("self.a = [quantity(1, 'min')]\nif quantity(60, 's') in self.a:\n    self.notify('yes')", []),
        ("self.a = ['x']\nif 1 in self.a:\n    self.notify('yes')", ["not_comparable"]),
        (f"self.a = [self.mixer, self.oven]\nfor m in self.a:\n    {CURE}", ["may_not_fit Paint Mixer A"]),
        ("self.a = [1, 2]\nfor x in self.a:\n    self.notify(f'{1 / (x - 2)}')", ["may_divide_by_zero"]),
    ],
)  # fmt: skip
def test_what_is_wrong_with_a_list_is_told(body: str, codes: list[str]) -> None:
    assert told(body) == codes


def run(body: str) -> tuple[list[str], str, str]:
    """Return what people are told in a run that is written to JSON and read again at each event, and its end."""
    tree = parse_script(program(body), factory()).tree
    assert tree is not None
    compiled = compile_document(tree_to_document(tree, factory()), factory())
    assert compiled.tree == tree
    assert compiled.plan is not None, compiled.diagnostics
    plan = plan_from_json(json.loads(json.dumps(plan_to_json(compiled.plan))))
    state, actions = machine.start(plan, {}, {("curingOven01", "temperature"): 80})
    said: list[str] = []
    while True:
        said += [action.text for action in actions if isinstance(action, m.Tell)]
        timers = [action.timer for action in actions if isinstance(action, m.SetTimer)]
        if state.status != "running" or not timers:
            reasons = [action.reason for action in actions if isinstance(action, m.Finished)]
            return said, state.status, "".join(reasons)
        state = machine.from_json(json.loads(json.dumps(machine.to_json(state))))
        state, actions = machine.step(plan, state, m.TimerFired(timers[-1]))


def test_a_list_outlives_a_kill_in_the_middle_of_its_loop() -> None:
    body = "self.a = ['x', 'y']\nfor n, i in enumerate(self.a, 1):\n    self.wait(1)\n    self.notify(f'{n} {i}')"
    assert run(body) == (["1 x", "2 y"], "finished", "")


def test_a_loop_goes_through_the_list_as_it_was_when_it_began() -> None:
    body = "self.a = [1, 2]\nfor i in self.a:\n    self.a = self.a + [i]\nself.notify(f'{self.a}')"
    assert run(body) == (["1, 2, 1, 2"], "finished", "")


def test_lists_in_different_units_meet() -> None:
    body = "self.a = [quantity(1, 'min')]\nself.b = [quantity(30, 's')]\nself.a = self.a + self.b\n"
    body += "self.notify(f'{self.a}')"
    assert run(body) == (["1, 0.5"], "finished", "")


def test_an_item_that_there_is_not_fails_the_run() -> None:
    body = "self.a = [1]\nself.n = self.ask('Which?', type='number')\nself.notify(f'{nth(self.a, self.n)}')"
    assert told(body) == []
    items, ask = Constant((1,)), Operation("nth", (Constant((1,)), Constant(2)))
    with pytest.raises(EvaluationError, match="There is no item 2: the list has 1"):
        evaluate(ask, {}, {})
    with pytest.raises(EvaluationError, match="There is no item 0"):
        evaluate(Operation("nth", (items, Constant(0))), {}, {})
    with pytest.raises(EvaluationError, match="stands where a list is needed"):
        evaluate(Operation("len", (Constant("abc"),)), {}, {})


def test_a_list_that_grows_beyond_all_measure_fails_the_run() -> None:
    body = "self.a = []\nwhile self.oven.temperature > 40:\n    self.a = self.a + [1]\nself.notify(f'{self.a}')"
    said, status, reason = run(body)
    assert (said, status, reason) == ([], "failed", f"A list has more than {MOST_ITEMS:,} items.")


@pytest.mark.parametrize(
    "value",
    [
        {"op": "list", "args": [{"op": "list", "args": [{"op": "list", "args": []}]}]},
        {"op": "list", "args": [[1], {"quantity": [1, "MIN"]}, None, {"zone": "z1"}, {"at": {"point": [1, 2]}}]},
        {"op": "list", "args": [0] * 5000},
        {"op": "nth", "args": [{"op": "list", "args": []}, {"op": "list", "args": []}]},
        {"op": "+", "args": [{"op": "list", "args": [True]}, {"op": "list", "args": ["x", 2]}]},
        {"op": "len", "args": ["abc"]},
        {"op": "-", "args": [[1, 2], 1]},
    ],
)
def test_a_hostile_list_is_told_and_reads_back(value: Any) -> None:
    given = {
        "s": ("set", {"variable": "a", "value": value}),
        "f": ("for_each", {"variable": "x", "list": {"param": "a"}}),
    }
    steps = {
        name: {"kind": kind, "place": ["program", "body", order], "pos": [0, 0], "params": params}
        for order, (name, (kind, params)) in zip(("1V", "2V"), given.items(), strict=True)
    }
    compiled = compile_document({"format": 2, "start_pos": [0, 0], "steps": steps}, factory())
    assert compiled.plan is None
    assert {"s", "f"} & {each.step for each in compiled.diagnostics if each.severity == "error"}
    assert parse_script(compiled.script, factory()).tree == compiled.tree


def test_a_list_that_is_written_out_is_one_constant() -> None:
    assert read_value({"op": "list", "args": [1, 2]}, {}) == Constant((1, 2))
    assert read_value({"op": "list", "args": []}, {}) == Operation("list", ())


CIRCLE = """try:
    try:
        self.ys = self.ys + [self.n]
    except TaskError:
        self.wait(60)
    for each in self.xs:
        self.n = each
        self.xs = [self.k]
except TimedOut:
    self.k = self.n
self.wait({})"""


@pytest.mark.parametrize(("waited", "codes"), [("self.n", []), ("self.k", []), ("60", [])])
def test_variables_in_a_circle_through_an_empty_list_have_an_open_unit(waited: str, codes: list[str]) -> None:
    """Their types would change for ever: a hall of mirrors, found by `odd_scripts`."""
    found = told(f"self.n = 1\nself.xs = []\n{CIRCLE.format(waited)}")
    assert [code for code in found if code not in {"unused_variable", "unset_variable", "may_be_unset"}] == codes

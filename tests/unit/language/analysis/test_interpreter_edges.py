"""Edges of the interpreter and its domains, found by changing them and seeing that no test noticed."""

from __future__ import annotations

from typing import Any
from unittest import mock

import pytest

from editor.language import compile_document
from editor.language.analysis.domain import States
from editor.language.analysis.walk import Walk
from editor.language.compiler import EditedProgram
from editor.language.tree.nodes import Block, Wait
from tests.kit.demo_site import factory
from tests.kit.programs import document, step
from tests.unit.language.units.test_units_to_the_run import document_of, script, site

BODY = ("program", "body")
NEVER = "def never(self):\n    for n, t in enumerate([1, 2], 1):\n        self.notify(f'{1 / (n - 2)}')"
ASKED = "self.zero = 0\nself.n = self.ask('?', type='number', minimum=0, maximum=5)\n"
ZERO = "self.notify(f'{1 / self.zero}')"
GROWS = "self.a = []\nwhile self.curing_oven.temperature > 40:\n    self.a = self.a + [1]\n    self.wait(60)\n"


def told(body: str, functions: str = "") -> list[str]:
    """Return the codes of what is said of a script."""
    return [each.code for each in compile_document(document_of(script(body, functions)), site()).diagnostics]


def test_a_function_that_nothing_calls_is_followed_too() -> None:
    assert "divided_by_zero" in told("self.wait(1)", NEVER)


@pytest.mark.parametrize(
    ("body", "is_told"),
    [
        (f"{ASKED}if self.n != 5:\n    if self.n >= 5:\n        {ZERO}", False),
        (f"{ASKED}if self.n != 5:\n    if self.n >= 4:\n        {ZERO}", True),
        (f"{ASKED}if self.n != 0:\n    if self.n <= 0:\n        {ZERO}", False),
        (f"{ASKED}if self.n != 3:\n    if self.n >= 5:\n        {ZERO}", True),
        (f"{ASKED}if self.n != 0:\n    if self.n != 5:\n        if self.n <= 0:\n            {ZERO}", False),
    ],
)
def test_a_number_that_is_not_at_an_end_of_its_range_is_beside_it(body: str, is_told: bool) -> None:
    assert ("divided_by_zero" in told(body)) is is_told


@pytest.mark.parametrize(
    ("compared", "is_told"),
    [("len(self.a) < 2", False), ("len(self.a) < 3", True), ("len(self.a) <= 1", False), ("len(self.a) <= 2", True)],
)
def test_a_list_shorter_than_a_length_has_one_item_less_at_most(compared: str, is_told: bool) -> None:
    at_least = "if len(self.a) >= 2:\n        self.notify(f'{1 / (len(self.a) - 2)}')"
    found = told(f"{GROWS}if {compared}:\n    {at_least}")
    assert ("divided_by_zero" in found) is is_told


def looks(steps: int) -> dict[str, Any]:
    """Return a program of that many loops, each with a step."""
    found: dict[str, Any] = {}
    for number in range(steps):
        found[f"r{number}"] = step("repeat", BODY, f"{number:03}V", times=2)
        found[f"w{number}"] = step("wait", (f"r{number}", "body"), "1V", duration=number + 1)
    return found


def test_an_edit_follows_what_it_changes_and_no_more() -> None:
    program, steps = EditedProgram(), looks(40)
    program.compile(document(steps), factory())
    followed: list[str] = []
    block = Walk.block

    def count(walk: Walk, nodes: Block, states: States) -> States | None:
        followed.extend(node.step for node in nodes if isinstance(node, Wait))
        return block(walk, nodes, states)

    changed = {**steps, "w7": step("wait", ("r7", "body"), "1V", duration=99)}
    with mock.patch.object(Walk, "block", count):
        compiled = program.compile(document(changed), factory())
    assert set(followed) == {"w7"}
    assert compiled == compile_document(document(changed), factory())


def test_what_a_failure_leaves_of_a_variable_may_be_what_it_was_before() -> None:
    robot_fails = (
        "try:\n    self.wait(1)\n    self.n = 1\n    self.wait(1)\nexcept TaskError:\n    self.notify(f'{1 / self.n}')"
    )
    assert "divided_by_zero" not in told(f"self.n = 0\n{robot_fails}")


CHOSEN = "self.zero = 0\nself.c = self.ask('?', type='choice', options=['red', 'blue'])\n"


@pytest.mark.parametrize(
    ("body", "is_told"),
    [
        (f"{CHOSEN}if self.c == 'red':\n    if self.c == 'blue':\n        {ZERO}", False),
        (f"{CHOSEN}if self.c == 'red':\n    if self.c == 'red':\n        {ZERO}", True),
        (f"{CHOSEN}if self.c != 'red':\n    if self.c == 'blue':\n        {ZERO}", True),
        (f"{CHOSEN}if self.c != 'red':\n    self.wait(1)\nelse:\n    if self.c == 'blue':\n        {ZERO}", False),
        (f"{CHOSEN}if not (self.c != 'red'):\n    if self.c == 'blue':\n        {ZERO}", False),
    ],
)
def test_a_text_is_what_a_condition_says_that_it_is(body: str, is_told: bool) -> None:
    assert ("divided_by_zero" in told(body)) is is_told


def beside(other: str, body: str) -> list[str]:
    """Return what is said where two branches run at once."""
    lines = "self.zero = 0\nself.x = 5\nself.parallel(self.branch_1a, self.branch_1b)"
    return told(lines, f"def branch_1a(self):\n    {other}\n\ndef branch_1b(self):\n    {body}")


def test_what_another_branch_sets_meanwhile_may_be_so_and_need_not() -> None:
    shares = "self.notify(f'{1 / self.x}')"
    assert "divided_by_zero" not in beside("self.x = 0", shares)
    assert "divided_by_zero" in beside("self.x = 0", f"self.x = 0\n    {shares}")


def test_a_condition_says_nothing_that_lasts_of_what_another_branch_sets() -> None:
    body = f"if self.x == 5:\n        if self.x == 0:\n            {ZERO}"
    assert "divided_by_zero" in beside("self.x = 0", body)
    assert "divided_by_zero" not in beside("self.wait(1)", body)


def test_half_a_box_is_told_and_what_is_carried_then_is_not_known() -> None:
    at = {"role": "robot", "object": "box", "at": {"device": "itemInventory01"}}
    steps = {
        "a": step("pick", BODY, "1V", **at, quantity=1.5),
        "b": step("drop", BODY, "2V", **at, quantity=2),
    }
    found = [each.code for each in compile_document(document(steps), factory()).diagnostics]
    assert "drops_nothing" not in found
    assert found


@pytest.mark.parametrize(("compared", "is_told"), [("> 1", True), (">= 2", True), ("> 2", False), (">= 3", False)])
def test_a_list_longer_than_a_length_has_one_item_more_at_least(compared: str, is_told: bool) -> None:
    found = told(f"{GROWS}if len(self.a) {compared}:\n    self.notify(f'{{1 / (len(self.a) - 2)}}')")
    assert ("may_divide_by_zero" in found) is is_told


@pytest.mark.parametrize(("compared", "is_told"), [("> 0", False), (">= 0", True)])
def test_in_a_loop_s_first_round_its_condition_holds(compared: str, is_told: bool) -> None:
    body = "self.notify(f'{1 / self.n}')\n    self.n = self.n - 1"
    asked = "self.n = self.ask('?', type='number', minimum=0, maximum=9)"
    found = told(f"{asked}\nwhile self.n {compared}:\n    {body}")
    assert any("by_zero" in code for code in found) is is_told


@pytest.mark.parametrize(
    ("body", "codes"),
    [
        ("self.a = [1, 2, 3]", []),
        (f"{GROWS}", ["may_divide_by_zero"]),
        (f"{GROWS}self.a = self.a + [1]", []),
        ("self.a = []", ["divided_by_zero"]),
    ],
)
def test_what_is_shared_among_the_items_of_a_list_needs_one(body: str, codes: list[str]) -> None:
    assert [code for code in told(f"{body}\nself.notify(f'{{6 / len(self.a)}}')") if "zero" in code] == codes

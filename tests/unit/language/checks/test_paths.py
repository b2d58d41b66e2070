"""What is known along the paths of a program: what surely goes wrong is told, and what cannot go wrong is not."""

from __future__ import annotations

from typing import Any

import pytest

from editor.language.compiler import EditedProgram, compile_document
from tests.unit.language.units.test_units_to_the_run import document_of, script, site

HOT = "self.curing_oven.temperature > 60"
PICK = 'self.robot.pick({"value": 1, "object": "box"})'
DROP = 'self.robot.drop({"value": 1, "object": "box"})'
FETCH = f"def fetch(self, n: Number):\n    SHELF\n    for _ in range(n):\n        {PICK}"
STEP = "def step(self, n: Number):\n    if n > 0:\n        self.step(n=n - 1)"


def drawn(body: str, functions: str = "") -> dict[str, Any]:
    """Return the document of a program; SHELF and BOOTH stand for moves there."""
    text = script(body, functions)
    text = text.replace("SHELF", "self.robot.move(self.shelf.location)")
    text = text.replace("BOOTH", "self.robot.move(self.booth.location)")
    given = '        self.shelf = ctx.get("itemInventory01")\n        self.booth = ctx.get("paintMachine01")\n'
    text = text.replace("* S)", '* quantity(1, "s"))')
    if "self.robot" in text:
        robot = '        self.robot = ctx.any("pick", "drop")\n'
        text = text.replace("    def run(self, ctx):\n", f"    def run(self, ctx):\n{robot}{given}")
    return document_of(text)


def told(body: str, functions: str = "") -> list[str]:
    """Return the codes that are told of a program."""
    found = [each.code for each in compile_document(drawn(body, functions), site()).diagnostics]
    return [code for code in found if code not in {"unused_variable", "busy_circle"}]


@pytest.mark.parametrize(
    ("body", "codes"),
    [
        ("self.n = 3\nwhile self.n > 0:\n    self.n = self.n - 1\nself.notify(f'{1 / self.n}')", ["divided_by_zero"]),
        ("self.n = 3\nwhile self.n > 0:\n    self.wait(1)", ["never_ends"]),
        ("self.n = 3\nwhile self.n > 0:\n    self.n = self.n - 1\n    self.wait(self.n * S)", []),
        (f"self.n = 3\nwhile {HOT}:\n    self.n = self.n + 1\nself.wait((0 - self.n) * S)", ["out_of_range"]),
        (f"self.n = 0\nif {HOT}:\n    self.n = 5\nself.notify(f'{{1 / self.n}}')", ["may_divide_by_zero"]),
        (f"self.n = 0\nif {HOT}:\n    self.n = 5\nif self.n != 0:\n    self.notify(f'{{1 / self.n}}')", []),
        (
            "self.n = self.ask('?', type='number', minimum=1, maximum=9)\nself.notify(f'{1 / (self.n - 1)}')",
            ["may_divide_by_zero"],
        ),
        (
            "self.n = self.ask('?', type='number', minimum=-1, maximum=1)\n"
            "if self.n != 0:\n    self.notify(f'{1 / self.n}')",
            [],
        ),
        ("self.n = self.ask('?', type='number')\nif self.n > 1:\n    self.notify(f'{1 / (self.n - 1)}')", []),
        ("self.done = True\nif self.done:\n    self.notify('x')\nelse:\n    self.wait(0 - 5)", ["out_of_range"]),
        ("self.mode = 'slow'\nif self.mode == 'fast':\n    self.n = 1\nself.notify(f'{self.n}')", ["unset_variable"]),
        ("self.mode = 'fast'\nif self.mode == 'fast':\n    self.n = 1\nself.notify(f'{self.n}')", []),
        ("self.n = self.ask('How many?', type='number')\nif self.n > 0:\n    self.wait(self.n * S)", []),
        ("self.n = self.ask('?', type='number')\nif self.n < -1:\n    self.wait(self.n * S)", ["out_of_range"]),
        ("self.n = self.ask('?', type='number', minimum=0, maximum=9)\nself.wait(self.n * S)", []),
        ("self.n = self.ask('?', type='number', maximum=-1)\nself.wait(self.n * S)", ["out_of_range"]),
    ],
)
def test_variables_are_followed_to_where_they_are_read(body: str, codes: list[str]) -> None:
    assert told(body) == codes


@pytest.mark.parametrize(
    ("body", "codes"),
    [
        ("self.fetch(n=2)\nBOOTH\n" + f"{DROP}\n{DROP}", []),
        ("self.fetch(n=3)", ["carrying_too_much"]),
        ("self.fetch(n=1)", ["ends_carrying"]),
        ("self.fetch(n=1)\nBOOTH\n" + DROP + "\nself.fetch(n=2)\nBOOTH\n" + f"{DROP}\n{DROP}", []),
        (f"self.fetch(n=1)\nself.end()\nBOOTH\n{DROP}", ["ends_carrying", "never_reached"]),
        (f"self.n = 2\nself.fetch(n=self.n)\nBOOTH\nfor _ in range(self.n):\n    {DROP}", []),
    ],
)
def test_loads_are_followed_through_functions_with_their_arguments(body: str, codes: list[str]) -> None:
    assert told(body, FETCH) == codes


def test_recursion_that_ends_is_followed_and_one_that_does_not_is_told() -> None:
    assert told("self.step(n=5)", STEP) == []
    assert told("self.step(n=500)", STEP) == []
    assert told("self.step(n=5)", STEP.replace("n > 0", "n < 9").replace("n - 1", "n")) == ["calls_itself"]


def test_what_other_branches_set_is_not_known() -> None:
    branches = "def branch_2a(self):\n    self.wait(until=self.go)\n\ndef branch_2b(self):\n    self.go = True"
    assert told("self.go = False\nself.parallel(self.branch_2a, self.branch_2b)", branches) == []
    alone = branches.replace("self.go = True", "self.wait(1)")
    assert told("self.go = False\nself.parallel(self.branch_2a, self.branch_2b)", alone) == ["waits_for_ever"]


def test_an_edit_is_told_as_the_whole_program_is() -> None:
    program = EditedProgram()
    for n in (1, 2, 1, 0, 3, 3):
        loop = f"while {HOT}:\n    SHELF\n    {PICK}\n    BOOTH\n    {DROP}"
        document = drawn(
            f"{loop}\nself.x = {n}\nfor _ in range(self.x):\n    SHELF\n    {PICK}\nself.wait((self.x - 2) * S)"
        )
        assert program.compile(document, site()).diagnostics == compile_document(document, site()).diagnostics


@pytest.mark.parametrize(
    ("body", "functions", "codes"),
    [
        (
            "while True:\n    try:\n        FAIL\n    except TaskError as problem:\n        self.wait(1)",
            "",
            ["never_ends"],
        ),
        (
            "while True:\n    try:\n        FAIL\n    except Failed as problem:\n        self.wait(1)",
            "",
            ["never_ends"],
        ),
        ("while True:\n    try:\n        FAIL\n    except Blocked as problem:\n        self.wait(1)", "", []),
        ("while True:\n    try:\n        self.wait(1)\n    finally:\n        FAIL", "", []),
        ("while True:\n    try:\n        self.wait(1)\n    except TaskError as problem:\n        FAIL", "", []),
        (
            "while True:\n    try:\n        self.try_it()\n    except TaskError as problem:\n        self.wait(1)",
            "def try_it(self):\n    FAIL",
            ["never_ends"],
        ),
        ("while True:\n    self.try_it()", "def try_it(self):\n    FAIL", []),
    ],
)
def test_a_failure_that_is_caught_within_a_loop_does_not_end_it(body: str, functions: str, codes: list[str]) -> None:
    fail = 'raise Failed("The oven is cold.")'
    assert told(body.replace("FAIL", fail), functions.replace("FAIL", fail)) == codes


@pytest.mark.parametrize(
    ("body", "codes"),
    [
        (f"SHELF\n{PICK}\n{PICK}\nwhile {HOT}:\n    SHELF\n    {PICK}\n    BOOTH\n    {DROP}", ["carrying_too_much"]),
        (f"SHELF\n{PICK}\nwhile {HOT}:\n    SHELF\n    {PICK}\n    BOOTH\n    {DROP}\nBOOTH\n{DROP}", []),
        (f"self.n = 0\nwhile {HOT}:\n    self.notify(f'{{1 / self.n}}')\n    self.n = self.n + 1", ["divided_by_zero"]),
        (f"self.n = 1\nwhile {HOT}:\n    self.notify(f'{{1 / self.n}}')\n    self.n = self.n + 1", []),
    ],
)
def test_the_first_round_of_a_loop_is_told_of_by_what_is_known_before_it(body: str, codes: list[str]) -> None:
    assert told(body) == codes


ASKED = "self.n = self.ask('How many?', type='number', minimum=1, maximum=2)\n"
SOME = 'self.robot.pick({"value": self.n, "object": "box"})'
SAME = 'self.robot.drop({"value": self.n, "object": "box"})'


@pytest.mark.parametrize(
    ("body", "functions", "codes"),
    [
        (f"{ASKED}SHELF\n{SOME}\nBOOTH\n{SAME}", "", []),
        (f"{ASKED}while {HOT}:\n    SHELF\n    {SOME}\n    BOOTH\n    {SAME}", "", []),
        (f"{ASKED}SHELF\n{SOME}\n{ASKED}BOOTH\n{SAME}", "", ["may_drop_nothing"]),
        (f"{ASKED}SHELF\n{SOME}\nif {HOT}:\n    self.n = 2\nBOOTH\n{SAME}", "", ["may_drop_nothing"]),
        (f"{ASKED}SHELF\n{SOME}\nself.more()\nBOOTH\n{SAME}", "def more(self):\n    self.n = 2", ["may_drop_nothing"]),
        (f"{ASKED}SHELF\n{SOME}\nself.rest()\nBOOTH\n{SAME}", "def rest(self):\n    self.wait(60)", []),
        (
            f"{ASKED}SHELF\n{SOME}\nself.parallel(self.branch_4a, self.branch_4b)\nBOOTH\n{SAME}",
            "def branch_4a(self):\n    self.n = 2\n\ndef branch_4b(self):\n    self.wait(1)",
            ["may_drop_nothing"],
        ),
        (
            f"{ASKED}SHELF\n{SOME}\nself.leave(n=1)\nBOOTH\n{DROP}",
            'def leave(self, n: Number):\n    BOOTH\n    self.robot.drop({"value": n, "object": "box"})',
            ["may_drop_nothing"],
        ),
    ],
)
def test_who_drops_by_the_value_that_was_picked_drops_all_while_nothing_sets_it(
    body: str, functions: str, codes: list[str]
) -> None:
    functions = functions.replace("BOOTH", "self.robot.move(self.booth.location)")
    assert told(body, functions) == codes

"""What a robot carries through loops: counted rounds are followed one by one, others as often as nobody knows."""

from __future__ import annotations

from typing import Any

import pytest

from editor.language import compile_document
from tests.kit.demo_site import factory

BOX = {"role": "robot", "object": "box", "quantity": 1}
PICK = ("pick", {**BOX, "at": {"device": "itemInventory01"}})
DROP = ("drop", {**BOX, "at": {"device": "paintMachine01"}})
TWICE, THRICE = ("repeat", {"times": 2}), ("repeat", {"times": 3})
EACH = ("for_each", {"variable": "colour", "items": ["teal", "red", "blue"]})
HOT = {"op": ">", "args": [{"property": ["curingOven01", "temperature"]}, 60]}
NEXT_ROUND, TRY_TO = ("continue", {}), ("try", {"catch": False})
WHILE_HOT, IF_HOT = ("while", {"condition": HOT}), ("if", {"condition": HOT})
Step = tuple[str, dict[str, Any]]


def told(*steps: Step | list[Any]) -> list[str]:
    """Return what is said of loads in a program; a list is a loop with what stands in it."""
    found: dict[str, Any] = {}

    def add(step: Step | list[Any], parent: str, branch: str, order: str) -> None:
        (kind, params), *inner = step if isinstance(step, list) else [step]
        name = f"s{len(found)}"
        found[name] = {"kind": kind, "place": [parent, branch, order], "params": params}
        for number, each in enumerate(inner):
            add(each, name, "then" if kind == "if" else "body", f"{number}V")

    for number, step in enumerate(steps):
        add(step, "program", "body", f"{number}V")
    diagnostics = compile_document({"format": 2, "steps": found}, factory()).diagnostics
    told_of = ("carrying_too_much", "may_carry_too_much", "drops_nothing", "may_drop_nothing")
    return [each.code for each in diagnostics if each.code in told_of]


@pytest.mark.parametrize(
    ("program", "codes"),
    [
        ([[TWICE, PICK]], []),
        ([[THRICE, PICK]], ["carrying_too_much"]),
        ([[EACH, PICK]], ["carrying_too_much"]),
        ([[WHILE_HOT, PICK]], ["may_carry_too_much"]),
        ([[WHILE_HOT, PICK, DROP]], []),
        ([[THRICE, PICK, DROP]], []),
        ([PICK, PICK, [TWICE, DROP]], []),
        ([PICK, PICK, [THRICE, DROP]], ["drops_nothing"]),
        ([[TWICE, PICK], [TWICE, DROP]], []),
        ([[TWICE, [TWICE, PICK]]], ["carrying_too_much"]),
        ([[WHILE_HOT, [TWICE, PICK], [TWICE, DROP]]], []),
        ([[WHILE_HOT, [THRICE, PICK, [IF_HOT, ("break", {})], DROP]]], ["may_carry_too_much"]),
        ([PICK, [WHILE_HOT, DROP]], ["may_drop_nothing"]),
        ([[THRICE, PICK, [IF_HOT, NEXT_ROUND], DROP]], ["may_carry_too_much"]),
        ([[TWICE, PICK, [IF_HOT, NEXT_ROUND], DROP]], []),
        ([[WHILE_HOT, [IF_HOT, NEXT_ROUND], PICK, DROP]], []),
        ([[THRICE, PICK, [TRY_TO, NEXT_ROUND]]], ["carrying_too_much"]),
        ([[TWICE, PICK, NEXT_ROUND, DROP], DROP, DROP], []),
    ],
)
def test_loads_are_followed_through_loops(program: list[Any], codes: list[str]) -> None:
    assert told(*program) == codes


def test_rounds_that_change_nothing_are_not_gone_through_a_million_times() -> None:
    deep: Any = PICK
    for _ in range(6):
        deep = [("repeat", {"times": 100}), deep, DROP]
    assert told(deep) == ["drops_nothing"] * 5

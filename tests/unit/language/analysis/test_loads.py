"""What robots carry: how many at least and at most, where that is known, and what is told of it."""

from __future__ import annotations

import pytest

from editor.language.compiler import compile_document
from tests.kit.demo_site import factory
from tests.unit.language.checks.test_told_before import HOT, document_of, program, told

SHELF, CANS, BOOTH = (f"self.robot.move(self.{name}.location)" for name in ("shelf", "cans", "booth"))


def asked(name: str, least: int, most: int | None) -> str:
    end = "" if most is None else f", maximum={most}"
    return f"self.{name} = self.ask('How many?', type='number', minimum={least}{end})"


def pick(quantity: object, thing: str = "box") -> str:
    return f"self.robot.pick({{'value': {quantity}, 'object': '{thing}'}})"


def drop(quantity: object, thing: str = "box") -> str:
    return f"self.robot.drop({{'value': {quantity}, 'object': '{thing}'}})"


def told_of(*lines: str) -> list[str]:
    """Return the codes of what is told of the robot's picks and drops."""
    return [code for code in told("\n".join(lines)) if "range" not in code and "not_taken" not in code]


def test_as_many_as_another_number_says_need_not_be_as_many() -> None:
    first, second = asked("n", 1, 2), asked("m", 1, 2)
    assert told_of(first, SHELF, pick("self.n"), BOOTH, drop("self.n")) == []
    assert told_of(first, second, SHELF, pick("self.n"), BOOTH, drop("self.m")) == ["may_drop_nothing"]


@pytest.mark.parametrize(("least", "most"), [(0, 2), (1, None)])
def test_after_a_pick_that_may_be_of_none_or_of_any_number_nothing_is_said_of_drops(
    least: int, most: int | None
) -> None:
    assert told_of(asked("n", least, most), SHELF, pick("self.n"), BOOTH, drop(1)) == []


def test_a_loop_that_drops_what_it_picks_leaves_as_many_as_there_were() -> None:
    perhaps_one = f"if {HOT}:\n    {pick(1)}"
    loop = f"while {HOT}:\n    {pick(1)}\n    {drop(1)}\n    self.wait(60)"
    assert told_of(SHELF, perhaps_one, loop, BOOTH, drop(2)) == ["drops_nothing"]
    assert told_of(SHELF, perhaps_one, loop, BOOTH, drop(1)) == ["may_drop_nothing"]


def test_a_pick_that_may_be_too_much_is_followed_by_what_fits() -> None:
    several = asked("n", 1, 3), SHELF, pick("self.n"), BOOTH
    assert told_of(*several, drop(1)) == ["may_carry_too_much"]
    assert told_of(*several, drop(2)) == ["may_carry_too_much", "may_drop_nothing"]


def test_what_is_carried_already_is_named_without_what_may_not_be_there() -> None:
    lines = CANS, f"if {HOT}:\n    {pick(1, 'can')}", SHELF, pick(2), pick(1)
    found = compile_document(document_of(program("\n".join(lines))), factory()).diagnostics
    assert [(each.code, each.args.get("carried")) for each in found] == [
        ("may_carry_too_much", None),
        ("carrying_too_much", "2 box"),
    ]


@pytest.mark.parametrize(
    ("lines", "codes"),
    [
        ((SHELF, pick("1 + 0.5")), ["quantity_not_positive"]),
        (("self.n = 1.5", SHELF, pick("self.n")), ["quantity_not_positive"]),
        (("self.n = 3", SHELF, pick("self.n / 2")), ["quantity_not_positive"]),
        (("self.n = 4", SHELF, pick("self.n / 2"), BOOTH, drop("self.n / 2")), []),
        (("for _ in range(1 + 0.5):\n    self.wait(60)",), ["times_not_whole"]),
        (("self.n = 0.5", "for _ in range(self.n):\n    self.wait(60)"), ["times_not_whole"]),
        (("self.n = 0", "for _ in range(self.n - 1):\n    self.wait(60)"), ["times_not_whole"]),
        ((asked("n", 0, 2), "for _ in range(self.n - 1):\n    self.wait(60)"), []),
        (("self.n = 0", "for _ in range(self.n):\n    self.wait(60)"), []),
    ],
)
def test_a_number_that_is_no_whole_one_is_told_however_it_is_come_by(lines: tuple[str, ...], codes: list[str]) -> None:
    assert told_of(*lines) == codes

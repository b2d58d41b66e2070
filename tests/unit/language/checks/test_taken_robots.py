"""Where a robot is can be asked when it is known which robot it is: one that is bound from the start, others later."""

from __future__ import annotations

import pytest

from tests.unit.language.checks.test_told_before import HOT, told

ASK = "self.notify(f'{distance(self.robot, self.oven)}')"
GO = "self.robot.move(self.dock.location)"
NEAR = "self.wait(until=distance(self.robot, self.oven) < 3)"
BRANCHES = f"def branch_1a(self):\n    {GO}\ndef branch_1b(self):\n    "
AT_ONCE = "self.parallel(self.branch_1a, self.branch_1b)"


@pytest.mark.parametrize(
    ("parts", "codes"),
    [
        ((f"{ASK}\n{GO}",), ["no_robot_yet"]),
        ((f"{GO}\n{ASK}",), []),
        ((f"{NEAR}\n{GO}",), ["no_robot_yet"]),
        ((f"while distance(self.robot, self.oven) > 3:\n    {GO}",), ["no_robot_yet"]),
        ((f"if {HOT}:\n    {GO}\n{ASK}",), ["perhaps_no_robot_yet"]),
        ((f"if {HOT}:\n    {GO}\nelse:\n    self.robot.honk(2)\n{ASK}",), []),
        ((f"if {HOT}:\n    {GO}\n    {ASK}",), []),
        ((f"for _ in range(3):\n    {GO}\n    {ASK}",), []),
        ((f"for _ in range(3):\n    {ASK}\n    {GO}",), ["no_robot_yet"]),
        ((f"while {HOT}:\n    {GO}\n    {ASK}",), []),
        ((f"self.go()\n{ASK}", f"def go(self):\n    {GO}"), []),
        ((f"self.ask_it()\n{GO}", f"def ask_it(self):\n    {ASK}"), ["no_robot_yet"]),
        ((f"try:\n    {GO}\nexcept Failed as problem:\n    self.notify('x')\n{ASK}",), ["perhaps_no_robot_yet"]),
        ((f"{AT_ONCE}\n{ASK}", f"{BRANCHES}self.wait(3)"), []),
        ((AT_ONCE, f"{BRANCHES}{NEAR}"), []),
        ((AT_ONCE, f"{BRANCHES}{ASK}"), ["perhaps_no_robot_yet"]),
    ],
)
def test_where_a_robot_is_can_be_asked_once_it_is_taken(parts: tuple[str, ...], codes: list[str]) -> None:
    assert told(*parts) == codes


@pytest.mark.parametrize("body", [f"{ASK}\n{GO}", f"if {HOT}:\n    {GO}\n{ASK}", f"{NEAR}\n{GO}"])
def test_where_a_robot_is_that_is_bound_can_be_asked_from_the_start(body: str) -> None:
    assert told(body, robot='ctx.get("robot01")') == []

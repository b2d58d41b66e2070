"""Which answers to commands are remembered: the same cases for simulated devices, robots and boards."""

from __future__ import annotations

import json
import runpy
from collections.abc import Callable
from typing import Any

import pytest

from tests.kit.files import ROOT
from tests.unit.robot_agent.agent import Ack, Answers
from vipo_device.kit.answers import REMEMBERED, AnswerLedger
from vipo_device.protocol.messages import AckMessage, AckStatus, is_final

CASES = json.loads((ROOT / "tests" / "cases" / "answers.json").read_text())
BOARD: dict[str, Any] = runpy.run_path(str(ROOT / "firmware" / "lib" / "vipo" / "commands.py"))
Story = list[tuple[str, AckStatus]]


def answered_by_the_kit(story: Story) -> Callable[[str], str | None]:
    ledger = AnswerLedger()
    for command, status in story:
        ledger.note(AckMessage(command, status))
    return lambda command: found.status if (found := ledger.find(command)) else None


def answered_by_a_robot(story: Story) -> Callable[[str], str | None]:
    answers = Answers()
    for command, status in story:
        answers.note(Ack(command, status))
    return lambda command: found.status if (found := answers.find(command)) else None


def answered_by_a_board(story: Story) -> Callable[[str], str | None]:
    answers, running = BOARD["Answers"]([]), ""
    for command, status in story:
        running = command if not is_final(status) else "" if command == running else running
        answers.remember(command, BOARD["make_answer"](command, status), running)
    return lambda command: json.loads(found)["st"] if (found := answers.find(command)) else None


@pytest.mark.parametrize("answered", [answered_by_the_kit, answered_by_a_robot, answered_by_a_board])
@pytest.mark.parametrize("case", CASES, ids=lambda case: case["what"])
def test_devices_remember_the_same_answers(case: dict[str, Any], answered: Callable[[Story], Any]) -> None:
    find = answered(case["answers"])
    assert {command: find(command) for command in case["known"]} == case["known"]


def test_what_is_open_and_what_is_over_can_be_kept_and_taken_up_again() -> None:
    ledger = AnswerLedger()
    for number in range(REMEMBERED + 2):
        ledger.note(AckMessage(f"c{number}", "DONE"))
    ledger.note(AckMessage("last", "RUNNING"))
    assert [ack.command for ack in ledger.over()] == [f"c{number}" for number in range(2, REMEMBERED + 2)]
    again = AnswerLedger(ledger.over(), ledger.under_way())
    assert (again.find("c2"), again.find("c1")) == (AckMessage("c2", "DONE"), None)
    assert (again.is_under_way("last"), again.is_over("last"), again.is_over("c2")) == (True, False, True)

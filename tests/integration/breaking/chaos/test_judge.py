"""The judge of a game sees what is lost, doubled, out of order, in the wrong place and at the same time."""

from __future__ import annotations

from typing import Any

import pytest

from tests.integration.breaking.chaos.hall import STEPS_MOST, Game
from tests.integration.breaking.chaos.judge import count_once, find_faults, longest_silences

GAME = Game(runs=2, sites=1, commands=3, seed=1)
FINISHED = {0: "finished", 1: "finished"}


def whole_log() -> list[dict[str, Any]]:
    lines = [
        {"device": device, "id": f"c{value}", "value": value, "is": word}
        for run in range(GAME.runs)
        for device, value in GAME.steps_of(run)
        for word in ("begin", "end")
    ]
    return [{**line, "at": float(number)} for number, line in enumerate(lines)]


def test_a_whole_log_has_no_faults() -> None:
    assert find_faults(GAME, whole_log(), FINISHED) == []
    assert count_once(GAME, whole_log()) == 6


def test_a_command_that_is_lost_or_cut_off_is_named() -> None:
    device = GAME.steps_of(1)[2][0]
    log = whole_log()[:-2]
    assert find_faults(GAME, log, FINISHED) == [
        f"step 2 of run 1 on {device}: 0 times begin, commands []",
        f"step 2 of run 1 on {device}: 0 times end, commands []",
    ]
    assert find_faults(GAME, whole_log()[:-1], FINISHED) == [
        f"step 2 of run 1 on {device}: 0 times end, commands ['c{STEPS_MOST + 2}']"
    ]
    assert count_once(GAME, whole_log()[:-1]) == 5


def test_a_command_that_is_done_twice_is_named_with_both_ids() -> None:
    log = whole_log()
    again = [{**line, "id": "other"} for line in log[:2]]
    found = find_faults(GAME, [*log[:2], *again, *log[2:]], FINISHED)
    device = GAME.steps_of(0)[0][0]
    assert found == [
        f"step 0 of run 0 on {device}: 2 times {word}, commands ['c0', 'other']" for word in ("begin", "end")
    ]


def test_steps_in_another_order_are_named() -> None:
    log = whole_log()
    found = find_faults(GAME, [*log[2:4], *log[:2], *log[4:]], FINISHED)
    order = [(1, "begin"), (1, "end"), (0, "begin"), (0, "end"), (2, "begin"), (2, "end")]
    assert found == [f"run 0 was done in the order {order}"]


def test_two_commands_at_the_same_time_on_one_device_are_named() -> None:
    log = [{**line, "device": "hall1.oven1"} for line in whole_log()]
    found = find_faults(GAME, [log[0], log[6], log[1], *log[2:6], *log[7:]], FINISHED)
    assert "hall1.oven1 began step 0 of run 1 in the midst of step 0 of run 0" in found


def test_work_of_another_device_or_that_nobody_asked_for_is_named() -> None:
    log = whole_log()
    wrong = [{**line, "device": "hall1.oven9"} for line in log[:2]]
    assert find_faults(GAME, [*wrong, *log[2:]], FINISHED) == ["step 0 of run 0 was done by hall1.oven9"] * 2
    more = {"at": 99.0, "device": "hall1.oven1", "id": "x", "value": 7 * STEPS_MOST, "is": "begin"}
    assert find_faults(GAME, [*log, more], FINISHED) == ["step 0 of run 7 was never asked for"]


@pytest.mark.parametrize("status", ["running", "failed: away", "there twice: finished, running"])
def test_a_run_that_is_stuck_failed_or_there_twice_is_named(status: str) -> None:
    assert find_faults(GAME, whole_log(), {0: "finished", 1: status}) == [f"run 1 is {status}"]
    assert find_faults(GAME, whole_log(), {0: "finished"}) == ["run 1 is not there"]


def test_a_silence_counts_only_while_there_is_work() -> None:
    faults = [
        {"kind": "kill worker", "at": 0.5, "until": 4.5, "runs": 2},
        {"kind": "flush redis", "at": 4.5, "until": 40.0, "runs": 2},
    ]
    assert longest_silences(GAME, whole_log(), faults) == {"kill worker": 1.0, "flush redis": 1.0}
    held = [{**line, "at": line["at"] + (20.0 if line["at"] > 6 else 0.0)} for line in whole_log()]
    assert longest_silences(GAME, held, faults) == {"kill worker": 1.0, "flush redis": 21.0}
    stuck = [{"kind": "kill worker", "at": 0.5, "until": 9.0, "runs": 2}]
    assert longest_silences(GAME, whole_log()[:3], stuck) == {"kill worker": 7.0}

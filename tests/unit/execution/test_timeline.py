"""A run's journal as bars, which the screen goes on with, and of which there are never too many."""

from __future__ import annotations

import gc
import json
import random
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import pytest

from execution.runs.timeline import Bar, TimelineLine, read_timeline, robots_of
from tests.kit.files import ROOT

CASES: list[dict[str, Any]] = json.loads((ROOT / "tests" / "cases" / "timelines.json").read_text())
ROBOTS = {"go": "robot01", "fetch": "robot01", "sweep": "robot01"}


@pytest.mark.parametrize("case", CASES, ids=[case["name"] for case in CASES])
def test_a_journal_is_read_as_the_screen_reads_it(case: dict[str, Any]) -> None:
    bars = read_timeline([TimelineLine(*line) for line in case["lines"]], ROBOTS).bars
    assert [[bar.device, bar.step, bar.kind, bar.started_s, bar.ended_s, bar.failed] for bar in bars] == case["bars"]


def test_what_is_under_way_is_told_so_that_others_can_go_on() -> None:
    entered = [TimelineLine(0, "step", "step_entered", step, "", "") for step in ("all", "go")]
    way = TimelineLine(1, "way", "way", "", "robot01", "robot01")
    commands = [TimelineLine(2, "command", "command", "cure", "oven", "")] * 2
    read = read_timeline([*entered, way, *commands], ROBOTS)
    assert (read.steps, read.drives) == (("all", "go"), {"robot01": "go"})
    assert [(bar.device, bar.pending) for bar in read.bars] == [("robot01", 1), ("oven", 2)]


def test_a_step_belongs_to_the_robot_of_its_role() -> None:
    steps = {
        "go": {"kind": "move", "params": {"role": "carrier"}},
        "pick": {"kind": "pick"},
        "odd": {"kind": "move", "params": {"role": 7}},
        "wave": {"kind": "operate", "params": {"device": {"role": "carrier"}}},
        "mix": {"kind": "operate", "params": {"device": {"device": "mixer"}}},
        "named": {"kind": "operate", "params": {"device": "mixer"}},
        "wait": {"kind": "wait"},
        "new": {"kind": "not known here"},
    }
    roles = {"robot": "robot01", "carrier": "robot02"}
    assert robots_of({"steps": steps}, roles) == {"go": "robot02", "pick": "robot01", "wave": "robot02"}
    assert robots_of({}, roles) == {}


def work(device: str, step: str, at_s: float, took_s: float, status: str = "DONE") -> list[TimelineLine]:
    return [
        TimelineLine(at_s, "command", "command", step, device, ""),
        TimelineLine(at_s + took_s, "answer", "answer", step, device, "", status),
    ]


def test_bars_that_are_too_many_are_joined_where_they_lie_close_together() -> None:
    lines = [*work("oven", "long", 0, 400)]
    for turn in range(100):
        lines += work("oven", f"s{turn % 2}", 500 + turn * 5, 1, "FAILED" if turn == 41 else "DONE")
    lines += work("oven", "end", 1500, 500)
    exact = read_timeline(lines, {}, most=102).bars
    assert (len(exact), {bar.count for bar in exact}) == (102, {1})
    bars = read_timeline(lines, {}, most=30).bars
    assert len(bars) <= 30
    assert (bars[0], bars[-1]) == (exact[0], exact[-1])
    assert sum(bar.count for bar in bars) == 102
    assert [bar.step for bar in bars if bar.failed] == ["s1"]
    assert all(bar.ended_s is not None and bar.ended_s - bar.started_s <= 64 for bar in bars[1:-1])
    assert all(first.started_s < second.started_s for first, second in pairwise(bars))


def test_of_however_many_bars_there_are_so_many_as_a_screen_shows_and_each_moment_of_work_is_in_one() -> None:
    chance = random.Random(7)
    lines: list[TimelineLine] = []
    for at_s in range(20_000):
        device = f"d{chance.randrange(10)}"
        lines += work(device, f"s{chance.randrange(40)}", at_s, chance.random())
    lines.append(TimelineLine(20_000, "command", "command", "s1", "d1", ""))
    read = read_timeline(lines, {}).bars
    assert 500 < len(read) <= 2000
    assert (read[-1].ended_s, read[-1].count) == (None, 1)
    assert all(_is_in_one(line, read) for line in lines[::501])


@pytest.mark.parametrize("end_s", [5, 0])
def test_there_are_never_too_many_bars_also_where_a_clock_was_put_back(end_s: float) -> None:
    lines = [line for at_s in range(300) for line in work("oven", f"s{at_s % 3}", at_s * 10, 1)]
    assert len(read_timeline([*lines, *work("mixer", "late", end_s, 0)], {}, most=100).bars) <= 100
    at_once = [line for number in range(9) for line in work("oven", f"s{number}", 0, 0)]
    assert len(read_timeline(at_once, {}, most=4).bars) <= 4
    begun = [TimelineLine(0, "command", "command", f"s{number}", "oven", "") for number in range(9)]
    assert len(read_timeline(begun, {}, most=4).bars) == 9, "what goes on is joined with nothing"


def test_however_long_a_journal_is_not_more_bars_are_kept_while_it_is_read_than_four_times_those_that_are_shown() -> (
    None
):
    most, seen, total = 50, 0, 20_000

    def lines() -> Iterator[TimelineLine]:
        nonlocal seen
        yield TimelineLine(0, "command", "command", "long", "mixer", "")
        for number in range(total):
            if number % 500 == 0:
                seen = max(seen, sum(isinstance(each, Bar) for each in gc.get_objects()))
            yield from work(f"d{number % 3}", f"s{number % 7}", number * 2, 1, "FAILED" if number == 777 else "DONE")
        yield TimelineLine(total * 2, "answer", "answer", "long", "mixer", "", "DONE")

    bars = read_timeline(lines(), {}, most=most).bars
    assert (len(bars) <= most, sum(bar.count for bar in bars), seen <= 4 * most + 10) == (True, total + 1, True)
    assert [(bar.started_s, bar.ended_s, bar.count) for bar in bars if bar.device == "mixer"] == [(0, total * 2, 1)]
    assert [bar.step for bar in bars if bar.failed] == ["s0"]
    assert all(_is_in_one(line, bars) for line in [*work("d0", "s0", 0, 1), *work("d1", "s0", total * 2 - 2, 1)])


def _is_in_one(line: TimelineLine, bars: tuple[Bar, ...]) -> bool:
    mine = [bar for bar in bars if bar.device == line.device]
    return any(bar.started_s <= line.t_s and (bar.ended_s is None or line.t_s <= bar.ended_s) for bar in mine)

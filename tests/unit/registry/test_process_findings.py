"""What is said of processes by their heartbeats alone."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from typing import Any

from registry.processes.findings import find_trouble
from registry.processes.heartbeats import ProcessView

NOW = datetime(2026, 11, 23, 12, tzinfo=UTC)
DAY_S = 86_400.0


def process(kind: str, name: str = "", *, seen_s: float = 1, since_s: float = DAY_S, **more: Any) -> ProcessView:
    """Return a process that beat `seen_s` seconds ago for the last time, and for the first `since_s` seconds ago."""
    seen, since = (NOW - timedelta(seconds=each) for each in (seen_s, since_s))
    told = {"machine": "m1", "process": 7, "version": "0.1.0", "activity": "", **more}
    return ProcessView(kind, kind, name or f"{kind}-m1", since=since, at=seen, now=NOW, **told)


ALL = (process("gateway"), process("worker"), process("ticker"), process("web"))


def found(*processes: ProcessView) -> list[tuple[str, str]]:
    return [(finding.code, finding.severity) for finding in find_trouble(processes=processes)]


def test_where_one_of_each_beats_nothing_is_wrong():
    assert found(*ALL) == []


def test_a_silent_one_beside_another_of_its_kind_is_a_warning_that_names_it():
    silent = process("gateway", "gateway-m2", seen_s=11)
    assert found(*ALL, silent) == [("process_silent", "warning")]
    assert find_trouble(processes=[*ALL, silent])[0].text == "A process has fallen silent: gateway gateway-m2."


def test_the_only_one_that_falls_silent_is_an_error_at_once_and_not_before_ten_seconds():
    assert found(*ALL[1:], process("gateway", seen_s=9.9)) == []
    assert found(*ALL[1:], process("gateway", seen_s=11)) == [("no_gateway", "error"), ("process_silent", "warning")]


def test_who_says_goodbye_is_missed_only_when_nobody_has_come_for_a_minute():
    def ended(seconds: float) -> ProcessView:
        return process("ticker", seen_s=seconds, ended_at=NOW - timedelta(seconds=seconds))

    assert found(*ALL, ended(300)) == []
    others = [each for each in ALL if each.kind != "ticker"]
    assert found(*others, ended(59)) == []
    assert found(*others, ended(61)) == [("no_ticker", "error")]


def test_what_never_came_is_missed_a_minute_after_the_first_process():
    assert found(process("web", since_s=59)) == []
    assert found(process("web", since_s=61)) == [
        ("no_gateway", "error"),
        ("no_worker", "error"),
        ("no_ticker", "error"),
    ]


def test_clocks_that_are_more_than_two_seconds_apart_are_an_error_either_way():
    for apart_s in (2.1, -60.0):
        odd = process("worker", "worker-m2", clock_apart_s=apart_s)
        assert found(*ALL, odd) == [("clock_apart", "error")]
    assert found(*ALL, process("worker", clock_apart_s=-1.9)) == []
    assert found(*ALL, process("worker", seen_s=20, clock_apart_s=60.0)) == [("process_silent", "warning")]


def test_who_was_killed_and_has_begun_again_under_its_name_is_not_missed():
    killed = process("worker", seen_s=20)
    assert found(*ALL, killed) == [("process_silent", "warning")]
    again = process("worker", since_s=18)
    assert found(*ALL, killed, again) == []
    assert found(*ALL, killed, process("worker", since_s=18, seen_s=12)) == [("process_silent", "warning")]
    assert found(*ALL, killed, process("worker", "worker-m2", since_s=18)) == [("process_silent", "warning")]

"""The outcome of tests as JUnit XML, which build servers read."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from xml.sax.saxutils import escape, quoteattr

from execution.trials.odds import Odds
from execution.trials.trial_run import Outcome

_NO_XML = re.compile(r"[^\t\n\r\x20-\uD7FF\uE000-\uFFFD\U00010000-\U0010FFFF]")


def junit_xml(files: Sequence[tuple[str, Sequence[Outcome]]], odds: Mapping[tuple[str, str], Odds]) -> str:
    """Return one suite for each file; times are those of the simulation.

    `odds` are those of tests by file and name, where they were tried with many seeds: one that failed fails the test.
    """
    suites = "".join(_suite(name, outcomes, odds) for name, outcomes in files)
    return f'<?xml version="1.0" encoding="utf-8"?>\n<testsuites>\n{suites}</testsuites>\n'


def _suite(name: str, outcomes: Sequence[Outcome], odds: Mapping[tuple[str, str], Odds]) -> str:
    seeds = [odds.get((name, outcome.trial.name)) for outcome in outcomes]
    failed = sum(not is_passed(outcome, of_it) for outcome, of_it in zip(outcomes, seeds, strict=True))
    time_s = sum(outcome.duration_s for outcome in outcomes)
    cases = "".join(_case(name, outcome, of_it) for outcome, of_it in zip(outcomes, seeds, strict=True))
    head = f'tests="{len(outcomes)}" failures="{failed}" errors="0" time="{time_s:.2f}"'
    return f" <testsuite name={_attribute(name)} {head}>\n{cases} </testsuite>\n"


def is_passed(outcome: Outcome, odds: Odds | None) -> bool:
    """Tell whether a test passes, also with each seed that it was tried with."""
    return outcome.ok and not (odds and odds.failed)


def _case(file: str, outcome: Outcome, odds: Odds | None) -> str:
    head = f"  <testcase classname={_attribute(file)} name={_attribute(outcome.trial.name)} "
    head += f'time="{outcome.duration_s:.2f}"'
    failed = [verdict for verdict in outcome.verdicts if not verdict.ok]
    if is_passed(outcome, odds):
        return f"{head}/>\n"
    lines = [f"line {v.line}: expected: {v.expected}; seen: {v.saw}" for v in failed]
    if odds and odds.failed:
        lines.append(f"with {odds.failed} of {odds.seeds} seeds it fails, {100 * odds.share:.1f} %")
    message = _attribute(f"expected: {failed[0].expected}; seen: {failed[0].saw}" if failed else lines[0])
    text = escape(_clean("\n".join(lines)))
    return f"{head}>\n   <failure message={message}>{text}</failure>\n  </testcase>\n"


def _attribute(text: str) -> str:
    return quoteattr(_clean(text))


def _clean(text: str) -> str:
    return _NO_XML.sub("\ufffd", text)

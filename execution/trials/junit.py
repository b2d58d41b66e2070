"""The outcome of tests as JUnit XML, which build servers read."""

from __future__ import annotations

import re
from collections.abc import Sequence
from xml.sax.saxutils import escape, quoteattr

from execution.trials.trial_run import Outcome

_NO_XML = re.compile(r"[^\t\n\r\x20-\uD7FF\uE000-\uFFFD\U00010000-\U0010FFFF]")


def junit_xml(files: Sequence[tuple[str, Sequence[Outcome]]]) -> str:
    """Return one suite for each file; times are those of the simulation."""
    suites = "".join(_suite(name, outcomes) for name, outcomes in files)
    return f'<?xml version="1.0" encoding="utf-8"?>\n<testsuites>\n{suites}</testsuites>\n'


def _suite(name: str, outcomes: Sequence[Outcome]) -> str:
    failed = sum(not outcome.ok for outcome in outcomes)
    time_s = sum(outcome.duration_s for outcome in outcomes)
    cases = "".join(_case(name, outcome) for outcome in outcomes)
    head = f'tests="{len(outcomes)}" failures="{failed}" errors="0" time="{time_s:.2f}"'
    return f" <testsuite name={_attribute(name)} {head}>\n{cases} </testsuite>\n"


def _case(file: str, outcome: Outcome) -> str:
    head = f"  <testcase classname={_attribute(file)} name={_attribute(outcome.trial.name)} "
    head += f'time="{outcome.duration_s:.2f}"'
    failed = [verdict for verdict in outcome.verdicts if not verdict.ok]
    if not failed:
        return f"{head}/>\n"
    text = "\n".join(f"line {v.line}: expected: {v.expected}; seen: {v.saw}" for v in failed)
    message = _attribute(f"expected: {failed[0].expected}; seen: {failed[0].saw}")
    return f"{head}>\n   <failure message={message}>{escape(_clean(text))}</failure>\n  </testcase>\n"


def _attribute(text: str) -> str:
    return quoteattr(_clean(text))


def _clean(text: str) -> str:
    return _NO_XML.sub("\ufffd", text)

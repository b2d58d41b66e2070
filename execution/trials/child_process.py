"""`python -m execution.trials.child_process`: tests of a program in a process of their own, without Django.

It speaks as `execution.rehearsals.child_process` does; `steps` of the course are tests. The result has for each test
what `execution.rehearsals.test_results` keeps, and the ways through the program.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any, Final

from editor.language import plan_from_json
from execution.rehearsals.child_process import Teller, begin, main, scene_from_json
from execution.rehearsals.course import Course
from execution.trials.coverage import Coverage
from execution.trials.trial_file import read_trial
from execution.trials.trial_run import Outcome, Subject, run_trial, settle
from execution.trials.yaml_lines import BadTrialFile

MOST_ERRORS: Final = 20
MOST_TEXT: Final = 300
MOST_TAKEN: Final = 2000


@dataclass(slots=True)
class _Follower:
    """Says how far the tests are; `is_over` once the time for all of them is."""

    teller: Teller
    tests: int
    done: int = 0
    is_over: bool = False

    def __call__(self, course: Course) -> float | None:
        wall_s = self.teller(Course(course.virtual_s, course.step, self.done, self.tests, True))
        self.is_over = self.is_over or wall_s is not None
        return wall_s


def run_tests(job: Mapping[str, Any]) -> dict[str, Any]:
    """Carry out the tests of a job one after the other, writing how far they are; returns what came of them."""
    follower = _Follower(begin(job), len(job["tests"]))
    scene, places, zones = scene_from_json(job["scene"])
    plan = plan_from_json(job["plan"])
    subject = Subject(plan, scene, places, job["numbers"], (), zones)
    found = []
    for test in job["tests"]:
        found.append({"test": test["id"], "revision": test["revision"], **_run(test["text"], subject, follower)})
        follower.done += 1
    return {"tests": found, "ways": [asdict(way) for way in Coverage(plan).ways]}


def _run(text: str, subject: Subject, follower: _Follower) -> dict[str, Any]:
    if follower.is_over:
        return _nothing("stopped", 0, "")
    try:
        trial = settle(read_trial(text.encode()), subject)
    except BadTrialFile as error:
        return _nothing("unusable", error.line, error.why)
    outcome = run_trial(trial, subject, follow=follower)
    if follower.is_over:
        return _nothing("stopped", 0, "")
    return _told(outcome)


def _nothing(status: str, line: int, why: str) -> dict[str, Any]:
    detail = {"expectations": [], "errors": [], "line": line, "why": why[:MOST_TEXT]}
    return {"status": status, "seed": 0, "duration_s": 0.0, "detail": detail, "taken": []}


def _told(outcome: Outcome) -> dict[str, Any]:
    verdicts = [asdict(each) for each in outcome.verdicts]
    for each in verdicts:
        each["expected"], each["saw"] = each["expected"][:MOST_TEXT], each["saw"][:MOST_TEXT]
    errors = [text[:MOST_TEXT] for text in outcome.said[:MOST_ERRORS]]
    taken = sorted([step, name] for (step, name), count in outcome.coverage.taken.items() if count)
    return {
        "status": "passed" if outcome.ok else "failed",
        "seed": outcome.trial.seed,
        "duration_s": outcome.duration_s,
        "detail": {"expectations": verdicts, "errors": errors, "line": 0, "why": ""},
        "taken": taken[:MOST_TAKEN],
    }


if __name__ == "__main__":
    sys.exit(main(run_tests))

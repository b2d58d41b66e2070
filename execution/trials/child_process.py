"""`python -m execution.trials.child_process`: tests of a program in a process of their own, without Django.

It speaks as `execution.rehearsals.child_process` does; `steps` of the progress are tests, seeds of them and changes of
the program. The result has for each test what `execution.rehearsals.test_results` keeps, the ways through the program,
and what became of changes where they were asked for.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any, Final

from editor.language import plan_from_json
from execution.rehearsals.child_process import Teller, begin, main, scene_from_json
from execution.rehearsals.progress import Progress
from execution.trials.coverage import Coverage
from execution.trials.many_seeds import ManySeeds
from execution.trials.mutants import Mutant
from execution.trials.mutation import Mutation, choose_mutants, try_mutant
from execution.trials.trial import Trial
from execution.trials.trial_file import read_trial
from execution.trials.trial_run import Outcome, Subject, run_trial, settle
from execution.trials.yaml_lines import BadTrialFile

MOST_ERRORS: Final = 20
MOST_TEXT: Final = 300
MOST_TAKEN: Final = 2000


@dataclass(slots=True)
class _Follower:
    """Says how much of all that is to be rehearsed is done; `is_over` once the time for it is."""

    teller: Teller
    steps: int
    done: int = 0
    is_over: bool = False

    def __call__(self, progress: Progress) -> float | None:
        wall_s = self.teller(Progress(progress.virtual_s, progress.step, self.done, self.steps, True))
        self.is_over = self.is_over or wall_s is not None
        return wall_s


def run_tests(job: Mapping[str, Any]) -> dict[str, Any]:
    """Carry out the tests of a job one after the other, writing how far they are; returns what came of them.

    `seeds` of the job are those that each test is carried out with besides its own; of `changes` of the program so many
    are tried at most, once all tests pass.
    """
    scene, places, zones = scene_from_json(job["scene"])
    plan = plan_from_json(job["plan"])
    subject = Subject(plan, scene, places, job["numbers"], (), zones)
    seeds, most = job.get("seeds", 0), job.get("changes", 0)
    chosen, there_are = choose_mutants(subject, most) if most else ([], 0)
    follower = _Follower(begin(job), len(job["tests"]) * (1 + seeds) + len(chosen))
    found, outcomes = [], []
    for test in job["tests"]:
        told, outcome = _run(test["text"], subject, follower, seeds)
        found.append({"test": test["id"], "revision": test["revision"], **told})
        outcomes += [outcome] if outcome else []
    answer: dict[str, Any] = {"tests": found, "ways": [asdict(path) for path in Coverage(plan).paths]}
    if most:
        all_pass = len(outcomes) == len(found) and all(outcome.ok for outcome in outcomes)
        tried = _try(chosen, subject, outcomes, follower) if all_pass else []
        answer["changes"] = _changes(tried, there_are, "" if all_pass else "failing", follower)
    return answer


def _run(text: str, subject: Subject, follower: _Follower, seeds: int) -> tuple[dict[str, Any], Outcome | None]:
    """Carry out a test; returns what is kept of it, and how it ended if it did."""
    done = follower.done + 1 + seeds
    try:
        if follower.is_over:
            return _nothing("stopped", 0, ""), None
        trial = settle(read_trial(text.encode()), subject)
        outcome = run_trial(trial, subject, follow=follower)
        if follower.is_over:
            return _nothing("stopped", 0, ""), None
        follower.done += 1
        told = _told(outcome)
        told["detail"]["odds"] = _run_seeds(trial, subject, follower, seeds) if seeds else None
    except BadTrialFile as error:
        return _nothing("unusable", error.line, error.why), None
    else:
        return told, outcome
    finally:
        follower.done = done


def _run_seeds(trial: Trial, subject: Subject, follower: _Follower, seeds: int) -> dict[str, Any]:
    """Carry out a test with the seeds from 1 on, as many as there is time for."""
    found = ManySeeds(seeds)
    for seed in range(1, seeds + 1):
        outcome = run_trial(replace(trial, seed=seed), subject, follow=follower)
        if follower.is_over:
            break
        found.take(seed, outcome)
        follower.done += 1
    return found.to_json()


def _try(
    chosen: Sequence[Mutant], subject: Subject, outcomes: Sequence[Outcome], follower: _Follower
) -> list[Mutation]:
    tried = []
    for mutant in chosen:
        mutation = try_mutant(mutant, subject, outcomes, follower)
        if follower.is_over:
            break
        tried.append(mutation)
        follower.done += 1
    return tried


def _changes(tried: Sequence[Mutation], there_are: int, why: str, follower: _Follower) -> dict[str, Any]:
    unnoticed = [
        {"step": m.step, "line": m.line, "code": m.code, "name": m.name, "reached": each.is_reached}
        for each in tried
        if not each.noticed_by
        for m in [each.mutant]
    ]
    noticed = len(tried) - len(unnoticed)
    over = follower.is_over
    return {
        "there_are": there_are, "tried": len(tried), "noticed": noticed, "unnoticed": unnoticed, "why": why,
        "out_of_time": over,
    }  # fmt: skip


def _nothing(status: str, line: int, why: str) -> dict[str, Any]:
    detail = {"expectations": [], "errors": [], "line": line, "why": why[:MOST_TEXT], "odds": None}
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

"""Which changes of a program its tests notice."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from random import Random

from execution.trials.mutants import Mutant, mutants
from execution.trials.trial_run import Outcome, Subject, run_trial

LONGER = 2.0
SPARE_S = 600.0
"""A mutant may take so much longer than the program did; what takes longer yet is noticed by that."""
MOST_FOUND = 5000
Progress = Callable[[int, int], None]


@dataclass(frozen=True, slots=True)
class Mutation:
    """A mutant and the test that noticed it; empty: none did. `is_reached` tells whether a test comes there at all."""

    mutant: Mutant
    noticed_by: str
    is_reached: bool


def mutate(subject: Subject, outcomes: Sequence[Outcome], most: int, progress: Progress) -> tuple[list[Mutation], int]:
    """Try at most so many mutants on tests that all pass; return what became of them, and how many there are.

    Where there are more, those tried are drawn evenly, always the same. A test that never reaches a step cannot notice
    what is changed there, and is not tried.
    """
    found = list(islice(mutants(subject.plan), MOST_FOUND))
    chosen = found
    if len(found) > most:
        places = Random(0).sample(range(len(found)), most)  # noqa: S311 - a play of chance that can be repeated
        chosen = [found[place] for place in sorted(places)]
    tried = []
    for number, mutant in enumerate(chosen):
        progress(number, len(chosen))
        tried.append(_try(mutant, subject, outcomes))
    return tried, len(found)


def _try(mutant: Mutant, subject: Subject, outcomes: Sequence[Outcome]) -> Mutation:
    changed = replace(subject, plan=mutant.plan)
    reaching = [o for o in outcomes if not mutant.step or _comes_to(o, mutant.step)]
    for outcome in sorted(reaching, key=lambda o: o.duration_s):
        limit_s = min(outcome.trial.limit_s, LONGER * outcome.duration_s + SPARE_S)
        if not run_trial(outcome.trial, changed, limit_s).ok:
            return Mutation(mutant, outcome.trial.name, is_reached=True)
    return Mutation(mutant, "", is_reached=bool(reaching))


def _comes_to(outcome: Outcome, step: str) -> bool:
    return any(known == step and count for (known, _), count in outcome.coverage.taken.items())

"""Which changes of a program its tests notice."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from random import Random

from execution.rehearsals.rehearsal import Follow
from execution.trials.mutants import Mutant, mutants
from execution.trials.trial_run import Outcome, Subject, run_trial

LONGER = 2.0
SPARE_S = 600.0
"""A mutant may take so much longer than the program did; what takes longer yet is stopped, which a test notices only
if something that it expects does not hold then."""
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
    chosen, there_are = choose_mutants(subject, most)
    tried = []
    for number, mutant in enumerate(chosen):
        progress(number, len(chosen))
        tried.append(try_mutant(mutant, subject, outcomes))
    return tried, there_are


def choose_mutants(subject: Subject, most: int) -> tuple[list[Mutant], int]:
    """Return at most so many mutants, drawn evenly and always the same, and how many there are."""
    there_are = sum(1 for _ in islice(mutants(subject.plan), MOST_FOUND))
    places = range(there_are)
    taken = set(places if there_are <= most else Random(0).sample(places, most))  # noqa: S311 - repeatable chance
    every = enumerate(islice(mutants(subject.plan), MOST_FOUND))
    # Each has a copy of the plan's instructions, so those that are not tried are made and let go of.
    return [mutant for place, mutant in every if place in taken], there_are


def try_mutant(mutant: Mutant, subject: Subject, outcomes: Sequence[Outcome], follow: Follow | None = None) -> Mutation:
    """Carry out the tests that come to a mutant, the shortest first, until one notices it.

    `follow` may end a rehearsal; what comes of the mutant then says nothing.
    """
    changed = replace(subject, plan=mutant.plan)
    reaching = [o for o in outcomes if not mutant.step or _comes_to(o, mutant.step)]
    for outcome in sorted(reaching, key=lambda o: o.duration_s):
        limit_s = min(outcome.trial.limit_s, LONGER * outcome.duration_s + SPARE_S)
        if not run_trial(outcome.trial, changed, limit_s, follow).ok:
            return Mutation(mutant, outcome.trial.name, is_reached=True)
    return Mutation(mutant, "", is_reached=bool(reaching))


def _comes_to(outcome: Outcome, step: str) -> bool:
    return any(known == step and count for (known, _), count in outcome.coverage.taken.items())

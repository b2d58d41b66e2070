"""What `vipo test` says of a program: on the terminal and as JSON."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from execution.trials.coverage import REACHED, ProgramPath, coverage_to_json
from execution.trials.junit import is_passed
from execution.trials.mutation import Mutation
from execution.trials.odds import Odds
from execution.trials.trial_run import Outcome, Subject
from vipo_device.protocol.faults import printable

_WORDS: Mapping[str, str] = {
    REACHED: "never reached", "true": "its condition never held", "false": "its condition always held",
    "none": "it is never skipped", "one": "it never runs exactly once", "many": "it never runs more than once",
    "limit": "its time limit was never over", "time out": "it never timed out", "fires": "its event never came",
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Tested:
    """A program with what its tests have shown; `mutations` is None where they were not asked for."""

    program: str
    subject: Subject
    files: tuple[tuple[str, tuple[Outcome, ...]], ...]
    ways: tuple[ProgramPath, ...]
    taken: Mapping[tuple[str, str], int]
    missed: tuple[ProgramPath, ...]
    odds: Mapping[tuple[str, str], Odds]
    mutations: Sequence[Mutation] | None
    mutants: int

    @property
    def ok(self) -> bool:
        """True when every test passes, with every seed."""
        return all(self.passed)

    @property
    def passed(self) -> list[bool]:
        """Whether each test passes, in their order."""
        return [is_passed(each, self.odds.get((file, each.trial.name))) for file, of_it in self.files for each in of_it]

    def where(self, step: str, line: int) -> str:
        """Return a step in the program's words: its number and its line of the script."""
        number = self.subject.numbers.get(step, "")
        text = self.subject.lines[line - 1].removesuffix(":") if 0 < line <= len(self.subject.lines) else ""
        return ", ".join(part for part in (f"step {number}" if number else "", text) if part) or "the program"


def say_tested(tested: Tested) -> Iterator[str]:
    """Yield the lines of the report."""
    for file, outcomes in tested.files:
        yield printable(file)
        for outcome in outcomes:
            yield from _say_outcome(outcome, tested.odds.get((file, outcome.trial.name)))
    yield from _say_coverage(tested)
    yield from _say_mutations(tested)
    yield f"{tested.program}: {sum(tested.passed)} of {len(tested.passed)} tests pass."


def _say_outcome(outcome: Outcome, odds: Odds | None) -> Iterator[str]:
    word = "passed" if outcome.ok else "FAILED"
    yield f"  {word}  {printable(outcome.trial.name)} ({outcome.duration_s:g} s)"
    for verdict in outcome.verdicts:
        if not verdict.ok:
            yield f"          line {verdict.line}: expected: {printable(verdict.expected)}"
            yield f"          {' ' * len(f'line {verdict.line}')}  seen:     {printable(verdict.saw)}"
    if odds is not None:
        span = f"{100 * odds.low:.1f} to {100 * odds.high:.1f} %"
        times = "" if odds.p50_s is None else f", p50 {odds.p50_s:g} s, p95 {odds.p95_s:g} s"
        yield f"          {odds.seeds} seeds: {odds.failed} failed, {100 * odds.share:.1f} % (95 %: {span}){times}"


def _say_coverage(tested: Tested) -> Iterator[str]:
    steps = [way for way in tested.ways if way.name == REACHED]
    others = [way for way in tested.ways if way.name != REACHED]
    for of, word in ((steps, "steps"), (others, "ways through branches, loops, catches and limits")):
        taken = sum(bool(tested.taken.get((way.step, way.name))) for way in of)
        yield f"Tested: {taken} of {len(of)} {word}."
    for way in tested.missed:
        words = _WORDS.get(way.name) or f"its {way.name} never came"
        yield f"  {printable(tested.where(way.step, way.line))}: {words}"


def _say_mutations(tested: Tested) -> Iterator[str]:
    if tested.mutations is None:
        return
    noticed = sum(bool(each.noticed_by) for each in tested.mutations)
    tried = f", of {tested.mutants} that there are" if tested.mutants > len(tested.mutations) else ""
    yield f"Changes that a test notices: {noticed} of {len(tested.mutations)}{tried}."
    for each in tested.mutations:
        if not each.noticed_by:
            why = "" if each.is_reached else " (no test comes there)"
            where = printable(tested.where(each.mutant.step, each.mutant.line))
            yield f"  no test notices at {where}: {each.mutant.what}{why}"


def tested_to_json(tested: Tested) -> dict[str, Any]:
    """Return the report for machines."""
    return {
        "program": tested.program,
        "ok": tested.ok,
        "files": [
            {"file": file, "tests": [_outcome_to_json(o, tested.odds.get((file, o.trial.name))) for o in outcomes]}
            for file, outcomes in tested.files
        ],
        "coverage": coverage_to_json(tested.ways, tested.taken, tested.subject.numbers),
        "mutations": None
        if tested.mutations is None
        else [_mutation_to_json(each, tested) for each in tested.mutations],
        "mutants": tested.mutants,
    }


def _outcome_to_json(outcome: Outcome, odds: Odds | None) -> dict[str, Any]:
    return {
        "name": outcome.trial.name,
        "ok": outcome.ok,
        "seed": outcome.trial.seed,
        "duration_s": outcome.duration_s,
        "expectations": [asdict(verdict) for verdict in outcome.verdicts],
        "errors": list(outcome.said),
        "odds": None if odds is None else asdict(odds) | {"share": odds.share},
    }


def _mutation_to_json(each: Mutation, tested: Tested) -> dict[str, Any]:
    mutant = each.mutant
    return {
        "step": mutant.step,
        "number": tested.subject.numbers.get(mutant.step, ""),
        "line": mutant.line,
        "what": mutant.what,
        "noticed_by": each.noticed_by,
        "reached": each.is_reached,
    }

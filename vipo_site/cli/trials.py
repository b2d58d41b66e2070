"""`vipo test`: tests of programs, carried out in virtual time, without services."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from editor.language import compile_document
from execution.rehearsals.program_file import read_site
from execution.trials.coverage import missed
from execution.trials.junit import junit_xml
from execution.trials.mutation import Mutation, mutate
from execution.trials.odds import Odds, find_odds
from execution.trials.trial import Trial
from execution.trials.trial_file import read_trials
from execution.trials.trial_run import Outcome, Subject, run_trial, settle
from execution.trials.yaml_lines import BadTrialFile
from vipo_site.cli.program_file import FaultyScript, ProgramFile, UnreadableFile, read_bounded, read_program_file
from vipo_site.cli.terminal import CLEAN, FAULTY, Unusable, complain, write, write_json
from vipo_site.cli.trial_report import Tested, say_tested, tested_to_json

MOST_SEEDS = 1000
MOST_MUTANTS = 1000


@dataclass(frozen=True, slots=True)
class _Suite:
    """A file of tests, ready: its program in its site, and its tests with steps by their ids."""

    path: Path
    program: Path
    subject: Subject
    trials: tuple[Trial, ...]


def test_files(options: argparse.Namespace) -> int:
    """Carry out the tests of the named files and say how they went; return the exit code.

    Raises:
        Unusable: a file or its program cannot be used, or an option is out of bounds.
    """
    if not 0 <= options.seeds <= MOST_SEEDS or not 1 <= options.mutants <= MOST_MUTANTS:
        raise Unusable(
            f"--seeds takes a number from 0 to {MOST_SEEDS}, --mutants one from 1 to {MOST_MUTANTS}.", "bad_option"
        )
    suites = [_load(path) for path in _files(options.files)]
    outcomes = [(suite, [run_trial(trial, suite.subject) for trial in suite.trials]) for suite in suites]
    tested = [_tested(group, options) for group in _by_program(outcomes)]
    if options.junit is not None:
        files = [(str(suite.path), of_suite) for suite, of_suite in outcomes]
        odds = {test: found for each in tested for test, found in each.odds.items()}
        options.junit.parent.mkdir(parents=True, exist_ok=True)
        options.junit.write_text(junit_xml(files, odds), encoding="utf-8")
    if options.json:
        write_json({"version": 1, "programs": [tested_to_json(each) for each in tested]})
    else:
        for each in tested:
            for line in say_tested(each):
                write(line)
    return CLEAN if all(each.ok for each in tested) else FAULTY


def _files(named: Sequence[Path]) -> Iterator[Path]:
    for path in named:
        if path.is_dir():
            found = sorted([*path.glob("*.yaml"), *path.glob("*.yml")])
            if not found:
                raise UnreadableFile(f"{path} holds no file of tests (.yaml).")
            yield from found
        else:
            yield path


def _load(path: Path) -> _Suite:
    """Read a file of tests with its program; raises UnreadableFile with the line."""
    try:
        file = read_trials(read_bounded(path, "file of tests"))
        where = path.parent / file.program
        program = read_program_file(where, path.parent / file.site if file.site else None)
        subject = _subject(where, program)
        return _Suite(path, where.resolve(), subject, tuple(settle(trial, subject) for trial in file.trials))
    except BadTrialFile as error:
        line = f"line {error.line}: " if error.line else ""
        raise UnreadableFile(f"{path}: {line}{error.why}") from error
    except FaultyScript as error:  # otherwise than where a program is checked, that is no result
        raise UnreadableFile(str(error), error.code) from error


def _subject(path: Path, program: ProgramFile) -> Subject:
    compiled = compile_document(program.document, program.surroundings)
    if compiled.plan is None:
        first = next(d for d in compiled.diagnostics if d.severity == "error")
        number = compiled.numbers.get(first.step, "")
        where = f"step {number}: " if number else ""
        raise UnreadableFile(f"{path} has errors, so it cannot be tested. {where}{first.message}", "not_ready")
    _, scene, places = read_site(dict(program.site), 0)
    lines = tuple(line.strip() for line in compiled.script.splitlines())
    return Subject(compiled.plan, scene, places, compiled.numbers, lines, program.surroundings.zones)


_Of = tuple[_Suite, list[Outcome]]


def _by_program(outcomes: Sequence[_Of]) -> list[list[_Of]]:
    """Return the files of the same program in the same site together."""
    groups: list[list[_Of]] = []
    for suite, of_suite in outcomes:
        same = (g for g in groups if g[0][0].program == suite.program and g[0][0].subject == suite.subject)
        group = next(same, None)
        if group is None:
            groups.append([(suite, of_suite)])
        else:
            group.append((suite, of_suite))
    return groups


def _tested(group: Sequence[_Of], options: argparse.Namespace) -> Tested:
    subject = group[0][0].subject
    outcomes = [outcome for _, of_suite in group for outcome in of_suite]
    taken: dict[tuple[str, str], int] = {}
    for outcome in outcomes:
        for way in {way for way, count in outcome.coverage.taken.items() if count}:
            taken[way] = taken.get(way, 0) + 1
    ways = outcomes[0].coverage.paths
    files = tuple((str(suite.path), tuple(of_suite)) for suite, of_suite in group)
    found, there_are = _mutations(subject, outcomes, options)
    odds = _odds(group, options.seeds)
    name, never = group[0][0].program.name, tuple(missed(ways, taken))
    return Tested(name, subject, files, ways, taken, never, odds, found, there_are)


def _odds(group: Sequence[_Of], seeds: int) -> dict[tuple[str, str], Odds]:
    """Carry out each test with the seeds from 1 on."""
    found: dict[tuple[str, str], Odds] = {}
    for suite, _ in group:
        for trial in suite.trials if seeds else ():
            runs = []
            for seed in range(1, seeds + 1):
                _progress(f"{trial.name}: seed {seed} of {seeds}")
                runs.append(run_trial(replace(trial, seed=seed), suite.subject))
            went_well = [outcome.duration_s for outcome in runs if outcome.ok]
            found[str(suite.path), trial.name] = find_odds(went_well, len(runs) - len(went_well))
    _progress("")
    return found


def _mutations(
    subject: Subject, outcomes: Sequence[Outcome], options: argparse.Namespace
) -> tuple[list[Mutation] | None, int]:
    """Try what the tests notice; None where that was not asked for, or cannot be said as a test fails already."""
    if not options.mutate or not all(outcome.ok for outcome in outcomes):
        if options.mutate:
            complain("Tests that fail notice everything: what no test notices can be said when all of them pass.")
        return None, 0
    found, there_are = mutate(subject, outcomes, options.mutants, lambda n, of: _progress(f"change {n + 1} of {of}"))
    _progress("")
    return found, there_are


def _progress(text: str) -> None:
    """Say on a terminal how far it is, on one line that the next word takes."""
    if sys.stderr.isatty():
        sys.stderr.write(f"\r\x1b[K{text}")
        sys.stderr.flush()

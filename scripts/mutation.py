"""Change the language in some small places, one at a time, and count how often its tests notice.

python scripts/mutation.py [--of analysis] [--mutants 150] [--seed 0] [--cosmic-ray var/mutation/bin/cosmic-ray]

Works on a copy of the tree. See docs/language/testing.md.
"""

from __future__ import annotations

import argparse
import ast
import random
import shutil
import sqlite3
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = "editor/language"
COPIED = (
    "editor", "vipo_device", "registry", "simulation", "execution", "connectors", "vipo_site", "bench", "scripts",
    "tests", "examples", "docs", "pyproject.toml",
)  # fmt: skip
TEXTS = ("en", "de", "syntax_errors_de", "refusals_de")
"""Modules of sentences."""
CONFIGURATION = """[cosmic-ray]
module-path = "{package}"
timeout = {timeout}
excluded-modules = []
test-command = "{tests}"

[cosmic-ray.distributor]
name = "local"
"""
SPECIFICATIONS = "select job_id, module_path, operator_name, start_pos_row, start_pos_col from mutation_specs"
RESULTS = (
    "select test_outcome, module_path, operator_name, start_pos_row, diff"
    " from work_results join mutation_specs using (job_id) order by module_path, start_pos_row"
)
PYTEST = (
    "-m pytest -q -x --assert=plain -c /dev/null --rootdir . --noconftest -W error --ds tests.settings"
    " -p no:cacheprovider -p no:asyncio -p no:anyio -p no:playwright -p no:schemathesis -p no:xdist "
)
"""The tests of the language need no server, which would take longer to begin than most of them."""
LANGUAGE = "tests/unit/language"
QUICK = ("checks", "analysis", "test_cases.py", "test_incremental.py", "test_catches.py", "test_lists.py",
         "test_edges.py", "test_robot_methods.py", "test_robot_readings.py", "parsing/test_script.py",
         "odd")  # fmt: skip
PARTS = {
    "language": (PACKAGE, f"{LANGUAGE} --ignore {LANGUAGE}/test_examples.py", 300.0),
    "analysis": (f"{PACKAGE}/analysis", " ".join(f"{LANGUAGE}/{name}" for name in QUICK), 150.0),
}
"""What is changed, the tests that judge it, and the seconds after which a change counts as noticed."""
Span = tuple[tuple[int, int], tuple[int, int]]


@dataclass(frozen=True, slots=True)
class Mutant:
    """One change: where, and of which kind."""

    id: str
    module: str
    operator: str
    row: int
    column: int

    @property
    def spot(self) -> tuple[str, int, int, str]:
        """Return what mutants of one spot share, so that no spot counts eleven times."""
        family = "Binary" if "BinaryOperator" in self.operator else self.operator.split("_")[0]
        return (self.module, self.row, self.column, family)


def quiet_spans(source: str) -> Iterator[Span]:
    """Yield the parts of a module that mean nothing when it runs: annotations, and decorators of classes."""
    for node in ast.walk(ast.parse(source)):
        for name in ("annotation", "returns"):
            part = getattr(node, name, None)
            if isinstance(part, ast.expr):
                yield span(part)
        if isinstance(node, ast.ClassDef):
            yield from (span(decorator) for decorator in node.decorator_list)


def span(node: ast.expr) -> Span:
    """Return where an expression begins and ends."""
    end = (node.end_lineno or node.lineno, node.end_col_offset or node.col_offset)
    return (node.lineno, node.col_offset), end


def worth_testing(mutants: list[Mutant], folder: Path) -> list[Mutant]:
    """Leave out sentences and what means nothing at run time."""
    spans = {m: list(quiet_spans((folder / m).read_text())) for m in {each.module for each in mutants}}
    return [
        each
        for each in mutants
        if Path(each.module).stem not in TEXTS
        and each.operator != "core/RemoveDecorator"
        and not any(begin <= (each.row, each.column) < end for begin, end in spans[each.module])
    ]


def sample(mutants: list[Mutant], count: int, seed: int) -> list[Mutant]:
    """Choose spots at random, and at each one mutant."""
    chance = random.Random(seed)  # noqa: S311 — a sample, not a secret
    spots: dict[tuple[str, int, int, str], list[Mutant]] = {}
    for mutant in sorted(mutants, key=lambda each: (each.spot, each.operator, each.id)):
        spots.setdefault(mutant.spot, []).append(mutant)
    chosen = chance.sample(sorted(spots), min(count, len(spots)))
    return [chance.choice(spots[spot]) for spot in chosen]


def keep_only(session: Path, folder: Path, count: int, seed: int) -> None:
    """Take all mutants but the sample out of the session."""
    with sqlite3.connect(session) as database:
        mutants = worth_testing([Mutant(*row) for row in database.execute(SPECIFICATIONS)], folder)
        kept = [(mutant.id,) for mutant in sample(mutants, count, seed)]
        database.execute("create temporary table kept (id text)")
        database.executemany("insert into kept values (?)", kept)
        database.execute("delete from mutation_specs where job_id not in (select id from kept)")
        database.execute("delete from work_items where job_id not in (select id from kept)")
    sys.stdout.write(f"{len(kept)} of {len(mutants)} mutants\n")


def report(session: Path) -> int:
    """Print the survivors and the score; return how many survived."""
    with sqlite3.connect(session) as database:
        rows = database.execute(RESULTS).fetchall()
    survivors = [row for row in rows if str(row[0]).lower().endswith("survived")]
    for _, module, operator, row, diff in survivors:
        sys.stdout.write(f"\n{module}:{row} {operator}\n{diff}\n")
    killed = len(rows) - len(survivors)
    sys.stdout.write(f"\n{killed} of {len(rows)} mutants were noticed: {100 * killed / max(1, len(rows)):.1f} %\n")
    return len(survivors)


def copy_tree(folder: Path) -> None:
    """Copy what the language's tests need, so that nobody meets a mutant."""
    for name in COPIED:
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, folder / name, ignore=shutil.ignore_patterns("__pycache__", "node_modules"))
        else:
            shutil.copy(source, folder / name)


def check_unchanged(folder: Path, tests: str) -> None:
    """Leave where the tests fail without any mutant: each would seem to be noticed."""
    # the interpreter and the tests of this project
    if subprocess.run([sys.executable, *tests.split()], cwd=folder, check=False).returncode:  # noqa: S603
        sys.exit("The tests fail on the copy of the tree as it is; mend that first, or add to COPIED what they need.")


def main() -> None:
    """Make the mutants, test a sample of them, report."""
    parser = argparse.ArgumentParser(description="Mutation testing of editor/language.")
    parser.add_argument("--of", choices=sorted(PARTS), default="language")
    parser.add_argument("--mutants", type=int, default=150)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--cosmic-ray", default=str(ROOT / "var" / "mutation" / "bin" / "cosmic-ray"))
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="vipo-mutation-") as name:
        folder = Path(name)
        copy_tree(folder)
        package, tests, timeout = PARTS[options.of]
        check_unchanged(folder, PYTEST + tests)
        configuration = CONFIGURATION.format(
            package=package, tests=f"{sys.executable} {PYTEST}{tests}", timeout=timeout
        )
        (folder / "mutation.toml").write_text(configuration)
        session = folder / "mutation.sqlite"
        for command in ("init", "exec"):
            # the command line's own tool, with a session of our own
            subprocess.run(  # noqa: S603
                [options.cosmic_ray, command, "mutation.toml", str(session)], cwd=folder, check=True
            )
            if command == "init":
                keep_only(session, folder, options.mutants, options.seed)
        report(session)


if __name__ == "__main__":
    main()

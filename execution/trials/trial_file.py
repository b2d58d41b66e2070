"""The file of tests: what may stand in it, and a sentence with the line for what may not."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Final, get_args

from execution.trials.trial import Expectation, ExpectationKind, Trial, TrialFile
from execution.trials.yaml_lines import BadTrialFile, Path, read_yaml
from simulation.fault_form import BadFaults, read_list
from simulation.world import MOST_SEED
from vipo_device.protocol.description import Scalar

VERSION: Final = 1
LADDER: Final[Mapping[int, Callable[[dict[str, Any]], dict[str, Any]]]] = {}
"""For each older version what makes the next one of it; the first version has none before it."""
MOST_TRIALS: Final = 200
MOST_EXPECTATIONS: Final = 100
LONGEST_S: Final = 7 * 24 * 3600.0
MOST_COUNT: Final = 1_000_000
MOST_TEXT: Final = 200
_EXPECTATIONS: Final = frozenset(get_args(ExpectationKind))
_WORDS: Final[Mapping[str, tuple[frozenset[str], frozenset[str]]]] = {
    "item": (frozenset({"object", "at"}), frozenset({"count"})),
    "never_two_in": (frozenset(), frozenset({"zone", "place", "within_m"})),
    "property": (frozenset({"device", "name"}), frozenset({"is", "at_least", "at_most"})),
    "step": (frozenset({"step"}), frozenset({"times"})),
}
"""For expectations that are tables: the words that each needs, and those that it may have."""


def read_trials(payload: bytes) -> TrialFile:
    """Read a file of tests; raises BadTrialFile with the line and how to mend it."""
    data, lines = read_yaml(payload)
    return _Reader(lines).file(data)


def read_trial(payload: bytes) -> Trial:
    """Read one test, as an entry of `tests` says it; raises BadTrialFile with the line and how to mend it."""
    data, lines = read_yaml(payload)
    return _Reader(lines).trial((), data)


@dataclass(frozen=True, slots=True)
class _Reader:
    lines: Mapping[Path, int]

    def file(self, data: object) -> TrialFile:
        if not isinstance(data, dict):
            raise BadTrialFile(1, f"It must begin with “version: {VERSION}”, then “program:” and “tests:”.")
        version = data.get("version")
        if type(version) is not int or not 1 <= version <= VERSION:
            raise self.bad(("version",), f"Write “version: {VERSION}”, not {version!r}.")
        for step in range(version, VERSION):
            data = LADDER[step](data)
        self.known((), data, {"version", "program", "site", "tests"})
        tests = data.get("tests")
        if not isinstance(tests, list) or not 0 < len(tests) <= MOST_TRIALS:
            raise self.bad(("tests",), f"Write 1 to {MOST_TRIALS} tests as a list under “tests:”.")
        trials = tuple(self.trial(("tests", index), test) for index, test in enumerate(tests))
        self.refuse_same_names(trials)
        if not data.get("program"):
            raise self.bad((), "Name the program: “program: ../paint-order.json”.")
        return TrialFile(
            self.text(("program",), data.get("program")), self.text(("site",), data.get("site", "")), trials
        )

    def trial(self, path: Path, test: object) -> Trial:
        body = self.table(path, test)
        self.known(path, body, {"name", "given", "when", "then"})
        name = self.text((*path, "name"), body.get("name"))
        if _is_blank(name):
            raise self.bad(path, "Give the test a name: “name: One box, all goes well”.")
        given, when = (self.table((*path, word), body.get(word) or {}) for word in ("given", "when"))
        self.known((*path, "given"), given, {"stock", "carrying", "readings"})
        self.known((*path, "when"), when, {"seed", "driver", "limit_s", "parameters", "faults"})
        readings, parameters = (*path, "given", "readings"), (*path, "when", "parameters")
        return Trial(
            name=name,
            line=self.line(path),
            then=self.then((*path, "then"), body.get("then")),
            seed=self.whole((*path, "when", "seed"), when.get("seed", 0), MOST_SEED),
            driver=self.driver((*path, "when", "driver"), when.get("driver", "kinematic")),
            limit_s=self.number((*path, "when", "limit_s"), when.get("limit_s", 4 * 3600.0), 1.0, LONGEST_S),
            parameters=self.scalars(parameters, when.get("parameters") or {}),
            faults=self.faults((*path, "when", "faults"), when.get("faults") or []),
            faults_line=self.line((*path, "when", "faults")),
            stocks=self.counts((*path, "given", "stock"), given.get("stock") or {}),
            carrying=self.counts((*path, "given", "carrying"), given.get("carrying") or {}),
            readings={
                device: self.scalars((*readings, device), values)
                for device, values in self.table(readings, given.get("readings") or {}).items()
            },
        )

    def then(self, path: Path, entries: object) -> tuple[Expectation, ...]:
        if not isinstance(entries, list) or not 0 < len(entries) <= MOST_EXPECTATIONS:
            raise self.bad(path, "Say under “then:” what holds, as a list, such as “- ends: well”.")
        return tuple(self.expectation((*path, index), entry) for index, entry in enumerate(entries))

    def expectation(self, path: Path, entry: object) -> Expectation:
        body = self.table(path, entry)
        if len(body) != 1 or (kind := next(iter(body))) not in _EXPECTATIONS:
            raise self.bad(path, f"Write one of {', '.join(sorted(_EXPECTATIONS))}, a colon and what is expected.")
        return Expectation(kind, self.line(path), self.says((*path, kind), kind, body[kind]))  # type: ignore[arg-type]

    def says(self, path: Path, kind: str, value: object) -> Any:
        if kind in _WORDS:
            return self.words(path, kind, value)
        if (kind == "ends" and value != "well") or (kind == "fails" and _is_blank(value)):
            raise self.bad(path, "Write “ends: well”, or “fails:” and a word of the reason.")
        if kind == "within_s":
            return self.number(path, value, 0.0, LONGEST_S)
        if kind == "commands":
            listed = value if isinstance(value, list) else [value]
            if not listed or any(map(_is_blank, listed)):
                raise self.bad(path, "commands needs “device.method”.")
            return [self.text(path, command, MOST_TEXT) for command in listed]
        return self.text(path, value)

    def words(self, path: Path, kind: str, value: object) -> dict[str, Any]:
        body, (needs, may) = self.table(path, value), _WORDS[kind]
        self.known(path, body, needs | may)
        if missing := needs - set(body):
            raise self.bad(path, f"{kind} needs “{min(missing)}”.")
        if kind == "never_two_in" and len({"zone", "place"} & set(body)) != 1:
            raise self.bad(path, "Write “zone:” with a zone of the program, or “place:” with a place of the site.")
        if kind == "property" and len(body) != 3:
            raise self.bad(path, "Write one of “is”, “at_least” and “at_most” beside the device and the name.")
        return {word: self.word((*path, word), word, held) for word, held in body.items()}

    def word(self, path: Path, word: str, value: object) -> Any:
        if word in {"count", "times"}:
            return self.whole(path, value, MOST_COUNT)
        if word in {"at_least", "at_most"}:
            return self.number(path, value, -1e15, 1e15)
        if word == "within_m":
            return self.number(path, value, 0.0, 1000.0)
        return self.scalar(path, value) if word == "is" else self.text(path, value)

    def faults(self, path: Path, entries: object) -> Any:
        try:
            return read_list(entries)
        except BadFaults as error:
            raise self.bad((*path, error.number - 1) if error.number else path, error.detail) from error

    def driver(self, path: Path, value: object) -> Any:
        if value not in ("physics", "kinematic"):
            raise self.bad(path, f"The driver is physics or kinematic, not {value!r}.")
        return value

    def counts(self, path: Path, value: object) -> dict[str, dict[str, int]]:
        return {
            device: {
                name: self.whole((*path, device, name), count, MOST_COUNT)
                for name, count in self.table((*path, device), held).items()
            }
            for device, held in self.table(path, value).items()
        }

    def scalars(self, path: Path, value: object) -> dict[str, Scalar]:
        return {name: self.scalar((*path, name), held) for name, held in self.table(path, value).items()}

    def scalar(self, path: Path, value: object) -> Scalar:
        if isinstance(value, bool | str):
            return value
        return self.number(path, value, -1e15, 1e15)

    def number(self, path: Path, value: object, low: float, high: float) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float) or value != value:
            raise self.bad(path, f"“{path[-1]}” is a number, not {str(value)[:40]!r}.")
        if not low <= value <= high:  # also of a number that is too large for a float
            raise self.bad(path, f"“{path[-1]}” is a number from {low:g} to {high:g}, not {str(value)[:40]}.")
        return value

    def whole(self, path: Path, value: object, most: int) -> int:
        if type(value) is not int or not 0 <= value <= most:
            raise self.bad(path, f"“{path[-1]}” is a whole number from 0 to {most}, not {value!r}.")
        return value

    def text(self, path: Path, value: object, most: int = 500) -> str:
        if isinstance(value, int) and not isinstance(value, bool):
            return str(value)  # a step's number without quotes
        if not isinstance(value, str) or len(value) > most:
            raise self.bad(path, f"“{path[-1]}” is a text of at most {most} characters, not {str(value)[:40]!r}.")
        return value

    def table(self, path: Path, value: object) -> dict[str, Any]:
        if not isinstance(value, dict):
            raise self.bad(path, "Here stand words, each with a colon and a value.")
        return value

    def known(self, path: Path, body: Iterable[str], words: Iterable[str]) -> None:
        for word in body:
            if word not in words:
                raise self.bad((*path, word), f"“{word}” is not known here. Known are: {', '.join(sorted(words))}.")

    def refuse_same_names(self, trials: tuple[Trial, ...]) -> None:
        seen: set[str] = set()
        for trial in trials:
            if trial.name in seen:
                raise BadTrialFile(trial.line, f"Two tests are called “{trial.name}”; give each a name of its own.")
            seen.add(trial.name)

    def bad(self, path: Path, why: str) -> BadTrialFile:
        return BadTrialFile(self.line(path), why)

    def line(self, path: Path) -> int:
        """Return the line of a value, or of the nearest one around it that stands in the file."""
        return next((self.lines[path[:end]] for end in range(len(path), -1, -1) if path[:end] in self.lines), 1)


def _is_blank(value: object) -> bool:
    return isinstance(value, str) and not value.strip()

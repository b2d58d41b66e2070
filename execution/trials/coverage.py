"""Which paths through a program were taken: branches, catches, time limits, loops; as data for each construct; pure."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from editor.language.expressions.nodes import Constant, Expression, Operation, Variable
from editor.language.plan import instructions as p

ROUNDS = ("none", "one", "many")
REACHED = "reached"


@dataclass(frozen=True, slots=True)
class ProgramPath:
    """A path through a construct: `step` is its id, `line` that of the script, `name` says which path.

    Names: `reached`, `true` and `false` of a condition, `none`, `one` and `many` of a loop's rounds, `catch` with the
    kinds that it takes, `limit` of a time limit, `time out` of a wait or question, `fires` of an event.
    """

    step: str
    line: int
    name: str


class Coverage:
    """Counts for one plan how often each path was taken; an observer of rehearsals (`Observer`)."""

    def __init__(self, plan: p.Plan) -> None:
        self.paths = _each_once(_paths(plan))
        self.taken: Counter[tuple[str, str]] = Counter()
        self._plan = plan
        self._loops = {i for i in range(len(plan.instructions)) if _is_loop(plan, i)}
        self._catches = _catches(plan)
        self._events = {event.entry: event.step for event in plan.events}
        self._timed = _timed(plan)
        self._goes_to: dict[int, int] = {}
        self._rounds: dict[tuple[int, int], int] = {}

    def carried(self, thread: int, at: int, to: int) -> None:
        """Take in an instruction and where its thread goes on."""
        instruction = self._plan.instructions[at]
        came_by_itself = self._goes_to.get(thread) == at  # an empty catch begins where the path without it goes on
        self._goes_to[thread] = to
        for step, name in () if came_by_itself else self._catches.get(at, ()):
            self.taken[step, name] += 1
        if at in self._events:
            self.taken[self._events[at], "fires"] += 1
        if not isinstance(instruction.do, p.Branch) or not instruction.step:
            return
        holds = to == at + 1
        if at not in self._loops:
            self.taken[instruction.step, "true" if holds else "false"] += 1
        elif holds:
            self._rounds[thread, at] = self._rounds.get((thread, at), 0) + 1
        else:
            self._end_loop(at, self._rounds.pop((thread, at), 0))

    def did(self, step: str, kind: str = "") -> None:
        """Take in a step that begins, or with a `kind` one that fails so."""
        if not kind:
            self.taken[step, REACHED] += 1
        elif kind == "timed_out" and step in self._timed:
            self.taken[step, self._timed[step]] += 1

    def end(self) -> None:
        """Count the loops that were left in the midst of a round."""
        for (_, at), rounds in self._rounds.items():
            self._end_loop(at, rounds)
        self._rounds.clear()

    def _end_loop(self, at: int, rounds: int) -> None:
        self.taken[self._plan.instructions[at].step, ROUNDS[min(rounds, 2)]] += 1


def missed(paths: Iterable[ProgramPath], taken: Mapping[tuple[str, str], int]) -> list[ProgramPath]:
    """Return the paths that were never taken; of a step that was never reached, that alone."""
    paths = list(paths)
    unreached = {each.step for each in paths if each.name == REACHED and not taken.get((each.step, REACHED))}
    return [
        each
        for each in paths
        if not taken.get((each.step, each.name)) and (each.step not in unreached or each.name == REACHED)
    ]


def coverage_to_json(
    paths: Iterable[ProgramPath], taken: Mapping[tuple[str, str], int], numbers: Mapping[str, str]
) -> list[dict[str, Any]]:
    """Return for each construct its number, line and how often each of its paths was taken."""
    found: dict[str, dict[str, Any]] = {}
    for path in paths:
        number = numbers.get(path.step, "")
        entry = found.setdefault(path.step, {"step": path.step, "number": number, "line": path.line, "ways": {}})
        entry["ways"][path.name] = taken.get((path.step, path.name), 0)
    return list(found.values())


def _each_once(paths: Iterable[ProgramPath]) -> tuple[ProgramPath, ...]:
    """Return each path with the first line on which it stands: a step may have several."""
    found: dict[tuple[str, str], ProgramPath] = {}
    for path in paths:
        found.setdefault((path.step, path.name), path)
    return tuple(found.values())


def _paths(plan: p.Plan) -> Iterable[ProgramPath]:
    catches = _catches(plan)
    names = {step: [n for found in catches.values() for s, n in found if s == step] for step in _steps_of(plan)}
    for index, instruction in enumerate(plan.instructions):
        step, line = instruction.step, instruction.line
        for entered in (*instruction.enters, *((step,) if step else ())):
            yield ProgramPath(entered, line, REACHED)
        if isinstance(instruction.do, p.Branch) and step:
            rounds = _possible_rounds(plan, index) if _is_loop(plan, index) else ("true", "false")
            yield from (ProgramPath(step, line, name) for name in rounds)
        elif isinstance(instruction.do, p.TryBegin) and step:
            yield from (ProgramPath(step, line, name) for name in names[step])
        elif (name := _time_path(instruction.do)) and step:
            yield ProgramPath(step, line, name)
    for event in plan.events:
        yield ProgramPath(event.step, plan.instructions[event.entry].line, "fires")


def _steps_of(plan: p.Plan) -> set[str]:
    return {instruction.step for instruction in plan.instructions}


def _is_loop(plan: p.Plan, at: int) -> bool:
    """Tell whether a branch is the head of a loop: something behind it jumps back to it."""
    if not isinstance(plan.instructions[at].do, p.Branch):
        return False
    return any(i.do == p.Jump(at) for i in plan.instructions[at + 1 :])


def _possible_rounds(plan: p.Plan, at: int) -> tuple[str, ...]:
    """Return what a loop's rounds can be: where the program fixes their number, that alone."""
    fixed = _fixed_rounds(plan, at)
    return ROUNDS if fixed is None else (ROUNDS[min(fixed, 2)],)


def _fixed_rounds(plan: p.Plan, at: int) -> int | None:
    """Return how many rounds a Repeat of a constant, or a For-each over what is written down, has."""
    branch = plan.instructions[at].do
    assert isinstance(branch, p.Branch)
    if not isinstance(branch.condition, Operation) or not plan.instructions[at].step:
        return None
    counted, most = branch.condition.arguments[0], branch.condition.arguments[-1]
    if not isinstance(counted, Variable) or plan.instructions[at].enters:
        return None  # a While: its condition is the program's own
    if isinstance(most, Operation) and most.operator == "len" and isinstance(most.arguments[0], Variable):
        listed = _assigned(plan, at, most.arguments[0].name)
        if isinstance(listed, Constant) and isinstance(listed.value, list | tuple):
            return len(listed.value)
        fits = isinstance(listed, Operation) and listed.operator == "list"
        return len(listed.arguments) if fits and isinstance(listed, Operation) else None
    held = most if branch.condition.operator == "<" else _assigned(plan, at, counted.name)
    value = held.value if isinstance(held, Constant) else None
    return max(0, int(value)) if isinstance(value, int | float) else None


def _assigned(plan: p.Plan, at: int, name: str) -> Expression | None:
    """Return what a variable was last given before an address."""
    for instruction in reversed(plan.instructions[:at]):
        if isinstance(instruction.do, p.Assign) and instruction.do.name == name:
            return instruction.do.value
    return None


def _catches(plan: p.Plan) -> dict[int, list[tuple[str, str]]]:
    """Return for each address where a catch begins its step and the name of the path."""
    found: dict[int, list[tuple[str, str]]] = {}
    for instruction in plan.instructions:
        do = instruction.do
        if isinstance(do, p.TryBegin) and not do.final and instruction.step:
            name = " ".join(("catch", *do.kinds))
            found.setdefault(do.handler, []).append((instruction.step, name))
    return found


def _timed(plan: p.Plan) -> dict[str, str]:
    return {i.step: name for i in plan.instructions if i.step and (name := _time_path(i.do))}


def _time_path(do: p.Action) -> str:
    if isinstance(do, p.LimitBegin):
        return "limit"
    return "time out" if isinstance(do, p.WaitUntil | p.AskPerson) and do.timeout_s is not None else ""

"""A run's journal as bars: who worked on which step, from when to when; pure.

`frontend/src/run/gantt.ts` goes on with what the journal tells after it; `tests/cases/timelines.json` holds both.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Set
from dataclasses import dataclass, field, replace
from typing import Any, Final, Literal

from editor.language.constructs.table import CONSTRUCTS
from editor.language.reading.names import DEFAULT_ROLE, text_of

Kind = Literal["work", "wait"]
TOLD: Final = ("step", "wait", "command", "answer", "way")
"""The kinds of lines that say something of bars."""
MOST_BARS = 2000
"""More bars than these nobody can tell from each other on a screen."""
CELLS = 1000
"""Bars that are joined because they are too many lie within so small a part of the whole time, or twice that, …"""
KEPT = 4
"""So many times as many bars are kept while a journal is read, however long it is; then those that are over join."""
JOIN_S = 3.0
"""Pieces of one way follow each other closely; a pause shorter than this does not part a bar."""
FAILED: Final = frozenset({"FAILED", "REJECTED"})


@dataclass(frozen=True, slots=True)
class TimelineLine:
    """A line of a journal, as far as it says something of bars; `status` is what an answer was."""

    t_s: float
    kind: str
    code: str
    step: str
    device: str
    robot: str
    status: str = ""


@dataclass(slots=True)
class Bar:
    """What a device did or waited for, for a step, in seconds of the run; `ended_s` is None while it goes on.

    `pending` counts the commands for it that are under way. `count` is of how many bars it was joined, which may be of
    several steps: `step` is then the first that failed, or just the first.
    """

    device: str
    step: str
    kind: Kind
    started_s: float
    ended_s: float | None = None
    failed: bool = False
    count: int = 1
    pending: int = 1


@dataclass(frozen=True, slots=True)
class Timeline:
    """The bars in the order in which they began, and what is needed to go on.

    `steps` are those under way, the one that began last at the end; `drives` says for which each robot drives.
    """

    bars: tuple[Bar, ...]
    steps: tuple[str, ...]
    drives: Mapping[str, str]


def read_timeline(lines: Iterable[TimelineLine], robots: Mapping[str, str], most: int = MOST_BARS) -> Timeline:
    """Return the bars of a journal whose lines come in their order, `most` of them or a few more.

    `robots` names the robot of each step that a robot carries out.
    """
    reader = _Reader(robots)
    last_s, too_many = 0.0, KEPT * most
    for line in lines:
        reader.take(line)
        last_s = max(last_s, line.t_s)
        if len(reader.bars) >= too_many:
            reader.join(last_s, KEPT // 2 * most)
            too_many = max(KEPT * most, 2 * len(reader.bars))
    return Timeline(tuple(_fitted(reader.bars, last_s, most)), tuple(reader.steps), reader.drives)


def robots_of(document: Mapping[str, Any], roles: Mapping[str, str]) -> dict[str, str]:
    """Return which robot carries out which step of a program, as far as a robot does and is known."""
    steps: Mapping[str, Any] = document.get("steps") or {}
    found = {step: roles.get(_role_of(said)) for step, said in steps.items()}
    return {step: robot for step, robot in found.items() if robot}


def _role_of(step: Mapping[str, Any]) -> str:
    """Return the role whose robot carries out a step; of one without a robot an empty text."""
    kind, params = step.get("kind"), step.get("params") or {}
    if kind == "operate":
        device = params.get("device")
        return text_of(device.get("role")) if isinstance(device, Mapping) else ""
    construct = CONSTRUCTS.get(str(kind))
    return text_of(params.get("role", DEFAULT_ROLE)) if construct and construct.drives else ""


@dataclass(slots=True)
class _Reader:
    robots: Mapping[str, str]
    bars: list[Bar] = field(default_factory=list)
    steps: list[str] = field(default_factory=list)
    drives: dict[str, str] = field(default_factory=dict)
    _open: dict[tuple[str, str, Kind], Bar] = field(default_factory=dict)
    _last: dict[str, Bar] = field(default_factory=dict)

    def join(self, last_s: float, most: int) -> None:
        """Join bars until there are so many, but none of which anything may still be told."""
        kept = {id(bar) for bar in (*self._open.values(), *self._last.values())}
        self.bars = _fitted(self.bars, last_s, most, kept)

    def take(self, line: TimelineLine) -> None:
        who = line.robot or line.device
        if line.kind == "step":
            self._note_step(line)
        elif line.code == "way":
            self._drive(line.robot, line.t_s)
        elif line.code == "command":
            self._arrive(line.device, line.t_s)
            self._begin(line.device, line.step, "work", line.t_s)
        elif line.code == "answer":
            self._end((line.device, line.step, "work"), line.t_s, line.status in FAILED)
        elif line.kind == "wait" and who:
            self._note_wait(line, who)

    def _note_wait(self, line: TimelineLine, who: str) -> None:
        if line.code == "wait_over":
            self._end((who, line.step, "wait"), line.t_s)
        elif (who, line.step, "wait") not in self._open:  # else it is only told anew for what it waits
            self._begin(who, line.step, "wait", line.t_s)

    def _note_step(self, line: TimelineLine) -> None:
        if line.code == "step_entered":
            self.steps.append(line.step)
        elif line.code.startswith("step_"):  # others tell how it goes on
            self._leave(line)

    def _leave(self, line: TimelineLine) -> None:
        self.steps = [step for step in self.steps if step != line.step]
        if line.code != "step_done":
            self._break_off(line.step, line.t_s)
        for robot in [robot for robot, step in self.drives.items() if step == line.step]:
            self._arrive(robot, line.t_s)

    def _drive(self, robot: str, at_s: float) -> None:
        step = next((each for each in reversed(self.steps) if self.robots.get(each) == robot), "")
        if self.drives.get(robot) == step:
            return
        self._arrive(robot, at_s)
        self.drives[robot] = step
        self._begin(robot, step, "work", at_s)

    def _arrive(self, robot: str, at_s: float) -> None:
        step = self.drives.pop(robot, None)
        if step is not None:
            self._end((robot, step, "work"), at_s)

    def _begin(self, device: str, step: str, kind: Kind, at_s: float) -> None:
        """A piece of work begins: it goes on with the device's last bar if that is of the same step and just over."""
        under_way = self._open.get((device, step, kind))
        if under_way is not None:
            under_way.pending += 1
            return
        bar = self._last.get(device)
        if bar is None or not _goes_on(bar, step, kind, at_s):
            bar = Bar(device, step, kind, at_s)
            self.bars.append(bar)
        bar.ended_s, bar.pending = None, 1
        self._last[device] = self._open[device, step, kind] = bar

    def _end(self, key: tuple[str, str, Kind], at_s: float, failed: bool = False) -> None:
        bar = self._open.get(key)
        if bar is None:
            return
        bar.pending -= 1
        bar.failed |= failed
        if bar.pending == 0:
            bar.ended_s = at_s
            del self._open[key]

    def _break_off(self, step: str, at_s: float) -> None:
        """A step was broken off: whatever was done for it is over, and did not come to its end."""
        for key, bar in [(key, bar) for key, bar in self._open.items() if bar.step == step]:
            bar.ended_s, bar.failed, bar.pending = at_s, bar.kind == "work", 0
            del self._open[key]


def _goes_on(bar: Bar, step: str, kind: Kind, at_s: float) -> bool:
    is_same = bar.step == step and bar.kind == kind and not bar.failed
    return is_same and bar.ended_s is not None and at_s - bar.ended_s < JOIN_S


def _fitted(bars: list[Bar], last_s: float, most: int, kept: Set[int] = frozenset()) -> list[Bar]:
    """Return bars of which too many are joined where they lie closest, until they fit or each device has one or two.

    Those whose identities are `kept` stay the same objects.
    """
    whole_s = last_s or 1.0
    cell_s = whole_s / CELLS
    while len(bars) > most and cell_s <= 2 * whole_s:
        bars = _joined(bars, cell_s, kept)
        cell_s *= 2
    return bars


def _joined(bars: Iterable[Bar], cell_s: float, kept: Set[int]) -> list[Bar]:
    """Return the bars with those as one that are over, of one device and kind, and lie together within `cell_s`."""
    found: list[Bar] = []
    last: dict[tuple[str, Kind], int] = {}
    for bar in bars:
        key = (bar.device, bar.kind)
        place = None if id(bar) in kept else last.get(key)
        joined = None if place is None else _as_one(found[place], bar, cell_s)
        if id(bar) in kept:
            last.pop(key, None)
            found.append(bar)
        elif place is None or joined is None:
            last[key] = len(found)
            found.append(bar)
        else:
            found[place] = joined
    return found


def _as_one(first: Bar, second: Bar, cell_s: float) -> Bar | None:
    """Return two bars, the second of which began later, as one; None where one goes on, or they are too long for it."""
    if first.ended_s is None or second.ended_s is None:
        return None
    ended_s = max(first.ended_s, second.ended_s)
    if ended_s - first.started_s > cell_s:
        return None
    step = second.step if second.failed and not first.failed else first.step
    failed, count = first.failed or second.failed, first.count + second.count
    return replace(first, step=step, ended_s=ended_s, failed=failed, count=count)

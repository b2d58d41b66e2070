"""Whether what was expected holds in a rehearsal, and what was seen instead, when; pure."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from math import hypot
from typing import Any

from execution.trials.trial import Expectation

BESIDE_M = 1.0
"""Robots that are nearer to a place than this are in it, unless a test says otherwise."""
Result = Mapping[str, Any]
Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Seen:
    """What a rehearsal has left: its result, what machines hold at the end, and where zones and places are."""

    result: Result
    stocks: Mapping[str, Mapping[str, int]]
    zones: Mapping[str, Sequence[Point]]
    places: Mapping[str, Point]
    steps: Mapping[str, str]
    """For each step its number, as people see it."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """Whether an expectation holds; `saw` says what was seen, `t_s` when, if at one time."""

    expected: str
    line: int
    ok: bool
    saw: str
    t_s: float | None = None


def judge(expectation: Expectation, seen: Seen) -> Verdict:
    """Hold an expectation against what was seen."""
    expected, ok, saw, t_s = _JUDGES[expectation.kind](expectation.says, seen)
    return Verdict(expected, expectation.line, ok, saw, t_s)


_Answer = tuple[str, bool, str, float | None]


def _ends_well(says: Any, seen: Seen) -> _Answer:
    if seen.result["ok"]:
        return "ends well", True, _ended(seen), None
    return "ends well", False, *_how_it_failed(seen)


def _fails(says: str, seen: Seen) -> _Answer:
    expected, result = f"fails with “{says}”", seen.result
    if result["ok"]:
        return expected, False, _ended(seen), None
    word = says.casefold()
    for error in result["errors"]:
        if word in error["message"].casefold() or word == error["kind"]:
            return expected, True, _error(error, seen), error["t"]
    return expected, False, *_how_it_failed(seen)


def _within(says: float, seen: Seen) -> _Answer:
    took_s = seen.result["duration_s"]
    return f"ends within {says:g} s", took_s <= says, f"it took {took_s:g} s", None


def _item(says: Mapping[str, Any], seen: Seen) -> _Answer:
    name, where, count = says["object"], says["at"], says.get("count")
    loads = seen.result["carrying"].get(where)
    held = (loads[-1][1] if loads else {}) if loads is not None else seen.stocks.get(where, {})
    has = held.get(name, 0)
    expected = f"{where} holds {'some' if count is None else count} {name} at the end"
    return expected, has > 0 if count is None else has == count, f"it holds {has}", None


def _never_two(says: Mapping[str, Any], seen: Seen) -> _Answer:
    is_in, where = _area(says, seen)
    frames, expected = seen.result["frames"], f"never two robots in {where}"
    robots: Mapping[str, Sequence[Sequence[float]]] = frames["robots"]
    for moment in range(max((len(f) for f in robots.values()), default=0)):
        inside = [r for r, f in robots.items() if moment < len(f) and is_in((f[moment][0], f[moment][1]))]
        for a, b in combinations(inside, 2):
            t_s = round(moment * frames["dt_s"], 1)
            return expected, False, f"{a} and {b} were in it at {t_s:g} s", t_s
    return expected, True, "no two were", None


def _area(says: Mapping[str, Any], seen: Seen) -> tuple[Callable[[Point], bool], str]:
    if "zone" in says:
        corners = seen.zones[says["zone"]]
        return lambda point: _is_inside(point, corners), f"the zone {says['zone']}"
    (x, y), reach_m = seen.places[says["place"]], says.get("within_m", BESIDE_M)
    return lambda point: hypot(point[0] - x, point[1] - y) <= reach_m, f"{reach_m:g} m around {says['place']}"


def _is_inside(point: Point, corners: Sequence[Point]) -> bool:
    """Tell by the even-odd rule whether a point is in a polygon."""
    x, y = point
    is_in = False
    for (ax, ay), (bx, by) in zip(corners, [*corners[1:], corners[0]], strict=True):
        if (ay > y) != (by > y) and x < (bx - ax) * (y - ay) / (by - ay) + ax:
            is_in = not is_in
    return is_in


def _commands(says: Sequence[str], seen: Seen) -> _Answer:
    expected = f"commands in this order: {', '.join(says)}"
    given = [(f"{line['device']}.{line['args']['method']}", line["t"]) for line in seen.result["log"]
             if line["code"] == "command"]  # fmt: skip
    at = 0
    for command, _ in given:
        if at < len(says) and says[at] in {command, command.partition(".")[2]}:
            at += 1
    if at == len(says):
        return expected, True, "they came", None
    after = f" after {says[at - 1]}" if at else ""
    return expected, False, f"{says[at]} did not come{after}", None


def _property(says: Mapping[str, Any], seen: Seen) -> _Answer:
    device, name = says["device"], says["name"]
    word = next(word for word in ("is", "at_least", "at_most") if word in says)
    wanted = says[word]
    expected = f"{device}.{name} {word.replace('_', ' ')} {wanted!s}"
    shown = [(t, v) for t, known, v in seen.result["properties"].get(device, []) if known == name]
    for t_s, value in shown:
        if _fits(word, value, wanted):
            return expected, True, f"it was {value} at {t_s:g} s", t_s
    values = [v for _, v in shown]
    numbers = [v for v in values if isinstance(v, int | float) and not isinstance(v, bool)]
    spread = f"from {min(numbers):g} to {max(numbers):g}" if numbers else ", ".join(dict.fromkeys(map(str, values)))
    return expected, False, f"it was {spread or 'never shown'}", None


def _fits(word: str, value: object, wanted: Any) -> bool:
    if word == "is":
        return value == wanted and isinstance(value, bool) == isinstance(wanted, bool)
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    return bool(value >= wanted if word == "at_least" else value <= wanted)


def _step(says: Mapping[str, Any], seen: Seen) -> _Answer:
    step, times = says["step"], says.get("times")
    begun = [s for s in seen.result["steps"] if s["step"] == step]
    number = seen.steps.get(step, step)
    expected = f"step {number} is carried out{'' if times is None else f' {times} times'}"
    return expected, bool(begun) if times is None else len(begun) == times, f"it was, {len(begun)} times", None


_JUDGES: Mapping[str, Callable[[Any, Seen], _Answer]] = {
    "ends": _ends_well, "fails": _fails, "within_s": _within, "item": _item, "never_two_in": _never_two,
    "commands": _commands, "property": _property, "step": _step,
}  # fmt: skip


def _ended(seen: Seen) -> str:
    return f"it ended well after {seen.result['duration_s']:g} s"


def _how_it_failed(seen: Seen) -> tuple[str, float | None]:
    result = seen.result
    if result["collisions"]:
        touch = result["collisions"][0]
        return f"{touch['a']} touched {touch['b']} at {touch['t']:g} s", touch["t"]
    if not result["errors"]:
        return f"it did not end well, after {result['duration_s']:g} s", None
    return _error(result["errors"][-1], seen), result["errors"][-1]["t"]


def _error(error: Mapping[str, Any], seen: Seen) -> str:
    step = error["step"]
    return f"at {error['t']:g} s, step {seen.steps.get(step, step) or 'none'}: {error['message']}"

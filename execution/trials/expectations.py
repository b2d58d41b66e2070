"""Whether what was expected holds in a rehearsal, and what was seen instead, when; pure."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations
from math import hypot
from typing import Any

from execution.trials.trial import Expectation

BESIDE_M = 1.0
"""Robots that are nearer to a place than this are in it, unless a test says otherwise."""
STOPPED = frozenset({"too_long", "too_much", "too_slow"})
"""Codes of the errors that say of a rehearsal that it was stopped, since it had not ended."""
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
class Saw:
    """What was seen: an English sentence, what it is made of (`code`, `args`), when, and the figure, if it is one."""

    sentence: str
    code: str
    args: Mapping[str, Any] = field(default_factory=dict)
    t_s: float | None = None
    figure: float | None = None


@dataclass(frozen=True, slots=True)
class Verdict:
    """Whether an expectation holds; `saw` says what was seen, `t_s` when, if at one time.

    Screens make sentences of their own: of `kind` and `says` what was expected, of `seen` (a code and what it is made
    of) what was seen. `figure` is what was measured: seconds, pieces, rounds or the reading that came nearest.
    """

    expected: str
    line: int
    ok: bool
    saw: str
    t_s: float | None = None
    figure: float | None = None
    kind: str = ""
    says: Mapping[str, Any] = field(default_factory=dict)
    seen: Mapping[str, Any] = field(default_factory=dict)


def judge(expectation: Expectation, seen: Seen) -> Verdict:
    """Hold an expectation against what was seen."""
    expected, says, ok, saw = _JUDGES[expectation.kind](expectation.says, seen)
    told = {"code": saw.code, **saw.args}
    return Verdict(expected, expectation.line, ok, saw.sentence, saw.t_s, saw.figure, expectation.kind, says, told)


_Answer = tuple[str, Mapping[str, Any], bool, Saw]
"""What was expected, what that sentence is made of, whether it holds, and what was seen."""


def _ends_well(says: Any, seen: Seen) -> _Answer:
    ok = bool(seen.result["ok"])
    return "ends well", {}, ok, _ended(seen) if ok else _how_it_failed(seen)


def _fails(says: str, seen: Seen) -> _Answer:
    expected, result, made_of = f"fails with “{says}”", seen.result, {"word": says}
    if result["ok"]:
        return expected, made_of, False, _ended(seen)
    word = says.casefold()
    for error in result["errors"]:
        if word in error["message"].casefold() or word == error["kind"]:
            return expected, made_of, True, _error(error, seen)
    return expected, made_of, False, _how_it_failed(seen)


def _within(says: float, seen: Seen) -> _Answer:
    expected, made_of, took_s = f"ends within {says:g} s", {"most_s": says}, seen.result["duration_s"]
    stopped = next((error for error in seen.result["errors"] if error.get("code") in STOPPED), None)
    if stopped is not None:
        return expected, made_of, False, _error(stopped, seen)
    saw = Saw(f"it took {took_s:g} s", "took", {"t_s": took_s}, figure=took_s)
    return expected, made_of, took_s <= says, saw


def _item(says: Mapping[str, Any], seen: Seen) -> _Answer:
    name, where, count = says["object"], says["at"], says.get("count")
    loads = seen.result["carrying"].get(where)
    held = (loads[-1][1] if loads else {}) if loads is not None else seen.stocks.get(where, {})
    has = held.get(name, 0)
    expected = f"{where} holds {'some' if count is None else count} {name} at the end"
    saw = Saw(f"it holds {has}", "holds", {"held": has}, figure=has)
    return expected, dict(says), has > 0 if count is None else has == count, saw


def _never_two(says: Mapping[str, Any], seen: Seen) -> _Answer:
    is_in, where = _area(says, seen)
    frames, expected, made_of = seen.result["frames"], f"never two robots in {where}", {"within_m": BESIDE_M, **says}
    robots: Mapping[str, Sequence[Sequence[float]]] = frames["robots"]
    for moment in range(max((len(f) for f in robots.values()), default=0)):
        inside = [r for r, f in robots.items() if moment < len(f) and is_in((f[moment][0], f[moment][1]))]
        for a, b in combinations(inside, 2):
            t_s = round(moment * frames["dt_s"], 1)
            saw = Saw(f"{a} and {b} were in it at {t_s:g} s", "two_were", {"a": a, "b": b, "t_s": t_s}, t_s)
            return expected, made_of, False, saw
    return expected, made_of, True, Saw("no two were", "never_met")


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
    expected, made_of = f"commands in this order: {', '.join(says)}", {"commands": list(says)}
    given = [(f"{line['device']}.{line['args']['method']}", line["t"]) for line in seen.result["log"]
             if line["code"] == "command"]  # fmt: skip
    at = 0
    for command, _ in given:
        if at < len(says) and says[at] in {command, command.rpartition(".")[2]}:
            at += 1
    if at == len(says):
        return expected, made_of, True, Saw("they came", "came")
    if not at:
        return expected, made_of, False, Saw(f"{says[0]} did not come", "not_come", {"command": says[0]})
    missing = {"command": says[at], "after": says[at - 1]}
    return expected, made_of, False, Saw(f"{says[at]} did not come after {says[at - 1]}", "not_come_after", missing)


def _property(says: Mapping[str, Any], seen: Seen) -> _Answer:
    device, name = says["device"], says["name"]
    word = next(word for word in ("is", "at_least", "at_most") if word in says)
    wanted = says[word]
    expected = f"{device}.{name} {word.replace('_', ' ')} {wanted!s}"
    made_of = {"device": device, "name": name, "word": word, "value": wanted}
    shown = [(t, v) for t, known, v in seen.result["properties"].get(device, []) if known == name]
    values = [v for _, v in shown]
    numbers = [v for v in values if isinstance(v, int | float) and not isinstance(v, bool)]
    nearest = None if word == "is" or not numbers else max(numbers) if word == "at_least" else min(numbers)
    for t_s, value in shown:
        if _fits(word, value, wanted):
            saw = Saw(f"it was {value} at {t_s:g} s", "was_at", {"value": value, "t_s": t_s}, t_s, nearest)
            return expected, made_of, True, saw
    return expected, made_of, False, _shown(values, numbers, nearest)


def _shown(values: Sequence[Any], numbers: Sequence[float], nearest: float | None) -> Saw:
    """Say what a property was, none of which was what was expected."""
    if numbers:
        least, most = min(numbers), max(numbers)
        return Saw(f"it was from {least:g} to {most:g}", "was_from", {"least": least, "most": most}, figure=nearest)
    if not values:
        return Saw("it was never shown", "never_shown")
    listed = ", ".join(dict.fromkeys(map(str, values)))
    return Saw(f"it was {listed}", "was", {"values": listed[:200]})


def _fits(word: str, value: object, wanted: Any) -> bool:
    if word == "is":
        return value == wanted and isinstance(value, bool) == isinstance(wanted, bool)
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    return bool(value >= wanted if word == "at_least" else value <= wanted)


def _step(says: Mapping[str, Any], seen: Seen) -> _Answer:
    step, times = says["step"], says.get("times")
    begun = len([s for s in seen.result["steps"] if s["step"] == step])
    number = seen.steps.get(step, step)
    expected = f"step {number} is carried out{'' if times is None else f' {times} times'}"
    saw = Saw(f"it was, {begun} times", "times", {"times": begun}, figure=begun)
    return expected, {**says, "number": number}, begun > 0 if times is None else begun == times, saw


_JUDGES: Mapping[str, Callable[[Any, Seen], _Answer]] = {
    "ends": _ends_well, "fails": _fails, "within_s": _within, "item": _item, "never_two_in": _never_two,
    "commands": _commands, "property": _property, "step": _step,
}  # fmt: skip


def _ended(seen: Seen) -> Saw:
    took_s = seen.result["duration_s"]
    return Saw(f"it ended well after {took_s:g} s", "ended_well", {"t_s": took_s})


def _how_it_failed(seen: Seen) -> Saw:
    result = seen.result
    if result["collisions"]:
        touch = result["collisions"][0]
        a, b, t_s = touch["a"], touch["b"], touch["t"]
        return Saw(f"{a} touched {b} at {t_s:g} s", "touched", {"a": a, "b": b, "t_s": t_s}, t_s)
    if not result["errors"]:
        took_s = result["duration_s"]
        return Saw(f"it did not end well, after {took_s:g} s", "not_well", {"t_s": took_s})
    return _error(result["errors"][-1], seen)


def _error(error: Mapping[str, Any], seen: Seen) -> Saw:
    t_s, message = error["t"], error["message"]
    number = seen.steps.get(error["step"], error["step"])
    sentence = f"at {t_s:g} s, step {number or 'none'}: {message}"
    return Saw(sentence, "error", {"t_s": t_s, "number": number, "message": message[:300]}, t_s)

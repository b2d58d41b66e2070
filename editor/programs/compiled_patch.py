"""What of a compiled program is another than before: little enough to go to every browser at each edit.

Both forms are JSON as docs/shapes/compiled.md has it; the patch is described there, too, and browsers apply it in
`frontend/src/program/compiledPatch.ts`. Pure.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from vipo_device.protocol.errors import VipoError

Json = dict[str, Any]
Hunk = tuple[int, int, list[Any]]
"""At this place of what was, so many items go, and these come."""
Shift = tuple[str, int, int]
"""Numbers with this beginning, followed by this count or a higher one, are counted so much further."""
_LOOK_AHEAD, _MOST_HUNKS, _MOST_SHIFTS = 40, 64, 4
_LISTS = ("lines", "order", "added_moves")


class OtherBase(VipoError):
    """A patch begins from another form than the one that is here."""

    code = "other_base"
    status = 409


def make_patch(before: Mapping[str, Any], after: Mapping[str, Any]) -> Json:
    """Return what makes `before` into `after`; what is not named in it stays."""
    patch: Json = {"base": before["revision"], "revision": after["revision"]}
    lists = {name: (before[name], after[name]) for name in _LISTS}
    lists["script"] = (before["script"].split("\n"), after["script"].split("\n"))
    lists["diagnostics"] = (_without_lines(before["diagnostics"]), _without_lines(after["diagnostics"]))
    for name, (old, new) in lists.items():
        if old != new:
            patch[name] = hunks_between(old, new)
    if (where := _lines_of(after)) != _lines_of(before):
        patch["diagnostic_lines"] = where
    if before["numbers"] != after["numbers"] or before["order"] != after["order"]:
        shifts = _shifts_between(before["numbers"], after["numbers"])
        patch["shifts"] = shifts
        patch["numbers"] = _changes(_shifted_all(before["numbers"], shifts), after["numbers"])
    if before["depth"] != after["depth"] or before["order"] != after["order"]:
        patch["depth"] = _changes(before["depth"], after["depth"])
    return patch


def apply_patch(before: Mapping[str, Any], patch: Mapping[str, Any]) -> Json:
    """Return what a patch makes of `before`, which stays as it is. Raises OtherBase."""
    if patch["base"] != before["revision"]:
        raise OtherBase(f"The change begins from {patch['base']}; {before['revision']} is here.")
    after: Json = {**before, "revision": patch["revision"]}
    for name in _LISTS:
        if name in patch:
            after[name] = _spliced(before[name], patch[name])
    if "script" in patch:
        after["script"] = "\n".join(_spliced(before["script"].split("\n"), patch["script"]))
    if "diagnostics" in patch or "diagnostic_lines" in patch:
        found = _spliced(_without_lines(before["diagnostics"]), patch.get("diagnostics", ()))
        where = patch.get("diagnostic_lines", _lines_of(before))
        after["diagnostics"] = [{**each, "line": line} for each, line in zip(found, where, strict=True)]
    if "numbers" in patch:
        numbers = _shifted_all(before["numbers"], patch["shifts"])
        after["numbers"] = _in_order(_changed(numbers, patch["numbers"]), after["order"])
    if "depth" in patch:
        after["depth"] = _in_order(_changed(before["depth"], patch["depth"]), after["order"])
    return after


def hunks_between(old: Sequence[Any], new: Sequence[Any]) -> list[Hunk]:
    """Return hunks that make `old` into `new`: short, not always the shortest; in proportion to their length."""
    head = _common(old, new)
    tail = _common(old[: head - len(old) - 1 : -1], new[: head - len(new) - 1 : -1])
    old_end, new_end = len(old) - tail, len(new) - tail
    hunks: list[Hunk] = []
    i = j = head
    while i < old_end or j < new_end:
        a, b = (old_end, new_end) if len(hunks) == _MOST_HUNKS else _next_meeting(old, new, (i, j), (old_end, new_end))
        hunks.append((i, a - i, list(new[j:b])))
        i, j = a, b
        while i < old_end and j < new_end and old[i] == new[j]:
            i, j = i + 1, j + 1
    return hunks


def _common(old: Sequence[Any], new: Sequence[Any]) -> int:
    """Return how many items both begin with alike: by halves, since whole stretches are compared quickly."""
    least, most = 0, min(len(old), len(new))
    while least < most:
        middle = (least + most + 1) // 2
        if old[least:middle] == new[least:middle]:
            least = middle
        else:
            most = middle - 1
    return least


def _next_meeting(
    old: Sequence[Any], new: Sequence[Any], start: tuple[int, int], end: tuple[int, int]
) -> tuple[int, int]:
    """Return where both go on alike for two items, not far from where they part; else their ends."""
    (i, j), (old_end, new_end) = start, end
    for further in range(1, _LOOK_AHEAD):
        for a in range(i, min(i + further, old_end) + 1):
            b = j + further - (a - i)
            if b <= new_end and old[a : min(a + 2, old_end)] == new[b : min(b + 2, new_end)]:
                return a, b
    return old_end, new_end


def _spliced(items: Sequence[Any], hunks: Sequence[Sequence[Any]]) -> list[Any]:
    made: list[Any] = []
    at = 0
    for start, gone, come in hunks:
        made += items[at:start]
        made += come
        at = start + gone
    made += items[at:]
    return made


def _without_lines(diagnostics: Sequence[Mapping[str, Any]]) -> list[Json]:
    return [{name: value for name, value in each.items() if name != "line"} for each in diagnostics]


def _lines_of(compiled: Mapping[str, Any]) -> list[int | None]:
    return [each["line"] for each in compiled["diagnostics"]]


def _changes(old: Mapping[str, Any], new: Mapping[str, Any]) -> Json:
    """Return what is new or another, and null for what is gone."""
    return {
        **{key: value for key, value in new.items() if old.get(key) != value},
        **{key: None for key in old if key not in new},
    }


def _changed(old: Mapping[str, Any], changes: Mapping[str, Any]) -> Json:
    return {key: value for key, value in {**old, **changes}.items() if value is not None}


def _in_order(values: Mapping[str, Any], order: Sequence[str]) -> Json:
    return {key: values[key] for key in order if key in values}


def _shifts_between(old: Mapping[str, str], new: Mapping[str, str]) -> list[Shift]:
    """Return shifts that explain most of the numbers that are others: one step more moves all behind it."""
    shifts: list[Shift] = []
    moved: Mapping[str, str] = {step: number for step, number in old.items() if step in new}
    wrong = [step for step, number in moved.items() if number != new[step]]
    while len(wrong) > 1 and len(shifts) < _MOST_SHIFTS:
        shift = _shift_from(moved[wrong[0]], new[wrong[0]])
        tried = _shifted_all(moved, [shift]) if shift else moved
        still = [step for step, number in tried.items() if number != new[step]]
        if shift is None or len(still) >= len(wrong):
            break
        shifts.append(shift)
        moved, wrong = tried, still
    return shifts


def _shift_from(old: str, new: str) -> Shift | None:
    """Return the shift that makes one number into another, if there is one: 4b.2 to 4b.3 is ("4b.", 2, 1)."""
    head = _common(old, new)
    while head and old[head - 1].isdigit():
        head -= 1
    before, after = _count(old, head), _count(new, head)
    return None if before is None or after is None else (old[:head], before, after - before)


def _count(number: str, at: int) -> int | None:
    end = at
    while end < len(number) and number[end].isdigit():
        end += 1
    return int(number[at:end]) if end > at else None


def _shifted_all(numbers: Mapping[str, str], shifts: Sequence[Sequence[Any]]) -> Mapping[str, str]:
    for prefix, start, by in shifts:
        numbers = {step: _shifted(number, prefix, start, by) for step, number in numbers.items()}
    return numbers


def _shifted(number: str, prefix: str, start: int, by: int) -> str:
    if not number.startswith(prefix):
        return number
    count = _count(number, len(prefix))
    if count is None or count < start:
        return number
    return f"{prefix}{count + by}{number[len(prefix) + len(str(count)) :]}"

"""Two documents compared by construct: what was added, removed, changed or moved, and what was only tidied. Pure."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final, Literal

from editor.language.comparison.changes import ABSENT, STEPS, ValueChange, find_changes, is_same
from editor.language.constructs.table import COMMENT
from editor.language.document.fractional_index import longest_rise
from editor.language.document.outline import EVENTS, PROGRAM, Outline, kind_of, make_outline, mapping

Kind = Literal["added", "removed", "changed", "moved"]
Name = tuple[str, str]
"""A construct: the root that it stands in, and its id."""
START: Final[Name] = ("program", "start_pos")
_DRAWN: Final = ((STEPS, "pos"), (STEPS, "params", "route"))
"""Where a chip stands and how its line bends; the path of a change without the step's id."""
_FIELDS_AT: Final = {STEPS: "params"}


@dataclass(frozen=True, slots=True)
class ConstructChange:
    """What happened to a construct; `changes` has its fields, of one that was added or removed all that it has.

    `is_moved` also of a changed one that has another place in the order.
    """

    root: str
    id: str
    kind: Kind
    changes: tuple[ValueChange, ...]
    is_moved: bool = False


@dataclass(frozen=True, slots=True)
class Difference:
    """Two documents compared: the constructs that differ and those that were only tidied, in reading order.

    `changes` is all of it, value by value: applied to the old document they give the new one. `same` is how many steps
    are in both and do the same.
    """

    changes: tuple[ValueChange, ...]
    constructs: tuple[ConstructChange, ...]
    tidied: tuple[ConstructChange, ...]
    same: int


def compare(old: Mapping[str, Any], new: Mapping[str, Any]) -> Difference:
    """Compare two documents of today's format, whatever stands in them."""
    return _Comparison(old, new).difference()


def name_of(path: tuple[str, ...]) -> Name:
    """Return the construct that a change at a path belongs to."""
    return (path[0], path[1]) if len(path) > 1 else ("program", path[0])


class _Comparison:
    def __init__(self, old: Mapping[str, Any], new: Mapping[str, Any]) -> None:
        self._old, self._new = old, new
        self._before, self._after = make_outline(old), make_outline(new)

    def difference(self) -> Difference:
        by_construct: dict[Name, list[ValueChange]] = {}
        changes = find_changes(self._old, self._new)
        for change in changes:
            by_construct.setdefault(name_of(change.path), []).append(change)
        for step in sorted(self._moved):
            by_construct.setdefault((STEPS, step), [])
        found = [self._of(name, changes) for name, changes in self._sorted(by_construct)]
        differing = tuple(each for each, is_tidy in found if not is_tidy)
        touched = {each.id for each in differing if each.root == STEPS}
        same = [step for step in self._after.kinds if step in self._before.kinds and step not in touched]
        return Difference(changes, differing, tuple(each for each, is_tidy in found if is_tidy), len(same))

    def _of(self, name: Name, changes: list[ValueChange]) -> tuple[ConstructChange, bool]:
        """Return what happened to a construct, and whether it was only tidied."""
        root, key = name
        whole = next((change for change in changes if change.path == name), None)
        if whole is not None and (whole.old is ABSENT or whole.new is ABSENT):
            kind: Kind = "added" if whole.old is ABSENT else "removed"
            body = whole.new if whole.old is ABSENT else whole.old
            fields = tuple(_fields_of(name, body, is_new=whole.old is ABSENT))
            return ConstructChange(root, key, kind, fields), self._is_comment(name)
        is_moved = root == STEPS and key in self._moved
        telling = [change for change in changes if not self._is_drawing(change)]
        if (not telling and not is_moved) or self._is_comment(name):
            return ConstructChange(root, key, "changed", tuple(changes)), True
        places = [change for change in changes if _is_place(change) and is_moved]
        kind = "changed" if telling else "moved"
        return ConstructChange(root, key, kind, (*telling, *places), is_moved), False

    def _is_drawing(self, change: ValueChange) -> bool:
        """Tell whether a change shows on the map alone; a place that is no other in the order is one of them."""
        without_id = (change.path[0], *change.path[2:])
        return without_id in _DRAWN or _is_place(change) or name_of(change.path) == START

    def _is_comment(self, name: Name) -> bool:
        root, key = name
        sides = [mapping(mapping(side.get(root)).get(key)) for side in (self._old, self._new)]
        return root == STEPS and {kind_of(side) for side in sides if side} == {COMMENT}

    @cached_property
    def _moved(self) -> frozenset[str]:
        """The steps of both that have another place in the order: another parent, branch, or side of a brother."""
        before, after = _spots(self._before), _spots(self._after)
        common = self._before.kinds.keys() & self._after.kinds.keys()
        moved = {step for step in common if before.get(step, (None, 0))[0] != after.get(step, (None, 0))[0]}
        for branch, steps in self._after.children.items():
            stayed = [step for step in steps if step in common and before.get(step, (None, 0))[0] == branch]
            moved |= self._passed({step: before[step][1] for step in stayed})
        return frozenset(moved)

    def _passed(self, stood: Mapping[str, int]) -> set[str]:
        """Return those of a branch that went past others; they are given in their new order, each with its old one.

        Whose place was not written anew has not moved; of the others as few as explain the new order have.
        """
        still = [
            at for step, at in stood.items() if is_same(self._place(self._old, step), self._place(self._new, step))
        ]
        kept_at = set(still)
        between: list[str] = []
        moved: set[str] = set()
        passed = 0
        for step, at in stood.items():
            if at in kept_at:
                passed += 1
            elif bisect_left(still, at) == passed:
                between.append(step)
            else:
                moved.add(step)
        kept = longest_rise([(stood[step],) for step in between])
        return moved | {step for at, step in enumerate(between) if at not in kept}

    @staticmethod
    def _place(document: Mapping[str, Any], step: str) -> object:
        return mapping(mapping(document.get(STEPS)).get(step)).get("place")

    def _sorted(self, by_construct: dict[Name, list[ValueChange]]) -> list[tuple[Name, list[ValueChange]]]:
        """Steps in reading order, what is gone where it stood; then the rest by root and id."""
        new = {step: (at, 0) for at, step in enumerate(_reading(self._new, self._after))}
        places: dict[str, tuple[int, int]] = dict(new)
        last = (-1, 0)
        for step in _reading(self._old, self._before):
            last = new.get(step, (last[0], last[1] + 1))
            places.setdefault(step, last)
        end = (len(new), 0)
        return sorted(
            by_construct.items(),
            key=lambda item: (
                item[0][0] != STEPS,
                places.get(item[0][1], end) if item[0][0] == STEPS else end,
                item[0],
            ),
        )


def _is_place(change: ValueChange) -> bool:
    return change.path[0] == STEPS and change.path[2:] == ("place",)


def _fields_of(name: Name, body: object, *, is_new: bool) -> Iterator[ValueChange]:
    """Yield the fields of a construct that is there on one side alone."""
    root, key = name
    inner = _FIELDS_AT.get(root)
    fields = mapping(mapping(body).get(inner)) if inner else mapping(body)
    above = (root, key, inner) if inner else (root, key)
    for field, value in fields.items():
        sides = (ABSENT, value) if is_new else (value, ABSENT)
        yield ValueChange((*above, field), *sides)


def _spots(outline: Outline) -> dict[str, tuple[tuple[str, str], int]]:
    """Return for each step that stands in the program its branch and where in it."""
    return {step: (branch, at) for branch, steps in outline.children.items() for at, step in enumerate(steps)}


def _reading(document: Mapping[str, Any], outline: Outline) -> list[str]:
    """Return the steps in reading order: a function's at its first call, drafts last."""
    functions = list(mapping(document.get("functions")))
    read: dict[str, None] = {}
    roots = [(PROGRAM, "body"), (PROGRAM, EVENTS), *[(function, "body") for function in functions]]
    left = [step for root in reversed(roots) for step in reversed(outline.children.get(root, ()))]
    left[:0] = reversed(outline.drafts)
    while left:
        step = left.pop()
        if step in read:
            continue
        read[step] = None
        inner = [(step, branch) for branch in outline.branches(step)] if step in outline.kinds else []
        called = outline.params[step].get("function") if outline.kinds.get(step) == "call" else None
        into = [(called, "body")] if isinstance(called, str) and called in functions else []
        left.extend(
            child for branch in reversed([*inner, *into]) for child in reversed(outline.children.get(branch, ()))
        )
    return list(read)

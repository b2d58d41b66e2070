"""What is another in one document than in another, value by value. Pure.

The law: applying `find_changes(a, b)` to `a` gives `b`, whatever stands in them; their reverse gives `a` again.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Any, Final

Json = dict[str, Any]
Path = tuple[str, ...]
STEPS: Final = "steps"
ROOTS: Final = (STEPS, "functions", "roles", "parameters", "zones")


class Absent(Enum):
    """Where nothing stands, as against null."""

    ABSENT = "absent"


ABSENT: Final = Absent.ABSENT


class BadChange(ValueError):
    """What was sent is no change of a document."""


@dataclass(frozen=True, slots=True)
class ValueChange:
    """At this place of a document stands `new` instead of `old`; ABSENT is where nothing stood, or stands."""

    path: Path
    old: object
    new: object

    def reversed(self) -> ValueChange:
        """Return what takes it back."""
        return ValueChange(self.path, self.new, self.old)


def find_changes(old: Mapping[str, Any], new: Mapping[str, Any]) -> tuple[ValueChange, ...]:
    """Return what makes one document of another: whole constructs that come or go, single fields of the others."""
    return tuple(_changes((), old, new))


def _changes(path: Path, old: Mapping[str, Any], new: Mapping[str, Any]) -> Iterator[ValueChange]:
    for name in dict.fromkeys((*old, *new)):
        before, after = old.get(name, ABSENT), new.get(name, ABSENT)
        if before is after:
            continue
        here = (*path, name)
        if isinstance(before, Mapping) and isinstance(after, Mapping) and _has_parts(here):
            yield from _changes(here, before, after)
        elif not is_same(before, after):
            yield ValueChange(here, before, after)


def _has_parts(path: Path) -> bool:
    """Tell whether what stands there is compared part by part: roots, constructs, parameters and arguments of a step.

    What a parameter holds is one value: a place, or an operator with what it is applied to.
    """
    if path[0] not in ROOTS:
        return False
    if len(path) <= 2:
        return True
    return path[0] == STEPS and path[2] == "params" and (len(path) == 3 or path[3:] == ("args",))


def is_same(one: object, other: object) -> bool:
    """Tell whether two values of a document are the same; 1 and true are not, for Python alone they are."""
    if one.__class__ is not other.__class__:
        numbers = (int, float)
        return one.__class__ in numbers and other.__class__ in numbers and one == other
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(is_same(value, other[name]) for name, value in one.items())
    if isinstance(one, list | tuple) and isinstance(other, list | tuple):
        return len(one) == len(other) and all(map(is_same, one, other))
    return one == other


def apply_changes(document: Mapping[str, Any], changes: Iterable[ValueChange]) -> Json:
    """Return the document with the changes that were found in it; the document itself stays as it is."""
    return _Rewriting(document).applied(changes)


@dataclass(frozen=True, slots=True)
class Applied:
    """A document with changes in it: those that fitted, and those that were left out as somebody was there before."""

    document: Json
    applied: tuple[ValueChange, ...]
    skipped: tuple[ValueChange, ...]


def apply_where_same(document: Mapping[str, Any], changes: Sequence[ValueChange]) -> Applied:
    """Apply the changes whose `old` is what still stands there; the others are skipped."""
    fitting: list[ValueChange] = []
    skipped: list[ValueChange] = []
    for change in changes:
        fits = is_same(_value_at(document, change.path), change.old)
        (fitting if fits else skipped).append(change)
    return Applied(apply_changes(document, fitting), tuple(fitting), tuple(skipped))


def _value_at(document: Mapping[str, Any], path: Path) -> object:
    here: object = document
    for name in path:
        if not isinstance(here, Mapping):
            return ABSENT
        here = here.get(name, ABSENT)
    return here


class _Rewriting:
    """A document that is written anew where it changes; the rest is shared with the one before."""

    def __init__(self, document: Mapping[str, Any]) -> None:
        self._made: Json = dict(document)
        self._own: dict[Path, Json] = {(): self._made}

    def applied(self, changes: Iterable[ValueChange]) -> Json:
        for change in changes:
            parent = self._part(change.path[:-1])
            if parent is None:
                continue
            if change.new is ABSENT:
                parent.pop(change.path[-1], None)
            else:
                parent[change.path[-1]] = change.new
        return self._made

    def _part(self, path: Path) -> Json | None:
        """Return the object at a path, which may be written to; None where there is none."""
        known = self._own.get(path)
        if known is not None:
            return known
        above = self._part(path[:-1])
        part = None if above is None else above.get(path[-1])
        if above is None or not isinstance(part, Mapping):
            return None
        made = self._own[path] = dict(part)
        above[path[-1]] = made
        return made


def change_to_json(change: ValueChange) -> Json:
    """Return {path, old?, new?}; what is absent is left out."""
    sides = {"old": change.old, "new": change.new}
    return {"path": list(change.path), **{name: value for name, value in sides.items() if value is not ABSENT}}


def read_change(form: Mapping[str, Any]) -> ValueChange:
    """Return the change that `change_to_json` wrote."""
    return ValueChange(tuple(form["path"]), form.get("old", ABSENT), form.get("new", ABSENT))


def check_change(change: ValueChange) -> ValueChange:
    """Return a change that was sent if it is one of a construct, or of where the program starts. Raises BadChange."""
    path = change.path
    if not path or not all(isinstance(name, str) and name for name in path):
        raise BadChange('A change has a path: a list of names that are not empty, such as ["steps", "s1"].')
    if path != ("start_pos",) and (path[0] not in ROOTS or len(path) == 1):
        raise BadChange(f"A change is of start_pos, or of something in {', '.join(ROOTS)}.")
    return change

"""What is restored of an earlier document, and what that needs besides. Pure.

To restore a construct is to make it what it was. If it stood in a step that is gone, that step is needed; if it calls a
function that is gone, that function; and so on, until nothing is missing that was there.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Set
from dataclasses import dataclass
from typing import Any

from editor.language.comparison.changes import ABSENT, STEPS, Path, ValueChange, apply_changes, find_changes
from editor.language.comparison.difference import Name, name_of
from editor.language.document.outline import PROGRAM, make_outline, mapping, place_of

_NAMES: Mapping[str, str] = {"role": "roles", "zone": "zones", "param": "parameters", "function": "functions"}
"""Where the values of a step name something else that is drawn: the key, and the root of what it names."""


@dataclass(frozen=True, slots=True)
class Restoring:
    """The changes that restore what was wanted, and the constructs that have to be restored with it."""

    changes: tuple[ValueChange, ...]
    needs: tuple[Name, ...]


def restore_all(now: Mapping[str, Any], then: Mapping[str, Any]) -> Restoring:
    """Return what makes the document of now what it was then."""
    return Restoring(find_changes(now, then), ())


def restore_some(
    now: Mapping[str, Any], then: Mapping[str, Any], wanted: Collection[Name], fields: Collection[Path] = ()
) -> Restoring:
    """Return what restores these constructs, and single fields of others, with all that they need."""
    return _Restore(now, then, frozenset(wanted), frozenset(fields)).restoring()


class _Restore:
    def __init__(
        self, now: Mapping[str, Any], then: Mapping[str, Any], wanted: frozenset[Name], fields: frozenset[Path]
    ) -> None:
        self._now, self._then, self._wanted, self._fields = now, then, wanted, fields
        self._changes = find_changes(now, then)
        self._differing = {name_of(change.path) for change in self._changes}

    def restoring(self) -> Restoring:
        taken: dict[Name, None] = dict.fromkeys(sorted(self._wanted))
        while True:
            changes = [each for each in self._changes if name_of(each.path) in taken or each.path in self._fields]
            missing = [name for name in self._needed(changes, taken) if name not in taken]
            if not missing:
                return Restoring(tuple(changes), tuple(name for name in taken if name not in self._wanted))
            taken.update(dict.fromkeys(missing))

    def _needed(self, changes: list[ValueChange], taken: Collection[Name]) -> Iterator[Name]:
        """Yield the constructs without which these changes leave something without what it had."""
        made = apply_changes(self._now, changes)
        touched = {*taken, *(name_of(change.path) for change in changes)}
        whole = [change for change in changes if change.path == name_of(change.path)]
        back = {name_of(each.path) for each in whole if each.old is ABSENT}
        gone = {name_of(each.path) for each in whole if each.new is ABSENT}
        for name in self._named_by(made, touched):
            if not _holds(made, name) and name in self._differing:
                yield name
        yield from self._left_behind(made, gone)
        yield from self._inner_of(back)
        yield from self._circling(made)

    def _named_by(self, made: Mapping[str, Any], touched: Collection[Name]) -> Iterator[Name]:
        for root, key in sorted(touched):
            body = mapping(mapping(made.get(root)).get(key))
            if root == STEPS:
                yield from _stands_in(body)
            yield from _names_in(body)

    def _left_behind(self, made: Mapping[str, Any], gone: Set[Name]) -> Iterator[Name]:
        """Yield what still names a construct that goes."""
        if not gone:
            return
        for root in (STEPS, "functions", "roles"):
            for key, body in mapping(made.get(root)).items():
                named = [*_names_in(mapping(body)), *(_stands_in(mapping(body)) if root == STEPS else ())]
                if (root, key) in self._differing and not gone.isdisjoint(named):
                    yield root, key

    def _inner_of(self, back: Set[Name]) -> Iterator[Name]:
        """Yield the steps that stood in what comes back and are gone as well."""
        steps = mapping(self._now.get(STEPS))
        for step, body in mapping(self._then.get(STEPS)).items():
            if back and step not in steps and not back.isdisjoint(_stands_in(mapping(body))):
                yield STEPS, step

    def _circling(self, made: Mapping[str, Any]) -> Iterator[Name]:
        """Yield the steps above one that would stand nowhere: in itself, or in what takes no steps any more."""
        outline = make_outline(made)
        known = {*make_outline(self._now).drafts, *make_outline(self._then).drafts}
        for step in outline.drafts:
            here: str | None = None if step in known else step
            seen: set[str] = set()
            while here is not None and here not in seen:
                seen.add(here)
                if (STEPS, here) in self._differing:
                    yield STEPS, here
                place = place_of(mapping(mapping(made.get(STEPS)).get(here)).get("place"))
                here = place[0] if place else None


def _holds(document: Mapping[str, Any], name: Name) -> bool:
    return name[1] in mapping(document.get(name[0]))


def _stands_in(step: Mapping[str, Any]) -> Iterator[Name]:
    """Yield what a step's place names: a step or a function."""
    place = place_of(step.get("place"))
    if place is not None and place[0] != PROGRAM:
        yield STEPS, place[0]
        yield "functions", place[0]


def _names_in(value: object) -> Iterator[Name]:
    """Yield what values name: roles, zones, parameters, functions."""
    left = [value]
    while left:
        here = left.pop()
        if isinstance(here, Mapping):
            for key, inner in here.items():
                if isinstance(inner, str) and key in _NAMES:
                    yield _NAMES[key], inner
            left.extend(here.values())
        elif isinstance(here, list | tuple):
            left.extend(here)

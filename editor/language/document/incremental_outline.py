"""The outline of a document that is being edited: only the steps that changed find their places anew."""

from __future__ import annotations

from bisect import insort
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final

from editor.language.document.outline import (
    BRANCHES,
    DEEPEST_STEP,
    Outline,
    Params,
    Place,
    branches_of,
    kind_of,
    leads_on,
    make_outline,
    mapping,
    place_of,
)

_ABSENT: Final = object()
Children = Mapping[tuple[str, str], tuple[str, ...]]


@dataclass(slots=True)
class LastOutline:
    """The outline of a document as it was last, with what it was made of."""

    outline: Outline | None = None
    steps: Params = field(default_factory=dict)
    functions: frozenset[str] = frozenset()

    def look(self, document: object) -> Outline:
        """Return the outline of the document as it is now."""
        whole = mapping(document)
        steps, functions = mapping(whole.get("steps")), frozenset(mapping(whole.get("functions")))
        after: Outline | None = None
        if self.outline is not None and functions == self.functions:
            after = _Change(self.outline, self.steps, steps, functions).outline()
        self.outline = make_outline(whole) if after is None else after
        self.steps, self.functions = steps, functions
        return self.outline


class _MoreChanged(Exception):
    """Other steps than those that changed may stand elsewhere now."""


@dataclass(slots=True)
class _Move:
    """A step that is new, gone or elsewhere."""

    step: str
    before: Place | None
    after: Place | None


@dataclass(slots=True)
class _Change:
    """What an edit did to an outline."""

    before: Outline
    old: Params
    steps: Params
    functions: frozenset[str]
    kinds: dict[str, str] = field(default_factory=dict)
    params: dict[str, Params] = field(default_factory=dict)

    def outline(self) -> Outline | None:
        """Return the outline behind the edit; None where it must be made from the whole document."""
        before, old = self.before, self.old
        changed = [name for name, step in self.steps.items() if step is not old.get(name, _ABSENT)]
        gone = [name for name in old if name not in self.steps]
        if before.too_deep:
            return None
        self.kinds, self.params = {**before.kinds}, {**before.params}
        try:
            moves = [*map(self._taken_away, gone), *filter(None, map(self._changed, changed))]
            self._check_places(changed, moves)
        except _MoreChanged:
            return None
        children = _moved(before.children, moves, self.steps) if moves else before.children
        return Outline(self.kinds, self.params, children, before.drafts, before.too_deep, before.unknown)

    def _taken_away(self, step: str) -> _Move:
        self._must_be_placed(step)
        if self._holds(step):
            raise _MoreChanged
        del self.kinds[step], self.params[step]
        return _Move(step, self._place(step, self.old), None)

    def _changed(self, step: str) -> _Move | None:
        """Read a step that is new or changed; return where it stands now, if it stood elsewhere."""
        body = mapping(self.steps[step])
        kind, place = kind_of(body), place_of(body.get("place"))
        if kind not in BRANCHES or place is None or not step:
            raise _MoreChanged
        self.kinds[step], self.params[step] = kind, mapping(body.get("params"))
        if step not in self.old:
            return _Move(step, None, place)
        self._must_be_placed(step)
        stood = self._place(step, self.old)
        if self._holds(step) and (stood is None or stood[:2] != place[:2] or self._has_other_branches(step)):
            raise _MoreChanged
        return None if stood == place else _Move(step, stood, place)

    def _must_be_placed(self, step: str) -> None:
        if step not in self.before.kinds or step in self.before.drafts:
            raise _MoreChanged

    def _holds(self, step: str) -> bool:
        return any((step, branch) in self.before.children for branch in self.before.branches(step))

    def _has_other_branches(self, step: str) -> bool:
        return branches_of(self.kinds[step], self.params[step]) != self.before.branches(step)

    def _check_places(self, changed: Iterable[str], moves: Iterable[_Move]) -> None:
        """Check that what changed stands somewhere, not in itself and not too deep, and that drafts stay drafts."""
        if not all(self._leads_on(step) for step in changed) or any(map(self._leads_on, self.before.drafts)):
            raise _MoreChanged
        for move in moves:
            above = enumerate(self._above(move.step)) if move.after is not None else ()
            if any(parent == move.step or count + 1 >= DEEPEST_STEP for count, parent in above):
                raise _MoreChanged

    def _leads_on(self, step: str) -> bool:
        place = self._place(step, self.steps)
        return place is not None and leads_on(step, place, self.kinds, self.params, self.functions)

    def _above(self, step: str) -> Iterator[str]:
        """Yield the steps that a step stands in, the innermost first."""
        place = self._place(step, self.steps)
        while place is not None and place[0] in self.kinds:
            yield place[0]
            place = self._place(place[0], self.steps)

    def _place(self, step: str, steps: Params) -> Place | None:
        return place_of(mapping(steps[step]).get("place"))


def _moved(before: Children, moves: Iterable[_Move], steps: Params) -> Children:
    """Return who stands in which branch when these steps have moved."""
    children = dict(before)
    for move in moves:
        if move.before is not None:
            key = move.before[:2]
            children[key] = tuple(step for step in children[key] if step != move.step)
    for move in moves:
        if move.after is not None:
            members = [*children.get(move.after[:2], ())]
            insort(members, move.step, key=lambda step: _order(step, steps))
            children[move.after[:2]] = tuple(members)
    return {key: members for key, members in children.items() if members}


def _order(step: str, steps: Params) -> tuple[str, str]:
    place = place_of(mapping(steps[step]).get("place"))
    return (place[2] if place else ""), step

"""What an earlier look at a program found of its nodes, so that the next look only follows what has changed.

A node that was read again from the same step is the same object, with all that stands in it; what a pass found
of it holds as long as the pass comes to it with the same knowledge.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeVar

from editor.language.document.incremental_outline import LastOutline
from editor.language.document.outline import Outline
from editor.language.messages.diagnostics import Problem
from editor.language.tree.nodes import Node

Key = TypeVar("Key")
Findings = tuple[tuple[Problem, int], ...]
"""Problems that were reported of nodes, each with its node's identity."""


@dataclass(slots=True)
class Memo:
    """What one pass found. Entries hold their nodes, so that no other object takes over their identity."""

    _context: object = None
    _last: dict[int, tuple[Node, object, Any]] = field(default_factory=dict)
    _now: dict[int, tuple[Node, object, Any]] = field(default_factory=dict)

    def begin(self, context: object) -> None:
        """Begin a look; what the last one had no use for is forgotten, and everything where the context differs."""
        same = context == self._context
        self._context, self._last, self._now = context, self._now if same else {}, {}

    def get(self, node: Node, given: object = None) -> Any:
        """Return what was found of this very node when as much was given; None where nothing is known."""
        key = id(node)
        entry = self._last.get(key)
        if entry is None or entry[1] != given:
            return None
        self._now[key] = entry
        return entry[2]

    def put(self, node: Node, found: object, given: object = None) -> None:
        """Keep what was found of a node."""
        self._now[id(node)] = (node, given, found)


@dataclass(frozen=True, slots=True)
class StepRead:
    """The nodes of a step, what could not be read in it, and the names that could be seen there."""

    nodes: tuple[Node, ...]
    problems: tuple[Problem, ...]
    names: Mapping[str, str]


@dataclass(slots=True)
class ReadMemo:
    """The steps of a document as they were read last."""

    last: LastOutline = field(default_factory=LastOutline)
    outline: Outline | None = None
    steps: dict[str, StepRead] = field(default_factory=dict)
    _context: object = None

    def begin(self, outline: Outline, context: object) -> None:
        """Begin a look; the steps that changed are forgotten, with all that they stand in."""
        if self.outline is None or context != self._context:
            self.steps.clear()
        else:
            for step in _changed(self.outline, outline):
                self.steps.pop(step, None)
        self.outline, self._context = outline, context


def _changed(before: Outline, after: Outline) -> set[str]:
    """Return the steps that are gone or read otherwise, with the steps around them."""
    others = [step for step, params in after.params.items() if params is not before.params.get(step)]
    changed = {step for step in others if not _same(before.params.get(step), after.params[step])}
    changed.update(_differing(before.kinds, after.kinds))
    changed.update(parent for parent, _ in _differing(before.children, after.children))
    parents = {child: parent for (parent, _), steps in after.children.items() for child in steps}
    for step in tuple(changed):
        around = parents.get(step)
        while around is not None and around not in changed:
            changed.add(around)
            around = parents.get(around)
    return changed


def _differing(before: Mapping[Key, object], after: Mapping[Key, object]) -> Iterator[Key]:
    """Yield the keys under which two mappings do not hold the same."""
    if before is not after and before != after:
        yield from (key for key, value in after.items() if before.get(key) is not value and before.get(key) != value)
        yield from (key for key in before if key not in after)


def _same(before: object, after: object) -> bool:
    """Tell whether parameters say the same; 1 and True are equal in Python, and not here."""
    return before is after or (before == after and repr(before) == repr(after))


@dataclass(slots=True)
class Memos:
    """What all passes over one program found."""

    read: ReadMemo = field(default_factory=ReadMemo)
    positions: Memo = field(default_factory=Memo)
    paths: Memo = field(default_factory=Memo)
    printed: Memo = field(default_factory=Memo)
    uses: Memo = field(default_factory=Memo)
    _around: object = None
    _last: dict[str, Memo] = field(default_factory=dict)
    _blocks: dict[str, Memo] = field(default_factory=dict)

    def begin_checks(self, around: object) -> None:
        """Begin to check the steps for themselves, with this around them."""
        self._last = self._blocks if around == self._around else {}
        self._around, self._blocks = around, {}

    def of_block(self, name: str, context: object) -> Memo:
        """Return what was found of the steps of the program's body, of an event's or of a function's."""
        known = self._blocks.setdefault(name, self._last.get(name) or Memo())
        known.begin(context)
        return known

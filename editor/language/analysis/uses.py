"""What the steps of a program look at: variables, and roles whose robots' places are asked for; and what they set."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from editor.language.analysis.memo import Memo
from editor.language.expressions.nodes import Constant, Located, Variable
from editor.language.expressions.values import parts_of
from editor.language.tree import nodes as n
from editor.language.tree.program import Tree
from editor.language.tree.variables import set_by, worked_out


@dataclass(slots=True)
class Uses:
    """By the identity of the step, the names that it uses, each with the field where it does."""

    reads: dict[int, Mapping[str, str]] = field(default_factory=dict)
    asks: dict[int, Mapping[str, str]] = field(default_factory=dict)
    """The roles of whose robots it is asked where they are, or how far."""
    sets: set[str] = field(default_factory=set)
    """The variables that any step sets."""

    def add(self, other: Uses) -> None:
        """Take in what other steps use."""
        self.reads.update(other.reads)
        self.asks.update(other.asks)
        self.sets.update(other.sets)


def uses_of(tree: Tree, memo: Memo | None) -> Uses:
    """Return what the program's steps use; of a step that is the same as at the last look, `memo` knows it."""
    blocks = (tree.body, *(event.body for event in tree.events), *(f.body for f in tree.functions))
    if memo is not None:
        memo.begin(None)
        return _of_blocks(blocks, memo)
    uses = Uses()
    for block in blocks:
        for node in n.walk(block):
            _note(node, uses)
    return uses


def _of_blocks(blocks: tuple[n.Block, ...], memo: Memo) -> Uses:
    uses = Uses()
    for block in blocks:
        for node in block:
            found: Uses | None = memo.get(node)
            if found is None:
                found = _of_step(node, memo)
                memo.put(node, found)
            if found is not _NOTHING:
                uses.add(found)
    return uses if uses != _NOTHING else _NOTHING


def _of_step(node: n.Node, memo: Memo) -> Uses:
    inner = _of_blocks(n.blocks_of(node), memo) if node.__class__ in n.COMPOSITES else _NOTHING
    uses = Uses() if inner is _NOTHING else inner
    _note(node, uses)
    return uses if inner is not _NOTHING or uses != _NOTHING else _NOTHING


def _note(node: n.Node, uses: Uses) -> None:
    """Add what a step itself uses, without the steps in it."""
    reads: dict[str, str] = {}
    asks: dict[str, str] = {}
    for field_name, value in worked_out(node):
        if isinstance(value, Constant):
            continue
        for part in parts_of(value):
            if isinstance(part, Variable):
                reads.setdefault(part.name, field_name)
            elif isinstance(part, Located) and part.role is not None:
                asks[part.role] = field_name
    if reads:
        uses.reads[id(node)] = reads
    if asks:
        uses.asks[id(node)] = asks
    if name := set_by(node):
        uses.sets.add(name)


_NOTHING = Uses()

"""Which nodes are one step: a move belongs to the pick or drop behind it, a pick to a drop of the same load."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from editor.language.plan.instructions import PlaceRef
from editor.language.tree import nodes as n

Drawable = n.Node | n.Event


def grouped(block: Sequence[Drawable]) -> Iterator[tuple[Drawable, ...]]:
    """Yield the nodes of each step; nodes that bear a step's id stand together as long as they make one step."""
    index = 0
    while index < len(block):
        length = _length_by_id(block[index:]) or natural_length(block[index:])
        yield tuple(block[index : index + length])
        index += length


def _length_by_id(rest: Sequence[Drawable]) -> int:
    """Return how many nodes have the first one's id; 0 when it has none, or when they are no step together."""
    step = rest[0].step
    if not step:
        return 0
    length = next((index for index, node in enumerate(rest) if node.step != step), len(rest))
    return length if length == 1 or natural_length(rest[:length]) == length else 0


def natural_length(rest: Sequence[Drawable]) -> int:
    """Return how many nodes the first step has, going by what they say."""
    start = 1 if isinstance(rest[0], n.Move) and not rest[0].route and _leads_to(rest[0], rest[1:]) else 0
    first, behind = rest[start], rest[start + 1 :]
    if not isinstance(first, n.Pick):
        return start + 1
    if behind and _unloads(first, behind[0], first.at):
        return start + 2
    if len(behind) > 1 and isinstance(behind[0], n.Move) and _leads_to(behind[0], behind[1:]):
        return start + (3 if _unloads(first, behind[1], behind[0].to) else 1)
    return start + 1


def _unloads(pick: n.Pick, drop: Drawable, at: PlaceRef) -> bool:
    if not isinstance(drop, n.Drop) or drop.at != at:
        return False
    return (drop.role, drop.object, drop.quantity) == (pick.role, pick.object, pick.quantity)


def _leads_to(move: n.Move, rest: Sequence[Drawable]) -> bool:
    following = rest[0] if rest else None
    return isinstance(following, n.Pick | n.Drop) and (following.role, following.at) == (move.role, move.to)

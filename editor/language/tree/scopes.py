"""Who sees which variable: those of the program, those of one function, and those of one loop."""

from __future__ import annotations

from collections.abc import Iterator

from editor.language.tree.nodes import Block, ForEach, Function, Tree, blocks_of
from editor.language.tree.variables import SETTERS, set_by


def program_variables(tree: Tree) -> frozenset[str]:
    """Return the variables that the program's body or an event's sets; they can be seen everywhere."""
    if not tree.holds(*SETTERS):
        return frozenset()
    bodies = (tree.body, *(event.body for event in tree.events))
    return frozenset(name for body in bodies for name in _set_in(body, frozenset()))


def local_variables(function: Function, shared: frozenset[str]) -> tuple[str, ...]:
    """Return the variables that belong to one call of a function, in the order of first use.

    `shared` are the variables of the program.
    """
    own = frozenset(parameter.name for parameter in function.parameters)
    names = dict.fromkeys(_set_in(function.body, frozenset()))
    return tuple(name for name in names if name not in shared and name not in own)


def _set_in(block: Block, loops: frozenset[str]) -> Iterator[str]:
    """Yield the names that a block sets, without those of the loops that they stand in."""
    for node in block:
        name = set_by(node)
        if name and name not in loops:
            yield name
        inside = loops | {node.variable} if isinstance(node, ForEach) else loops
        for inner in blocks_of(node):
            yield from _set_in(inner, inside)

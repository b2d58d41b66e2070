"""What a block may change when it is carried out, also in part: variables, where robots stand, what they carry."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from editor.language.tree import nodes as n
from editor.language.tree.program import Function, Tree
from editor.language.tree.traversal import callees_first, functions_in_circles
from editor.language.tree.variables import SETTERS, local_variables, read_by, set_by

Names = frozenset[str]
NO_NAMES: Names = frozenset()


@dataclass(frozen=True, slots=True)
class Effects:
    """What may change: names as they are seen from the block, the program's by calls, and roles."""

    names: Names = NO_NAMES
    shared: Names = NO_NAMES
    """Variables of the program that called functions set, whatever the same names mean in the block."""
    moved: Names = NO_NAMES
    """Roles whose robots go somewhere else by a Move or a Cover."""
    loaded: Names = NO_NAMES
    """Roles whose robots take or leave something, and go there before in a program that is drawn."""
    released: Names = NO_NAMES
    """Roles that give their robots back."""
    used: Names = NO_NAMES
    """Roles whose robots do anything."""
    reads: Names = NO_NAMES
    """Variables that are read: not an effect, but what one depends on."""
    calls: bool = False

    def __or__(self, other: Effects) -> Effects:
        return Effects(
            self.names | other.names,
            self.shared | other.shared,
            self.moved | other.moved,
            self.loaded | other.loaded,
            self.released | other.released,
            self.used | other.used,
            self.reads | other.reads,
            self.calls or other.calls,
        )


NOTHING = Effects()
_IDLE = frozenset(n.NODES.values()) - n.COMPOSITES - {*n.OF_ROBOTS, n.Call, *SETTERS}
"""Steps that change nothing of all that."""


def together(effects: Iterable[Effects]) -> Effects:
    """Return what changes when any of these happen."""
    whole, last = NOTHING, NOTHING
    for each in effects:
        if each is not last and each is not NOTHING:
            last, whole = each, each if whole is NOTHING else whole | each
    return whole


@dataclass(slots=True)
class EffectTable:
    """The effects of a tree's blocks and functions, each worked out once."""

    tree: Tree
    own: dict[str, frozenset[str]] = field(default_factory=dict)
    """Function → its parameters and the variables that belong to one call of it."""
    functions: dict[str, Effects] = field(default_factory=dict)
    """Function → what a call of it may change outside of it, and what of the outside it reads."""
    _blocks: dict[int, Effects] = field(default_factory=dict)
    _kept: dict[tuple[str, type[n.Node]], Effects] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if not self.tree.functions:
            return
        for function in self.tree.functions:
            names = (parameter.name for parameter in function.parameters)
            self.own[function.method] = frozenset((*names, *local_variables(self.tree, function)))
            self.functions[function.method] = NOTHING
        order = callees_first(self.tree)
        read = {function.method: _read_in(self.tree, function.body) for function in order}
        while self._grow(order, read) and functions_in_circles(self.tree):
            self._blocks.clear()

    def _grow(self, order: tuple[Function, ...], read: Mapping[str, Names]) -> bool:
        """Work out the effects of the functions once more; tell whether one of them changes more than was known."""
        again = False
        for function in order:
            inside, own = self.of(function.body), self.own[function.method]
            names = inside.shared | (inside.names - own)
            reads = inside.reads | (read[function.method] - own)
            found = Effects(NO_NAMES, names, inside.moved, inside.loaded, inside.released, inside.used, reads)
            again = again or found != self.functions[function.method]
            self.functions[function.method] = found
        return again

    def of(self, block: n.Block) -> Effects:
        """Return what a block of the tree may change."""
        if not block:
            return NOTHING
        found = self._blocks.get(id(block))
        if found is None:
            found = self._blocks[id(block)] = together(
                self.of_node(node) for node in block if node.__class__ not in _IDLE
            )
        return found

    def of_node(self, node: n.Node) -> Effects:
        """Return what one step may change, with all that stands in it."""
        kind = node.__class__
        if kind in n.COMPOSITES:
            return together(self.of(inner) for inner in n.blocks_of(node))
        if isinstance(node, n.OF_ROBOTS):
            return self._of_robot(node.role, kind)
        if isinstance(node, n.Call):
            result = frozenset({node.result}) if node.result else NO_NAMES
            return self.functions.get(node.function, NOTHING) | Effects(result, calls=True)
        name = set_by(node)
        return Effects(frozenset({name})) if name else NOTHING

    def _of_robot(self, role: str, kind: type[n.Node]) -> Effects:
        found = self._kept.get((role, kind))
        if found is None:
            roles = frozenset({role})
            found = Effects(
                moved=roles if kind in {n.Move, n.Cover, n.Release} else NO_NAMES,
                loaded=roles if kind in {n.Pick, n.Drop, n.Release} else NO_NAMES,
                released=roles if kind is n.Release else NO_NAMES,
                used=roles if kind is not n.Release else NO_NAMES,
            )
            self._kept[role, kind] = found
        return found


def _read_in(tree: Tree, block: n.Block) -> Names:
    return frozenset(name for node in tree.walked(block) for name in read_by(node))

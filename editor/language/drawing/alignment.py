"""Which steps of a new tree are those of the tree before: what stayed, moved or changed a value keeps its id.

Block by block: first what is the same in the same order, then what is the same elsewhere, then, in the gaps that
are left, what is of the same kind in the same order; and so on inward.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from difflib import SequenceMatcher
from typing import Any, get_args

from editor.language.drawing.steps import Drawable, natural_length
from editor.language.tree import nodes as n
from editor.language.tree.program import Function, Role, Tree

_LARGEST_TABLE = 250_000
_CLASSES: tuple[Any, ...] = (*get_args(n.Node), n.Event)
_OWN_FIELDS = {
    kind: tuple(f.name for f in fields(kind) if f.compare and "Block" not in str(f.type)) for kind in _CLASSES
} | {n.Try: ("kinds",)}
_Blocks = tuple[tuple[Drawable, ...], ...]


@dataclass(frozen=True, slots=True)
class Renamed:
    """Roles and functions of the new tree, with their names in the tree before."""

    roles: Mapping[str, str]
    functions: Mapping[str, str]


@dataclass(eq=False, slots=True)
class _Unit:
    """What will be drawn as one step, or was printed as if it were."""

    nodes: tuple[Drawable, ...]
    kind: str
    own: str
    """What it says itself, without what stands in it."""
    deep: str
    blocks: list[list[_Unit]]
    partner: _Unit | None = None


_SAMENESS: tuple[Callable[[_Unit], str], ...] = (lambda unit: unit.deep, lambda unit: unit.own)


def align(tree: Tree, before: Tree) -> Tree:
    """Return the tree with the ids of steps, functions and roles that the tree before has, too."""
    renamed = Renamed(_same_roles(tree, before), _same_functions(tree, before))
    former = {function.method: function for function in before.functions}
    pairs = [(tree.body, before.body), (tree.events, before.events)]
    for function in tree.functions:
        old = former.get(renamed.functions.get(function.method, ""))
        pairs.append((function.body, old.body if old else ()))
    missed = former.keys() - set(renamed.functions.values())
    aligner = _Aligner()
    units = [(_units(new, renamed), _units(old, None)) for new, old in pairs]
    lost = [unit for method in sorted(missed) for unit in _units(former[method].body, None)]
    aligner.run(units, lost)
    known = frozenset(_ids([before.body, before.events, *(function.body for function in before.functions)]))
    body, events, *bodies = (_with_ids(new, known) for new, _ in units)
    functions = [_function(f, block, former, renamed) for f, block in zip(tree.functions, bodies, strict=True)]
    roles = [_role(role, before, renamed) for role in tree.roles]
    return replace(tree, body=body, events=events, functions=tuple(functions), roles=tuple(roles))


def _function(function: Function, body: n.Block, former: Mapping[str, Function], renamed: Renamed) -> Function:
    old = former.get(renamed.functions.get(function.method, ""))
    return replace(function, body=body, id=old.id if old else "")


def _role(role: Role, before: Tree, renamed: Renamed) -> Role:
    old = next((item for item in before.roles if item.name == renamed.roles.get(role.name)), None)
    return replace(role, id=old.id if old else "")


@dataclass(slots=True)
class _Aligner:
    """The pairs of blocks met so far."""

    blocks: list[tuple[list[_Unit], list[_Unit]]] = field(default_factory=list)

    def run(self, pairs: Sequence[tuple[list[_Unit], list[_Unit]]], lost: list[_Unit]) -> None:
        """Pair all that can be paired; `lost` are steps of blocks that are no more."""
        for news, olds in pairs:
            self.same(news, olds)
        every_new = [unit for news, _ in pairs for unit in news]
        every_old = [*(unit for _, olds in pairs for unit in olds), *lost]
        self.elsewhere(every_new, every_old)
        for news, olds in self.blocks:  # grows while it is walked
            self.changed(news, olds)
        self.elsewhere(every_new, every_old)

    def same(self, news: list[_Unit], olds: list[_Unit]) -> None:
        """Pair what is the same, in the same order; whole steps before steps with other things in them."""
        self.blocks.append((news, olds))
        self._in_order(news, olds, lambda unit: unit.deep)
        for some_new, some_old in _gaps(news, olds):
            self._in_order(some_new, some_old, lambda unit: unit.own)

    def elsewhere(self, news: list[_Unit], olds: list[_Unit]) -> None:
        """Pair what is the same wherever it stands."""
        for key in _SAMENESS:
            left: dict[str, list[_Unit]] = defaultdict(list)
            for old in _all_units(olds):
                left[key(old)].append(old)
            for new in _all_units(news):
                candidates = [old for old in left.get(key(new), ()) if old.partner is None]
                if new.partner is None and candidates:
                    self._take(new, candidates[0])

    def changed(self, news: list[_Unit], olds: list[_Unit]) -> None:
        """Pair steps of the same kind in the gaps between those that are paired."""
        for some_new, some_old in _gaps(news, olds):
            self._in_order(some_new, some_old, lambda unit: unit.kind)

    def _in_order(self, news: list[_Unit], olds: list[_Unit], key: Callable[[_Unit], str]) -> None:
        free_new = [unit for unit in news if unit.partner is None]
        free_old = [unit for unit in olds if unit.partner is None]
        for i, j in common_row([key(unit) for unit in free_new], [key(unit) for unit in free_old]):
            self._take(free_new[i], free_old[j])

    def _take(self, new: _Unit, old: _Unit) -> None:
        new.partner, old.partner = old, new
        for inner, former in zip(new.blocks, old.blocks, strict=False):
            self.same(inner, former)


def _gaps(news: list[_Unit], olds: list[_Unit]) -> Iterator[tuple[list[_Unit], list[_Unit]]]:
    """Yield what lies between the pairs of two blocks, as far as those stand in the same order."""
    places = {id(unit): index for index, unit in enumerate(olds)}
    start_new = start_old = 0
    for index, unit in enumerate(news):
        place = places.get(id(unit.partner), -1)
        if place >= start_old:
            yield news[start_new:index], olds[start_old:place]
            start_new, start_old = index + 1, place + 1
    yield news[start_new:], olds[start_old:]


def common_row(first: Sequence[str], second: Sequence[str]) -> list[tuple[int, int]]:
    """Return the places of a longest common row of two sequences (not quite the longest in very large ones)."""
    start, end = 0, 0
    while start < min(len(first), len(second)) and first[start] == second[start]:
        start += 1
    while end < min(len(first), len(second)) - start and first[-1 - end] == second[-1 - end]:
        end += 1
    head = [(index, index) for index in range(start)]
    tail = [(len(first) - index, len(second) - index) for index in range(end, 0, -1)]
    a, b = first[start : len(first) - end], second[start : len(second) - end]
    return [*head, *((i + start, j + start) for i, j in _common_middle(a, b)), *tail]


def _common_middle(a: Sequence[str], b: Sequence[str]) -> list[tuple[int, int]]:
    if not a or not b:
        return []
    if len(a) * len(b) > _LARGEST_TABLE:
        blocks = SequenceMatcher(None, a, b, autojunk=False).get_matching_blocks()
        return [(block.a + index, block.b + index) for block in blocks for index in range(block.size)]
    longest = [[0] * (len(b) + 1) for _ in range(len(a) + 1)]
    for i in reversed(range(len(a))):
        for j in reversed(range(len(b))):
            same = longest[i + 1][j + 1] + 1 if a[i] == b[j] else 0
            longest[i][j] = same or max(longest[i + 1][j], longest[i][j + 1])
    i = j = 0
    row: list[tuple[int, int]] = []
    while i < len(a) and j < len(b):
        if a[i] == b[j]:
            row.append((i, j))
            i, j = i + 1, j + 1
        elif longest[i + 1][j] >= longest[i][j + 1]:
            i += 1
        else:
            j += 1
    return row


def _units(block: Sequence[Drawable], renamed: Renamed | None) -> list[_Unit]:
    units: list[_Unit] = []
    index = 0
    while index < len(block):
        length = natural_length(block[index:])
        units.append(_unit(tuple(block[index : index + length]), renamed))
        index += length
    return units


def _unit(nodes: tuple[Drawable, ...], renamed: Renamed | None) -> _Unit:
    loads = [node for node in nodes if isinstance(node, n.Pick | n.Drop)]
    kind = "+".join(type(node).__name__ for node in loads or nodes).removesuffix("Until")
    telling = [node for node in nodes if not loads or node in loads or _has_route(node)]
    own = "\n".join(_own(node, renamed) for node in telling)
    blocks = [_units(inner, renamed) for inner in _blocks_in(nodes[0])]
    inside = "".join(f"\n[{'|'.join(unit.deep for unit in units)}]" for units in blocks)
    return _Unit(nodes, kind, own, own + inside, blocks)


def _has_route(node: Drawable) -> bool:
    return isinstance(node, n.Move) and bool(node.route)


def _own(node: Drawable, renamed: Renamed | None) -> str:
    """Return what a node says itself, in the words of the tree before."""
    values = {name: getattr(node, name) for name in _OWN_FIELDS[type(node)]}
    if renamed is not None and "role" in values:
        values["role"] = renamed.roles.get(values["role"], values["role"])
    if renamed is not None and "function" in values:
        values["function"] = renamed.functions.get(values["function"], values["function"])
    return f"{type(node).__name__}{values!r}"


def _blocks_in(node: Drawable) -> _Blocks:
    """Return the blocks that a node holds; those of which it has any number come last."""
    match node:
        case n.Event():
            return (node.body,)
        case n.Try():
            return (node.body, node.final, *node.catches)
    return n.blocks_of(node)


def _all_units(units: Sequence[_Unit]) -> Iterator[_Unit]:
    for unit in units:
        yield unit
        for inner in unit.blocks:
            yield from _all_units(inner)


def _ids(blocks: Sequence[Sequence[Drawable]]) -> Iterator[str]:
    for block in blocks:
        for node in block:
            yield node.step
            yield from _ids(_blocks_in(node))


def _with_ids(units: Sequence[_Unit], known: frozenset[str]) -> tuple[Any, ...]:
    """Return the nodes of a block with their ids; an id of its own that a node brings stays, if nobody else has it."""
    nodes: list[Any] = []
    for unit in units:
        ids = _ids_of(unit)
        for node in unit.nodes:
            own = "" if node.step in known else node.step
            nodes.append(replace(_inner(node, unit, known), step=ids.get(_slot(node, unit), own)))
    return tuple(nodes)


def _inner(node: Any, unit: _Unit, known: frozenset[str]) -> Any:
    """Return a node with ids in all that it holds."""
    blocks = tuple(_with_ids(units, known) for units in unit.blocks)
    match node:
        case n.Event():
            return replace(node, body=blocks[0])
        case n.Try():
            body, final, *caught = blocks
            return n.with_blocks(node, (body, *caught, final))
    return n.with_blocks(node, blocks) if blocks else node


def _ids_of(unit: _Unit) -> dict[str, str]:
    """Return the ids for the parts of a unit; a move that was not there before goes with what it leads to."""
    old = unit.partner
    if old is None:
        return {}
    ids = {_slot(node, old): node.step for node in old.nodes}
    for move, goal in (("way to Pick", "Pick"), ("way to Drop", "Drop")):
        if goal in ids:
            ids.setdefault(move, ids[goal])
    return ids


def _slot(node: Drawable, unit: _Unit) -> str:
    """Return which part of its unit a node is."""
    if not isinstance(node, n.Move) or len(unit.nodes) == 1:
        return type(node).__name__ if isinstance(node, n.Pick | n.Drop) else "all"
    place = next(index for index, other in enumerate(unit.nodes) if other is node)
    return f"way to {type(unit.nodes[place + 1]).__name__}"


def _same_roles(tree: Tree, before: Tree) -> dict[str, str]:
    """Return the roles with their former names: the same name, else the same robot, else the only one left."""
    former = {role.name: role for role in before.roles}
    pairs = {role.name: role.name for role in tree.roles if role.name in former}
    new = [role for role in tree.roles if role.name not in pairs]
    old = [role for role in before.roles if role.name not in pairs]
    for role in new:
        alike = [other for other in old if (other.device, other.can) == (role.device, role.can)]
        found = alike[0] if alike else old[0] if len(new) == len(old) == 1 else None
        if found is not None:
            pairs[role.name] = found.name
            old.remove(found)
    return pairs


def _same_functions(tree: Tree, before: Tree) -> dict[str, str]:
    """Return the functions with their former names: the same name, else the body that has most in common."""
    former = {function.method: function for function in before.functions}
    pairs = {function.method: function.method for function in tree.functions if function.method in former}
    new = [function for function in tree.functions if function.method not in pairs]
    old = [function for function in before.functions if function.method not in pairs]
    for function in new:
        likeness = [(_likeness(function, other), -index) for index, other in enumerate(old)]
        best, place = max(likeness, default=(0, 0))
        if best > 0:
            pairs[function.method] = old.pop(-place).method
    return pairs


def _likeness(function: Function, other: Function) -> int:
    """Return how many steps two functions have in common."""
    said = [unit.own for unit in _all_units(_units(other.body, None))]
    count = 0
    for unit in _all_units(_units(function.body, None)):
        if unit.own in said:
            said.remove(unit.own)
            count += 1
    return count

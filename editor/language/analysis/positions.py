"""Where each robot stands, followed along the steps: the moves that are missing are put in.

The script says no place beside a pick or a drop: they happen where the robot went last. So the same walk also
gives the picks and drops of a parsed script their places.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field, replace
from typing import Final

from editor.language.analysis.effects import EffectTable
from editor.language.analysis.memo import Memo
from editor.language.expressions.nodes import NOWHERE, PlaceRef, Variable
from editor.language.tree.nodes import (
    LOADS,
    Ask,
    Block,
    Break,
    Call,
    Continue,
    Cover,
    Drop,
    End,
    Fail,
    ForEach,
    If,
    Limit,
    Move,
    Node,
    Notify,
    Operate,
    Parallel,
    Perform,
    Pick,
    Release,
    Repeat,
    Return,
    Set,
    Try,
    Wait,
    WaitUntil,
    While,
    walk,
    with_blocks,
)
from editor.language.tree.program import Function, Role, Tree
from editor.language.tree.traversal import callees_first, functions_in_circles
from editor.language.tree.variables import set_in, sets_of_functions

Standing = dict[str, PlaceRef]
"""Role → where its robot stands; a role that is not in it may stand anywhere."""


_Composite = If | While | Repeat | ForEach | Parallel | Try | Limit
_COMPOSITE: Final = (If, While, Repeat, ForEach, Parallel, Try, Limit)
_SETS: Final = (Set, Ask)
_STAYING: Final = frozenset({Operate, Perform, Wait, WaitUntil, Notify})
"""Steps after which all robots stand as before."""
_LEAVES: Final = (End, Fail, Return, Break, Continue)


@dataclass(frozen=True, slots=True)
class _Found:
    """A step with its moves, where robots stand after it, and where it relies on their standing at the beginning."""

    node: Node
    after: Standing | None
    relied_on: Mapping[str, str]


@dataclass(slots=True)
class _Follower:
    """The walk over one tree; `from_script` is True for a parsed script, whose picks get the place of their robot.

    Where a block is never left at its end, what stands after it is None.
    """

    moved: Mapping[str, frozenset[str]]
    """Function → the roles whose robot it moves."""
    sets: Mapping[str, frozenset[str]]
    circular: frozenset[str]
    from_script: bool
    initial: Standing
    relied_on: dict[str, str] = field(default_factory=dict)
    """Roles whose place at the beginning matters, with that place."""
    unplaced: list[Pick | Drop] = field(default_factory=list)
    """Picks and drops of a script before which no move is known."""
    exits: dict[str, Standing] = field(default_factory=dict)
    breaks: list[list[Standing]] = field(default_factory=list)
    """For each loop around, innermost last, where the robots stand at the steps that leave it, or one of its rounds."""
    returns: list[Standing] = field(default_factory=list)
    memo: Memo | None = None
    calls: int = 0

    def block(self, block: Block, standing: Standing) -> tuple[Block, Standing | None]:
        """Return the block with its moves, and where the robots stand after it."""
        nodes: list[Node] = []
        ends = False
        for node in block:
            if node.__class__ in _STAYING:
                nodes.append(node)
            elif isinstance(node, Move):
                standing = {**standing, node.role: node.to}
                nodes.append(node)
            elif isinstance(node, LOADS):
                standing = self._load(node, standing, nodes)
            elif isinstance(node, Cover | Release):
                standing = _without(standing, frozenset({node.role}))
                nodes.append(node)
            elif isinstance(node, Call):
                standing = _without_values(self._call(node, standing), {node.result})
                nodes.append(node)
            elif isinstance(node, _SETS):
                standing = _without_values(standing, {node.variable})
                nodes.append(node)
            elif isinstance(node, _COMPOSITE):
                inner, after = self._followed(node, standing)
                ends, standing = ends or after is None, after or {}
                nodes.append(inner)
            else:
                nodes.append(node)
                if isinstance(node, _LEAVES):
                    self._leave(node, standing)
                    ends, standing = True, {}
        return tuple(nodes), None if ends else standing

    def _followed(self, node: _Composite, before: Standing) -> tuple[Node, Standing | None]:
        """Follow a step that holds others; what depends on nothing else is remembered."""
        if self.memo is None:
            return self._composite(node, before)
        known: _Found | None = self.memo.get(node, before)
        if known is None:
            outside, self.relied_on = self.relied_on, {}
            exits = self.calls, len(self.returns), len(self.breaks[-1]) if self.breaks else 0
            inner, after = self._composite(node, before)
            known = _Found(inner, after, self.relied_on)
            self.relied_on = outside
            if exits == (self.calls, len(self.returns), len(self.breaks[-1]) if self.breaks else 0):
                self.memo.put(node, known, before)
        self.relied_on.update(known.relied_on)
        return known.node, known.after

    def _leave(self, node: End | Fail | Return | Break | Continue, standing: Standing) -> None:
        if isinstance(node, Return):
            self.returns.append(standing)
        elif isinstance(node, Break | Continue) and self.breaks:
            self.breaks[-1].append(standing)

    def _load(self, node: Pick | Drop, standing: Standing, nodes: list[Node]) -> Standing:
        here = standing.get(node.role)
        if self.from_script:
            self._rely(node.role, here)
            if here is None:
                self.unplaced.append(node)
            place, make = here or NOWHERE, node.__class__
            nodes.append(make(node.role, place, node.object, node.quantity, node.step, node.place_field, node.route))
            return standing
        if here is not None and here == node.at:
            self._rely(node.role, here)
        else:
            nodes.append(Move(node.role, node.at, node.route, node.step, added=True))
            standing = {**standing, node.role: node.at}
        nodes.append(node)
        return standing

    def _rely(self, role: str, here: PlaceRef | None) -> None:
        if here is not None and here.device is not None and here == self.initial.get(role):
            self.relied_on[role] = here.device

    def _composite(self, node: _Composite, before: Standing) -> tuple[Node, Standing | None]:
        match node:
            case If(then=then, otherwise=otherwise):
                first, after_first = self.block(then, before)
                second, after_second = self.block(otherwise, before)
                return If(node.condition, first, second, node.step), _agreed(after_first, after_second)
            case Try():
                return self._try(node, before)
            case Limit(body=body):
                inside, after = self.block(body, before)
                return Limit(node.seconds, inside, node.step), after
            case Parallel(branches=branches):
                followed = [self.block(branch, self._beside(branches, branch, before)) for branch in branches]
                inner = Parallel(tuple(block for block, _ in followed), node.needed, node.step)
                return inner, self._joined(node, followed, before)
        return self._loop(node, before)

    def _loop(self, node: While | Repeat | ForEach, before: Standing) -> tuple[Node, Standing | None]:
        """A loop is left before its body, after it, or by a step in it."""
        self.breaks.append([])
        own = set(node.names) if isinstance(node, ForEach) else set()
        inner, after = self.block(node.body, _without_values(self._after_some_of(node.body, before), own))
        exits = self.breaks.pop()
        over = _agreed(before, after)
        for at_exit in exits:
            over = _agreed(over, at_exit)
        return _with_body(node, inner), None if over is None else _without_values(over, own)

    def _try(self, node: Try, before: Standing) -> tuple[Node, Standing | None]:
        """A catch begins anywhere in the body, the final part anywhere in all of them; it changes every exit."""
        exits = [*self.breaks[-1:], self.returns]
        marks = [len(at_exit) for at_exit in exits]
        body, after = self.block(node.body, before)
        unsure = self._after_some_of(node.body, before)
        caught: list[Block] = []
        some = unsure
        for block in node.catches:
            handler, after_catch = self.block(block, unsure)
            caught.append(handler)
            after, some = _agreed(after, after_catch), self._after_some_of(block, some)
        if not node.final:
            return with_blocks(node, (body, *caught, ())), after
        for at_exit, mark in zip(exits, marks, strict=True):
            at_exit[mark:] = [self._after_some_of(node.final, standing) for standing in at_exit[mark:]]
        final, after_final = self.block(node.final, some)
        whole = with_blocks(node, (body, *caught, final))
        if after is None or after_final is None:
            return whole, None
        movers = self.movers(node.final)
        moved = {role: place for role, place in after_final.items() if role in movers}
        return whole, {**self._after_some_of(node.final, after), **moved}

    def _joined(
        self, node: Parallel, followed: list[tuple[Block, Standing | None]], before: Standing
    ) -> Standing | None:
        """After a Parallel each robot stands where the one branch that moved it left it, if that surely ended.

        Where a branch may have been called off, its robots stand anywhere.
        """
        branches = node.branches
        alive = sum(after is not None for _, after in followed)
        needed = max(node.needed or 0, 0) if node.races else len(branches)
        if alive < needed:
            return None
        movers = [self.movers(branch) for branch in branches]
        result = before
        for branch in branches:
            result = self._after_some_of(branch, result)
        for moved, (_, after) in zip(movers, followed, strict=True):
            if after is None or alive > needed:
                continue
            alone = [role for role in moved if sum(role in others for others in movers) == 1]
            result = {**result, **{role: after[role] for role in alone if role in after}}
        return self._without_set_in(branches, result)

    def _beside(self, branches: tuple[Block, ...], branch: Block, before: Standing) -> Standing:
        return self._without_set_in([other for other in branches if other is not branch], before)

    def _without_set_in(self, blocks: Iterable[Block], standing: Standing) -> Standing:
        if not self._looks_up(standing):
            return standing
        return _without_values(standing, {name for block in blocks for name in set_in(block, self.sets)})

    def _looks_up(self, standing: Standing) -> bool:
        return any(place.value is not None for place in standing.values())

    def _after_some_of(self, block: Block, standing: Standing) -> Standing:
        """Return what is still known when the block was carried out in part."""
        return self._without_set_in([block], _without(standing, self.movers(block)))

    def _call(self, node: Call, standing: Standing) -> Standing:
        """After a call a robot stands where the function leaves it, unless an argument decides that."""
        self.calls += 1
        exits = self.exits.get(node.function, {})
        known = {role: place for role, place in exits.items() if place.value is None}
        kept = _without(standing, self.moved.get(node.function, frozenset()))
        return {**self._without_set_in([(node,)], kept), **known}

    def function(self, function: Function) -> Function:
        """Follow a function's body; where the robots stand when it is called is not known in it."""
        self.returns = []
        body, after = self.block(function.body, {})
        for standing in self.returns:
            after = _agreed(after, standing)
        moved = self.moved[function.method]
        if function.method not in self.circular:
            self.exits[function.method] = {role: place for role, place in (after or {}).items() if role in moved}
        return replace(function, body=body)

    def movers(self, block: Block) -> frozenset[str]:
        """Return the roles whose robot a block moves, also in the functions it calls; a script says every move."""
        roles: set[str] = set()
        for node in walk(block):
            if isinstance(node, Move | Cover | Release) or (isinstance(node, LOADS) and not self.from_script):
                roles.add(node.role)
            elif isinstance(node, Call):
                roles.update(self.moved.get(node.function, ()))
        return frozenset(roles)


def _with_body(node: While | Repeat | ForEach, body: Block) -> Node:
    if isinstance(node, While):
        return While(node.condition, body, node.step)
    return Repeat(node.times, body, node.step) if isinstance(node, Repeat) else replace(node, body=body)


def _without(standing: Standing, roles: frozenset[str]) -> Standing:
    return {role: place for role, place in standing.items() if role not in roles}


def _without_values(standing: Standing, names: AbstractSet[str]) -> Standing:
    """Return what is known when these variables have other values."""
    known = standing.items()
    return {r: p for r, p in known if not isinstance(p.value, Variable) or p.value.name not in names}


def _agreed(first: Standing | None, second: Standing | None) -> Standing | None:
    """Return what holds where two paths meet; one that leads nowhere has no say."""
    if first is None or second is None:
        return second if first is None else first
    return {role: place for role, place in first.items() if second.get(role) == place}


def add_moves(tree: Tree, standing_at: Mapping[str, str], memo: Memo | None = None) -> Tree:
    """Return the tree with the moves that were missing; `standing_at` says where known robots stand (device ids).

    `memo` has what was found at the last look.
    """
    initial = {
        role.name: PlaceRef(device=standing_at[role.device])
        for role in tree.roles
        if role.device is not None and role.device in standing_at
    }
    return _follow(tree, initial, memo, from_script=False)[0]


def place_loads(tree: Tree, standing_at: Mapping[str, str]) -> tuple[Tree, tuple[Pick | Drop, ...]]:
    """Return the tree of a parsed script with the places of its picks and drops, and those without a place.

    Where the script does not say where a robot begins, it begins where it is known to stand.
    """
    begins = {role.name: role.at or standing_at.get(role.device or "") for role in tree.roles}
    initial = {name: PlaceRef(device=device) for name, device in begins.items() if device is not None}
    return _follow(tree, initial, None, from_script=True)


def _follow(
    tree: Tree, initial: Standing, memo: Memo | None, *, from_script: bool
) -> tuple[Tree, tuple[Pick | Drop, ...]]:
    if memo is not None:
        memo.begin(initial)
    circular = functions_in_circles(tree) if tree.functions else frozenset()
    effects = EffectTable(tree).functions
    moved = {name: e.moved if from_script else e.moved | e.loaded for name, e in effects.items()}
    follower = _Follower(moved, sets_of_functions(tree), circular, from_script, initial, memo=memo)
    finished = {function.method: follower.function(function) for function in callees_first(tree)}
    body, _ = follower.block(tree.body, initial)
    events = tuple(replace(event, body=follower.block(event.body, {})[0]) for event in tree.events)
    roles = tuple(_with_place(role, follower.relied_on.get(role.name)) for role in tree.roles)
    done = tuple(finished[function.method] for function in tree.functions)
    return replace(tree, body=body, functions=done, roles=roles, events=events), tuple(follower.unplaced)


def _with_place(role: Role, at: str | None) -> Role:
    return role if role.at == at else replace(role, at=at)

"""Where each robot stands, followed along the steps: the moves that are missing are put in.

The script says no place beside a pick or a drop: they happen where the robot went last. So the same walk also
gives the picks and drops of a parsed script their places.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from editor.language.nodes import (
    NOWHERE,
    Block,
    Call,
    Drop,
    Function,
    If,
    Move,
    Node,
    Parallel,
    Pick,
    Role,
    Tree,
    Try,
    While,
)
from editor.language.plan import PlaceRef
from editor.language.walking import callees_first, functions_in_circles, roles_used, walk

Standing = dict[str, PlaceRef]
"""Role → where its robot stands; a role that is not in it may stand anywhere."""


@dataclass(slots=True)
class _Follower:
    """The walk over one tree; `settle` is True for a parsed script, whose picks get the place of their robot."""

    moved: Mapping[str, frozenset[str]]
    """Function → the roles whose robot it moves."""
    circular: frozenset[str]
    settle: bool
    initial: Standing
    relied_on: dict[str, str] = field(default_factory=dict)
    """Roles whose place at the beginning matters, with that place."""
    homeless: list[Pick | Drop] = field(default_factory=list)
    """Picks and drops of a script before which no move is known."""
    exits: dict[str, Standing] = field(default_factory=dict)

    def block(self, block: Block, standing: Standing) -> tuple[Block, Standing]:
        """Return the block with its moves, and where the robots stand after it."""
        nodes: list[Node] = []
        for node in block:
            if isinstance(node, Move):
                standing = {**standing, node.role: node.to}
                nodes.append(node)
            elif isinstance(node, Pick | Drop):
                standing = self._load(node, standing, nodes)
            elif isinstance(node, Call):
                standing = self._call(node, standing)
                nodes.append(node)
            elif isinstance(node, If | While | Parallel | Try):
                inner, standing = self._composite(node, standing)
                nodes.append(inner)
            else:
                nodes.append(node)
        return tuple(nodes), standing

    def _load(self, node: Pick | Drop, standing: Standing, nodes: list[Node]) -> Standing:
        here = standing.get(node.role)
        if self.settle:
            self._rely(node.role, here)
            if here is None:
                self.homeless.append(node)
            nodes.append(replace(node, at=here or NOWHERE))
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

    def _composite(self, node: If | While | Parallel | Try, before: Standing) -> tuple[Node, Standing]:
        match node:
            case If(then=then, otherwise=otherwise):
                first, after_first = self.block(then, before)
                second, after_second = self.block(otherwise, before)
                return replace(node, then=first, otherwise=second), _agreed(after_first, after_second)
            case While(body=body):
                entry = _without(before, self.movers(body))
                inner, after = self.block(body, entry)
                return replace(node, body=inner), _agreed(before, after)
            case Try(body=body, catch=catch):
                inner, after = self.block(body, before)
                handler, after_catch = self.block(catch, _without(before, self.movers(body)))
                return replace(node, body=inner, catch=handler), _agreed(after, after_catch)
            case Parallel(branches=branches):
                followed = [self.block(branch, before) for branch in branches]
                return replace(node, branches=tuple(b for b, _ in followed)), self._joined(branches, followed, before)

    def _joined(
        self, branches: tuple[Block, ...], followed: list[tuple[Block, Standing]], before: Standing
    ) -> Standing:
        """After a Parallel each robot stands where the one branch that moved it left it."""
        movers = [self.movers(branch) for branch in branches]
        result = _without(before, frozenset[str]().union(*movers))
        for moved, (_, after) in zip(movers, followed, strict=True):
            alone = [role for role in moved if sum(role in others for others in movers) == 1]
            result.update({role: after[role] for role in alone if role in after})
        return result

    def _call(self, node: Call, standing: Standing) -> Standing:
        """After a call a robot stands where the function leaves it, unless an argument decides that."""
        exits = self.exits.get(node.function, {})
        known = {role: place for role, place in exits.items() if place.value is None}
        return {**_without(standing, self.moved.get(node.function, frozenset())), **known}

    def function(self, function: Function) -> Function:
        """Follow a function's body; where the robots stand when it is called is not known in it."""
        body, after = self.block(function.body, {})
        moved = self.moved[function.method]
        if function.method not in self.circular:
            self.exits[function.method] = {role: place for role, place in after.items() if role in moved}
        return replace(function, body=body)

    def movers(self, block: Block) -> frozenset[str]:
        """Return the roles whose robot a block moves, also in the functions it calls."""
        nodes = tuple(walk(block))
        called = (self.moved.get(node.function, frozenset()) for node in nodes if isinstance(node, Call))
        return frozenset(node.role for node in nodes if isinstance(node, Move | Pick | Drop)).union(*called)


def _without(standing: Standing, roles: frozenset[str]) -> Standing:
    return {role: place for role, place in standing.items() if role not in roles}


def _agreed(first: Standing, second: Standing) -> Standing:
    return {role: place for role, place in first.items() if second.get(role) == place}


def add_moves(tree: Tree, standing_at: Mapping[str, str]) -> Tree:
    """Return the tree with the moves that were missing; `standing_at` says where known robots stand (device ids)."""
    initial = {
        role.name: PlaceRef(device=standing_at[role.device])
        for role in tree.roles
        if role.device is not None and role.device in standing_at
    }
    return _follow(tree, initial, settle=False)[0]


def settle_places(tree: Tree) -> tuple[Tree, tuple[Pick | Drop, ...]]:
    """Return the tree of a parsed script with the places of its picks and drops, and those without a place."""
    initial = {role.name: PlaceRef(device=role.at) for role in tree.roles if role.at is not None}
    return _follow(tree, initial, settle=True)


def _follow(tree: Tree, initial: Standing, *, settle: bool) -> tuple[Tree, tuple[Pick | Drop, ...]]:
    circular = functions_in_circles(tree) if tree.functions else frozenset()
    moved = {function.method: roles_used(function.body, tree) for function in tree.functions}
    follower = _Follower(moved, circular, settle, initial)
    finished = {function.method: follower.function(function) for function in callees_first(tree)}
    body, _ = follower.block(tree.body, initial)
    roles = tuple(_with_place(role, follower.relied_on.get(role.name)) for role in tree.roles)
    done = tuple(finished[function.method] for function in tree.functions)
    return Tree(body, done, roles, tree.parameters), tuple(follower.homeless)


def _with_place(role: Role, at: str | None) -> Role:
    return role if role.at == at else replace(role, at=at)

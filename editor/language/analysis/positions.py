"""The domain of positions: where each robot stands; and the moves that are missing, put in where it stands elsewhere.

The script says no place beside a pick or a drop: they happen where the robot went last. So the same domain also
gives the picks and drops of a parsed script their places. What it puts in must be right whenever a step is come to,
also where no path leads; so the walk that it is made for goes through every step just once (`Walk.rewrites`).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import ClassVar

from editor.language.analysis.calls import follow_function
from editor.language.analysis.domain import Frame, PairwiseDomain, Place, Transfer
from editor.language.analysis.effects import NO_NAMES, Effects, EffectTable, Names
from editor.language.analysis.interpreter import FOLLOW
from editor.language.analysis.memo import Memo
from editor.language.analysis.walk import Walk
from editor.language.document.outline import PROGRAM
from editor.language.expressions.nodes import NOWHERE, Expression, PlaceRef, Variable
from editor.language.expressions.ranges import Range
from editor.language.tree import nodes as n
from editor.language.tree.program import Function, Tree
from editor.language.tree.traversal import callees_first, functions_in_circles
from editor.language.tree.variables import set_by

Standing = Mapping[str, PlaceRef]
"""Role → where its robot stands; a role that is not in it may stand anywhere."""
_RELIED_ON = "relied_on"
"""What is noted of a step that relies on its role's robot standing where it does at the beginning."""


class Beginning(PlaceRef):
    """The device where a role's robot stands from the beginning; equal to no place that it has gone to."""

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class Positions(PairwiseDomain[Standing]):
    """The domain of positions; `from_script` is True for a parsed script, which says every move."""

    initial: Standing
    from_script: bool
    exits: dict[str, Standing] = field(default_factory=dict)
    """Function → where it leaves the robots that it moves, as far as no argument decides that."""
    unplaced: list[n.Pick | n.Drop] = field(default_factory=list)
    """Picks and drops of a script before which no move is known."""

    def begin(self) -> Standing:
        """Return where robots are known to stand."""
        return self.initial

    def somewhere(self) -> Standing:
        """Return that robots may stand anywhere."""
        return {}

    def either(self, first: Standing, second: Standing) -> Standing:
        """Return what holds after one path or the other."""
        if first is second:
            return first
        agreed = ((role, _agreed(place, second.get(role))) for role, place in first.items())
        return {role: place for role, place in agreed if place is not None}

    def disturb(self, place: Place, known: Standing, effects: Effects) -> Standing:
        """Return where those robots stand that stay, at places that no variable gives that may have been set."""
        movers = self.movers(effects)
        kept = {role: at for role, at in known.items() if role not in movers} if movers else known
        return _without_values(kept, _set_by(effects))

    def beside(self, place: Place, known: Standing, ends: Sequence[Standing], effects: Effects) -> Standing:
        """Return the same: which branch moves whose robot is not a matter of chance, but what they set may be."""
        return _without_values(known, _set_by(effects))

    def join(self, place: Place, before: Standing, ends: Sequence[tuple[Standing, Effects]]) -> Standing:
        """Return that each robot stands where the one branch that moved it left it."""
        moved = Counter(role for _, effects in ends for role in self.movers(effects))
        names = NO_NAMES.union(*(_set_by(effects) for _, effects in ends))
        joined = _without_values({role: at for role, at in before.items() if role not in moved}, names)
        for index, (end, effects) in enumerate(ends):
            alone = {role: end[role] for role in self.movers(effects) if moved[role] == 1 and role in end}
            others = NO_NAMES.union(*(_set_by(each) for _, each in (*ends[:index], *ends[index + 1 :])))
            joined = {**joined, **_without_values(alone, others)}
        return joined

    def enter_round(
        self, place: Place, known: Standing, node: n.ForEach, items: Sequence[Expression], rounds: Range
    ) -> Standing:  # fmt: skip
        """Return where robots stand, where the loop's variables have other values."""
        return _without_values(known, frozenset(node.names))

    def movers(self, effects: Effects) -> Names:
        """Return the roles whose robots go somewhere; what is drawn goes to its picks and drops by itself."""
        return effects.moved if self.from_script else effects.moved | effects.loaded

    def _move(self, place: Place, node: n.Move, known: Standing) -> Standing:
        return {**known, node.role: node.to}

    def _load(self, place: Place, node: n.Pick | n.Drop, known: Standing) -> Standing:
        here = known.get(node.role)
        if self.from_script and here is None:
            self.unplaced.append(node)
        begins = here.__class__ is Beginning
        if begins and here is not None:
            here = PlaceRef(device=here.device)
        if here is not None and (self.from_script or here == node.at):
            if begins:
                place.report(node, _RELIED_ON, node.role)
        elif not self.from_script:
            place.instead[id(node)] = (n.Move(node.role, node.at, node.route, node.step, added=True), node)
            return {**known, node.role: node.at}
        if self.from_script:
            place.instead[id(node)] = (replace(node, at=here or NOWHERE),)
        return known

    def _leave(self, place: Place, node: n.Release | n.Cover, known: Standing) -> Standing:
        return {role: at for role, at in known.items() if role != node.role}

    def _set(self, place: Place, node: n.Set | n.Ask, known: Standing) -> Standing:
        return _without_values(known, frozenset({set_by(node)}))

    def _call(self, place: Place, node: n.Call, known: Standing) -> Standing:
        """Return where the function has left its robots."""
        return _without_values({**known, **self.exits.get(node.function, {})}, frozenset({node.result}))

    transfers: ClassVar[Mapping[type[n.Node], Transfer]] = {
        n.Move: _move,
        n.Pick: _load,
        n.Drop: _load,
        n.Release: _leave,
        n.Cover: _leave,
        n.Set: _set,
        n.Ask: _set,
        n.Call: _call,
    }


def _agreed(first: PlaceRef, second: PlaceRef | None) -> PlaceRef | None:
    """Return where a robot stands on either path; where one of them relies on the beginning, both do."""
    if second is None or first == second:
        return None if second is None else first
    either = Beginning in {first.__class__, second.__class__} and first.device is not None
    return Beginning(device=first.device) if either and first.device == second.device else None


def _set_by(effects: Effects) -> Names:
    return effects.names | effects.shared


def _without_values(known: Standing, names: Names) -> Standing:
    """Return what is known when these variables have other values."""
    if not names or not any(place.value is not None for place in known.values()):
        return known
    return {r: p for r, p in known.items() if not isinstance(p.value, Variable) or p.value.name not in names}


def add_moves(tree: Tree, standing_at: Mapping[str, str], memo: Memo | None = None) -> Tree:
    """Return the tree with the moves that were missing; `standing_at` says where known robots stand (device ids).

    `memo` has what was found at the last look.
    """
    begins = {role.name: standing_at.get(role.device or "") for role in tree.roles}
    return _rewritten(tree, Positions(_at_devices(begins), from_script=False), memo)


def place_loads(tree: Tree, standing_at: Mapping[str, str]) -> tuple[Tree, tuple[n.Pick | n.Drop, ...]]:
    """Return the tree of a parsed script with the places of its picks and drops, and those without a place.

    Where the script does not say where a robot begins, it begins where it is known to stand.
    """
    begins = {role.name: role.at or standing_at.get(role.device or "") for role in tree.roles}
    domain = Positions(_at_devices(begins), from_script=True)
    return _rewritten(tree, domain), tuple(domain.unplaced)


def _at_devices(begins: Mapping[str, str | None]) -> Standing:
    return {role: Beginning(device=device) for role, device in begins.items() if device is not None}


def _rewritten(tree: Tree, domain: Positions, memo: Memo | None = None) -> Tree:
    """Return the tree with what the domain puts into it, and of each role where it relies on its robot standing."""
    if memo is not None:
        memo.begin(domain.initial)
    comes_back = {function.method: True for function in tree.functions}
    walk = Walk(tree, [domain], EffectTable(tree), FOLLOW, summaries=comes_back, memo=memo, rewrites=True)
    circular = functions_in_circles(tree) if tree.functions else NO_NAMES
    for function in callees_first(tree):
        over = follow_function(walk, function, walk.somewhere())
        if over is not None and function.method not in circular:
            movers = domain.movers(walk.effects.functions[function.method])
            left = {role: at for role, at in over[0].items() if role in movers and at.value is None}
            domain.exits[function.method] = left
    walk.frame = Frame(PROGRAM)
    walk.block(tree.body, walk.begin())
    for event in tree.events:
        walk.frame = Frame(event.step)
        walk.block(event.body, walk.somewhere())
    relied_on = {role: domain.initial[role].device for code, _, role in walk.found if code == _RELIED_ON}
    roles = tuple(replace(role, at=relied_on.get(role.name)) for role in tree.roles)
    events = tuple(replace(event, body=walk.rewritten(event.body)) for event in tree.events)
    return replace(
        tree, body=walk.rewritten(tree.body), functions=_functions(walk, tree), roles=roles, events=events
    )  # fmt: skip


def _functions(walk: Walk, tree: Tree) -> tuple[Function, ...]:
    return tuple(replace(function, body=walk.rewritten(function.body)) for function in tree.functions)

"""The domain of loads: how many of each kind of object every robot carries, at least and at most.

Where paths meet the range widens; what grows with each round of an uncounted loop has no end. After a failure what
changed is not known any more and nothing is said of it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import inf
from typing import ClassVar

from editor.language.analysis.domain import PairwiseDomain, Place, Transfer
from editor.language.analysis.effects import Effects
from editor.language.analysis.variables import Variables
from editor.language.expressions.nodes import Constant, Expression
from editor.language.expressions.ranges import Range
from editor.language.messages.phrases import Argument
from editor.language.tree import nodes as n
from editor.language.tree.program import Function

Count = tuple[int, float | None]
"""At least, at most; without end where each round of a loop brings more, None: nobody can tell."""
ANY: Count = (0, None)
Carried = Mapping[tuple[str, str], Count]
"""(role, object) → how many; what is not in it is not carried."""
_EVERYTHING = "*"


@dataclass(frozen=True, slots=True)
class Loads(PairwiseDomain[Carried]):
    """The domain of loads; `capacity` tells how many objects a role's robot holds (0: not known)."""

    variables: Variables
    capacity: Callable[[str], int]
    robot: Callable[[str], Argument]
    """What to call a role's robot."""
    roles: frozenset[str]

    def begin(self) -> Carried:
        """Return that nobody carries anything."""
        return {}

    def somewhere(self) -> Carried:
        """Return that everybody may carry anything."""
        return _forget({}, self.roles)

    def either(self, first: Carried, second: Carried) -> Carried:
        """Return what is carried after one path or the other."""
        if first is second:
            return first
        keys = {**first, **second}
        return {key: _between(_count(first, key), _count(second, key)) for key in keys}

    def widen(self, place: Place, entry: Carried, after: Carried, effects: Effects) -> Carried:
        """Return a range that more rounds do not leave."""
        return {key: _widened(_count(entry, key), _count(after, key)) for key in {**entry, **after}}

    def disturb(self, place: Place, known: Carried, effects: Effects) -> Carried:
        """Return that these roles may carry anything."""
        return _forget(known, effects.loaded) if effects.loaded else known

    def join(self, place: Place, before: Carried, ends: Sequence[tuple[Carried, Effects]]) -> Carried:
        """Return what each branch left its own robots with."""
        changed = frozenset[str]().union(*(effects.loaded for _, effects in ends))
        joined = {key: count for key, count in before.items() if key[0] not in changed}
        for carried, effects in ends:
            joined.update({key: count for key, count in carried.items() if key[0] in effects.loaded})
        return joined

    def passing(self, passed: Carried, known: Carried) -> Carried:
        """Return what is carried at the one point or the other."""
        return self.either(passed, known)

    def interrupted(self, place: Place, known: Carried, effects: Effects, passed: Carried) -> Carried:
        """Return that these roles carry what they did at any point; what functions did is not known."""
        if effects.calls:
            return self.disturb(place, known, effects)
        between = self.either(known, passed)
        kept = {key: count for key, count in known.items() if key[0] not in effects.loaded}
        return {**kept, **{key: count for key, count in between.items() if key[0] in effects.loaded}}

    def key(self, place: Place, known: Carried, node: n.Call, function: Function) -> object:
        """Return what the function's robots carry."""
        loaded = place.effects.functions[function.method].loaded
        return frozenset((key, count) for key, count in known.items() if key[0] in loaded)

    def leave(self, place: Place, known: Carried, after: Carried, function: Function) -> Carried:
        """Return what the function left its robots with; the others carry what they did."""
        loaded = place.effects.functions[function.method].loaded
        kept = {key: count for key, count in known.items() if key[0] not in loaded}
        return {**kept, **{key: count for key, count in after.items() if key[0] in loaded}}

    def end(self, place: Place, node: n.Node | None, known: Carried) -> None:
        """Tell of what is still carried where the program ends."""
        last = node or (place.tree.body[-1] if place.tree.body else None)
        for (role, thing), (least, _) in sorted(known.items()):
            if least > 0 and last is not None:
                args: dict[str, Argument] = {"robot": self.robot(role), "quantity": least, "object": thing}
                place.report(last, "ends_carrying", "", args)

    def _pick(self, place: Place, node: n.Pick, known: Carried) -> Carried:
        load = self._load(place, node)
        capacity = self.capacity(node.role)
        if load is None or (capacity and load[1][0] > capacity):  # told already; what is carried cannot be known
            return _forget(known, frozenset({node.role}))
        thing, (fewest, most) = load
        mine = [(t, count) for (role, t), count in known.items() if role == node.role and t != _EVERYTHING]
        least, all_ = _total([count for _, count in mine])
        if capacity and least + fewest > capacity:
            text = ", ".join(f"{count[0]} {each}" for each, count in sorted(mine) if count[0])
            self._tell(place, node, "carrying_too_much", {"carried": text, "capacity": capacity})
            return _forget(known, frozenset({node.role}))
        if capacity and all_ is not None and all_ + most > capacity and (node.role, _EVERYTHING) not in known:
            self._tell(place, node, "may_carry_too_much", {"capacity": capacity})
        before = _count(known, (node.role, thing))
        most_after = None if before[1] is None else min(before[1] + most, capacity or inf)
        return {**known, (node.role, thing): (min(before[0] + fewest, capacity or inf), most_after)}  # type: ignore[dict-item]

    def _drop(self, place: Place, node: n.Drop, known: Carried) -> Carried:
        load = self._load(place, node)
        if load is None:
            return _forget(known, frozenset({node.role}))
        thing, (fewest, most) = load
        before = _count(known, (node.role, thing))
        if before[1] is not None:
            args: dict[str, Argument] = {"object": thing, "quantity": fewest, "carried": before[1]}
            if before[1] < fewest:
                self._tell(place, node, "drops_nothing", args)
            elif before[0] < most:
                self._tell(place, node, "may_drop_nothing", {**args, "quantity": int(most)})
        left = None if before[1] is None else max(before[1] - fewest, 0)
        return {**known, (node.role, thing): (max(before[0] - int(most), 0), left)}

    def _release(self, place: Place, node: n.Release, known: Carried) -> Carried:
        """Return that the role's next robot carries nothing, or what this one was released with."""
        mine = {thing: count for (role, thing), count in known.items() if role == node.role}
        for thing, (least, most) in sorted(mine.items()):
            if least > 0 or (most is not None and most > 0):
                args: dict[str, Argument] = {"robot": self.robot(node.role), "quantity": least, "object": thing}
                place.report(node, "releases_carrying" if least > 0 else "may_release_carrying", "role", args)
        return {key: (0, count[1]) if key[0] == node.role else count for key, count in known.items()}

    transfers: ClassVar[Mapping[type[n.Node], Transfer]] = {n.Pick: _pick, n.Drop: _drop, n.Release: _release}

    def _tell(self, place: Place, node: n.Pick | n.Drop, code: str, args: dict[str, Argument]) -> None:
        place.report(node, code, "quantity", {"robot": self.robot(node.role), **args})

    def _load(self, place: Place, node: n.Pick | n.Drop) -> tuple[str, tuple[int, float]] | None:
        """Return what is loaded and between how many; None when that depends on the run or is wrong anyway."""
        things = self._value(place, node.object, node)
        quantity = self._value(place, node.quantity, node)
        if not isinstance(things, frozenset) or len(things) != 1 or not isinstance(quantity, Range):
            return None
        thing = next(iter(things))
        if not isinstance(thing, str) or quantity.least < 1 or quantity.most == inf:
            return None
        if quantity.least == quantity.most and quantity.least != int(quantity.least):
            return None
        return thing, (int(quantity.least), int(quantity.most))

    def _value(self, place: Place, expression: Expression, node: n.Node) -> object:
        if isinstance(expression, Constant):
            value = expression.value
            if isinstance(value, str):
                return frozenset({value})
            is_plain = isinstance(value, int | float) and not isinstance(value, bool)
            return Range(value, value) if is_plain else None  # type: ignore[arg-type]
        return self.variables.value(place, expression, node)


def _total(counts: Iterable[Count]) -> Count:
    """Return how many there are in all."""
    least, most, known = 0, 0.0, True
    for count in counts:
        least += count[0]
        most += count[1] or 0
        known = known and count[1] is not None
    return least, most if known else None


def _count(carried: Carried, key: tuple[str, str]) -> Count:
    """Return how many of an object a robot carries."""
    return carried.get(key, ANY if (key[0], _EVERYTHING) in carried else (0, 0))


def _between(first: Count, second: Count) -> Count:
    most = None if first[1] is None or second[1] is None else max(first[1], second[1])
    return min(first[0], second[0]), most


def _widened(before: Count, after: Count) -> Count:
    """Return a range that more rounds do not leave: what falls may fall to nothing, what grows has no end."""
    least = before[0] if after[0] >= before[0] else 0
    if before[1] is None or after[1] is None:
        return least, None
    return least, before[1] if after[1] <= before[1] else inf


def _forget(carried: Carried, roles: frozenset[str]) -> Carried:
    """Return what is known when anything may have happened to these roles' loads."""
    kept = {key: count for key, count in carried.items() if key[0] not in roles}
    known = {key: ANY for key in carried if key[0] in roles}
    return {**kept, **known, **{(role, _EVERYTHING): ANY for role in roles}}

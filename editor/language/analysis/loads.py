"""The domain of loads: how many of each kind of object every robot carries, at least and at most.

Where paths meet the range widens; what grows with each round of an uncounted loop has no end. After a failure what
changed is not known any more and nothing is said of it. What was picked by a value is known by that value, too, as long
as nothing in it is set: who drops by the same value drops all of it, however many that are.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import inf
from typing import ClassVar, Final, NamedTuple

from editor.language.analysis.domain import PairwiseDomain, Place, Transfer
from editor.language.analysis.effects import Effects
from editor.language.analysis.variables import Variables
from editor.language.expressions.nodes import Constant, Expression, Operation, Variable
from editor.language.expressions.ranges import Range
from editor.language.expressions.values import parts_of
from editor.language.messages.phrases import Argument
from editor.language.tree import nodes as n
from editor.language.tree.program import Function
from editor.language.tree.variables import set_by


class Count(NamedTuple):
    """How many: at least, at most (without end where each round of a loop brings more, None: nobody can tell)."""

    least: int
    most: float | None
    by: Expression | None = None
    """What it is now, whatever that is: a value of variables that nothing has set since."""


NONE: Final = Count(0, 0)
ANY: Final = Count(0, None)
Carried = Mapping[tuple[str, str], Count]
"""(role, object) → how many; what is not in it is not carried."""
_EVERYTHING = "*"
HOLDS: Final = "holds"
"""What is noted of a pick after which a role's robot may hold more than one object: no problem, but what is needed."""


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
        known = _without_values_of(known, effects.names | effects.shared)
        return _forget(known, effects.loaded) if effects.loaded else known

    def join(self, place: Place, before: Carried, ends: Sequence[tuple[Carried, Effects]]) -> Carried:
        """Return what each branch left its own robots with."""
        changed = frozenset[str]().union(*(effects.loaded for _, effects in ends))
        joined = {key: count for key, count in before.items() if key[0] not in changed}
        for carried, effects in ends:
            joined.update({key: count for key, count in carried.items() if key[0] in effects.loaded})
        return _without_values_of(joined, frozenset().union(*(each.names | each.shared for _, each in ends)))

    def passing(self, passed: Carried, known: Carried) -> Carried:
        """Return what is carried at the one point or the other."""
        return self.either(passed, known)

    def interrupted(self, place: Place, known: Carried, effects: Effects, passed: Carried) -> Carried:
        """Return that these roles carry what they did at any point; what functions did is not known."""
        if effects.calls:
            return self.disturb(place, known, effects)
        known = _without_values_of(known, effects.names | effects.shared)
        between = self.either(known, passed)
        kept = {key: count for key, count in known.items() if key[0] not in effects.loaded}
        return {**kept, **{key: count for key, count in between.items() if key[0] in effects.loaded}}

    def key(self, place: Place, known: Carried, node: n.Call, function: Function) -> object:
        """Return what the function's robots carry."""
        loaded = place.effects.functions[function.method].loaded
        return frozenset((key, count[:2]) for key, count in known.items() if key[0] in loaded)

    def enter(self, place: Place, known: Carried, node: n.Call, function: Function) -> Carried:
        """Return what is carried; what the function calls its variables may be others of these names."""
        return _without_values(known)

    def enter_round(
        self, place: Place, known: Carried, node: n.ForEach, items: Sequence[Expression], rounds: Range
    ) -> Carried:  # fmt: skip
        """Return what is carried, where the loop's variables have other values."""
        return _without_values_of(known, frozenset({node.variable, node.index or ""}))

    def leave(self, place: Place, known: Carried, after: Carried, function: Function) -> Carried:
        """Return what the function left its robots with; the others carry what they did."""
        effects = place.effects.functions[function.method]
        loaded, still = effects.loaded, _without_values_of(known, effects.names | effects.shared)
        kept = {key: count for key, count in still.items() if key[0] not in loaded}
        return {**kept, **{key: count for key, count in _without_values(after).items() if key[0] in loaded}}

    def end(self, place: Place, node: n.Node | None, known: Carried) -> None:
        """Tell of what is still carried where the program ends."""
        last = node or (place.tree.body[-1] if place.tree.body else None)
        for (role, thing), least in sorted((key, count.least) for key, count in known.items()):
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
        least, all_, _ = _total([count for _, count in mine])
        if capacity and least + fewest > capacity:
            text = ", ".join(f"{count[0]} {each}" for each, count in sorted(mine) if count[0])
            self._tell(place, node, "carrying_too_much", {"carried": text, "capacity": capacity})
            return _forget(known, frozenset({node.role}))
        if capacity and all_ is not None and all_ + most > capacity and (node.role, _EVERYTHING) not in known:
            self._tell(place, node, "may_carry_too_much", {"capacity": capacity})
        holds = int(min(least + most if all_ is None else all_ + most, capacity))
        if holds > 1:
            place.report(node, HOLDS, str(holds), {"role": node.role})
        before = _count(known, (node.role, thing))
        most_after = None if before.most is None else min(before.most + most, capacity or inf)
        least_after = min(before.least + fewest, capacity or before.least + fewest)
        by = node.quantity if before == NONE and _stays(place, node.quantity) else None
        return {**known, (node.role, thing): Count(least_after, most_after, by)}

    def _drop(self, place: Place, node: n.Drop, known: Carried) -> Carried:
        load = self._load(place, node)
        if load is None:
            return _forget(known, frozenset({node.role}))
        thing, (fewest, most) = load
        before = _count(known, (node.role, thing))
        if before.by is not None and before.by == node.quantity:
            return {**known, (node.role, thing): NONE}
        if before[1] is not None:
            args: dict[str, Argument] = {"object": thing, "quantity": fewest, "carried": before[1]}
            if before[1] < fewest:
                self._tell(place, node, "drops_nothing", args)
            elif before[0] < most:
                self._tell(place, node, "may_drop_nothing", {**args, "quantity": int(most)})
        left = None if before[1] is None else max(before[1] - fewest, 0)
        return {**known, (node.role, thing): Count(max(before[0] - int(most), 0), left)}

    def _release(self, place: Place, node: n.Release, known: Carried) -> Carried:
        """Return that the role's next robot carries nothing, or what this one was released with."""
        mine = {thing: count for (role, thing), count in known.items() if role == node.role}
        for thing, (least, most, _) in sorted(mine.items(), key=lambda item: item[0]):
            if least > 0 or (most is not None and most > 0):
                args: dict[str, Argument] = {"robot": self.robot(node.role), "quantity": least, "object": thing}
                place.report(node, "releases_carrying" if least > 0 else "may_release_carrying", "role", args)
        return {key: Count(0, count.most) if key[0] == node.role else count for key, count in known.items()}

    def _set(self, place: Place, node: n.Set | n.Ask | n.Call, known: Carried) -> Carried:
        """Return that what was known by a variable's old value is not known by it any more."""
        return _without_values_of(known, frozenset({set_by(node)}))

    transfers: ClassVar[Mapping[type[n.Node], Transfer]] = {
        n.Pick: _pick,
        n.Drop: _drop,
        n.Release: _release,
        n.Set: _set,
        n.Ask: _set,
        n.Call: _set,
    }

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
    return Count(least, most if known else None)


_LASTING: Final = frozenset({"+", "-", "*", "/", "abs", "round", "min", "max", "nth", "len"})
"""What gives the same again while the variables in it do."""


def _stays(place: Place, value: Expression) -> bool:
    """Tell whether a value is one of variables alone, which nothing beside the path sets."""
    return not isinstance(value, Constant) and all(
        isinstance(part, Constant)
        or (isinstance(part, Variable) and part.name not in place.volatile)
        or (isinstance(part, Operation) and part.operator in _LASTING)
        for part in parts_of(value)
    )


def _without_values_of(known: Carried, names: frozenset[str]) -> Carried:
    """Return what is carried where these variables may have been set."""
    gone = {
        key: Count(count.least, count.most)
        for key, count in known.items()
        if count.by is not None
        and any(isinstance(part, Variable) and part.name in names for part in parts_of(count.by))
    }
    return {**known, **gone} if gone else known


def _without_values(known: Carried) -> Carried:
    return {key: Count(count.least, count.most) for key, count in known.items()}


def _count(carried: Carried, key: tuple[str, str]) -> Count:
    """Return how many of an object a robot carries."""
    return carried.get(key, ANY if (key[0], _EVERYTHING) in carried else NONE)


def _between(first: Count, second: Count) -> Count:
    most = None if first[1] is None or second[1] is None else max(first[1], second[1])
    return Count(min(first[0], second[0]), most, first.by if first.by == second.by else None)


def _widened(before: Count, after: Count) -> Count:
    """Return a range that more rounds do not leave: what falls may fall to nothing, what grows has no end."""
    least = before[0] if after[0] >= before[0] else 0
    by = before.by if before.by == after.by else None
    if before[1] is None or after[1] is None:
        return Count(least, None, by)
    return Count(least, before[1] if after[1] <= before[1] else inf, by)


def _forget(carried: Carried, roles: frozenset[str]) -> Carried:
    """Return what is known when anything may have happened to these roles' loads."""
    kept = {key: count for key, count in carried.items() if key[0] not in roles}
    known = {key: ANY for key in carried if key[0] in roles}
    return {**kept, **known, **{(role, _EVERYTHING): ANY for role in roles}}

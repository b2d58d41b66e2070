"""What each robot carries, followed along all paths through the program.

For every role and kind of object two numbers are kept: how many it carries at least and at most. Where paths meet
the range widens. A loop that is counted is followed round by round; in any other what grows with each round has no
end. After a failure what changed is not known any more and nothing is said of it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from math import inf

from editor.language.analysis.memo import Findings, Memo
from editor.language.expressions.nodes import Constant, Expression, Variable
from editor.language.expressions.values import is_number
from editor.language.messages.diagnostics import Problem
from editor.language.messages.phrases import Argument
from editor.language.tree import nodes as n
from editor.language.tree.nodes import walk
from editor.language.tree.variables import set_by

ANY = (0, None)
Range = tuple[int, float | None]
"""At least, at most; without end where each round of a loop brings more, None: nobody can tell."""
Carried = Mapping[tuple[str, str], Range]
"""(role, object) → how many; what is not in it is not carried."""
MOST_CALLS = 500
"""Function calls that are followed; beyond them nothing is known, which is better than slow."""
DEEPEST_CALL = 12
MOST_ROUNDS = 2000
"""Rounds of loops that are followed in all; in the loops after that nothing is known of what they change."""
MOST_COUNTED = 100
"""A loop of more rounds is followed as one that nobody has counted."""
_EVERYTHING = "*"


@dataclass(slots=True)
class _Follower:
    """The walk; `silent` while a loop is walked only to see what it changes."""

    functions: Mapping[str, n.Function]
    capacity: Callable[[str], int]
    robot: Callable[[str], Argument]
    found: list[tuple[Problem, int]] = field(default_factory=list)
    silent: bool = False
    calls: int = 0
    depth: int = 0
    breaks: list[list[Carried]] = field(default_factory=list)
    """For each loop around, innermost last, what is carried at the steps that leave it."""
    returns: list[list[Carried]] = field(default_factory=list)
    """The same for the functions being followed."""
    memo: Memo | None = None
    met: int = 0
    """Calls that were met, also those that were not followed."""
    rounds: int = 0
    """Rounds that were followed within the outermost loop or call that is being followed."""
    nested: int = 0
    """Loops and calls around the step that is being followed."""

    def block(self, block: n.Block, carried: Carried, values: Mapping[str, Expression]) -> Carried | None:
        """Return what is carried after a block; None where its end is never reached."""
        after: Carried | None = carried
        memo = None if self.silent or self.depth else self.memo
        for node in block:
            follow = _FOLLOW.get(node.__class__)
            if follow is None:
                continue
            if after is None:
                break
            if memo is None or node.__class__ not in n.COMPOSITES:
                after = follow(self, node, after, values)
            else:
                after = self._followed(node, after, memo)
        return after

    def _followed(self, node: n.Node, carried: Carried, memo: Memo) -> Carried | None:
        """Follow a step outside of functions that holds others; what depends on nothing else is remembered."""
        known: tuple[Carried | None, Findings] | None = memo.get(node, carried)
        if known is None:
            reported, exits = len(self.found), (self.met, len(self.breaks[-1]) if self.breaks else 0)
            after = _FOLLOW[type(node)](self, node, carried, {})
            known = after, tuple(self.found[reported:])
            if exits == (self.met, len(self.breaks[-1]) if self.breaks else 0):
                memo.put(node, known, carried)
        else:
            self.found.extend(known[1])
        return known[0]

    def enter(self) -> None:
        """Begin to count rounds anew where no other loop or call is around: nothing depends on what came before."""
        if not self.nested:
            self.rounds = 0

    def report(self, node: n.Pick | n.Drop, code: str, args: dict[str, Argument]) -> None:
        if not self.silent:
            problem = Problem(code, node.step, "quantity", {"robot": self.robot(node.role), **args})
            self.found.append((problem, id(node)))


def _known(expression: Expression, values: Mapping[str, Expression]) -> object:
    """Return the value that an expression has here, None when it depends on the run."""
    if isinstance(expression, Variable):
        expression = values.get(expression.name, expression)
    return expression.value if isinstance(expression, Constant) else None


def _load(
    node: n.Pick | n.Drop, carried: Carried, values: Mapping[str, Expression]
) -> tuple[tuple[str, str], int] | None:
    """Return what is loaded and how many, None when that depends on the run or is wrong anyway."""
    thing, quantity = _known(node.object, values), _known(node.quantity, values)
    if not isinstance(thing, str) or not is_number(quantity) or quantity <= 0 or quantity != int(quantity):
        return None
    return (node.role, thing), int(quantity)


def _pick(follower: _Follower, node: n.Pick, carried: Carried, values: Mapping[str, Expression]) -> Carried:
    load = _load(node, carried, values)
    if load is None:
        return _forget(carried, frozenset({node.role}))
    key, quantity = load
    capacity = follower.capacity(node.role)
    if capacity and quantity > capacity:  # reported already; what is really carried cannot be known
        return _forget(carried, frozenset({node.role}))
    mine = [(thing, count) for (role, thing), count in carried.items() if role == node.role and thing != _EVERYTHING]
    least, most = _total([count for _, count in mine])
    if capacity:
        if least + quantity > capacity:
            load_text = ", ".join(f"{count[0]} {thing}" for thing, count in sorted(mine) if count[0])
            follower.report(node, "carrying_too_much", {"carried": load_text, "capacity": capacity})
        elif most is not None and most + quantity > capacity and (node.role, _EVERYTHING) not in carried:
            follower.report(node, "may_carry_too_much", {"capacity": capacity})
    before = _count(carried, key)
    most_after = None if before[1] is None else min(before[1] + quantity, capacity or inf)
    return {**carried, key: (min(before[0] + quantity, capacity or quantity), most_after)}


def _total(counts: Iterable[Range]) -> Range:
    """Return how many there are in all."""
    least, most, known = 0, 0.0, True
    for count in counts:
        least += count[0]
        most += count[1] or 0
        known = known and count[1] is not None
    return least, most if known else None


def _drop(follower: _Follower, node: n.Drop, carried: Carried, values: Mapping[str, Expression]) -> Carried:
    load = _load(node, carried, values)
    if load is None:
        return _forget(carried, frozenset({node.role}))
    key, quantity = load
    before = _count(carried, key)
    if before[1] is not None:
        args: dict[str, Argument] = {"object": key[1], "quantity": quantity, "carried": before[1]}
        if before[1] < quantity:
            follower.report(node, "drops_nothing", args)
        elif before[0] < quantity:
            follower.report(node, "may_drop_nothing", args)
    after = (max(before[0] - quantity, 0), None if before[1] is None else max(before[1] - quantity, 0))
    return {**carried, key: after}


def _if(follower: _Follower, node: n.If, carried: Carried, values: Mapping[str, Expression]) -> Carried | None:
    return _either(follower.block(node.then, carried, values), follower.block(node.otherwise, carried, values))


def _loop(
    follower: _Follower, node: n.While | n.Repeat | n.ForEach, carried: Carried, values: Mapping[str, Expression]
) -> Carried | None:
    """Follow a loop: each of its rounds where they are counted, else one in which all is known that ever holds."""
    follower.enter()
    hidden = {node.variable} if isinstance(node, n.ForEach) else set()
    values = {name: value for name, value in values.items() if name not in hidden}
    rounds = _rounds(node, values)
    if rounds is None or follower.rounds + len(rounds) > MOST_ROUNDS:
        return _uncounted(follower, node, carried, values)
    before: Carried | None = None
    after: Carried | None = carried
    over: Carried | None = None
    for known in rounds:
        if after is None or (after == before and not known):
            break  # the rounds that are left bring nothing new
        before = after
        after, exits = _round(follower, node.body, after, {**values, **known})
        for at_exit in exits:
            over = _either(over, at_exit)
    return _either(over, after)


def _rounds(
    node: n.While | n.Repeat | n.ForEach, values: Mapping[str, Expression]
) -> list[Mapping[str, Expression]] | None:
    """Return for each round what is known of the loop's variable; None where nobody can say how many there are."""
    if isinstance(node, n.ForEach):
        known = (item if isinstance(item, Constant) else None for item in node.items)
        rounds: list[Mapping[str, Expression]] = [{node.variable: item} if item else {} for item in known]
        return rounds if len(rounds) <= MOST_COUNTED else None
    times = _known(node.times, values) if isinstance(node, n.Repeat) else None
    return [{}] * int(times) if is_number(times) and 0 <= times <= MOST_COUNTED else None


def _uncounted(
    follower: _Follower, node: n.While | n.Repeat | n.ForEach, carried: Carried, values: Mapping[str, Expression]
) -> Carried | None:
    """Walk the body in silence until nothing widens any more, then once more to report."""
    if follower.rounds >= MOST_ROUNDS:
        return _forget(carried, _roles(follower, node.body))
    silent, follower.silent = follower.silent, True
    entry = carried
    while follower.rounds < MOST_ROUNDS:
        once, _ = _round(follower, node.body, entry, values)
        widened = entry if once is None else _in_every_round(entry, once)
        if widened == entry:
            break
        entry = widened
    follower.silent = silent
    after, exits = _round(follower, node.body, entry, values)
    over = _either(carried, after)
    for at_exit in exits:
        over = _either(over, at_exit)
    return over


def _in_every_round(before: Carried, after: Carried) -> Carried:
    """Return what holds at the beginning of every round, given what one round makes of it."""
    return {key: _widened(_count(before, key), _count(after, key)) for key in {**before, **after}}


def _widened(before: Range, after: Range) -> Range:
    """Return a range that more rounds do not leave: what falls may fall to nothing, what grows has no end."""
    least = before[0] if after[0] >= before[0] else 0
    if before[1] is None or after[1] is None:
        return least, None
    return least, before[1] if after[1] <= before[1] else inf


def _round(
    follower: _Follower, body: n.Block, carried: Carried, values: Mapping[str, Expression]
) -> tuple[Carried | None, list[Carried]]:
    """Return what is carried after one round, and where a step leaves the loop."""
    follower.rounds += 1
    follower.nested += 1
    follower.breaks.append([])
    after = follower.block(body, carried, values)
    follower.nested -= 1
    return after, follower.breaks.pop()


def _try(follower: _Follower, node: n.Try, carried: Carried, values: Mapping[str, Expression]) -> Carried | None:
    """The catch begins anywhere in the body, the final part anywhere in both; it changes every exit."""
    exits = [*follower.breaks[-1:], *follower.returns[-1:]]
    marks = [len(at_exit) for at_exit in exits]
    after = follower.block(node.body, carried, values)
    failed = _forget(carried, _roles(follower, node.body))
    if node.catches:
        after = _either(after, follower.block(node.catch, failed, values))
    if not node.final:
        return after
    roles = _roles(follower, node.final)
    for at_exit, mark in zip(exits, marks, strict=True):
        at_exit[mark:] = [_forget(left, roles) for left in at_exit[mark:]]
    final = follower.block(node.final, _forget(failed, _roles(follower, node.catch)), values)
    if after is None or final is None:
        return None
    kept = {key: count for key, count in after.items() if key[0] not in roles}
    return {**kept, **{key: count for key, count in final.items() if key[0] in roles}}


def _parallel(
    follower: _Follower, node: n.Parallel, carried: Carried, values: Mapping[str, Expression]
) -> Carried | None:
    result = dict(carried)
    for branch in node.branches:
        after = follower.block(branch, carried, values)
        if after is None:
            return None
        result.update({key: count for key, count in after.items() if carried.get(key) != count})
    return result


def _call(follower: _Follower, node: n.Call, carried: Carried, values: Mapping[str, Expression]) -> Carried | None:
    follower.met += 1
    function = follower.functions.get(node.function)
    if function is None:
        return carried
    if follower.calls >= MOST_CALLS or follower.depth >= DEEPEST_CALL:
        return _forget(carried, frozenset(role for role, _ in carried) | _roles(follower, function.body))
    given = {name: values.get(v.name, v) if isinstance(v, Variable) else v for name, v in node.arguments}
    defaults = {p.name: Constant(p.default) for p in function.parameters if p.default is not None}
    changed = {set_by(inner) for inner in walk(function.body)}
    known = {name: value for name, value in {**defaults, **given}.items() if name not in changed}
    follower.enter()
    follower.calls += 1
    follower.depth += 1
    follower.nested += 1
    breaks, follower.breaks = follower.breaks, []
    follower.returns.append([])
    result = follower.block(function.body, carried, known)
    for returned in follower.returns.pop():
        result = _either(result, returned)
    follower.breaks = breaks
    follower.depth -= 1
    follower.nested -= 1
    return result


def _break(follower: _Follower, node: n.Break, carried: Carried, values: Mapping[str, Expression]) -> None:
    if follower.breaks:
        follower.breaks[-1].append(carried)


def _return(follower: _Follower, node: n.Return, carried: Carried, values: Mapping[str, Expression]) -> None:
    if follower.returns:
        follower.returns[-1].append(carried)


def _end(follower: _Follower, node: n.End, carried: Carried, values: Mapping[str, Expression]) -> None:
    """Nothing follows."""


def _roles(follower: _Follower, block: n.Block) -> frozenset[str]:
    """Return the roles that may carry something else after the block; a call may change every one."""
    nodes = walk(block)
    roles = {node.role for node in nodes if isinstance(node, n.LOADS)}
    if any(node.__class__ is n.Call for node in nodes):
        bodies = (function.body for function in follower.functions.values())
        roles |= {node.role for body in bodies for node in walk(body) if isinstance(node, n.LOADS)}
    return frozenset(roles)


_FOLLOW: Mapping[type[n.Node], Callable[..., Carried | None]] = {
    n.Pick: _pick,
    n.Drop: _drop,
    n.If: _if,
    n.While: _loop,
    n.Repeat: _loop,
    n.ForEach: _loop,
    n.Break: _break,
    n.Return: _return,
    n.End: _end,
    n.Try: _try,
    n.Parallel: _parallel,
    n.Call: _call,
}


def _count(carried: Carried, key: tuple[str, str]) -> Range:
    """Return how many of an object a robot carries."""
    return carried.get(key, ANY if (key[0], _EVERYTHING) in carried else (0, 0))


def _forget(carried: Carried, roles: frozenset[str]) -> Carried:
    """Return what is known when anything may have happened to these roles' loads."""
    kept = {key: count for key, count in carried.items() if key[0] not in roles}
    known = {key: ANY for key in carried if key[0] in roles}
    return {**kept, **known, **{(role, _EVERYTHING): ANY for role in roles}}


def _either(first: Carried | None, second: Carried | None) -> Carried | None:
    """Return what holds after one or the other; a path that leads nowhere has no say."""
    if first is second or second is None:
        return first
    if first is None:
        return second
    merged: dict[tuple[str, str], Range] = {}
    for key in {**first, **second}:
        a, b = _count(first, key), _count(second, key)
        merged[key] = (min(a[0], b[0]), None if a[1] is None or b[1] is None else max(a[1], b[1]))
    return merged


def follow_loads(
    tree: n.Tree, capacity: Callable[[str], int], robot: Callable[[str], Argument], memo: Memo | None = None
) -> list[tuple[Problem, int]]:
    """Return what is wrong with what robots carry, each with its node's identity.

    `capacity` tells how many objects a role's robot holds (0: not known), `robot` what to call it; `memo` has what
    was found at the last look.
    """
    functions = {function.method: function for function in tree.functions}
    follower = _Follower(functions, capacity, robot, memo=memo)
    if memo is not None:
        drivers = frozenset(node.role for f in tree.functions for node in walk(f.body) if isinstance(node, n.LOADS))
        memo.begin((drivers, [(role.name, capacity(role.name), robot(role.name)) for role in tree.roles]))
    follower.block(tree.body, {}, {})
    for event in tree.events:
        follower.block(event.body, _forget({}, frozenset(role.name for role in tree.roles)), {})
    return follower.found

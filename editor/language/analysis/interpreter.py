"""The abstract interpreter: one walk along all paths of a program, for all that is known along them.

It knows the flow of control and nothing else: branches, loops, calls, what happens at once, failures and early ends.
What is known on the way belongs to the domains. A condition that the variables decide leads one way only; a loop
whose rounds can be told is gone through round by round, any other until another round teaches nothing new. Functions
are followed with what is known where they are called. All of that is bounded; beyond the bounds less is known, and
what is told stays right.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import combinations
from math import comb
from typing import Any, Final

from editor.language.analysis.domain import Frame, States
from editor.language.analysis.effects import NOTHING, Effects, together
from editor.language.analysis.walk import Walk
from editor.language.document.outline import PROGRAM
from editor.language.expressions.nodes import Constant, Expression
from editor.language.expressions.ranges import Known
from editor.language.tree import nodes as n

Loop = n.While | n.Repeat | n.ForEach
Leaves = tuple[int, int, int]
"""How often a function was left so far, the program ended, and a failure brought about that nothing has caught."""
MOST_COUNTED = 100
"""A loop of more rounds is followed as one that nobody has counted."""
MOST_SILENT = 3
"""Rounds in which an uncounted loop may settle; after them nothing is known of what it changes."""
DEEPEST_CALL = 12
MOST_CONTEXTS = 8
"""A function is followed with so much different knowledge."""
DEEPEST_FINAL = 3
MOST_RACES = 20
"""So many sets of first branches are told apart; beyond them each branch is looked at alone."""
_TRUE = Constant(True)


def interpret(walk: Walk) -> None:
    """Follow the program from its beginning, its events, and the functions that are not known by then."""
    tree = walk.tree
    walk.frame = Frame(PROGRAM)
    end = walk.block(tree.body, walk.begin())
    if end is not None:
        walk.end(None, end)
    for event in tree.events:
        walk.frame = Frame(event.step)
        walk.block(event.body, walk.somewhere())
    for function in tree.functions:
        unseen = bool(function.body) and id(function.body[0]) not in walk.visited
        if unseen or function.method in walk.opened:
            follow_function(walk, function, walk.somewhere())


def follow_function(walk: Walk, function: n.Function, states: States) -> States | None:
    """Follow a function's body and return what holds where it comes back; None where it never does."""
    outside, walk.frame = walk.frame, Frame(function.method, function)
    end = walk.block(function.body, walk.copy(states))
    if end is not None and not walk.silent:
        walk.falls_off.add(function.method)
    over = walk.meet(states, [*walk.frame.returns, end], walk.effects.of(function.body))
    walk.frame = outside
    return over


def _if(walk: Walk, node: n.If, states: States) -> States | None:
    always = walk.truth(node, states)
    if always is not None:
        return walk.block(node.then if always else node.otherwise, states)
    with walk.unsure():
        then = walk.block(node.then, walk.assume(walk.copy(states), node, holds=True))
        otherwise = walk.block(node.otherwise, walk.assume(walk.copy(states), node, holds=False))
    return walk.meet(states, (then, otherwise), walk.changes(node.then, node.otherwise))


# loops


def _while(walk: Walk, node: n.While, states: States) -> States | None:
    """Follow a loop as long as its condition is known to hold, then as one of which nobody knows."""
    exits, now, effects = list[States](), walk.copy(states), walk.effects.of(node.body)
    leaves = _leaves(walk)
    with walk.again():
        for _ in range(MOST_COUNTED if walk.values is not None else 0):
            holds = walk.truth(node, now)
            if holds is False:
                return walk.meet(states, [now, *exits], effects)
            if holds is None or walk.left < 0:
                break
            begun = walk.copy(now)
            after = _round(walk, node, now, exits)
            if after is None or after == begun:
                return _left_by(walk, node, walk.meet(states, exits, effects), exits, leaves)
            now = after
            walk.read(node, now)
        over = _uncounted(walk, node, states, now, exits, goes_round=False)
    return _left_by(walk, node, over, exits, leaves)


def _leaves(walk: Walk) -> Leaves:
    return len(walk.frame.returns), walk.ended, len(walk.failures)


def _left_by(
    walk: Walk, node: n.While, over: States | None, exits: Sequence[States], leaves: Leaves
) -> States | None:  # fmt: skip
    """Note whether a loop is left at all, by a step in it or otherwise."""
    if not walk.silent:
        if exits or leaves != _leaves(walk):
            walk.broken.add(id(node))
        elif over is None:
            walk.endless.add(id(node))
    return over


def _repeat(walk: Walk, node: n.Repeat, states: States) -> States | None:
    least, most = walk.count(node, states)
    with walk.again():
        if least == most and least <= MOST_COUNTED and walk.domains:
            return _counted(walk, node, [None] * least, states)
        return _uncounted(walk, node, states, walk.copy(states), [], goes_round=least > 0)


def _for_each(walk: Walk, node: n.ForEach, states: States) -> States | None:
    with walk.again():
        if not walk.domains or len(node.items) > MOST_COUNTED:
            return _uncounted(walk, node, states, walk.copy(states), [], goes_round=bool(node.items))
        return _counted(walk, node, node.items, states)


def _counted(walk: Walk, node: n.Repeat | n.ForEach, items: Sequence[Any], states: States) -> States | None:
    """Follow a loop round by round."""
    exits = list[States]()
    now: States | None = walk.copy(states)
    for item in items:
        assert now is not None
        if walk.left < 0:
            return _uncounted(walk, node, states, now, exits, goes_round=True)
        begun = walk.copy(now)
        now = _round(walk, node, now, exits, None if item is None else (item,))
        if now is None or (item is None and now == begun):
            break  # the rounds that are left bring nothing new
    return walk.meet(states, [*exits, now], walk.effects.of(node.body))


def _uncounted(
    walk: Walk, node: Loop, before: States, now: States, exits: list[States], *, goes_round: bool
) -> States | None:
    """Follow the body in silence until another round teaches nothing new, then once more to tell."""
    items = node.items if isinstance(node, n.ForEach) else None
    with walk.unsure():
        entry = _settled(walk, node, now)
        walk.read(node, entry)
        after = _round(walk, node, walk.assume(walk.copy(entry), node, holds=True), exits, items)
    ends: list[States | None] = [*exits]
    if not (isinstance(node, n.While) and node.condition == _TRUE):
        ends.append(None if after is None else walk.assume(after, node, holds=False))
        ends.append(None if goes_round else walk.assume(entry, node, holds=False))
    return walk.meet(before, ends, walk.effects.of(node.body))


def _settled(walk: Walk, node: Loop, entry: States) -> States:
    """Return what is known at the beginning of every round."""
    items = node.items if isinstance(node, n.ForEach) else None
    effects = walk.effects.of(node.body)
    if effects is NOTHING:
        return entry
    with walk.silently():
        for _ in range(MOST_SILENT):
            if walk.left < 0:
                break
            after = _round(walk, node, walk.assume(walk.copy(entry), node, holds=True), [], items)
            if after is None:
                return entry
            widened = walk.widen(entry, after, effects)
            if widened == entry:
                return entry
            entry = widened
    return walk.disturb(entry, effects)


def _round(
    walk: Walk, node: Loop, states: States, exits: list[States], items: Sequence[Expression] | None = None
) -> States | None:
    """Follow a loop's body once; what is known where a step leaves the loop is added to the exits."""
    frame, outside = walk.frame, walk.frame.loops
    frame.breaks.append([])
    if isinstance(node, n.ForEach):
        rows = zip(walk.domains, states, strict=True)
        states = [domain.enter_round(walk, known, node, items or ()) for domain, known in rows]
        frame.loops = (*outside, node)
    after = walk.block(node.body, states)
    frame.loops = outside
    exits.extend(frame.breaks.pop())
    return after


# failures, and what happens at once


def _try(walk: Walk, node: n.Try, states: States) -> States | None:
    """The catch begins anywhere in the body, the final part anywhere in both; every exit leads through it."""
    frame = walk.frame
    marks = len(frame.breaks[-1]) if frame.breaks else 0, len(frame.returns)
    failures = len(walk.failures)
    after = walk.block(node.body, walk.copy(states))
    if node.catches:
        walk.failures[failures:] = [kind for kind in walk.failures[failures:] if node.kinds and kind not in node.kinds]
        with walk.unsure():
            caught = walk.block(node.catch, walk.disturb(states, walk.effects.of(node.body)))
        after = walk.meet(states, (after, caught), walk.changes(node.body, node.catch))
    if not node.final:
        return after
    with walk.unsure():
        ended = walk.block(node.final, walk.disturb(states, walk.changes(node.body, node.catch)))
    _exits_through(walk, node, marks, ended)
    if ended is None or after is None:
        return None
    walk.finals += 1
    with walk.silently(silent=walk.finals > DEEPEST_FINAL):
        end = walk.block(node.final, after)
    walk.finals -= 1
    return end


def _exits_through(walk: Walk, node: n.Try, marks: tuple[int, int], ended: States | None) -> None:
    """What is left by a break or a return is known as far as the final part does not change it."""
    frame, effects = walk.frame, walk.effects.of(node.final)
    for exits, mark in ((frame.breaks[-1] if frame.breaks else [], marks[0]), (frame.returns, marks[1])):
        exits[mark:] = [] if ended is None else [walk.disturb(each, effects) for each in exits[mark:]]


def _parallel(walk: Walk, node: n.Parallel, states: States) -> States | None:
    """Follow each branch beside what the others may do: first in silence, to see what they set, then to tell."""
    effects = [walk.effects.of(branch) for branch in node.branches]
    known: dict[str, Known] = {}
    if not walk.silent and walk.values is not None and any(each.names or each.shared for each in effects):
        outside, walk.put = walk.put, {}
        with walk.silently():
            _branches(walk, node, walk.copy(states), effects, {})
        known, walk.put = walk.put, outside
    if node.races:
        return _race(walk, node, states, effects, known)
    ends = _branches(walk, node, states, effects, known)
    done = [end for end in ends if end is not None]
    return None if len(done) < len(ends) else _joined(walk, states, done, effects)


def _joined(walk: Walk, states: States, ends: Sequence[States], effects: Sequence[Effects]) -> States:
    """Return what holds where these branches have all come to their ends."""
    return [
        domain.join(walk, states[place], [(end[place], own) for end, own in zip(ends, effects, strict=True)])
        for place, domain in enumerate(walk.domains)
    ]


def _race(
    walk: Walk, node: n.Parallel, states: States, effects: list[Effects], known: Mapping[str, Known]
) -> States | None:
    """Follow a Parallel that ends before all of its branches have; a loop that nothing ends is called off in it."""
    endless, ended, put, passed = set(walk.endless), walk.ended, walk.put, walk.passed
    walk.raced, walk.put, walk.passed = walk.raced + 1, {} if put is None else put, walk.copy(states)
    ends = _branches(walk, node, states, effects, known)
    over = _after_race(walk, node, states, effects, ends)
    if passed is not None:
        rows = zip(walk.domains, passed, walk.passed, strict=True)
        passed = [domain.passing(outer, inner) for domain, outer, inner in rows]
    walk.raced, walk.put, walk.passed, walk.endless = walk.raced - 1, put, passed, endless
    if over is None and walk.ended == ended and not walk.silent:
        walk.endless.add(id(node))
    return over


def _after_race(
    walk: Walk, node: n.Parallel, states: States, effects: Sequence[Effects], ends: Sequence[States | None]
) -> States | None:
    """Return what holds when enough branches have come to their ends, whichever they are; None where too few do."""
    done = [index for index, end in enumerate(ends) if end is not None]
    needed = max(node.needed or 0, 1)
    if len(done) < needed:
        return None
    found: list[States | None] = []
    for winners in combinations(done, needed if comb(len(done), needed) <= MOST_RACES else 1):
        over = _joined(walk, states, [ends[index] or [] for index in winners], [effects[index] for index in winners])
        others = together(own for index, own in enumerate(effects) if index not in winners)
        rows = zip(walk.domains, over, walk.passed or (), strict=True)
        found.append([domain.interrupted(walk, one, others, passed) for domain, one, passed in rows])
    return walk.meet(states, found, together(effects))


def _branches(
    walk: Walk, node: n.Parallel, states: States, effects: list[Effects], known: Mapping[str, Known]
) -> list[States | None]:
    """Follow the branches; of what others set all is known that they may set it to, or nothing."""
    outside = walk.volatile
    ends: list[States | None] = []
    for index, branch in enumerate(node.branches):
        others = together(effects[:index] + effects[index + 1 :])
        walk.volatile = {**outside, **{name: known.get(name) for name in others.names | others.shared}}
        alive = [end for end in ends if end is not None]
        begin = [
            domain.beside(walk, known, [end[place] for end in alive], others)
            for place, (domain, known) in enumerate(zip(walk.domains, walk.copy(states), strict=True))
        ]
        walk.frame.breaks.append([])
        ends.append(walk.block(branch, begin))
        walk.frame.breaks.pop()
    walk.volatile = outside
    return ends


# calls and exits


def _call(walk: Walk, node: n.Call, states: States) -> States | None:
    """Follow a function with what is known here; what is known of such a call is not asked again."""
    function = walk.functions.get(node.function)
    after = states if function is None else _called(walk, node, function, states)
    if after is not None:
        walk.transfer(node, after)
    return after


def _called(walk: Walk, node: n.Call, function: n.Function, states: States) -> States | None:
    unfollowed = walk.effects.functions[function.method]
    if walk.summaries is not None:
        return walk.disturb(states, unfollowed) if walk.summaries[function.method] else None
    rows = zip(walk.domains, states, strict=True)
    walk.states = states
    keys = tuple(domain.key(walk, known, node, function) for domain, known in rows)
    key = function.method, keys, frozenset(walk.volatile.items()), walk.silent, walk.raced > 0
    if key in walk.running:
        if walk.running[key] != walk.ways_out():
            return walk.disturb(states, unfollowed)
        if not walk.silent:
            walk.endless.add(id(node))
        return None
    if key not in walk.contexts:
        known_calls = walk.known_calls.get(function.method, 0)
        if known_calls >= MOST_CONTEXTS or len(walk.running) >= DEEPEST_CALL or walk.left < 0:
            walk.opened.add(function.method)
            return walk.disturb(states, unfollowed)
        walk.known_calls[function.method] = known_calls + 1
        walk.contexts[key] = _followed(walk, key, node, function, states)
    over, ends, failures = walk.contexts[key]
    walk.ended += ends
    walk.failures += failures
    if over is None:
        return None
    ended = zip(walk.domains, states, over, strict=True)
    return [domain.leave(walk, known, end, function) for domain, known, end in ended]


def _followed(
    walk: Walk, key: object, node: n.Call, function: n.Function, states: States
) -> tuple[States | None, bool, list[str]]:  # fmt: skip
    ended, failures = walk.ended, len(walk.failures)
    walk.running[key] = walk.ways_out()
    with walk.again():
        rows = zip(walk.domains, states, strict=True)
        begin = [domain.enter(walk, known, node, function) for domain, known in rows]
        over = follow_function(walk, function, begin)
    del walk.running[key]
    failed, walk.failures[failures:] = {*walk.failures[failures:]}, []
    return over, walk.ended > ended, sorted(failed)


def _break(walk: Walk, node: n.Break, states: States) -> None:
    if walk.frame.breaks:
        walk.frame.breaks[-1].append(states)


def _return(walk: Walk, node: n.Return, states: States) -> None:
    walk.transfer(node, states)
    walk.returned += 1
    walk.frame.returns.append(states)


def _fail(walk: Walk, node: n.Fail, states: States) -> None:
    """A Try around may catch it, which begins with whatever may be known there; nothing else goes on from here."""
    walk.failures.append("failed")


FOLLOW: Final[Mapping[type[n.Node], Callable[[Walk, Any, States], States | None]]] = {
    n.If: _if,
    n.While: _while,
    n.Repeat: _repeat,
    n.ForEach: _for_each,
    n.Try: _try,
    n.Parallel: _parallel,
    n.Call: _call,
    n.Break: _break,
    n.Return: _return,
    n.End: Walk.end,
    n.Fail: _fail,
}

"""The abstract interpreter: one walk along all paths of a program, for all that is known along them.

It knows the flow of control and nothing else: branches, loops, calls, what happens at once, failures and early ends.
What is known on the way belongs to the domains. A condition that the variables decide leads one way only; a loop
whose rounds can be told is gone through round by round, any other until another round teaches nothing new. Functions
are followed with what is known where they are called. All of that is bounded; beyond the bounds less is known, and
what is told stays right.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

from editor.language.analysis.branches import follow_branches
from editor.language.analysis.calls import follow_call, follow_function
from editor.language.analysis.domain import Frame, States
from editor.language.analysis.effects import NOTHING
from editor.language.analysis.walk import Walk
from editor.language.document.outline import PROGRAM
from editor.language.expressions.nodes import Constant, Expression
from editor.language.expressions.ranges import Range
from editor.language.tree import nodes as n

Loop = n.While | n.Repeat | n.ForEach
Leaves = tuple[int, int, int]
"""How often a function was left so far, the program ended, and a failure brought about that nothing has caught."""
MOST_COUNTED = 100
"""A loop of more rounds is followed as one that nobody has counted."""
MOST_SILENT = 3
"""Rounds in which an uncounted loop may settle; after them nothing is known of what it changes."""
DEEPEST_FINAL = 3
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
        walk.block(event.body, walk.in_event())
    for function in tree.functions:
        unseen = bool(function.body) and id(function.body[0]) not in walk.visited
        if unseen or function.method in walk.opened:
            follow_function(walk, function, walk.somewhere())


def _if(walk: Walk, node: n.If, states: States) -> States | None:
    always = walk.truth(node, states)
    if always is not None:
        return walk.block(node.then if always else node.otherwise, states)
    with walk.unsure:
        then = walk.block(node.then, walk.assume(walk.copy(states), node, holds=True))
        otherwise = walk.block(node.otherwise, walk.assume(walk.copy(states), node, holds=False))
    return walk.meet(states, (then, otherwise), node.then, node.otherwise)


# loops


def _while(walk: Walk, node: n.While, states: States) -> States | None:
    """Follow a loop as long as its condition is known to hold, then as one of which nobody knows."""
    exits, now, leaves = list[States](), walk.copy(states), _leaves(walk)
    with walk.again:
        for _ in range(MOST_COUNTED if walk.values is not None else 0):
            holds = walk.truth(node, now)
            if holds is False:
                return walk.meet(states, [now, *exits], node.body)
            if holds is None or walk.left < 0:
                break
            begun = walk.copy(now)
            after = _round(walk, node, now, exits)
            if after is None or after == begun:
                return _left_by(walk, node, walk.meet(states, exits, node.body), exits, leaves)
            now = after
            walk.read(node, now)
        over = _uncounted(walk, node, states, now, exits, goes_round=False)
    return _left_by(walk, node, over, exits, leaves)


def _leaves(walk: Walk) -> Leaves:
    return len(walk.frame.returns), walk.ended, len(walk.failures)


def _left_by(
    walk: Walk, node: n.While, over: States | None, exits: Sequence[States], leaves: Leaves
) -> States | None:  # fmt: skip
    """Note whether a loop is left at all, by a step in it, by a time limit around it, or otherwise."""
    left = exits or leaves != _leaves(walk)
    if not walk.silent:
        if left or walk.limited:
            walk.broken.add(id(node))
        elif over is None:
            walk.endless.add(id(node))
    if over is None and walk.limited and not left:
        walk.failures.append("timed_out")
    return over


def _repeat(walk: Walk, node: n.Repeat, states: States) -> States | None:
    least, most = walk.count(node, states)
    with walk.again:
        if least == most and least <= MOST_COUNTED and walk.domains:
            return _counted(walk, node, [None] * least, states)
        return _uncounted(walk, node, states, walk.copy(states), [], goes_round=least > 0)


def _for_each(walk: Walk, node: n.ForEach, states: States) -> States | None:
    least, most = walk.length(node, states)
    with walk.again:
        if not walk.domains or least < most or most > MOST_COUNTED:
            return _uncounted(walk, node, states, walk.copy(states), [], goes_round=least > 0)
        return _counted(walk, node, node.items if node.over is None else [node.over] * most, states)


def _counted(walk: Walk, node: n.Repeat | n.ForEach, items: Sequence[Any], states: States) -> States | None:
    """Follow a loop round by round."""
    exits = list[States]()
    now: States | None = walk.copy(states)
    for number, item in enumerate(items, start=1):
        assert now is not None
        if walk.left < 0:
            return _uncounted(walk, node, states, now, exits, goes_round=True)
        begun = walk.copy(now)
        now = _round(walk, node, now, exits, () if item is None else (item,), Range(number, number))
        if now is None or (item is None and now == begun):
            break  # the rounds that are left bring nothing new
    return walk.meet(states, [*exits, now], node.body)


def _uncounted(
    walk: Walk, node: Loop, before: States, now: States, exits: list[States], *, goes_round: bool
) -> States | None:
    """Follow the body in silence until another round teaches nothing new, then once more to tell.

    What is known in the first round alone is told of that: of a loop in another's first round only of all rounds.
    """
    items = node.items if isinstance(node, n.ForEach) else ()
    with walk.unsure:
        entry = _settled(walk, node, walk.copy(now))
        if entry != now and not (walk.silent or walk.first or walk.rewrites):
            walk.first = True
            _round(walk, node, walk.assume(walk.copy(now), node, holds=True), [], items)
            walk.first = False
        walk.read(node, entry)
        after = _round(walk, node, walk.assume(walk.copy(entry), node, holds=True), exits, items)
    ends: list[States | None] = [*exits]
    if not (isinstance(node, n.While) and node.condition == _TRUE):
        ends.append(None if after is None else walk.assume(after, node, holds=False))
        ends.append(None if goes_round else walk.assume(now, node, holds=False))
    return walk.meet(before, ends, node.body)


def _settled(walk: Walk, node: Loop, entry: States) -> States:
    """Return what is known at the beginning of every round."""
    items = node.items if isinstance(node, n.ForEach) else ()
    effects = walk.effects.of(node.body)
    if effects is NOTHING:
        return entry
    if walk.rewrites:
        return walk.disturb(entry, effects)
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
    walk: Walk,
    node: Loop,
    states: States,
    exits: list[States],
    items: Sequence[Expression] = (),
    rounds: Range | None = None,
) -> States | None:
    """Follow a loop's body once; what is known where a step leaves the loop is added to the exits."""
    frame, outside = walk.frame, walk.frame.loops
    frame.breaks.append([])
    frame.continues.append([])
    if isinstance(node, n.ForEach):
        rows = zip(walk.domains, states, strict=True)
        these = rounds or Range(1, max(1, walk.length(node, states)[1]))
        states = [domain.enter_round(walk, known, node, items, these) for domain, known in rows]
        frame.loops = (*outside, node)
    begun = walk.copy(states) if walk.tree.holds(n.Continue) else states
    after = walk.block(node.body, states)
    frame.loops = outside
    exits.extend(frame.breaks.pop())
    early = frame.continues.pop()
    return walk.meet(begun, [*early, after], node.body) if early else after


# failures, and what happens at once


def _try(walk: Walk, node: n.Try, states: States) -> States | None:
    """A catch begins anywhere in the body, the final part anywhere in all of them; every exit leads through it."""
    marks = tuple(map(len, walk.frame.exits()))
    failures = len(walk.failures)
    after = walk.block(node.body, walk.copy(states))
    if node.handlers:
        walk.failures[failures:] = [
            kind for kind in walk.failures[failures:] if not any(each.takes(kind) for each in node.handlers)
        ]
        begun = walk.disturb(states, walk.effects.of(node.body))
        with walk.unsure:
            caught = [walk.block(block, walk.copy(begun)) for block in node.catches]
        after = walk.meet(states, (after, *caught), node.body, *node.catches)
    if not node.final:
        return after
    with walk.unsure:
        ended = walk.block(node.final, walk.disturb(states, walk.changes(node.body, *node.catches)))
    _exits_through(walk, node, marks, ended)
    if ended is None or after is None:
        return None
    if walk.rewrites:  # what it does to what the end of the body knows is as if it had been done beside
        effects, rows = walk.effects.of(node.final), zip(walk.domains, after, ended, strict=True)
        return [domain.join(walk, known, [(end, effects)]) for domain, known, end in rows]
    walk.finals += 1
    with walk.silently(silent=walk.finals > DEEPEST_FINAL):
        end = walk.block(node.final, after)
    walk.finals -= 1
    return end


def _limit(walk: Walk, node: n.Limit, states: States) -> States | None:
    """What comes behind is come to from the end of the body alone: past its time a limit fails, as a step does."""
    walk.limited += 1
    after = walk.block(node.body, states)
    walk.limited -= 1
    return after


def _exits_through(walk: Walk, node: n.Try, marks: Sequence[int], ended: States | None) -> None:
    """What is left by a break, a continue or a return is known as far as the final part does not change it."""
    effects = walk.effects.of(node.final)
    for exits, mark in zip(walk.frame.exits(), marks, strict=True):
        exits[mark:] = [] if ended is None else [walk.disturb(each, effects) for each in exits[mark:]]


def _break(walk: Walk, node: n.Break, states: States) -> None:
    if walk.frame.breaks:
        walk.frame.breaks[-1].append(states)


def _continue(walk: Walk, node: n.Continue, states: States) -> None:
    if walk.frame.continues:
        walk.frame.continues[-1].append(states)


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
    n.Limit: _limit,
    n.Parallel: follow_branches,
    n.Call: follow_call,
    n.Break: _break,
    n.Continue: _continue,
    n.Return: _return,
    n.End: Walk.end,
    n.Fail: _fail,
}

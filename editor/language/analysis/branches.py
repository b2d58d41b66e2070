"""How the walk follows a Parallel: each branch beside what the others may do, to the end of all or of the first."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations
from math import comb

from editor.language.analysis.domain import States
from editor.language.analysis.effects import Effects, together
from editor.language.analysis.walk import Walk
from editor.language.expressions.ranges import Known
from editor.language.tree import nodes as n

MOST_RACES = 20
"""So many sets of first branches are told apart; beyond them each branch is looked at alone."""


def follow_branches(walk: Walk, node: n.Parallel, states: States) -> States | None:
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
    endless, ended, put, passed = set(walk.endless), (walk.ended, len(walk.failures)), walk.put, walk.passed
    walk.raced, walk.put, walk.passed = walk.raced + 1, {} if put is None else put, walk.copy(states)
    ends = _branches(walk, node, states, effects, known)
    over = _after_race(walk, node, states, effects, ends)
    if passed is not None:
        rows = zip(walk.domains, passed, walk.passed, strict=True)
        passed = [domain.passing(outer, inner) for domain, outer, inner in rows]
    walk.raced, walk.put, walk.passed, walk.endless = walk.raced - 1, put, passed, endless
    if over is None and (walk.ended, len(walk.failures)) == ended and not walk.silent:
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
    return walk.meet(states, found, *node.branches)


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
        walk.frame.continues.append([])
        ends.append(walk.block(branch, begin))
        walk.frame.breaks.pop()
        walk.frame.continues.pop()
    walk.volatile = outside
    return ends


# calls and exits

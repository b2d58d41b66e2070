"""How the walk follows a call: into the function, with what is known there; not for ever, and not too often."""

from __future__ import annotations

from editor.language.analysis.domain import Frame, States
from editor.language.analysis.walk import Walk
from editor.language.tree import nodes as n
from editor.language.tree.program import Function

DEEPEST_CALL = 12
MOST_CONTEXTS = 8
"""A function is followed with so much different knowledge."""


def follow_function(walk: Walk, function: Function, states: States) -> States | None:
    """Follow a function's body and return what holds where it comes back; None where it never does."""
    outside, walk.frame = walk.frame, Frame(function.method, function)
    end = walk.block(function.body, walk.copy(states))
    if end is not None and not walk.silent:
        walk.falls_off.add(function.method)
    over = walk.meet(states, [*walk.frame.returns, end], function.body)
    walk.frame = outside
    return over


def follow_call(walk: Walk, node: n.Call, states: States) -> States | None:
    """Follow a function with what is known here; what is known of such a call is not asked again."""
    function = walk.functions.get(node.function)
    after = states if function is None else _called(walk, node, function, states)
    if after is not None:
        walk.transfer(node, after)
    return after


def _called(walk: Walk, node: n.Call, function: Function, states: States) -> States | None:
    unfollowed = walk.effects.functions[function.method]
    if walk.summaries is not None:
        return walk.disturb(states, unfollowed) if walk.summaries[function.method] else None
    rows = zip(walk.domains, states, strict=True)
    walk.states = states
    keys = tuple(domain.key(walk, known, node, function) for domain, known in rows)
    key = function.method, keys, frozenset(walk.volatile.items()), walk.silent, walk.limited > 0, walk.raced > 0
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
    walk: Walk, key: object, node: n.Call, function: Function, states: States
) -> tuple[States | None, bool, list[str]]:  # fmt: skip
    ended, failures = walk.ended, len(walk.failures)
    walk.running[key] = walk.ways_out()
    with walk.again:
        rows = zip(walk.domains, states, strict=True)
        begin = [domain.enter(walk, known, node, function) for domain, known in rows]
        over = follow_function(walk, function, begin)
    del walk.running[key]
    failed, walk.failures[failures:] = {*walk.failures[failures:]}, []
    return over, walk.ended > ended, sorted(failed)

"""Checks of time limits: what surely takes longer than a limit around it allows."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import inf

from editor.language.checks.context import Context
from editor.language.checks.values import range_in
from editor.language.expressions.constant_values import constant_value
from editor.language.expressions.nodes import Expression
from editor.language.tree import nodes as n

_MOST_ROUNDS = 10**6
_LEAVES = (n.Break, n.Return, n.End, n.Fail)


@dataclass(slots=True)
class _Clock:
    """Follows blocks and reckons how much time has passed at least, from their waits."""

    context: Context
    wrong: frozenset[str]
    """The steps whose time is wrong; nothing follows from it."""
    breaks: int = 0
    """The breaks that were met: a loop with one may be left at any time."""

    def block(self, block: n.Block, now: float, over: float) -> float:
        """Return the least time at a block's end; infinite where that is never come to.

        `now` is the least time at its beginning, `over` the time when the limits around it are over, in seconds.
        """
        for node in block:
            before, now = now, self._after(node, now, over)
            self.breaks += isinstance(node, n.Break)
            if isinstance(node, _LEAVES) or now == inf:
                return inf
            if before < over <= now:
                self.context.report(node, "past_limit", "duration" if isinstance(node, n.Wait) else "")
                return inf
        return now

    def _after(self, node: n.Node, now: float, over: float) -> float:
        match node:
            case n.Wait(seconds=seconds):
                return now + self._least(node, seconds)
            case n.Limit(seconds=seconds, body=body):
                return self.block(body, now, min(over, now + self._most(node, seconds)))
            case n.Repeat(times=times, body=body):
                return self._counted(body, constant_value(times), now, over)
            case n.ForEach(items=items, body=body):
                return self._counted(body, len(items), now, over)
            case n.Try(body=body, catches=catches, final=final):
                done = [self.block(inner, now, over) for inner in (body, *catches)]
                self.block(final, now, inf)
                return min(done)
        ends = [self.block(inner, now, over) for inner in n.blocks_of(node)]
        # of what happens at once the first may be enough; a While need not go round
        return now if isinstance(node, n.While) else min(ends, default=now)

    def _counted(self, body: n.Block, rounds: object, now: float, over: float) -> float:
        breaks = self.breaks
        took = self.block(body, now, over) - now
        sure = breaks == self.breaks and took < inf and isinstance(rounds, int) and rounds > 0
        return now + took * min(rounds, _MOST_ROUNDS) if sure and isinstance(rounds, int) else now

    def _least(self, node: n.Wait, seconds: Expression) -> float:
        return 0 if node.step in self.wrong else max(0, range_in(self.context, seconds, "SEC").least)

    def _most(self, node: n.Limit, seconds: Expression) -> float:
        return inf if node.step in self.wrong else range_in(self.context, seconds, "SEC").most


def check_limited(context: Context) -> None:
    """Tell of the first step on each path that surely ends later than a time limit around it.

    A wait for what never comes true lasts until the limit is over, and not for ever.
    """
    tree = context.tree
    if not tree.holds(n.Limit):
        return
    clock = _Clock(context, frozenset(problem.step for problem, _ in context.found if problem.field == "duration"))
    blocks = (tree.body, *(event.body for event in tree.events), *(f.body for f in tree.functions))
    inside = {id(node) for block in blocks for node in _limited(block) if isinstance(node, n.WaitUntil)}
    context.found[:] = [
        (replace(found, code="past_limit") if found.code == "waits_for_ever" and key in inside else found, key)
        for found, key in context.found
    ]
    for block in blocks:
        clock.block(block, 0, inf)


def _limited(block: n.Block) -> Iterator[n.Node]:
    """Yield the steps of a block that stand in a time limit of it."""
    for node in block:
        if isinstance(node, n.Limit):
            yield from n.walk(node.body)
        else:
            for inner in n.blocks_of(node):
                yield from _limited(inner)

"""Whether there are as many robots as roles that need one at the same time: each keeps its own until the end."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import reduce

from editor.language.checks.context import Context
from editor.language.expressions.value_types import constant_value
from editor.language.messages.phrases import Options
from editor.language.tree import nodes as n
from editor.language.tree.nodes import blocks_of

DEEPEST_CALL = 50
"""Functions that call each other are followed so far; what is deeper adds nothing."""
Held = frozenset[str]
_ENDS = (n.End, n.Return, n.Break)


@dataclass(slots=True)
class _Follower:
    """The walk along all paths, with the roles that surely have a robot already."""

    context: Context
    told: set[str] = field(default_factory=set)
    calls: dict[tuple[str, Held], Held] = field(default_factory=dict)
    """What functions were found to hold after them, by what was held before; one that calls itself adds nothing."""
    depth: int = 0

    def block(self, block: n.Block, held: Held) -> Held:
        """Return the roles that have a robot after a block, whatever path was taken."""
        for node in block:
            if isinstance(node, n.DRIVES):
                held = self._take(node, held)
            elif isinstance(node, n.Call):
                held = self._call(node, held)
            elif isinstance(node, n.Parallel):
                held = reduce(lambda so_far, branch: self.block(branch, so_far), node.branches, held)
            elif isinstance(node, n.Try):
                held = self._try(node, held)
            elif blocks_of(node):
                held = self._maybe(node, held)
            elif isinstance(node, _ENDS):
                break
        return held

    def _take(self, node: n.Move | n.Pick | n.Drop, held: Held) -> Held:
        if node.role in held:
            return held
        together = held | {node.role}
        if _has_robots_for(self.context, together):
            return together
        if node.role not in self.told:
            self.told.add(node.role)
            names = Options(tuple(sorted(together)), "and")
            robots = {robot.id for role in together for robot in self.context.robots(role)}
            self.context.report(node, "too_few_robots", "role", {"roles": names, "count": len(robots)})
        return held

    def _call(self, node: n.Call, held: Held) -> Held:
        function = self.context.functions.get(node.function)
        if function is None or self.depth >= DEEPEST_CALL:
            return held
        key = node.function, held
        if key not in self.calls:
            self.calls[key] = held
            self.depth += 1
            self.calls[key] = self.block(function.body, held)
            self.depth -= 1
        return self.calls[key]

    def _try(self, node: n.Try, held: Held) -> Held:
        after = self.block(node.body, held)
        caught = self.block(node.catch, held)
        return self.block(node.final, after & caught if node.catches else after)

    def _maybe(self, node: n.Node, held: Held) -> Held:
        """Of two branches one is taken; a loop is gone through at least once only where that is said."""
        ends = [self.block(inner, held) for inner in blocks_of(node)]
        if isinstance(node, n.If):
            return frozenset.intersection(*ends)
        times = constant_value(node.times) if isinstance(node, n.Repeat) else None
        surely = (isinstance(times, int | float) and times >= 1) or (isinstance(node, n.ForEach) and bool(node.items))
        return ends[0] if surely else held


def check_crew(context: Context) -> None:
    """Tell of the first step of a role for which no robot is left, with the roles that have theirs already."""
    if len({context.robot_key(role) for role in context.roles}) < 2:
        return
    follower = _Follower(context)
    for body in (context.tree.body, *(event.body for event in context.tree.events)):
        follower.block(body, frozenset())


def _has_robots_for(context: Context, roles: Held) -> bool:
    """Tell whether each of these roles can have a robot of its own; one without any robot is told elsewhere."""
    wants = {context.robot_key(role): [robot.id for robot in context.robots(role)] for role in sorted(roles)}
    given: dict[str, tuple[str, str]] = {}

    def find(role: tuple[str, str], seen: set[str]) -> bool:
        for robot in wants[role]:
            if robot not in seen:
                seen.add(robot)
                if robot not in given or find(given[robot], seen):
                    given[robot] = role
                    return True
        return False

    return all(find(role, set()) for role, robots in wants.items() if robots)

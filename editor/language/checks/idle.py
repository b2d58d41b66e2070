"""Checks of logic that does nothing: branches and loops without steps, and loops that turn without taking time."""

from __future__ import annotations

from typing import get_args

from editor.language.checks.context import Context
from editor.language.constructs.table import FORMS
from editor.language.expressions.constant_values import constant_value, is_measured
from editor.language.expressions.nodes import Constant, Variable
from editor.language.expressions.values import parts_of
from editor.language.tree import nodes as n
from editor.language.tree.program import Tree
from editor.language.tree.traversal import calls_by_function
from editor.language.tree.variables import set_by

_TAKE_TIME = frozenset(node for node in get_args(n.Node) if FORMS[node.__name__][0].takes_time)
_LEAVE = (n.Break, n.Return, n.End)


def check_idle(context: Context) -> None:
    """Tell of steps that hold nothing, and of loops that only go round until something else happens."""
    tree = context.tree
    for kind in (n.If, n.Repeat, n.ForEach, n.Limit):
        for node in tree.of_kind(kind):
            if not any(n.blocks_of(node)):
                context.report(node, "empty_branch", "")
    slow = slow_functions(tree) if tree.of_kind(n.While) else frozenset()
    for loop in tree.of_kind(n.While):
        _check_circle(context, loop, slow)


def _check_circle(context: Context, node: n.While, slow: frozenset[str]) -> None:
    """Tell of a loop that waits for what is measured, or set beside it, and takes no time for it."""
    if any(isinstance(step, _LEAVE) for step in node.body) or takes_time(node.body, slow):
        return
    inside = _within(context, node.body)
    changed = set(map(set_by, inside))
    read = {part.name for part in parts_of(node.condition) if isinstance(part, Variable)}
    beside = context.tree.events or context.tree.holds(n.Parallel)
    waits = is_measured(node.condition) or (beside and read & context.changing()) or _leaves_by_itself(node, inside)
    if changed.isdisjoint(read) and waits:
        context.report(node, "busy_circle", "")


def _leaves_by_itself(node: n.While, inside: list[n.Node]) -> bool:
    """Tell whether a loop without an end of its own is left when something that is measured says so."""
    forever = isinstance(node.condition, Constant) and constant_value(node.condition) is True
    leaves = any(isinstance(step, _LEAVE) for step in inside)
    return forever and leaves and any(isinstance(step, n.If) and is_measured(step.condition) for step in inside)


def takes_time(block: n.Block, slow: frozenset[str]) -> bool:
    """Tell whether any step of a block waits for something; `slow` are the functions that do."""
    for node in block:
        kind = node.__class__
        if kind in _TAKE_TIME or (isinstance(node, n.Call) and node.function in slow):
            return True
        if kind in n.COMPOSITES and any(takes_time(inner, slow) for inner in n.blocks_of(node)):
            return True
    return False


def slow_functions(tree: Tree) -> frozenset[str]:
    """Return the functions in which any step waits for something, also in those that they call."""
    slow = {f.method for f in tree.functions if takes_time(f.body, frozenset())}
    callers: dict[str, list[str]] = {}
    for method, called in calls_by_function(tree).items():
        for callee in called:
            callers.setdefault(callee, []).append(method)
    left = [*slow]
    while left:
        new = {caller for caller in callers.get(left.pop(), ()) if caller not in slow}
        slow |= new
        left.extend(new)
    return frozenset(slow)


def _within(context: Context, block: n.Block) -> list[n.Node]:
    """Return the steps of a block, with those of the functions that it calls."""
    steps = n.walk(block)
    seen: set[str] = set()
    for step in steps:  # grows while it is gone through
        if isinstance(step, n.Call) and step.function not in seen and step.function in context.functions:
            seen.add(step.function)
            steps.extend(n.walk(context.functions[step.function].body))
    return steps

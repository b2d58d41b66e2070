"""Checks of logic that does nothing: branches and loops without steps, and loops that turn without taking time."""

from __future__ import annotations

from editor.language.checks.context import Context
from editor.language.expressions.nodes import Constant, Variable
from editor.language.expressions.value_types import constant_value, is_measured
from editor.language.expressions.values import parts_of
from editor.language.tree import nodes as n
from editor.language.tree.variables import set_by

_TAKE_TIME = (*n.ACTS, n.Operate, n.Wait, n.WaitUntil, n.Ask)
_LEAVE = (n.Break, n.Return, n.End)


def check_idle(context: Context) -> None:
    """Tell of steps that hold nothing, and of loops that only go round until something else happens."""
    tree = context.tree
    if not tree.holds(n.If, n.While, n.Repeat, n.ForEach, n.Limit):
        return
    for block in (tree.body, *(event.body for event in tree.events), *(f.body for f in tree.functions)):
        for node in tree.walked(block):
            if isinstance(node, n.While):
                _check_circle(context, node)
            elif isinstance(node, n.If | n.Repeat | n.ForEach | n.Limit) and not any(n.blocks_of(node)):
                context.report(node, "empty_branch", "")


def _check_circle(context: Context, node: n.While) -> None:
    """Tell of a loop that waits for what is measured, or set beside it, and takes no time for it."""
    if any(isinstance(step, _LEAVE) for step in node.body):
        return
    inside = _within(context, node.body)
    if takes_time(context, node.body):
        return
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


def takes_time(context: Context, block: n.Block) -> bool:
    """Tell whether any step of a block waits for something, also in the functions that it calls."""
    return any(isinstance(step, _TAKE_TIME) for step in _within(context, block))


def _within(context: Context, block: n.Block) -> list[n.Node]:
    """Return the steps of a block, with those of the functions that it calls."""
    steps = n.walk(block)
    seen: set[str] = set()
    for step in steps:  # grows while it is gone through
        if isinstance(step, n.Call) and step.function not in seen and step.function in context.functions:
            seen.add(step.function)
            steps.extend(n.walk(context.functions[step.function].body))
    return steps

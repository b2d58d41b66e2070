"""Checks of the condition by which a role's robot is chosen, told at the first step that the robot does."""

from __future__ import annotations

from editor.language.checks.context import Context
from editor.language.checks.values import check_condition, has_missing
from editor.language.expressions.ranges import possible
from editor.language.tree import nodes as n
from editor.language.tree.choice import of_role
from editor.language.tree.program import Role

_SAID_HERE = frozenset({"may_not_tell", "never_true_in_range", "contradiction"})
"""A robot that does not report it is not chosen; a choice that nobody meets has a sentence of its own."""


def check_choice(context: Context, node: n.Node, role: Role) -> None:
    """Check a condition: it looks at the robot's own readings, gives yes or no, and some robot can meet it."""
    field = n.robot_field(node)
    if role.looks_elsewhere:
        context.report(node, "choice_looks_elsewhere", field, {"role": role.name})
    if role.where is None:
        return
    where = of_role(role.where, role.name)
    outside, context.found = context.found, []
    check_condition(context, node, where, field)
    found, context.found = context.found, outside
    context.found.extend(each for each in found if each[0].code not in _SAID_HERE)
    if not has_missing(where) and possible(where, context.surroundings) is False:
        context.report(node, "never_chosen", field, {"role": role.name})

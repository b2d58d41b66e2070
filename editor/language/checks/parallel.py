"""Checks of what happens at once: branches that fight over a robot, or wait for each other."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import combinations

from editor.language.checks.context import Context
from editor.language.checks.idle import slow_functions, takes_time
from editor.language.expressions.constant_values import constant_value
from editor.language.expressions.nodes import Constant, Expression, Operation, Variable
from editor.language.expressions.values import parts_of
from editor.language.messages.diagnostics import Fix
from editor.language.messages.phrases import Options
from editor.language.tree import nodes as n
from editor.language.tree.nodes import walk
from editor.language.tree.program import Tree
from editor.language.tree.traversal import roles_used
from editor.language.tree.variables import SETTERS, program_variables, set_by, set_in, sets_of_functions

Drivers = dict[tuple[str, str], str]
"""What tells robots apart → their roles."""


def check_needed(context: Context, node: n.Parallel) -> None:
    """So many branches as are needed must be there, and take time: one that does not calls the others off at once."""
    count = len(node.branches)
    if node.needed is None:
        return
    if not 1 <= node.needed <= count:
        fix = Fix("all_branches", node.step, "needed", None)
        context.report(node, "needed_out_of_range", "needed", {"count": count}, fix)
    elif node.races:
        quick = [_letter(index) for index, branch in enumerate(node.branches) if _is_over_at_once(context, branch)]
        if len(quick) >= node.needed:
            context.report(node, "over_at_once", "needed", {"branches": Options(tuple(quick), "and")})


def _slow(context: Context) -> frozenset[str]:
    """Return the functions that take time, worked out once for all Parallels."""
    if context.slow is None:
        context.slow = slow_functions(context.tree)
    return context.slow


def _is_over_at_once(context: Context, branch: n.Block) -> bool:
    """Tell whether a branch comes to its end as soon as it begins; one that ends the program does not."""
    return not takes_time(branch, _slow(context)) and not any(isinstance(step, n.End | n.Fail) for step in walk(branch))


def check_branches(context: Context, node: n.Parallel) -> None:
    """Two branches cannot drive the same robot."""
    drivers = [_drivers(context, branch, n.ACTS) for branch in node.branches]
    for (first, mine), (second, theirs) in combinations(enumerate(drivers), 2):
        for key in sorted(mine.keys() & theirs.keys()):
            names = {"first": _letter(first), "second": _letter(second)}
            robot = context.driver_name(theirs[key])
            context.report(
                node,
                "shared_robot",
                "branches",
                {**names, "robot": robot},
                _own_robot(context, node, second, theirs[key]),
            )

    _check_releases(context, node, drivers)
    _check_updates(context, node)


def _check_releases(context: Context, node: n.Parallel, drivers: list[Drivers]) -> None:
    """A branch cannot release a robot that another uses, or releases."""
    if not context.tree.holds(n.Release):
        return
    releases = [_drivers(context, branch, (n.Release,)) for branch in node.branches]
    for first, mine in enumerate(releases):
        for second, theirs in enumerate(drivers):
            both = mine.keys() & (theirs.keys() | (releases[second].keys() if second > first else set()))
            for key in sorted(both - drivers[first].keys()) if second != first else ():
                names = {"first": _letter(first), "second": _letter(second)}
                robot = context.driver_name(mine[key])
                context.report(node, "released_beside", "branches", {**names, "robot": robot})


def _check_updates(context: Context, node: n.Parallel) -> None:
    """Two branches that set one variable: nobody can say whose value it has then."""
    if not context.tree.holds(*SETTERS):
        return
    sets = sets_of_functions(context.tree)
    shared = program_variables(context.tree)
    names = [_names_set_in(branch, sets, shared) for branch in node.branches]
    if node.needed == 1 and node.races:
        names = _without_the_first(context, node, names)
    for (first, mine), (second, theirs) in combinations(enumerate(names), 2):
        both = [*walk(node.branches[first]), *walk(node.branches[second])]
        for name in sorted(mine & theirs):
            if all(_adds(each, name) for each in both if set_by(each) == name):
                continue
            args = {"first": _letter(first), "second": _letter(second), "variable": name}
            context.report(node, "branches_set_it", "branches", args)


def _without_the_first(context: Context, node: n.Parallel, names: list[frozenset[str]]) -> list[frozenset[str]]:
    """Leave out what branches set only at their very end: the first that comes so far calls the others off."""
    late = [_set_at_the_end(context, branch) for branch in node.branches]
    early = frozenset().union(*(mine - last for mine, last in zip(names, late, strict=True)))
    return [mine & early for mine in names]


def _set_at_the_end(context: Context, branch: n.Block) -> frozenset[str]:
    """Return the variables that a branch sets nowhere but in steps behind which nothing takes time."""
    start = len(branch)
    while start and not takes_time(branch[start - 1 : start], _slow(context)):
        start -= 1
    if start and isinstance(branch[start - 1], n.Ask):
        start -= 1
    before = {set_by(node) for node in walk(branch[:start])}
    return frozenset(map(set_by, branch[start:])) - before - {""}


def _adds(node: n.Node, name: str) -> bool:
    """Tell whether a step adds to a variable, or takes from it: nothing is lost, whichever comes first."""
    match node:
        case n.Set(value=Operation(operator="+" | "-", arguments=(Variable(name=first), other))):
            return first == name and other != Variable(name)
        case n.Set(value=Operation(operator="+", arguments=(other, Variable(name=second)))):
            return second == name and other != Variable(name)
    return False


def _names_set_in(branch: n.Block, sets: Mapping[str, frozenset[str]], shared: frozenset[str]) -> frozenset[str]:
    """Return the variables that a branch sets, also by its functions, whose own ones are nobody else's."""
    here = set_in(branch, {})
    calls = [node.function for node in walk(branch) if isinstance(node, n.Call)]
    return here.union(*(sets.get(function, frozenset()) & shared for function in calls))


def _own_robot(context: Context, node: n.Parallel, branch: int, role: str) -> Fix | None:
    """Return the fix that gives a branch a role of its own; not where functions decide who drives."""
    if any(isinstance(inner, n.Call) for inner in walk(node.branches[branch])):
        return None
    letter = _letter(branch)
    value = {"branch": letter, "role": context.roles[role].id or role}
    return Fix("own_robot", node.step, "robot_of", value, {"value": letter})


def _letter(index: int) -> str:
    return chr(97 + index)


def _drivers(context: Context, block: n.Block, steps: tuple[type[n.Node], ...] = n.OF_ROBOTS) -> Drivers:
    """Return what tells the robots apart that a block has in such steps, also by its functions, with their roles."""
    return {context.robot_key(role): role for role in roles_used(block, context.tree, steps)}


def check_parallel(context: Context) -> None:
    """Check the events against the program beside which they run, and branches that wait for each other."""
    tree = context.tree
    main = _drivers(context, tree.body) if tree.events else {}
    for event in tree.events:
        if event.starts == "branch":
            for key, role in sorted(_drivers(context, event.body).items()):
                if key in main:
                    context.report_step(event.step, "event_shares_robot", "", {"robot": context.driver_name(role)})
    if tree.holds(n.Parallel):
        for node in _all_nodes(tree):
            if isinstance(node, n.Parallel):
                _check_waiting(context, node)


@dataclass(frozen=True, slots=True)
class _Wait:
    """A wait without a limit, at the top of a branch, that only a variable's new value can end."""

    branch: int
    index: int
    variable: str
    node: n.WaitUntil


def _check_waiting(context: Context, node: n.Parallel) -> None:
    """Tell of two branches of which each sets what the other waits for only after its own waiting.

    Where enough other branches are there to end, these two are called off.
    """
    if node.races and len(node.branches) - 2 >= (node.needed or 0):
        return
    waits = [wait for index, branch in enumerate(node.branches) for wait in _waits(index, branch)]
    for first, second in combinations(waits, 2):
        if first.branch == second.branch:
            continue
        if _only_after(context, node, first, second) and _only_after(context, node, second, first):
            letters = {"first": _letter(first.branch), "second": _letter(second.branch)}
            names = {**letters, "variable": first.variable, "other": second.variable}
            context.report(node, "branches_wait", "branches", names)


def _waits(branch: int, block: n.Block) -> Iterator[_Wait]:
    for index, node in enumerate(block):
        if isinstance(node, n.WaitUntil) and node.timeout_s is None:
            names = {part.name for part in parts_of(node.condition) if isinstance(part, Variable)}
            if len(names) == 1:
                yield _Wait(branch, index, names.pop(), node)


def _only_after(context: Context, node: n.Parallel, wait: _Wait, other: _Wait) -> bool:
    """Tell whether nothing can end the wait but what stands in the other branch behind its own wait."""
    late = {id(inner) for inner in walk(node.branches[other.branch][other.index + 1 :])}
    known = {parameter.name for parameter in context.tree.parameters}
    if wait.variable in known:
        return False
    setters = [inner for inner in _all_nodes(context.tree) if set_by(inner) == wait.variable]
    early = [inner for inner in setters if id(inner) not in late]
    ends = any(id(inner) in late for inner in setters)
    return ends and all(isinstance(inner, n.Set) and _keeps_waiting(wait, inner.value) for inner in early)


def _keeps_waiting(wait: _Wait, value: Expression) -> bool:
    return constant_value(_with(wait.node.condition, {wait.variable: value})) is False


def _with(expression: Expression, values: Mapping[str, Expression]) -> Expression:
    """Return the expression with constants in the place of variables."""
    if isinstance(expression, Variable):
        value = values.get(expression.name, expression)
        return value if isinstance(value, Constant) else expression
    if isinstance(expression, Operation):
        return Operation(expression.operator, tuple(_with(argument, values) for argument in expression.arguments))
    return expression


def _all_nodes(tree: Tree) -> Iterator[n.Node]:
    for block in (tree.body, *(event.body for event in tree.events), *(f.body for f in tree.functions)):
        yield from tree.walked(block)

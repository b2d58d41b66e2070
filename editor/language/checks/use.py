"""Checks of what is never used: functions, variables and parameters."""

from __future__ import annotations

from collections.abc import Iterator

from editor.language.checks.context import Context
from editor.language.tree import nodes as n
from editor.language.tree.nodes import walk
from editor.language.tree.program import Tree
from editor.language.tree.variables import SETTERS, read_by, set_by


def check_use(context: Context) -> None:
    """Tell of what the program has and never uses."""
    if context.tree.functions:
        _check_functions(context)
    if context.tree.holds(*SETTERS):
        _check_variables(context)
    if context.tree.parameters or any(function.parameters for function in context.tree.functions):
        _check_parameters(context)


def _check_functions(context: Context) -> None:
    """Tell of functions that nothing calls, at their first step."""
    tree = context.tree
    left = [tree.body, *(event.body for event in tree.events)]
    called: set[str] = set()
    while left:
        for node in walk(left.pop()):
            if isinstance(node, n.Call) and node.function in context.functions and node.function not in called:
                called.add(node.function)
                left.append(context.functions[node.function].body)
    for function in tree.functions:
        if function.method not in called and function.body:
            context.report(function.body[0], "unused_function", "", {"function": function.name or function.method})


def _check_variables(context: Context) -> None:
    """Tell of variables that are set and never read, at the first step that sets them."""
    first: dict[str, n.Node] = {}
    read = {name for event in context.tree.events for name in read_by(n.If(event.condition))}
    for node in _all_nodes(context.tree):
        first.setdefault(set_by(node), node)
        read.update(read_by(node))
    for name, node in first.items():
        if name and name not in read:
            field_name = "result" if isinstance(node, n.Call) else "variable"
            context.report(node, "unused_variable", field_name, {"variable": name})


def _check_parameters(context: Context) -> None:
    """Tell of parameters that no value reads: a function's at its first step, the program's for all of it."""
    tree = context.tree
    for function in tree.functions:
        read = {name for node in tree.walked(function.body) for name in read_by(node)}
        for parameter in function.parameters if function.body else ():
            if parameter.name not in read:
                context.report(function.body[0], "unused_parameter", "", {"parameter": parameter.name})
    if tree.parameters and tree.body:
        read = {name for event in tree.events for name in read_by(n.If(event.condition))}
        read.update(name for node in _all_nodes(tree) for name in read_by(node))
        for parameter in tree.parameters:
            if parameter.name not in read:
                context.report_step("", "unused_parameter", "parameters", {"parameter": parameter.name})


def _all_nodes(tree: Tree) -> Iterator[n.Node]:
    for block in (tree.body, *(event.body for event in tree.events), *(f.body for f in tree.functions)):
        yield from tree.walked(block)

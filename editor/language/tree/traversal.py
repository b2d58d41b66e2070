"""Traversals of a tree: every node in reading order, functions as they are called, what each robot has to do."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Final

from editor.language.expressions.names import ROBOT_METHODS
from editor.language.tree.nodes import (
    COMPOSITES,
    OF_ROBOTS,
    Block,
    Call,
    Cover,
    ForEach,
    Node,
    Perform,
    Release,
    blocks_of,
)
from editor.language.tree.program import Function, Role, Tree

Loops = tuple[ForEach, ...]
"""The loops over values around a step, the outermost first."""


def with_loops(block: Block) -> list[tuple[Node, Loops]]:
    """Return the steps of a block and of everything in it, in reading order, each with the loops over values around."""
    found: list[tuple[Node, Loops]] = []
    _gather_with_loops(block, (), found)
    return found


def _gather_with_loops(block: Block, loops: Loops, found: list[tuple[Node, Loops]]) -> None:
    for node in block:
        found.append((node, loops))
        if node.__class__ in COMPOSITES:
            inside = (*loops, node) if isinstance(node, ForEach) else loops
            for inner in blocks_of(node):
                _gather_with_loops(inner, inside, found)


def reading_order(tree: Tree) -> tuple[Function, ...]:
    """Return the functions in the order of their first call; those that nobody calls come last, by name."""
    if not tree.functions:
        return ()
    by_method = {function.method: function for function in tree.functions}
    found: dict[str, Function] = {}
    uncalled = sorted(tree.functions, key=lambda function: function.method, reverse=True)
    bodies = (tree.body, *(event.body for event in tree.events))
    first = [function for body in bodies for function in _called_in(tree, body, by_method)]
    left = [*uncalled, *reversed(first)]
    while left:
        function = left.pop()
        if function.method not in found:
            found[function.method] = function
            left.extend(reversed(_called_in(tree, function.body, by_method)))
    return tuple(found.values())


def _called_in(tree: Tree, block: Block, by_method: Mapping[str, Function]) -> list[Function]:
    calls = [node.function for node in tree.walked(block) if isinstance(node, Call)]
    return [by_method[name] for name in calls if name in by_method]


def needed_of_roles(tree: Tree, functions: tuple[Function, ...]) -> dict[str, tuple[str, ...]]:
    """Return what each role must be able to do, roles in the order of first use; a robot that picks also drives."""
    needed = {role: set[type[Node]]() for role in first_uses(tree, functions)}
    for kind in OF_ROBOTS if needed else ():
        for role in tree.roles_of(kind):
            needed[role].add(kind)
    own: dict[str, set[str]] = {}
    for node in tree.of_kind(Perform):
        if node.method not in ROBOT_METHODS:
            own.setdefault(node.role, set()).add(node.method)
    return {role: _methods_of(uses, own.get(role, set()) - {""}) for role, uses in needed.items()}


def first_uses(tree: Tree, functions: tuple[Function, ...]) -> dict[str, Node]:
    """Return the first step of each role, where the functions stand in this order; as far as need be gone through."""
    roles = tree.roles_of(*OF_ROBOTS)
    first: dict[str, Node] = {}
    for block in (tree.body, *(f.body for f in functions), *(event.body for event in tree.events)):
        for node in tree.walked(block):
            if len(first) == len(roles):
                return first
            if isinstance(node, OF_ROBOTS):
                first.setdefault(node.role, node)
    return first


_OF_NO_METHOD: Final = frozenset({Perform, Release})
"""Steps that need no method of the robot that is called like them."""


def _methods_of(uses: set[type[Node]], own: set[str]) -> tuple[str, ...]:
    """Return the methods that such steps need, those of a robot's own behind the others."""
    methods = {"move" if use is Cover else use.__name__.lower() for use in uses if use not in _OF_NO_METHOD}
    wanted = methods - {"move"} or methods
    return (*(method for method in ROBOT_METHODS if method in wanted), *sorted(own))


def calls_by_function(tree: Tree) -> dict[str, tuple[str, ...]]:
    """Return the functions that each function calls itself."""
    return tree.derived(_calls_by_function)


def _calls_by_function(tree: Tree) -> dict[str, tuple[str, ...]]:
    return {
        function.method: tuple(dict.fromkeys(n.function for n in tree.walked(function.body) if n.__class__ is Call))
        for function in tree.functions
    }


def callees_first(tree: Tree) -> tuple[Function, ...]:
    """Return the functions so that each comes after those that it calls, as far as that can be."""
    return tree.derived(_callees_first)


def _callees_first(tree: Tree) -> tuple[Function, ...]:
    by_method = {function.method: function for function in tree.functions}
    calls = calls_by_function(tree)
    done: dict[str, Function] = {}
    begun: set[str] = set()
    left = [*reversed(by_method)]
    while left:
        method = left[-1]
        waiting = [m for m in calls[method] if m in by_method and m not in begun] if method not in begun else []
        begun.add(method)
        left.extend(waiting)
        if not waiting:
            done.setdefault(left.pop(), by_method[method])
    return tuple(done.values())


def functions_in_circles(tree: Tree) -> frozenset[str]:
    """Return the functions that call themselves, directly or by way of others (Tarjan's components, without depth)."""
    return tree.derived(_functions_in_circles)


def _functions_in_circles(tree: Tree) -> frozenset[str]:
    calls = calls_by_function(tree)
    order: dict[str, int] = {}
    lowest: dict[str, int] = {}
    open_: dict[str, None] = {}
    circular: set[str] = set()
    for first in calls:
        left = [(first, iter(calls[first]))] if first not in order else []
        while left:
            method, called = left[-1]
            if method not in order:
                order[method] = lowest[method] = len(order)
                open_[method] = None
            following = next(
                (each for each in called if each in calls and _leads_on(each, method, order, lowest, open_)), None
            )
            if following is not None:
                left.append((following, iter(calls[following])))
                continue
            left.pop()
            if left:
                around = left[-1][0]
                lowest[around] = min(lowest[around], lowest[method])
            if lowest[method] == order[method]:
                component = _popped(open_, method)
                if len(component) > 1 or method in calls[method]:
                    circular.update(component)
    return frozenset(circular)


def _leads_on(
    called: str, method: str, order: Mapping[str, int], lowest: dict[str, int], open_: Mapping[str, None]
) -> bool:
    """Tell whether a called function is still to be gone into; one that is gone through leads back, or nowhere new."""
    if called not in order:
        return True
    if called in open_:
        lowest[method] = min(lowest[method], order[called])
    return False


def _popped(open_: dict[str, None], method: str) -> list[str]:
    component: list[str] = []
    while not component or component[-1] != method:
        component.append(open_.popitem()[0])
    return component


def roles_used(block: Block, tree: Tree, steps: tuple[type[Node], ...] = OF_ROBOTS) -> frozenset[str]:
    """Return the roles that a block uses in such steps, also in the functions that it calls."""
    by_method = {function.method: function for function in tree.functions}
    roles: set[str] = set()
    seen: set[str] = set()
    left = [block]
    while left:
        for node in tree.walked(left.pop()):
            if isinstance(node, steps):
                roles.update([node.role] if isinstance(node, OF_ROBOTS) else [])
            elif isinstance(node, Call) and node.function in by_method and node.function not in seen:
                seen.add(node.function)
                left.append(by_method[node.function].body)
    return frozenset(roles)


def in_reading_order(tree: Tree) -> Tree:
    """Put functions in the order of their first call, and roles in that of their first use; unused roles go."""
    functions = reading_order(tree)
    needed = needed_of_roles(tree, functions)
    by_name = {role.name: role for role in tree.roles}
    roles = (_fill(by_name[name], methods) for name, methods in needed.items())
    return tree.in_order(functions, tuple(roles))


def _fill(role: Role, needed: tuple[str, ...]) -> Role:
    """Add to a role for any robot what its steps need."""
    can = () if role.device is not None else tuple(dict.fromkeys([*role.can, *needed]))
    return replace(role, can=can)

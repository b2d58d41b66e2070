"""The bodies of a program, and what is known in each while its steps are checked: types, ranges, what was found."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from editor.language.analysis.memo import Findings, Memo
from editor.language.analysis.value_ranges import Ranges, Scope, Types, find_ranges, ranges_at
from editor.language.checks.context import Context
from editor.language.document.outline import PROGRAM
from editor.language.expressions.ranges import Range
from editor.language.expressions.value_types import UNKNOWN_TYPE, ValueType, declared_type
from editor.language.tree import nodes as n
from editor.language.tree.variable_types import types_in_function, types_in_loops, types_in_program, with_loops
from editor.language.tree.variables import SETTERS, local_variables, program_variables, read_by

Checks = Mapping[type[n.Node], Callable[..., None]]
_LOOK_AROUND = (n.Call, n.Parallel)


@dataclass(slots=True)
class Body:
    """The program's own body, an event's or a function's; `name` tells it apart, `result` is what it gives back."""

    name: str
    scope: Scope
    ranges: Ranges
    result: ValueType = UNKNOWN_TYPE
    event: n.Event | None = None
    _seen: dict[tuple[int, ...], Mapping[str, Range]] = field(default_factory=dict)

    def enter(self, context: Context, node: n.Node | None = None, loops: tuple[n.ForEach, ...] = ()) -> None:
        """Let the checks see what is known at a step, or in the body as a whole."""
        context.result = self.result
        context.variables = self.scope.types_in_loops.get(id(node), self.scope.types)
        key = tuple(map(id, loops))
        if key not in self._seen:
            self._seen[key] = ranges_at(self.ranges, self.scope, loops) if self.ranges else {}
        context.ranges = self._seen[key]

    def check(self, context: Context, checks: Checks) -> None:
        """Check each step; what was found of one at the last look holds where as much is known."""
        self.enter(context)
        memo: Memo | None = None
        if context.memos is not None:
            memo = context.memos.of_block(self.name, (self.scope.types, self.result))
        if not self.scope.types_in_loops:
            for node in context.tree.walked(self.scope.body):
                _check_node(context, checks, node, memo, (None, _read_there(node, context.ranges)))
            return
        for node, loops in with_loops(self.scope.body):
            self.enter(context, node, loops)
            known = context.variables if loops else None, _read_there(node, context.ranges)
            _check_node(context, checks, node, memo, known)


def _check_node(context: Context, checks: Checks, node: n.Node, memo: Memo | None, known: object) -> None:
    reported: Findings | None = memo.get(node, known) if memo is not None else None
    if reported is not None:
        context.found.extend(reported)
        return
    before = len(context.found)
    checks[type(node)](context, node)
    if memo is not None and not _looks_around(node):
        memo.put(node, tuple(context.found[before:]), known)


def find_bodies(context: Context) -> list[Body]:
    """Return the bodies of a program, its own first, then those of its events and functions."""
    tree, site = context.tree, context.surroundings
    shared = program_variables(tree)
    types = types_in_program(tree, shared, site)
    scopes = [_scope(context, "", body, types) for body in (tree.body, *(event.body for event in tree.events))]
    for function in tree.functions:
        own = frozenset(p.name for p in function.parameters) | frozenset(local_variables(function, shared))
        inside = types_in_function(tree, function, types, site)
        scopes.append(_scope(context, function.method, function.body, inside, own))
    ranges = find_ranges(tree, scopes, site) if tree.holds(*SETTERS, n.ForEach) else {}
    names = (PROGRAM, *(event.step for event in tree.events), *(function.method for function in tree.functions))
    bodies = [Body(name, scope, ranges) for name, scope in zip(names, scopes, strict=True)]
    behind = len(bodies) - len(tree.functions)
    for event, body in zip(tree.events, bodies[1:behind], strict=True):
        body.event = event
    for function, body in zip(tree.functions, bodies[behind:], strict=True):
        body.result = declared_type(function.result_type, function.result_unit)
    return bodies


def _scope(context: Context, name: str, body: n.Block, types: Types, own: frozenset[str] = frozenset()) -> Scope:
    in_loops = types_in_loops(body, types, context.surroundings) if context.tree.holds(n.ForEach) else {}
    return Scope(name, body, types, in_loops, own)


def _read_there(node: n.Node, ranges: Mapping[str, Range]) -> tuple[tuple[str, Range], ...]:
    """Return the ranges on which the check of a step depends."""
    return tuple((name, ranges[name]) for name in read_by(node) if name in ranges) if ranges else ()


def _looks_around(node: n.Node) -> bool:
    """Tell whether the check of a step looks at other steps, or at where robots are."""
    return isinstance(node, _LOOK_AROUND) or (isinstance(node, n.Move) and node.to.device is None)

"""The bodies of a program, with the types that are seen in each; their steps are checked each for itself."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from editor.language.analysis.memo import Findings, Memo
from editor.language.checks.context import Context
from editor.language.document.outline import PROGRAM
from editor.language.expressions.value_types import UNKNOWN_TYPE, ValueType, declared_type
from editor.language.tree import nodes as n
from editor.language.tree.variable_types import Types, types_in_function, types_in_loops, types_in_program
from editor.language.tree.variables import program_variables

Checks = Mapping[type[n.Node], Callable[..., None]]
_LOOK_AROUND = (n.Call, n.Parallel)


@dataclass(frozen=True, slots=True)
class Body:
    """The program's own body, an event's or a function's; `name` tells it apart, `result` is what it gives back."""

    name: str
    block: n.Block
    types: Types
    types_in_loops: Mapping[int, Types]
    """What is seen at the steps in loops over values, by their identity."""
    result: ValueType = UNKNOWN_TYPE
    event: n.Event | None = None

    def types_at(self, node: n.Node) -> Types:
        """Return the types that are seen at a step."""
        return self.types_in_loops.get(id(node), self.types)

    def enter(self, context: Context, node: n.Node) -> None:
        """Let the checks see what is known at a step."""
        context.result, context.body = self.result, self.name
        context.variables = self.types_at(node)

    def check(self, context: Context, checks: Checks) -> None:
        """Check each step; what was found of one at the last look holds where as much is known."""
        context.result, context.variables, context.body = self.result, self.types, self.name
        memo: Memo | None = None
        if context.memos is not None:
            memo = context.memos.of_block(self.name, (self.types, self.result))
        for node in context.tree.walked(self.block):
            seen = self.types_in_loops.get(id(node)) if self.types_in_loops else None
            reported: Findings | None = memo.get(node, seen) if memo is not None else None
            if reported is None:
                context.variables = self.types if seen is None else seen
                _check_node(context, checks, node, memo, seen)
            else:
                context.found += reported


def _check_node(context: Context, checks: Checks, node: n.Node, memo: Memo | None, seen: object) -> None:
    before = len(context.found)
    if (check := checks.get(type(node))) is not None:
        check(context, node)
    if memo is not None and not _looks_around(node):
        memo.put(node, tuple(context.found[before:]), seen)


def find_bodies(context: Context) -> list[Body]:
    """Return the bodies of a program, its own first, then those of its events and functions."""
    tree, site = context.tree, context.surroundings
    shared = program_variables(tree)
    types = types_in_program(tree, shared, site)
    bodies = [_body(context, PROGRAM, tree.body, types)]
    bodies += [_body(context, event.step, event.body, types, event=event) for event in tree.events]
    for function in tree.functions:
        inside = types_in_function(tree, function, types, site)
        result = declared_type(function.result_type, function.result_unit)
        bodies.append(_body(context, function.method, function.body, inside, result))
    return bodies


def _body(
    context: Context,
    name: str,
    block: n.Block,
    types: Types,
    result: ValueType = UNKNOWN_TYPE,
    event: n.Event | None = None,
) -> Body:
    in_loops = types_in_loops(block, types, context.surroundings, context.tree) if context.tree.holds(n.ForEach) else {}
    return Body(name, block, types, in_loops, result, event)


def _looks_around(node: n.Node) -> bool:
    """Tell whether the check of a step looks at other steps, or at where robots are."""
    match node:
        case n.Move(to=place):
            return place.device is None
        case n.Pick(at=place) | n.Drop(at=place) | n.Operate(device=place):
            return place.value is not None
    return isinstance(node, _LOOK_AROUND)

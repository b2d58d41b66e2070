"""Checks of the steps that leave something: whether it stands around them, and may be left."""

from __future__ import annotations

from dataclasses import dataclass, replace

from editor.language.checks.context import Context
from editor.language.messages.diagnostics import Fix
from editor.language.tree import nodes as n
from editor.language.tree.program import Function


@dataclass(frozen=True, slots=True)
class _Around:
    """What stands around a step; `None` where there is none, else the code of what would be left on the path there."""

    function: Function | None = None
    barrier: str = ""
    """What keeps a return from leaving the function."""
    loop: str | None = None
    """What keeps a break or a continue from its innermost loop; empty: nothing does."""

    def behind(self, code: str) -> _Around:
        """Return what stands around the steps in something that no step may leave."""
        return replace(self, barrier=code, loop=None if self.loop is None else code)


def check_exits(context: Context) -> None:
    """Check every break, every continue and every return of the program."""
    tree = context.tree
    if not tree.holds(n.Break, n.Continue, n.Return):
        return
    for block in (tree.body, *(event.body for event in tree.events)):
        _block(context, block, _Around())
    for function in tree.functions:
        _block(context, function.body, _Around(function))


def _block(context: Context, block: n.Block, around: _Around) -> None:
    for node in block:
        match node:
            case n.Break() | n.Continue():
                _of_loop(context, node, around)
            case n.Return():
                _return(context, node, around)
            case n.While(body=body) | n.Repeat(body=body) | n.ForEach(body=body):
                _block(context, body, replace(around, loop=""))
            case n.Parallel(branches=branches):
                _each(context, branches, around.behind("leaves_parallel"))
            case n.Try(body=body, catches=catches, final=final):
                _each(context, (body, *catches), around)
                _block(context, final, around.behind("leaves_finally"))
            case n.Limit(body=body):
                _block(context, body, around)
            case n.If(then=then, otherwise=otherwise):
                _block(context, then, around)
                _block(context, otherwise, around)


def _each(context: Context, blocks: tuple[n.Block, ...], around: _Around) -> None:
    for block in blocks:
        _block(context, block, around)


def _of_loop(context: Context, node: n.Break | n.Continue, around: _Around) -> None:
    if around.loop is None:
        code = "break_outside_loop" if isinstance(node, n.Break) else "continue_outside_loop"
        context.report(node, code, "")
    elif around.loop:
        context.report(node, around.loop, "")


def _return(context: Context, node: n.Return, around: _Around) -> None:
    function = around.function
    if function is None:
        context.report(node, "return_outside_function", "", fix=Fix("make_end", node.step, "kind", "end"))
    elif around.barrier:
        context.report(node, around.barrier, "")
    elif node.value is not None and not function.result_type:
        fix = Fix("remove", node.step, "value", None, {"value": "value"})
        context.report(node, "returns_unasked", "value", {"function": function.name or function.method}, fix)

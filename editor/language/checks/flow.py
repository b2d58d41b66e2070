"""Checks of the paths through a program: what is never reached, what never ends, which function gives no value."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

from editor.language.analysis.memo import Findings, Memo
from editor.language.checks.context import Context
from editor.language.expressions.nodes import Constant, Expression, Located, Operation, Reading, Variable
from editor.language.expressions.value_types import constant_value
from editor.language.expressions.values import parts_of
from editor.language.messages.diagnostics import Fix
from editor.language.tree import nodes as n
from editor.language.tree.nodes import walk
from editor.language.tree.traversal import callees_first, functions_in_circles
from editor.language.tree.variables import set_in, sets_of_functions

Outcomes = frozenset[str]
"""How a block can be left: `on` to what follows, `break`, `return`, `end`; without any it never ends."""
ON, NO_OUTCOME = frozenset({"on"}), Outcomes()
_STATES_TIME = frozenset({"now", "distance", "nearest"})


@dataclass(slots=True)
class _Flow:
    """One look at all paths; `context` is None while the functions are only being understood."""

    functions: dict[str, Outcomes] = field(default_factory=dict)
    context: Context | None = None
    sets: Mapping[str, frozenset[str]] = field(default_factory=dict)
    """The variables that each function sets."""
    beside: frozenset[str] = frozenset()
    """Variables that events or the branches of a Parallel set; they may change at any time."""
    memo: Memo | None = None
    calls: int = 0

    def block(self, block: n.Block) -> Outcomes:
        """Return how the block can be left."""
        outcomes = ON
        for index, node in enumerate(block):
            follow = _FOLLOW.get(type(node))
            if follow is None:
                continue
            after = self._followed(node) if node.__class__ in n.COMPOSITES else follow(self, node)
            outcomes = (outcomes - ON) | after
            if "on" not in outcomes:
                self._tell_unreached(block, index)
                break
        return outcomes

    def _followed(self, node: n.Node) -> Outcomes:
        """Follow a step that holds others; without calls what is found depends on nothing else."""
        if self.context is None or self.memo is None:
            return _FOLLOW[type(node)](self, node)
        known: tuple[Outcomes, Findings] | None = self.memo.get(node)
        if known is None:
            calls, reported = self.calls, len(self.context.found)
            known = _FOLLOW[type(node)](self, node), tuple(self.context.found[reported:])
            if calls == self.calls:
                self.memo.put(node, known)
        else:
            self.context.found.extend(known[1])
        return known[0]

    def _tell_unreached(self, block: n.Block, last: int) -> None:
        rest = [node for node in block[last + 1 :] if node.step != block[last].step]
        if self.context is not None and rest:
            step = rest[0].step
            self.context.report(rest[0], "never_reached", "", fix=Fix("delete_step", step, "delete", None))


def _if(flow: _Flow, node: n.If) -> Outcomes:
    then, otherwise = flow.block(node.then), flow.block(node.otherwise)
    always = constant_value(node.condition)
    if isinstance(always, bool):
        return then if always else otherwise
    return then | otherwise


def _while(flow: _Flow, node: n.While) -> Outcomes:
    inside = flow.block(node.body)
    always = constant_value(node.condition)
    out = (inside - {"on", "break"}) | (ON if "break" in inside else NO_OUTCOME)
    if flow.context is not None and not out:
        if always is True:
            flow.context.report(node, "never_ends", "condition")
        elif always is None and not _may_change(flow, node):
            flow.context.report(node, "may_never_end", "condition")
    return out if always is True else out | ON


def _may_change(flow: _Flow, node: n.While) -> bool:
    """Tell whether the condition can become false: what it looks at is measured, or set while the loop runs."""
    parts = tuple(parts_of(node.condition))
    names = {part.name for part in parts if isinstance(part, Variable)}
    missing = any(isinstance(part, Constant) and part.value is None for part in parts)
    if missing or any(_is_measured(part) for part in parts) or names & flow.beside:
        return True
    return flow.context is None or bool(names & set_in(node.body, flow.sets))


def _is_measured(part: Expression) -> bool:
    if isinstance(part, Operation):
        return part.operator in _STATES_TIME
    return isinstance(part, Reading) or (isinstance(part, Located) and (part.role or part.zone) is not None)


def _repeat(flow: _Flow, node: n.Repeat | n.ForEach) -> Outcomes:
    inside = flow.block(node.body)
    out = (inside - {"break"}) | (ON if "break" in inside else NO_OUTCOME)
    return out if _runs_at_least_once(node) else out | ON


def _runs_at_least_once(node: n.Repeat | n.ForEach) -> bool:
    if isinstance(node, n.ForEach):
        return bool(node.items)
    times = constant_value(node.times)
    return isinstance(times, int | float) and times >= 1


def _parallel(flow: _Flow, node: n.Parallel) -> Outcomes:
    branches = [flow.block(branch) for branch in node.branches]
    ends = {"end"} if any("end" in outcomes for outcomes in branches) else set()
    return frozenset(ends | ({"on"} if all("on" in outcomes for outcomes in branches) else set()))


def _try(flow: _Flow, node: n.Try) -> Outcomes:
    outcomes = flow.block(node.body)
    if node.catches:
        outcomes |= flow.block(node.catch)
    final = flow.block(node.final)
    return outcomes | (final - ON) if "on" in final else final


def _call(flow: _Flow, node: n.Call) -> Outcomes:
    flow.calls += 1
    outcomes = flow.functions.get(node.function)
    if outcomes is None:
        return ON
    return (ON if outcomes & {"on", "return"} else NO_OUTCOME) | (outcomes & {"end"})


def _leave(outcome: str) -> Callable[[_Flow, n.Node], Outcomes]:
    return lambda flow, node: frozenset({outcome})


_FOLLOW: Mapping[type[n.Node], Callable[..., Outcomes]] = {
    n.If: _if,
    n.While: _while,
    n.Repeat: _repeat,
    n.ForEach: _repeat,
    n.Parallel: _parallel,
    n.Try: _try,
    n.Call: _call,
    n.End: _leave("end"),
    n.Return: _leave("return"),
    n.Break: _leave("break"),
}


def outcomes_of_functions(tree: n.Tree) -> dict[str, Outcomes]:
    """Return how each function can be left; a call of itself that never comes back leads nowhere."""
    flow = _Flow({function.method: NO_OUTCOME for function in tree.functions})
    changed, functions = bool(tree.functions), callees_first(tree)
    while changed:
        changed = False
        for function in functions:
            outcomes = flow.block(function.body)
            if outcomes != flow.functions[function.method]:
                flow.functions[function.method] = outcomes
                changed = True
    return flow.functions


def check_flow(context: Context) -> None:
    """Check all paths through the program, its events and its functions."""
    tree = context.tree
    sets = sets_of_functions(tree)
    flow = _Flow(outcomes_of_functions(tree), context, sets, _set_beside(tree, sets))
    if context.memos is not None:
        flow.memo = context.memos.flow
        flow.memo.begin((flow.beside, sets))
    for block in (tree.body, *(event.body for event in tree.events), *(f.body for f in tree.functions)):
        flow.block(block)
    if tree.functions:
        _check_endless_calls(context, flow.functions)
        _check_results(context, flow.functions)
        _check_use(context)


def _set_beside(tree: n.Tree, sets: Mapping[str, frozenset[str]]) -> frozenset[str]:
    names = frozenset[str]()
    for event in tree.events:
        names |= set_in(event.body, sets)
    if not tree.holds(n.Parallel):
        return names
    for block in (tree.body, *(function.body for function in tree.functions)):
        for node in tree.walked(block):
            if isinstance(node, n.Parallel):
                names = names.union(*(set_in(branch, sets) for branch in node.branches))
    return names


def _check_endless_calls(context: Context, outcomes: Mapping[str, Outcomes]) -> None:
    """A function that calls itself must have a path on which it does not."""
    endless = {method for method in functions_in_circles(context.tree) if not outcomes[method]}
    for function in context.tree.functions:
        if function.method in endless:
            name = {"function": function.name or function.method}
            for node in walk(function.body):
                if isinstance(node, n.Call) and node.function in endless:
                    context.report(node, "calls_itself", "function", name)


def _check_results(context: Context, outcomes: Mapping[str, Outcomes]) -> None:
    """A function that gives a value gives one on every path, and whoever calls it takes the value."""
    for function in context.tree.functions:
        if not function.result_type:
            continue
        name = {"function": function.name or function.method}
        bare: list[n.Node] = [node for node in walk(function.body) if isinstance(node, n.Return) and node.value is None]
        if "on" in outcomes[function.method] and function.body:
            bare.append(function.body[-1])
        for node in bare:
            context.report(node, "no_value_on_some_way", "", name)
    for node in _all_nodes(context.tree):
        called = context.functions.get(node.function) if isinstance(node, n.Call) else None
        if isinstance(node, n.Call) and called is not None and called.result_type:
            if not node.result:
                context.report(node, "unused_result", "result", {"function": called.name or called.method})
            if not called.body:
                context.report(node, "no_value_on_some_way", "", {"function": called.name or called.method})


def _all_nodes(tree: n.Tree) -> list[n.Node]:
    blocks = (tree.body, *(event.body for event in tree.events), *(f.body for f in tree.functions))
    return [node for block in blocks for node in walk(block)]


def _check_use(context: Context) -> None:
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


@dataclass(frozen=True, slots=True)
class _Around:
    """What stands around a step; `None` where there is none, else the code of what would be left on the path there."""

    function: n.Function | None = None
    barrier: str = ""
    """What keeps a return from leaving the function."""
    loop: str | None = None
    """What keeps a break from leaving the innermost loop; empty: nothing does."""

    def behind(self, code: str) -> _Around:
        """Return what stands around the steps in something that no step may leave."""
        return replace(self, barrier=code, loop=None if self.loop is None else code)


def check_leaving(context: Context) -> None:
    """Check every break and every return of the program."""
    tree = context.tree
    if not tree.holds(n.Break, n.Return):
        return
    for block in (tree.body, *(event.body for event in tree.events)):
        _block(context, block, _Around())
    for function in tree.functions:
        _block(context, function.body, _Around(function))


def _block(context: Context, block: n.Block, around: _Around) -> None:
    for node in block:
        match node:
            case n.Break():
                _break(context, node, around)
            case n.Return():
                _return(context, node, around)
            case n.While(body=body) | n.Repeat(body=body) | n.ForEach(body=body):
                _block(context, body, replace(around, loop=""))
            case n.Parallel(branches=branches):
                for branch in branches:
                    _block(context, branch, around.behind("leaves_parallel"))
            case n.Try(body=body, catch=catch, final=final):
                _block(context, body, around)
                _block(context, catch, around)
                _block(context, final, around.behind("leaves_finally"))
            case n.If(then=then, otherwise=otherwise):
                _block(context, then, around)
                _block(context, otherwise, around)


def _break(context: Context, node: n.Break, around: _Around) -> None:
    if around.loop is None:
        context.report(node, "break_outside_loop", "")
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

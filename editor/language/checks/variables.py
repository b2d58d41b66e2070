"""Checks of variables: read before anything sets them, or set and never read."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from editor.language.checks.context import Context
from editor.language.expressions.value_types import constant_value
from editor.language.tree import nodes as n
from editor.language.tree.nodes import walk
from editor.language.tree.traversal import callees_first, functions_in_circles
from editor.language.tree.variables import SETTERS, read_by, set_by, set_in, sets_of_functions

Names = frozenset[str]


@dataclass(frozen=True, slots=True)
class _State:
    """The variables that have a value here on every path, and those that have one on some path."""

    sure: Names = frozenset()
    maybe: Names = frozenset()

    def plus(self, names: Names) -> _State:
        return _State(self.sure | names, self.maybe | names)

    def perhaps(self, names: Names) -> _State:
        return _State(self.sure, self.maybe | names)


def _meet(*states: _State | None) -> _State | None:
    """Return what holds where these paths meet; None: no path leads there."""
    alive = [state for state in states if state is not None]
    if not alive:
        return None
    return _State(
        frozenset.intersection(*(state.sure for state in alive)), frozenset().union(*(state.maybe for state in alive))
    )


@dataclass(slots=True)
class _Follower:
    """The walk along all paths; it reports nothing while the functions are only being understood."""

    context: Context
    shared: Names
    """The variables of the program; all others belong to one function."""
    sets_of: Mapping[str, Names]
    """Function → the variables that it sets, also by the functions that it calls."""
    telling: bool = False
    tracked: Names = frozenset()
    effects: dict[str, Names] = field(default_factory=dict)
    """Function → the program's variables that it sets on every path."""
    entries: dict[str, _State | None] = field(default_factory=dict)
    """Function → what is set where it is called."""
    breaks: list[list[_State]] = field(default_factory=list)
    returns: list[_State] = field(default_factory=list)

    def block(self, block: n.Block, state: _State | None) -> _State | None:
        for node in block:
            if state is None:
                return None
            self._read(node, state)
            follow = _FOLLOW.get(type(node))
            if follow is not None:
                state = follow(self, node, state)
        return state

    def _read(self, node: n.Node, state: _State) -> None:
        if not self.telling:
            return
        for name, field_name in read_by(node).items():
            if name in self.tracked and name not in state.sure:
                code = "may_be_unset" if name in state.maybe else "unset_variable"
                self.context.report(node, code, field_name, {"variable": name})

    def sets(self, block: n.Block) -> Names:
        return set_in(block, self.sets_of)

    def function(self, function: n.Function, entry: _State) -> _State | None:
        """Follow a function's body; return what is set when it gives back."""
        own = frozenset(parameter.name for parameter in function.parameters)
        local = frozenset(map(set_by, walk(function.body))) - {""}
        self.tracked, self.returns = (self.shared | local) - own, []
        start = _State(entry.sure & self.shared, entry.maybe & self.shared)
        return _meet(self.block(function.body, start.plus(own)), *self.returns)


def _set(follower: _Follower, node: n.Set | n.Ask, state: _State) -> _State:
    return state.plus(frozenset({set_by(node)}))


def _call(follower: _Follower, node: n.Call, state: _State) -> _State:
    function = follower.context.functions.get(node.function)
    if function is None:
        return state
    before = follower.entries.get(node.function)
    follower.entries[node.function] = _meet(before, state)
    changed = follower.sets_of[function.method] & follower.shared
    after = state.perhaps(changed).plus(follower.effects.get(node.function, frozenset()))
    return after.plus(frozenset({node.result})) if node.result else after


def _if(follower: _Follower, node: n.If, state: _State) -> _State | None:
    return _meet(follower.block(node.then, state), follower.block(node.otherwise, state))


def _loop(follower: _Follower, node: n.While | n.Repeat | n.ForEach, state: _State) -> _State | None:
    follower.breaks.append([])
    inside = state.perhaps(follower.sets(node.body))
    if isinstance(node, n.ForEach):
        inside = inside.plus(frozenset({node.variable}))
    once = follower.block(node.body, inside)
    exits = follower.breaks.pop()
    if isinstance(node, n.While):
        over = None if constant_value(node.condition) is True else _meet(state, once)
    else:
        over = once if _surely_runs(node) else _meet(state, once)
    return _meet(over, *exits)


def _surely_runs(node: n.Repeat | n.ForEach) -> bool:
    times = len(node.items) if isinstance(node, n.ForEach) else constant_value(node.times)
    return isinstance(times, int | float) and times >= 1


def _try(follower: _Follower, node: n.Try, state: _State) -> _State | None:
    after = follower.block(node.body, state)
    failed = state.perhaps(follower.sets(node.body))
    if node.catches:
        after = _meet(after, follower.block(node.catch, failed))
    final = follower.block(node.final, failed.perhaps(follower.sets(node.catch)))
    if after is None or final is None:
        return None
    return _State(after.sure | (final.sure - failed.sure), after.maybe | final.maybe)


def _parallel(follower: _Follower, node: n.Parallel, state: _State) -> _State | None:
    sets = [follower.sets(branch) for branch in node.branches]
    ends = []
    for index, branch in enumerate(node.branches):
        others = frozenset().union(*(names for i, names in enumerate(sets) if i != index))
        ends.append(follower.block(branch, state.perhaps(others)))
    alive = [end for end in ends if end is not None]
    if len(alive) < len(ends):
        return None
    return _State(state.sure.union(*(e.sure for e in alive)), state.maybe.union(*(e.maybe for e in alive)))


def _break(follower: _Follower, node: n.Break, state: _State) -> None:
    if follower.breaks:
        follower.breaks[-1].append(state)


def _return(follower: _Follower, node: n.Return, state: _State) -> None:
    follower.returns.append(state)


def _end(follower: _Follower, node: n.End, state: _State) -> None:
    """Nothing follows."""


_FOLLOW: Mapping[type[n.Node], Callable[..., _State | None]] = {
    n.Set: _set,
    n.Ask: _set,
    n.Call: _call,
    n.If: _if,
    n.While: _loop,
    n.Repeat: _loop,
    n.ForEach: _loop,
    n.Try: _try,
    n.Parallel: _parallel,
    n.Break: _break,
    n.Return: _return,
    n.End: _end,
}


def check_variables(context: Context) -> None:
    """Check where the variables of the program and of its functions get their values and where they are read."""
    blocks = _blocks(context.tree)
    if not context.tree.holds(*SETTERS):
        return
    _check_use(context, blocks)
    _check_order(context)


def _blocks(tree: n.Tree) -> tuple[n.Block, ...]:
    return (tree.body, *(event.body for event in tree.events), *(function.body for function in tree.functions))


def _check_use(context: Context, blocks: tuple[n.Block, ...]) -> None:
    """Tell of variables that are set and never read, at the first step that sets them."""
    first: dict[str, n.Node] = {}
    read = {name for event in context.tree.events for name in read_by(n.If(event.condition))}
    for block in blocks:
        for node in walk(block):
            first.setdefault(set_by(node), node)
            read.update(read_by(node))
    for name, node in first.items():
        if name and name not in read:
            field_name = "result" if isinstance(node, n.Call) else "variable"
            context.report(node, "unused_variable", field_name, {"variable": name})


def _check_order(context: Context) -> None:
    """Tell of variables that are read before they have a value; the callers go before those that they call."""
    tree = context.tree
    own = [tree.body, *(event.body for event in tree.events)]
    shared = frozenset(set_by(node) for block in own for node in walk(block)) - {""}
    follower = _Follower(context, shared, sets_of_functions(tree))
    everything = shared | frozenset(parameter.name for parameter in tree.parameters)
    circular = functions_in_circles(tree)
    for function in callees_first(tree):
        if function.method not in circular:
            after = follower.function(function, _State(frozenset(), everything))
            follower.effects[function.method] = frozenset() if after is None else after.sure & shared
    follower.entries, follower.telling = {}, True
    _follow_entries(follower, tree)
    for function in reversed(callees_first(tree)):
        entry = follower.entries.get(function.method)
        if function.method in circular or entry is None:
            entry = _State(everything, everything)
        follower.function(function, entry)


def _follow_entries(follower: _Follower, tree: n.Tree) -> None:
    """Follow the program from its beginning, and from every event that may begin a run."""
    given = frozenset(parameter.name for parameter in tree.parameters)
    beside = [event.body for event in tree.events if event.starts == "branch"]
    later = frozenset[str]().union(*(follower.sets(body) for body in beside))
    beginning = _State(given, given | later)
    for block in (tree.body, *(event.body for event in tree.events if event.starts == "run")):
        follower.tracked = follower.shared
        follower.block(block, beginning)

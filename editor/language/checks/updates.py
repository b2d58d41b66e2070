"""Checks of updates that are lost: a variable worked out from its value of before, while something beside sets it.

A single Set happens at once, so that `count = count + 1` loses nothing, wherever else it stands. What is lost is what
happens between the step that reads the variable and the one that sets it.
"""

from __future__ import annotations

from editor.language.checks.context import Context
from editor.language.checks.idle import slow_functions, takes_time
from editor.language.tree import nodes as n
from editor.language.tree.variables import program_variables, read_by, set_by, set_in, sets_of_functions


def check_updates(context: Context) -> None:
    """Tell of the program's and the events' steps that undo what others set beside them."""
    tree = context.tree
    beside = [(event.step, event.body) for event in tree.events if event.starts == "branch"]
    if not beside:
        return
    sets, shared, slow = sets_of_functions(tree), program_variables(tree), slow_functions(tree)
    bodies = [("", tree.body), *beside]
    for name, body in bodies:
        others = [set_in(other, sets) for key, other in bodies if key != name]
        _check_body(context, tree.walked(body), frozenset().union(*others) & shared, slow)


def _check_body(context: Context, steps: list[n.Node], others: frozenset[str], slow: frozenset[str]) -> None:
    """Follow which variables hold what another held before some time went by."""
    copied: dict[str, frozenset[str]] = {}
    old: dict[str, frozenset[str]] = {}
    for node in steps:
        name, read = set_by(node), read_by(node)
        takes_long = node.__class__ not in n.COMPOSITES and takes_time((node,), slow)
        if takes_long:
            old = {each: sources | old.get(each, frozenset()) for each, sources in copied.items()}
        late = frozenset(read) if takes_long and isinstance(node, n.Call) else frozenset()
        sources = late.union(*(old.get(each, frozenset()) for each in read))
        if name in sources & others:
            context.report(node, "loses_update", "", {"variable": name})
        if name:
            copied[name] = frozenset(read).union(*(copied.get(each, frozenset()) for each in read)) - {name}
            old[name] = sources - {name}

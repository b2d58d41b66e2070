"""The variables of a program: which steps set and read them, and who sees each of them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Final

from editor.language.constructs.table import FORMS
from editor.language.expressions.nodes import OF_PROBLEM, Constant, Expression, PlaceRef, Variable
from editor.language.expressions.values import parts_of
from editor.language.tree import nodes as n
from editor.language.tree.nodes import NODES, Block, ForEach, blocks_of, walk
from editor.language.tree.program import Function, Tree
from editor.language.tree.traversal import callees_first

_SET_IN: Final[Mapping[type[n.Node], str]] = {
    NODES[name]: field.attribute
    for name, (_, form) in FORMS.items()
    for field in form.fields
    if field.type == "variable"
}
SETTERS: Final = tuple(_SET_IN)
"""The steps that may set a variable."""


def set_by(node: n.Node) -> str:
    """Return the name of the variable that a step sets, empty when it sets none."""
    attribute = _SET_IN.get(node.__class__)
    return "" if attribute is None else getattr(node, attribute)


def sets_of_functions(tree: Tree) -> dict[str, frozenset[str]]:
    """Return the names that each function sets, also by way of the functions that it calls."""
    sets: dict[str, frozenset[str]] = {function.method: frozenset() for function in tree.functions}
    changed, functions = bool(sets), callees_first(tree)
    while changed:
        changed = False
        for function in functions:
            names = set_in(function.body, sets)
            changed = changed or names != sets[function.method]
            sets[function.method] = names
    return sets


def set_in(block: n.Block, sets: Mapping[str, frozenset[str]]) -> frozenset[str]:
    """Return the names that are set in a block and in the functions that it calls, whose `sets` are known."""
    names: set[str] = set()
    for node in walk(block):
        names.add(set_by(node))
        if isinstance(node, n.Call):
            names.update(sets.get(node.function, ()))
    return frozenset(names - {""})


def read_by(node: n.Node) -> dict[str, str]:
    """Return the names that a step itself reads, each with the field where it does."""
    found: dict[str, str] = {}
    for field, expression in worked_out(node):
        for part in parts_of(expression):
            if isinstance(part, Variable):
                found.setdefault(part.name, field)
    return found


def reads_problem(catch: n.Catch) -> bool:
    """Tell whether a catch looks at the failure that it has caught, or at one of which a catch in it knows."""
    return any(name in read_by(inner) for inner in walk(catch.block) for name in OF_PROBLEM)


_HOLD_VALUES: Final = ("place", "value", "values", "arguments")
VALUES: Mapping[type[n.Node], tuple[tuple[str, str], ...]] = {
    NODES[name]: tuple(
        (field.attribute, "" if field.type == "place" and hasattr(NODES[name], "place_field") else field.name)
        for field in form.fields
        if field.type in _HOLD_VALUES
    )
    for name, (_, form) in FORMS.items()
    if NODES[name] is not n.Event
}
"""The attributes of nodes that hold values, with the fields of the step where they stand (empty: the node says it)."""


def values_of(node: n.Node) -> Iterator[tuple[str, Expression]]:
    """Yield the values of a step, not those of the steps in it, each with its field."""
    for attribute, field in VALUES.get(type(node), ()):
        value = getattr(node, attribute)
        if attribute == "arguments":
            yield from ((f"args.{name}", given) for name, given in value)
        elif attribute == "items":
            yield from ((field, item) for item in value)
        else:
            value = value.value if isinstance(value, PlaceRef) else value
            if value is not None:
                yield field or getattr(node, "place_field", ""), value


def worked_out(node: n.Node) -> list[tuple[str, Expression]]:
    """Return the values of a step that are not just written out, each with its field; most steps have none."""
    found: list[tuple[str, Expression]] = []
    for attribute, field in VALUES.get(node.__class__, ()):
        value = getattr(node, attribute)
        if value is None or value.__class__ is Constant:
            continue
        if value.__class__ is PlaceRef:
            if value.value is not None:
                found.append((field or getattr(node, "place_field", ""), value.value))
        elif attribute == "arguments":
            found.extend((f"args.{name}", given) for name, given in value if given.__class__ is not Constant)
        elif attribute == "items":
            found.extend((field, item) for item in value)
        else:
            found.append((field, value))
    return found


def program_variables(tree: Tree) -> frozenset[str]:
    """Return the variables that the program's body or an event's sets; they can be seen everywhere."""
    return tree.derived(_program_variables)


def _program_variables(tree: Tree) -> frozenset[str]:
    if not tree.holds(*SETTERS):
        return frozenset()
    bodies = (tree.body, *(event.body for event in tree.events))
    return frozenset(name for body in bodies for name in _names_set_in(body, frozenset()))


def local_variables(tree: Tree, function: Function) -> tuple[str, ...]:
    """Return the variables that belong to one call of a function of the tree, in the order of first use."""
    return tree.derived(_local_variables).get(function.method, ())


def _local_variables(tree: Tree) -> dict[str, tuple[str, ...]]:
    if not tree.holds(*SETTERS):
        return {}
    shared = program_variables(tree)
    return {function.method: tuple(_set_in_calls(function, shared)) for function in tree.functions}


def _set_in_calls(function: Function, shared: frozenset[str]) -> Iterator[str]:
    own = frozenset(parameter.name for parameter in function.parameters)
    names = dict.fromkeys(_names_set_in(function.body, frozenset()))
    return (name for name in names if name not in shared and name not in own)


def _names_set_in(block: Block, loops: frozenset[str]) -> Iterator[str]:
    """Yield the names that a block sets, without those of the loops that they stand in."""
    for node in block:
        name = set_by(node)
        if name and name not in loops:
            yield name
        inside = loops.union(node.names) if isinstance(node, ForEach) else loops
        for inner in blocks_of(node):
            yield from _names_set_in(inner, inside)

"""What the variables of a program hold, as far as the first step that sets each of them tells."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from editor.language.expressions.typing import UNKNOWN_KIND, Kind, Typing, plain_type
from editor.language.site.surroundings import Surroundings
from editor.language.tree import nodes as n
from editor.language.tree.traversal import walk
from editor.language.tree.variables import set_by

Kinds = Mapping[str, Kind]


def kinds_of_parameters(parameters: Iterable[n.Parameter]) -> dict[str, Kind]:
    """Return what parameters hold, by their names."""
    return {p.name: Kind(plain_type(p.type), p.unit) for p in parameters}


def kinds_of_program(tree: n.Tree, shared: frozenset[str], surroundings: Surroundings) -> dict[str, Kind]:
    """Return what the program's parameters and variables hold."""
    known = kinds_of_parameters(tree.parameters)
    bodies = (tree.body, *(event.body for event in tree.events))
    return {**_set_in(bodies, shared, known, tree, surroundings), **known} if shared else known


def kinds_of_function(
    tree: n.Tree, function: n.Function, outside: Kinds, surroundings: Surroundings
) -> dict[str, Kind]:
    """Return what can be seen in a function; `outside` is what the program's parameters and variables hold."""
    known = {**outside, **kinds_of_parameters(function.parameters)}
    own = frozenset(map(set_by, walk(function.body))) - known.keys() - {""}
    return {**_set_in((function.body,), own, known, tree, surroundings), **known} if own else known


def _set_in(
    bodies: Iterable[n.Block], wanted: frozenset[str], known: Kinds, tree: n.Tree, surroundings: Surroundings
) -> dict[str, Kind]:
    """Return the kinds of the wanted variables, each by the first step that tells it."""
    found: dict[str, Kind] = {}
    functions = {function.method: function for function in tree.functions}
    for body in bodies:
        for node in walk(body):
            name = set_by(node)
            if name in wanted and name not in known and not found.get(name, UNKNOWN_KIND).type:
                found[name] = _kind(node, {**known, **found}, functions, surroundings)
    return found


def _kind(node: n.Node, known: Kinds, functions: Mapping[str, n.Function], surroundings: Surroundings) -> Kind:
    match node:
        case n.Set(value=value):
            return Typing(surroundings, known, []).kind_of(value)
        case n.Ask(answer=answer):
            return Kind("text" if answer.type == "choice" else answer.type, answer.unit)
        case n.Call(function=method) if method in functions:
            return Kind(plain_type(functions[method].result_type), functions[method].result_unit)
    return UNKNOWN_KIND

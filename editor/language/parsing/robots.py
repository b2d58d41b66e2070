"""Which of the attributes of a task are robots: what `run` gives as one, and what some step drives."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Mapping

from editor.language.expressions.names import ROBOT_METHODS
from editor.language.parsing.scope import Binding, attribute_of_self
from editor.language.parsing.variables import blocks_of
from editor.language.site.surroundings import Surroundings
from editor.language.tree.robots import is_robot


def calls_made(methods: Iterable[ast.FunctionDef]) -> list[ast.Call]:
    """Return the calls of some methods that are steps, or whose value a step takes; in any order."""
    found: list[ast.Call] = []
    left = [method.body for method in methods]
    while left:
        for statement in left.pop():
            value = getattr(statement, "value", None)
            if value.__class__ is ast.Call:
                found.append(value)
            left.extend(blocks_of(statement))
    return found


def robots_driven(
    calls: Iterable[ast.Call], bindings: Mapping[str, Binding], surroundings: Surroundings
) -> frozenset[str]:
    """Return the attributes of the task that some step has as a robot: x of `self.x.pick(…)` or of its own method."""
    found: set[str] = set()
    for call in calls:
        function = call.func
        name = attribute_of_self(function.value) if isinstance(function, ast.Attribute) else None
        if name is None or not isinstance(function, ast.Attribute) or function.attr == "read":
            continue
        if function.attr in ROBOT_METHODS or is_sure_robot(bindings.get(name), surroundings):
            found.add(name)
    return frozenset(found)


def is_sure_robot(binding: Binding | None, surroundings: Surroundings) -> bool:
    """Tell whether what `run` gives is a robot, whatever the steps do with it."""
    if binding is None or binding.kind not in {"get", "any"}:
        return False
    return binding.kind == "any" or binding.is_robot or is_robot(surroundings, binding.id)

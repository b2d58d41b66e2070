"""Which of the attributes of a task are robots: what `run` gives as one, and what some step drives."""

from __future__ import annotations

import ast
from collections.abc import Iterable
from typing import Final

from editor.language.expressions.names import ROBOT_METHODS
from editor.language.parsing.scope import Binding, Scope, attribute_of_self
from editor.language.tree.robots import is_robot


def calls_in(module: ast.Module) -> list[ast.Call]:
    """Return every call in a script, in any order."""
    found: list[ast.Call] = []
    left: list[ast.AST] = [module]
    while left:
        node = left.pop()
        if node.__class__ is ast.Call:
            found.append(node)
        for name in node._fields:
            value = getattr(node, name, None)
            if value.__class__ is list:
                left.extend(item for item in value if isinstance(item, ast.AST))
            elif isinstance(value, ast.AST) and value.__class__ not in _BARE:
                left.append(value)
    return found


_BARE: Final = frozenset({ast.Load, ast.Store, ast.Constant, ast.Name})
"""What a syntax tree has most of; nothing stands in it."""


def robots_driven(calls: Iterable[ast.Call], scope: Scope) -> frozenset[str]:
    """Return the attributes of the task that some step has as a robot: x of `self.x.pick(…)` or of its own method."""
    found: set[str] = set()
    for call in calls:
        function = call.func
        name = attribute_of_self(function.value) if isinstance(function, ast.Attribute) else None
        if name is None or not isinstance(function, ast.Attribute) or function.attr == "read":
            continue
        if function.attr in ROBOT_METHODS or is_sure_robot(scope.bindings.get(name), scope):
            found.add(name)
    return frozenset(found)


def is_sure_robot(binding: Binding | None, scope: Scope) -> bool:
    """Tell whether what `run` gives is a robot, whatever the steps do with it."""
    if binding is None or binding.kind not in {"get", "any"}:
        return False
    return binding.kind == "any" or binding.is_robot or is_robot(scope.surroundings, binding.id)

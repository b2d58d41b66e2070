"""Variables in a script: `self.x` for those of the program, bare names for those of a function or a loop."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from editor.language.expressions.names import attribute_name, local_name
from editor.language.parsing.answers import taken_name
from editor.language.parsing.scope import Refused, Scope, attribute_of_self, quoted

Methods = Mapping[str, ast.FunctionDef]
_BRANCHING = (ast.For, ast.While, ast.If)


@dataclass(frozen=True, slots=True)
class Assigned:
    """The names that a method and the branches of its Parallels assign: attributes of the task, and bare ones."""

    attributes: frozenset[str]
    bare: frozenset[str]


def names_assigned(method: ast.FunctionDef, methods: Methods) -> Assigned:
    """Return what a method assigns; the variable of a loop counts nowhere in that loop."""
    targets: list[ast.expr] = []
    _gather(method.body, methods, frozenset(), {method.name}, targets)
    attributes = frozenset(name for name in map(attribute_of_self, targets) if name is not None)
    return Assigned(attributes, frozenset(target.id for target in targets if isinstance(target, ast.Name)))


def _gather(
    statements: Iterable[ast.stmt], methods: Methods, loops: frozenset[str], seen: set[str], targets: list[ast.expr]
) -> None:
    for statement in statements:
        inside = loops
        match statement:
            case ast.Expr(value=ast.Call() as call) if attribute_of_self(call.func) == "parallel":
                for branch in map(attribute_of_self, call.args):
                    if branch is not None and branch in methods and branch not in seen:
                        seen.add(branch)
                        _gather(methods[branch].body, methods, loops, seen, targets)
            case ast.Expr():
                continue
            case ast.Assign(targets=[target]) | ast.AugAssign(target=target):
                if not (isinstance(target, ast.Name) and target.id in loops):
                    targets.append(target)
            case ast.For(target=ast.Name() | ast.Tuple() as target):
                named = target.elts if isinstance(target, ast.Tuple) else [target]
                inside = loops.union(name.id for name in named if isinstance(name, ast.Name))
        for inner in blocks_of(statement):
            _gather(inner, methods, inside, seen, targets)


def blocks_of(statement: ast.stmt) -> list[list[ast.stmt]]:
    """Return the blocks of statements that stand in a statement of the language."""
    if isinstance(statement, _BRANCHING):
        return [statement.body, statement.orelse]
    if isinstance(statement, ast.With):
        return [statement.body]
    if isinstance(statement, ast.Try):
        caught = (handler.body for handler in statement.handlers)
        return [statement.body, statement.orelse, *caught, statement.finalbody]
    return []


def parse_target(node: ast.expr, scope: Scope, methods: Methods) -> str:
    """Return the name of the variable that is assigned.

    Raises:
        Refused: nothing can be assigned there.
    """
    if isinstance(node, ast.Name) and node.id in scope.locals:
        check_local(node.id, node)
        return node.id
    if isinstance(node, ast.Name) and node.id in scope.bindings and scope.bindings[node.id].kind != "parameter":
        raise taken_name(node, node.id, scope)
    if isinstance(node, ast.Name):
        known = (
            "the program sets it, too" if node.id in scope.variables else "only functions have variables of their own"
        )
        raise Refused(node, f"The variable {quoted(node)}", f"Write self.{node.id}: {known}.")
    name = attribute_of_self(node)
    if name is None:
        raise _unsettable(node, scope)
    binding = scope.bindings.get(name)
    if (binding is not None and binding.kind != "parameter") or name in methods:
        raise taken_name(node, name, scope)
    if name in scope.locals:
        raise Refused(node, f"The variable {quoted(node)}", f"Here {name} is something else. Write {name}.")
    if name not in scope.variables:
        raise Refused(node, f"The variable {quoted(node)}", f"It belongs to this function alone. Write {name}.")
    if attribute_name(name, ()) != name:
        raise Refused(node, f"The name {name}", f"Call it {attribute_name(name, ())}.")
    return name


def _unsettable(node: ast.expr, scope: Scope) -> Refused:
    """Return the refusal of what is no variable at all."""
    if isinstance(node, ast.Tuple):
        return Refused(node, quoted(node), "Set one variable on each line: self.count = 1.")
    instead = "Only variables can be set: self.count = 1."
    if isinstance(node, ast.Attribute) and attribute_of_self(node.value) in scope.bindings:
        instead = "A reading cannot be set; it changes by what the machine does."
    return Refused(node, f"A change of {quoted(node)}", instead)


def check_local(name: str, node: ast.AST) -> None:
    """Check a name that belongs to a function or a loop.

    Raises:
        Refused: the language uses it for something else.
    """
    if local_name(name, ()) != name:
        raise Refused(node, f"The name {name}", f"Call it {local_name(name, ())}.")

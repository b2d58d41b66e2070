"""The heads of loops over values: `for oven in […]:`, also with the number of the round; and what else is refused."""

from __future__ import annotations

import ast
from dataclasses import dataclass

from editor.language.messages.syntax_errors import instead_of_expression
from editor.language.parsing.answers import unknown_device, what_it_is
from editor.language.parsing.scope import Refused, Scope, attribute_of_self, quoted, written
from editor.language.parsing.variables import check_local

MOST_TIMES = 10**6
_FOR = "Write for _ in range(3): or for oven in [self.oven_a, self.oven_b]:."
_NUMBERED = "Rounds are counted from 1. Write for number, oven in enumerate([self.oven_a, self.oven_b], 1):."


@dataclass(frozen=True, slots=True)
class LoopHead:
    """What a loop goes through, and what its item and the number of its round are called (empty: nothing)."""

    variable: str
    index: str
    items: list[ast.expr]
    over: ast.expr | None = None
    """The variable whose list it goes through."""

    @property
    def names(self) -> tuple[str, ...]:
        """Return the names that the body alone sees."""
        return tuple(filter(None, (self.variable, self.index)))


def parse_loop(loop: ast.For, scope: Scope) -> LoopHead:
    """Return the head of a loop over values; its item may be called `_`, which is no name.

    Raises:
        Refused: it is written otherwise.
    """
    match loop.target, loop.iter:
        case ast.Name(id=name), whole if _is_list(whole, scope):
            return LoopHead(_checked(name, loop.target), "", *_listed(whole))
        case ast.Tuple(elts=[ast.Name() as index, ast.Name() as item]), ast.Call(func=ast.Name(id="enumerate")) as call:
            if index.id in {"_", item.id}:
                raise Refused(index, quoted(index), "Give the number of the round a name of its own.")
            return LoopHead(_checked(item.id, item), _checked(index.id, index), *_listed(_numbered(call, scope)))
    raise _refused_loop(loop, scope)


def _checked(name: str, node: ast.AST) -> str:
    if name == "_":
        return ""
    check_local(name, node)
    return name


def _is_list(node: ast.expr, scope: Scope) -> bool:
    """Tell whether something is a list that is written out, or a variable that may hold one."""
    if isinstance(node, ast.Name):
        return node.id in scope.locals
    own = attribute_of_self(node)
    binding = scope.bindings.get(own or "")
    held = own is not None and (own in scope.variables or (binding is not None and binding.kind == "parameter"))
    return isinstance(node, ast.List) or held


def _listed(node: ast.expr) -> tuple[list[ast.expr], ast.expr | None]:
    """Return the items that are written out, or else the variable."""
    return (node.elts, None) if isinstance(node, ast.List) else ([], node)


def _numbered(call: ast.Call, scope: Scope) -> ast.expr:
    """Return what `enumerate(…, 1)` goes through."""
    match call:
        case (
            ast.Call(args=[whole, ast.Constant(value=1)], keywords=[])
            | ast.Call(args=[whole], keywords=[ast.keyword(arg="start", value=ast.Constant(value=1))])
        ) if _is_list(whole, scope):
            return whole
    raise Refused(call, quoted(call), _NUMBERED)


def _refused_loop(loop: ast.For, scope: Scope) -> Refused:
    """Return the refusal of a loop, which says what is wrong with its name or with what it goes through."""
    match loop.target, loop.iter:
        case ast.Name(id=name), ast.Call(func=ast.Name(id="range"), args=[_], keywords=[]):
            used = any(isinstance(node, ast.Name) and node.id == name for part in loop.body for node in ast.walk(part))
            instead = f"Count it yourself: self.{name} = 0 before the loop, self.{name} = self.{name} + 1 at its end."
            return Refused(loop.target, quoted(loop.target), instead if used else "Write for _ in range(3):.")
        case _, ast.Call(func=ast.Name(id="range"), args=[ast.Constant(value=int(a)), ast.Constant(value=int(b))]) if (
            abs(a) < MOST_TIMES > abs(b)
        ):
            return Refused(loop.iter, quoted(loop.iter), f"Say how often: for _ in range({max(b - a, 0)}):.")
        case _, ast.Call(func=ast.Name(id="range")):
            return Refused(loop.iter, quoted(loop.iter), "Say how often, with one number: for _ in range(3):.")
        case _, ast.Constant(value=int(times)) if times < MOST_TIMES:
            return Refused(loop.iter, quoted(loop.iter), f"Say how often: for _ in range({times}):.")
        case ast.Name(id=name), ast.Tuple() as items:
            listed = ", ".join(map(written, items.elts))
            return Refused(items, quoted(items), f"Write square brackets: for {name} in [{listed}]:.")
        case ast.Name(id=name), ast.Attribute(attr=own) as items if what_it_is(own, scope, frozenset()):
            return Refused(items, quoted(items), f"Name each: for {name} in [{written(items)}]:.")
        case ast.Name(), ast.Attribute(value=ast.Name(id="self"), attr=own) as items:
            return unknown_device(items, own, scope)
        case ast.Name(), ast.Call(func=ast.Name(id="enumerate")):
            return Refused(loop.target, quoted(loop.target), _NUMBERED)
        case ast.Name(), _:
            return Refused(loop.iter, quoted(loop.iter), instead_of_expression(loop.iter) or _FOR)
    return Refused(
        loop.target,
        quoted(loop.target),
        "A loop has one name, without self. Write for _ in range(3): or for oven in [self.oven_a, self.oven_b]:.",
    )

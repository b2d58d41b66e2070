"""The syntax tree of a script, put together from its different lines, each of which Python parses only once.

Most lines of a long script stand in it more than once. What is put together is what `ast.parse` gives of the whole,
but for where each piece stands: it will do for a script of which nothing is refused.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Final, Literal

_INDENT: Final = 4
_DEEPEST: Final = 60
_STRANGE: Final = ("\r", "\t", "\f", "\ufeff")
"""What Python reads as the end of a line, or as more or less than one space."""
_SIMPLE: Final = frozenset({ast.Expr, ast.Assign, ast.AugAssign, ast.Return, ast.Break, ast.Pass})
_WORDS: Final[Mapping[str, Form]] = {"try:": "try", "else:": "else", "finally:": "finally"}
_OPENED: Final[Mapping[type[ast.AST], Callable[[Any], Any]]] = {
    ast.If: lambda node: ast.If(node.test, [], []),
    ast.While: lambda node: ast.While(node.test, [], []),
    ast.For: lambda node: ast.For(node.target, node.iter, [], []),
    ast.FunctionDef: lambda node: _copied(node),
    ast.ClassDef: lambda node: _copied(node),
}
"""The statements that hold others, each as yet without them."""

Form = Literal["simple", "holding", "try", "except", "else", "finally"]
Piece = tuple[int, Form, Any]
"""How deep a line stands, what it is, and what Python makes of it."""


class _Unlike(Exception):
    """A line that does not stand for itself, or not where it could."""


def parse_lines(text: str) -> ast.Module | None:
    """Return the syntax tree of a script; None where it must be parsed as a whole, or is no Python."""
    if any(character in text for character in _STRANGE):
        return None
    lines = text.split("\n")
    try:
        pieces = _read_pieces(dict.fromkeys(lines))
        return ast.Module(_put_together(pieces[line] for line in lines if line in pieces), [])
    except (_Unlike, SyntaxError, ValueError, RecursionError, MemoryError):
        return None


def _read_pieces(lines: Iterable[str]) -> dict[str, Piece]:
    """Return what each line is; lines that say nothing are left out."""
    pieces: dict[str, Piece] = {}
    source: list[str] = []
    read: list[tuple[str, int, Form, int]] = []
    for line in lines:
        content = line.strip(" ")
        if not content or content[0] == "#":
            continue
        depth, odd = divmod(len(line) - len(line.lstrip(" ")), _INDENT)
        if odd or depth > _DEEPEST:
            raise _Unlike
        if content in _WORDS:
            pieces[line] = depth, _WORDS[content], None
            continue
        form, written = _as_statement(content)
        source.extend(written)
        read.append((line, depth, form, len(written)))
    statements = _parse_each([count for *_, count in read], "\n".join(source))
    for (line, depth, form, _), statement in zip(read, statements, strict=True):
        pieces[line] = depth, form, _checked(form, statement)
    return pieces


def _as_statement(content: str) -> tuple[Form, tuple[str, ...]]:
    """Return a line as a whole statement."""
    if content[-1] != ":":
        return "simple", (content,)
    if "#" in content:
        raise _Unlike
    if content.startswith("except"):
        return "except", ("try: pass", f"{content} pass")
    return "holding", (f"{content} pass",)


def _parse_each(counts: list[int], source: str) -> list[ast.stmt]:
    """Parse statements of so many lines each; every one must keep to its own lines."""
    statements = ast.parse(source).body
    if len(statements) != len(counts):
        raise _Unlike
    last = 0
    for statement, count in zip(statements, counts, strict=True):
        first, last = last + 1, last + count
        if statement.lineno != first or statement.end_lineno != last:
            raise _Unlike
    return statements


def _checked(form: Form, statement: Any) -> Any:
    """Return what Python made of a line, if that is what the line's form is for."""
    kind = statement.__class__
    if form == "except" and kind is ast.Try and len(statement.handlers) == 1 and not statement.finalbody:
        return statement.handlers[0]
    if kind not in (_SIMPLE if form == "simple" else _OPENED):
        raise _Unlike
    return statement


def _copied(node: ast.FunctionDef | ast.ClassDef) -> ast.AST:
    return node.__class__(**{**dict(ast.iter_fields(node)), "body": []})


@dataclass(slots=True)
class _Blocks:
    """The blocks that are open, the outermost first; `waiting` tells that the innermost is still empty."""

    open: list[list[Any]]
    waiting: bool = False

    def at(self, depth: int) -> list[Any]:
        """Close all blocks that are deeper, and return the one at this depth."""
        if depth >= len(self.open) or (self.waiting and depth + 1 != len(self.open)):
            raise _Unlike
        del self.open[depth + 1 :]
        return self.open[depth]

    def begin(self, block: list[Any]) -> None:
        """Open a block in the innermost one."""
        self.open.append(block)
        self.waiting = True


def _put_together(pieces: Iterable[Piece]) -> list[ast.stmt]:
    """Return the statements of a script, each with those that stand in it."""
    whole: list[ast.stmt] = []
    blocks = _Blocks([whole])
    guards: list[ast.Try] = []
    for depth, form, found in pieces:
        block = blocks.at(depth)
        blocks.waiting = False
        if form == "simple":
            block.append(found)
        elif form == "holding":
            block.append(_OPENED[found.__class__](found))
            blocks.begin(block[-1].body)
        elif form == "try":
            guards.append(ast.Try([], [], [], []))
            block.append(guards[-1])
            blocks.begin(guards[-1].body)
        else:
            blocks.begin(_continued(block, form, found))
    if blocks.waiting or not all(guard.handlers or guard.finalbody for guard in guards):
        raise _Unlike
    return whole


def _continued(block: list[Any], form: Form, handler: Any) -> list[Any]:
    """Return the new block that a line opens in the statement before it."""
    before: Any = block[-1] if block else None
    if isinstance(before, _WITH_ELSE) and form == "else" and not before.orelse:
        return before.orelse
    if isinstance(before, ast.Try) and not before.finalbody:
        if form == "finally":
            return before.finalbody
        if form == "except" and not before.orelse:
            before.handlers.append(ast.ExceptHandler(handler.type, handler.name, []))
            return before.handlers[-1].body
        if form == "else" and before.handlers and not before.orelse:
            return before.orelse
    raise _Unlike


_WITH_ELSE: Final = (ast.If, ast.While, ast.For)

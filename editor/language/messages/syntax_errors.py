"""What to write instead of Python that the language does not have, for the most frequent mistakes in scripts."""

from __future__ import annotations

import ast
import re
from collections.abc import Mapping
from typing import Final

_NO_IMPORT: Final = "Leave it out: a script uses only what self and ctx give."
_NO_FUNCTION_HERE: Final = "Write functions beside new_task, in class Task: def mix_paint(self, minutes):."
_ON_SELF: Final = "Write self. before it: self.wait(60)."
_NO_TEST: Final = "Write if, and inside it self.notify(…) or self.end()."

STATEMENTS: Final[Mapping[type[ast.AST], str]] = {
    ast.Import: _NO_IMPORT,
    ast.ImportFrom: _NO_IMPORT,
    ast.FunctionDef: _NO_FUNCTION_HERE,
    ast.AsyncFunctionDef: _NO_FUNCTION_HERE,
    ast.ClassDef: "A script has one class, Task. Write a function instead: def mix_paint(self):.",
    ast.With: "Leave “with” out and write its lines as they are.",
    ast.Assert: _NO_TEST,
    ast.Raise: _NO_TEST,
    ast.Delete: "Leave it out: nothing needs to be deleted.",
    ast.Global: "Leave it out: self.count is seen everywhere.",
    ast.Nonlocal: "Leave it out: self.count is seen everywhere.",
    ast.Continue: "Put what follows into an if instead of leaving it out by continue.",
    ast.Match: "Write if and else instead.",
}
"""Statements of Python that the language does not have."""

EXPRESSIONS: Final[Mapping[type[ast.AST], str]] = {
    ast.Lambda: "Write a function beside new_task, in class Task: def mix_paint(self, minutes):.",
    ast.ListComp: "Write the values one by one, or for oven in [self.oven_a, self.oven_b]:.",
    ast.SetComp: "Write the values one by one, or for oven in [self.oven_a, self.oven_b]:.",
    ast.DictComp: "Write the values one by one, or for oven in [self.oven_a, self.oven_b]:.",
    ast.GeneratorExp: "Write the values one by one, or for oven in [self.oven_a, self.oven_b]:.",
    ast.IfExp: "Write if and else on lines of their own.",
    ast.NamedExpr: "Set the variable on a line of its own: self.count = 1.",
    ast.Subscript: "Name a value itself; the language has no places in lists.",
    ast.Await: "Leave “await” out: a script waits by itself until a step is done.",
    ast.Yield: "Write return to give a value.",
    ast.YieldFrom: "Write return to give a value.",
    ast.Starred: "Write the values one by one.",
    ast.Dict: "Only pick, drop and operate take values in braces.",
    ast.Set: "Write a list with square brackets: [1, 2].",
}
"""Expressions of Python that the language does not have."""

CALLS: Final[Mapping[str, str]] = {
    "print": 'Tell people by self.notify("The box is dry.").',
    "input": 'Ask people by self.dry = self.ask("Is it dry?", type="boolean").',
    "sleep": "Wait by self.wait(60).",
    "wait": _ON_SELF,
    "notify": 'Write self. before it: self.notify("The box is dry.").',
    "ask": 'Write self. before it: self.dry = self.ask("Is it dry?", type="boolean").',
    "end": "Write self. before it: self.end().",
    "exit": "End the program by self.end().",
    "quit": "End the program by self.end().",
    "parallel": "Write self. before it: self.parallel(self.branch_a, self.branch_b).",
    "exec": "Write the steps themselves.",
    "eval": "Write the value itself.",
    "open": "A script reads no files. Use readings of devices, parameters and questions.",
    "len": "Use count(condition, …), or write the number.",
    "str": 'Write a text with the value in it: f"{self.count} boxes".',
    "int": "Use round(…), or write the number.",
    "float": "Leave “float” out and write the value.",
}
"""Calls by their last name."""

ATTRIBUTE_ALONE: Final = "Say what it does, for example self.oven.cure_paint(10) or self.end()."
VALUE_ALONE: Final = "Put it where it is used, or keep it: self.count = 5."


def count_characters(module: ast.Module, text: str) -> ast.Module:
    """Let the columns of a syntax tree count characters, where Python counts bytes."""
    if text.isascii():
        return module
    lines = [line.encode() for line in text.splitlines()]
    for node in ast.walk(module):
        for row, column in (("lineno", "col_offset"), ("end_lineno", "end_col_offset")):
            number = getattr(node, row, None)
            if isinstance(number, int) and 0 < number <= len(lines):
                before = lines[number - 1][: getattr(node, column)]
                setattr(node, column, len(before.decode(errors="ignore")))
    return module


def instead_of_statement(statement: ast.stmt) -> str | None:
    """Return what to write instead of a statement, when that can be told."""
    if not isinstance(statement, ast.Expr):
        return STATEMENTS.get(type(statement))
    value = statement.value
    if isinstance(value, ast.Call) and isinstance(value.func, ast.Name):
        return CALLS.get(value.func.id)
    if isinstance(value, ast.Attribute):
        return ATTRIBUTE_ALONE
    return EXPRESSIONS.get(type(value)) or (VALUE_ALONE if _is_value(value) else None)


def instead_of_call(call: ast.Call) -> str | None:
    """Return what to write instead of a call such as `time.sleep(5)`, when that can be told."""
    function = call.func
    name = (
        function.attr if isinstance(function, ast.Attribute) else function.id if isinstance(function, ast.Name) else ""
    )
    of_something = isinstance(function, ast.Attribute) and not _is_self(function.value)
    return CALLS.get(name) if name == "sleep" or not of_something else None


def instead_of_expression(node: ast.expr) -> str | None:
    """Return what to write instead of an expression, when that can be told."""
    return EXPRESSIONS.get(type(node))


def _is_self(node: ast.expr) -> bool:
    return isinstance(node, ast.Name) and node.id == "self"


def _is_value(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant | ast.Compare | ast.BinOp | ast.BoolOp | ast.UnaryOp | ast.Name)


_QUOTES: Final = 'Write straight quotation marks: "box".'
_LEVELS: Final = "Indent with 4 spaces for each level, like the lines beside it."
SYNTAX: Final[tuple[tuple[str, str], ...]] = (
    (r"'(.)' was never closed", "The bracket {0} is never closed. Close it behind its content."),
    (r"unmatched '(.)'", "The bracket {0} was never opened. Take it away, or open it before."),
    (
        r"closing parenthesis '(.)' does not match.*",
        "The bracket {0} closes another one than the last. Close that first.",
    ),
    (r"inconsistent use of tabs.*", "Indent with spaces, 4 for each level, not with tabs."),
    (r"unexpected indent|unindent does not match.*", _LEVELS),
    (r"expected an indented block.*", "Indent by 4 spaces what belongs to the line before it, or write pass."),
    (r"invalid character '[\u201c-\u201f\u00ab\u00bb\u2018-\u201a]'.*", _QUOTES),
    (r"invalid non-printable character.*", "There is a character here that cannot be seen. Delete it; type a space."),
    (r"invalid character '(.)'.*", "The character {0} belongs only into texts. Delete it."),
    (r".*Maybe you meant '=='.*", "Compare with ==; a single = sets a variable."),
    (r"expected ':'", "Write a colon at the end of this line."),
    (r"unterminated (?:triple-quoted )?(?:f-)?string literal.*", "Close the text with a quotation mark on its line."),
    (r"expected 'except' or 'finally' block", "Write except TaskError as problem: or finally: behind try."),
    (r".*Perhaps you forgot a comma\?", "Write a comma between the values."),
    (r"cannot assign to .*", "Only variables can be set: self.count = 1."),
    (r"'(return|break|continue|await|yield)' outside .*", "Write {0} in a method of class Task."),
)  # fmt: skip
"""What Python says → what helps."""
SYMBOLS: Final[tuple[tuple[str, str], ...]] = (
    (r"&&?|\|\|?", "Write “and” or “or”."),
    (r"!(?!=)", "Write “not”."),
    (r"\+\+|--", "Write self.count = self.count + 1."),
    (r"[{}]", "Blocks are indented by 4 spaces and have no braces."),
    (r"\?", "Write if and else on lines of their own."),
    (r";\s*$", "Leave the semicolon out."),
)
"""What stands where Python stops → what helps."""
NOTHING_BEFORE: Final = "There is no if, for, while or try right before this, at the same level."
_FOLLOWERS: Final = ("else", "elif", "except", "finally")
UNKNOWN: Final = "Python says: {0}."


def explain_syntax(error: SyntaxError, text: str) -> str:
    """Return what helps where Python cannot read a script."""
    lines = text.splitlines()
    number = error.lineno or 1
    line = lines[number - 1] if 0 < number <= len(lines) else ""
    if "\t" in line[: len(line) - len(line.lstrip())]:
        return "Indent with spaces, 4 for each level, not with tabs."
    message = error.msg
    for pattern, said in SYNTAX:
        found = re.fullmatch(pattern, message)
        if found is not None:
            return said.format(*found.groups())
    if line.strip().startswith(_FOLLOWERS):
        return NOTHING_BEFORE
    at = error.offset or 1
    near = line[max(at - 4, 0) : at + 2]
    return next((said for pattern, said in SYMBOLS if re.search(pattern, near)), UNKNOWN.format(message))

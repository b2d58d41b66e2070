"""What to write instead of Python that the language does not have, for the most frequent mistakes in scripts."""

from __future__ import annotations

import ast
import re
from collections.abc import Mapping
from typing import Final
from unicodedata import normalize

_NO_IMPORT: Final = "Leave it out: a script uses only what self and ctx give."
_NO_FUNCTION_HERE: Final = "Write functions beside new_task, in class Task: def mix_paint(self, minutes):."
_ON_SELF: Final = "Write self. before it: self.wait(60)."
_ARITHMETIC: Final = "There are +, -, *, /, abs, round, min and max. Reckon the rest beforehand and write the number."
_NO_TEST: Final = "Write if, and inside it self.notify(…) or self.end()."

_TEXT_WITH_VALUE: Final = 'Write a text with the value in it: f"{self.count} boxes".'
_ONE_PAIR: Final = "Write one pair of brackets only."

_NO_PROBLEM: Final = "What failed cannot be read. Write a text of your own."

LIMIT: Final = 'Write with self.limit(quantity(5, "min")): and under it the steps that may take so long.'
LIMITING: Final = ("limit", "timeout", "timeout_after", "time_limit", "fail_after", "move_on_after")
"""Calls by which Python writers limit a time."""

STATEMENTS: Final[Mapping[type[ast.AST], str]] = {
    ast.Import: _NO_IMPORT,
    ast.ImportFrom: _NO_IMPORT,
    ast.FunctionDef: _NO_FUNCTION_HERE,
    ast.AsyncFunctionDef: _NO_FUNCTION_HERE,
    ast.ClassDef: "A script has one class, Task. Write a function instead: def mix_paint(self):.",
    ast.With: "Leave “with” out and write its lines as they are.",
    ast.Assert: _NO_TEST,
    ast.Raise: 'Write raise Failed("The box is wet.").',
    ast.Delete: "Leave it out: nothing needs to be deleted.",
    ast.Global: "Leave it out: self.count is seen everywhere.",
    ast.Nonlocal: "Leave it out: self.count is seen everywhere.",
    ast.Match: "Write if and else instead.",
    ast.TryStar: "Write except without the star.",
    ast.AsyncFor: "Leave “async” out: a script waits by itself until a step is done.",
    ast.AsyncWith: "Leave “async with” out and write its lines as they are.",
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
    ast.Await: "Leave “await” out: a script waits by itself until a step is done.",
    ast.Yield: "Write return to give a value.",
    ast.YieldFrom: "Write return to give a value.",
    ast.Starred: "Write the values one by one.",
    ast.Dict: "Only pick, drop and operate take values in braces.",
    ast.Set: "Write a list with square brackets: [1, 2].",
    ast.Tuple: "Write each step on a line of its own.",
    ast.List: "Write each step on a line of its own.",
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
    "__import__": _NO_IMPORT,
    "repeat": "Write for _ in range(3):.",
    **dict.fromkeys(LIMITING, LIMIT),
    "range": "range stands only in a loop: for _ in range(3):.",
    "sum": "Add the values: self.first + self.second.",
    "any": "Join the conditions with “or”.",
    "all": "Join the conditions with “and”.",
    "bool": "Write a condition, such as self.count > 0.",
    "list": "Write the values in square brackets: [1, 2].",
    "sorted": "Write the values in the order that you want.",
    "pow": _ARITHMETIC,
    "sqrt": _ARITHMETIC,
    "str": _TEXT_WITH_VALUE,
    "int": "Use round(…), or write the number.",
    "float": "Leave “float” out and write the value.",
}
"""Calls by their last name."""

LIBRARIES: Final[Mapping[str, str]] = {
    "math": _ARITHMETIC,
    "numpy": _ARITHMETIC,
    "np": _ARITHMETIC,
    "random": "A task leaves nothing to chance. Write the value itself.",
    "time": "The time of day is now().",
    "datetime": "The time of day is now().",
    "sys": "End the program by self.end().",
    "os": "A script cannot use the computer, only devices that run gives.",
    "subprocess": "A script cannot use the computer, only devices that run gives.",
    "asyncio": "A script waits by itself until a step is done. Leave “asyncio” out.",
    "logging": 'Tell people by self.notify("The box is dry.").',
}
"""Modules that Python writers reach for, by their names."""

NAMES: Final[Mapping[str, str]] = {
    **LIBRARIES,
    **dict.fromkeys(("true", "TRUE", "yes", "on", "wahr", "ja"), "Write True, with a large first letter."),
    **dict.fromkeys(("false", "FALSE", "no", "off", "falsch", "nein"), "Write False, with a large first letter."),
    **dict.fromkeys(("null", "nil", "none", "undefined"), "Write a value; there is no empty one."),
    **dict.fromkeys(("this", "Self", "me", "Task"), "Write self."),
    "self": "Say what of it, such as self.count or self.oven.temperature.",
    "ctx": 'ctx gives things only in run: self.oven = ctx.get("curingOven01").',
    "end": "Leave it out: a block ends where the lines are no longer indented.",
    "begin": "Leave it out: a block begins where the lines are indented.",
    **dict.fromkeys(("e", "ex", "exc", "err", "error", "exception"), _NO_PROBLEM),
    "problem": _NO_PROBLEM,
}
"""Names without self. that stand for nothing."""

OTHER_WORDS: Final[Mapping[str, str]] = {
    **dict.fromkeys(("go", "goto", "go_to", "move_to", "drive", "drive_to", "navigate", "travel"), "move"),
    **dict.fromkeys(("grab", "take", "get", "pickup", "pick_up", "grasp", "load", "fetch"), "pick"),
    **dict.fromkeys(("put", "place", "release", "put_down", "unload", "leave", "deliver"), "drop"),
    **dict.fromkeys(("sleep", "delay", "pause", "wait_for", "wait_until"), "wait"),
    **dict.fromkeys(("print", "log", "say", "tell", "message", "alert", "info"), "notify"),
    **dict.fromkeys(("stop", "finish", "abort", "exit", "quit", "terminate"), "end"),
    **dict.fromkeys(("input", "question", "confirm", "prompt"), "ask"),
}
"""Words that people write for a step, with the step's own."""

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
    if isinstance(value, ast.Call):
        return _ONE_PAIR if isinstance(value.func, ast.Call) else instead_of_call(value)
    if isinstance(value, ast.Attribute):
        return ATTRIBUTE_ALONE
    if isinstance(value, ast.UnaryOp) and isinstance(value.operand, ast.UnaryOp):
        return "Write self.count = self.count + 1."
    if isinstance(value, ast.Tuple) and value.elts and _is_self(value.elts[0]):
        return "Write a dot behind self: self.wait(60)."
    if isinstance(value, ast.BoolOp) and any(isinstance(part, ast.Call) for part in value.values):
        return EXPRESSIONS[ast.Tuple]
    return EXPRESSIONS.get(type(value)) or (VALUE_ALONE if _is_value(value) else None)


def instead_of_import(statement: ast.stmt) -> str | None:
    """Return what to write instead of an import; None for anything else."""
    return _NO_IMPORT if isinstance(statement, ast.Import | ast.ImportFrom) else None


def instead_of_call(call: ast.Call) -> str | None:
    """Return what to write instead of a call such as `time.sleep(5)`, when that can be told."""
    function = call.func
    name = (
        function.attr if isinstance(function, ast.Attribute) else function.id if isinstance(function, ast.Name) else ""
    )
    if not isinstance(function, ast.Attribute) or name == "sleep":
        return CALLS.get(name)
    if _is_self(function.value):
        return CALLS.get(OTHER_WORDS.get(name, name))
    if isinstance(function.value, ast.Name):
        return LIBRARIES.get(function.value.id)
    if isinstance(function.value, ast.Constant) and isinstance(function.value.value, str):
        return _TEXT_WITH_VALUE
    return _ONE_PAIR if isinstance(function.value, ast.Call) else None


def instead_of_operator(node: ast.BinOp) -> str:
    """Return what to write instead of an operator that the language does not have."""
    if isinstance(node.op, ast.FloorDiv):
        return "Use round(self.a / self.b)."
    is_text = isinstance(node.left, ast.Constant) and isinstance(node.left.value, str)
    return _TEXT_WITH_VALUE if is_text and isinstance(node.op, ast.Mod) else "Use +, -, * or /."


def instead_of_is(node: ast.Compare) -> str:
    """Return what to write instead of `is`."""
    if isinstance(node.comparators[0], ast.Constant) and node.comparators[0].value is None:
        return "Leave it out: every value is there."
    return f"Compare with {'==' if isinstance(node.ops[0], ast.Is) else '!='}."


def instead_of_expression(node: ast.expr) -> str | None:
    """Return what to write instead of an expression, when that can be told."""
    return EXPRESSIONS.get(type(node))


def _is_self(node: ast.expr) -> bool:
    return isinstance(node, ast.Name) and node.id == "self"


def _is_value(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant | ast.Compare | ast.BinOp | ast.BoolOp | ast.UnaryOp | ast.Name)


_QUOTES: Final = 'Write straight quotation marks: "box".'
_LEVELS: Final = "Indent with 4 spaces for each level, like the lines beside it."
_QUANTITY: Final = 'Write a number with its unit as quantity(5, "min").'
_NAME_HERE: Final = "Write a name of one word and brackets behind it: def mix_paint(self):."
_SMALL: Final = "Write “{0}” in small letters."
FIRST_WORDS: Final[Mapping[str, str]] = {
    **dict.fromkeys(("elseif", "elsif", "sonst"), "Write elif or else."),
    **dict.fromkeys(("wenn", "unless", "when"), "Write if."),
    **dict.fromkeys(("until", "loop", "do", "solange"), "Write while."),
    **dict.fromkeys(("foreach", "repeat", "wiederhole"), "Write for _ in range(3):."),
    **dict.fromkeys(("switch", "case"), "Write if and else instead."),
    **dict.fromkeys(("function", "func", "fn", "sub", "procedure", "method"), "Write def mix_paint(self):."),
    **dict.fromkeys(("catch", "rescue"), "Write except TaskError:."),
    **dict.fromkeys(("var", "let", "const", "int", "float", "bool", "string"), "Set it as self.count = 1."),
    **dict.fromkeys(("//", "/*", "--", "*/"), "A note begins with #."),
}
"""The first word of a line that Python cannot read → what helps."""
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
    (r"invalid decimal literal|invalid imaginary literal", _QUANTITY),
    (r"leading zeros .*", "Write the number without zeros before it."),
    (r"expected '\('", _NAME_HERE),
    (r".*Perhaps you forgot a comma\?", "Write a comma between the values."),
    (r"cannot assign to .*", "Only variables can be set: self.count = 1."),
    (r"'(return|break|continue|await|yield)' outside .*", "Write {0} in a method of class Task."),
)  # fmt: skip
"""What Python says → what helps."""
BEHIND: Final[tuple[tuple[str, str], ...]] = ((r"\d+ (?:s|sec|min|h|m|mm|cm|kg|g|°C|%)(?!\w)", _QUANTITY),)
"""What begins where Python stops → what helps."""
ON_THE_LINE: Final[tuple[tuple[str, str], ...]] = (
    (r"=>|=<", "Write >= or <=."),
    (r"\belse if\b", "Write elif or else."),
    (r"\bthen\b", "Leave “then” out; a colon ends the line."),
    (r"\bfor each\b", "Write for oven in [self.oven_a, self.oven_b]:."),
    (r"\brange \d", "Write brackets: for _ in range(3):."),
    (r"(?:and|or) *[<>=!]", "Write what is compared on both sides of “and” or “or”."),
    (r"^\s*self \w", "Write a dot behind self: self.wait(60)."),
    (r"^\s*self\.\w+ [\w\"']", "Write brackets: self.wait(60)."),
    (r"/\*|//", "A note begins with #."),
)
"""What stands somewhere on the line where Python stops without a reason → what helps."""
_VAGUE: Final = ("invalid syntax", "expected ':'", "cannot assign")
SYMBOLS: Final[tuple[tuple[str, str], ...]] = (
    (r"&&?|\|\|?", "Write “and” or “or”."),
    (r"!(?!=)", "Write “not”."),
    (r"//|/\*", "A note begins with #."),
    (r"->|::", "Write a dot: self.wait(60)."),
    (r"<>", "Write !=."),
    (r"\+\+|--", "Write self.count = self.count + 1."),
    (r"[{}]", "Blocks are indented by 4 spaces and have no braces."),
    (r"\?", "Write if and else on lines of their own."),
    (r";\s*$", "Leave the semicolon out."),
)
"""What stands where Python stops → what helps."""
NOTHING_BEFORE: Final = "There is no if, for, while or try right before this, at the same level."
_WORDS: Final = frozenset({"if", "else", "elif", "while", "for", "def", "class", "try", "except", "finally", "return"})
_FOLLOWERS: Final = ("else", "elif", "except", "finally")
UNREADABLE: Final = "Something is missing here, or too much. A step is written like self.wait(60)."
UNKNOWN: Final = "Python says: {0}."


def explain_syntax(error: SyntaxError, text: str) -> str:
    """Return what helps where Python cannot read a script."""
    lines = text.splitlines()
    number = error.lineno or 1
    line = lines[number - 1] if 0 < number <= len(lines) else ""
    if "\t" in line[: len(line) - len(line.lstrip())]:
        return "Indent with spaces, 4 for each level, not with tabs."
    return (
        _by_first_word(line)
        or _by_text(error.msg, line, error.offset or 1)
        or _by_python(error.msg)
        or (NOTHING_BEFORE if line.strip().startswith(_FOLLOWERS) else None)
        or _by_symbol(error.msg, line, error.offset or 1)
    )


def _by_first_word(line: str) -> str | None:
    found = re.match(r"\s*(\w+|//|/\*|--|\*/)", line)
    first = found[1] if found is not None else ""
    if first == "for" and not re.search(r"\bin\b", line):
        return "Write for _ in range(3):."
    small = first.lower()
    return FIRST_WORDS.get(first) or (_SMALL.format(small) if small in _WORDS and first != small else None)


def _by_text(message: str, line: str, at: int) -> str | None:
    """Return what helps by what stands where Python stops, or on that line."""
    letter, behind = line[at - 1 : at], line[at - 1 :]
    plain = normalize("NFKC", letter)
    if "invalid character" in message and letter and plain.isascii() and plain.strip():
        return f"Type {plain} in place of {letter}."
    return next((said for pattern, said in BEHIND if re.match(pattern, behind)), None) or next(
        (said for pattern, said in ON_THE_LINE if re.search(pattern, line) and message.startswith(_VAGUE)), None
    )


def _by_python(message: str) -> str | None:
    for pattern, said in SYNTAX:
        found = re.fullmatch(pattern, message)
        if found is not None:
            return said.format(*found.groups())
    return None


def _by_symbol(message: str, line: str, at: int) -> str:
    near = line[max(at - 4, 0) : at + 2]
    unknown = UNREADABLE if message == "invalid syntax" else UNKNOWN.format(message)
    return next((said for pattern, said in SYMBOLS if re.search(pattern, near)), unknown)

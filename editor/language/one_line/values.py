"""A value as one line of text, parsed and printed: the grammar of the script, without `self.`."""

from __future__ import annotations

import ast
from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Final

from editor.language.document.references import with_document_names, with_role_ids
from editor.language.expressions.names import member_name
from editor.language.expressions.nodes import MISSING, Expression, Located, Quantity
from editor.language.expressions.printing import quantity_text, read_of, scalar_text, write_expression
from editor.language.expressions.value_types import TypeChecker, ValueType
from editor.language.expressions.values import FUNCTIONS, UnknownParameter, read_value, write_value
from editor.language.messages.phrases import LANGUAGES, Refusal
from editor.language.one_line.notation import Desugared, desugar
from editor.language.one_line.scope import LineScope
from editor.language.parsing.expressions import parse_expression
from editor.language.parsing.scope import Refused
from editor.language.tree.robots import short_reading
from vipo_device.protocol.units import UNITS, unit_symbol

LONGEST_LINE = 2000
_CALLED = frozenset({*FUNCTIONS, "quantity", "point"})
_YES_NO = {"true": True, "yes": True, "false": False, "no": False}
_USE_A_DEVICE = "Write for example: oven.temperature."
_SYNTAX = (
    ("was never closed", "open_bracket"),
    ("unterminated", "open_text"),
    ("unmatched", "closing_bracket"),
    ("f-string", "bad_braces"),
)


class NotUnderstood(Exception):
    """A line that is no value of the language: where (the column counts from 1), and why in each language."""

    def __init__(self, column: int, code: str, **args: str) -> None:
        self.column = column
        self.messages: dict[str, str] = {
            language: LINE_TEXTS[code][language].format_map(
                {name: _bare(Refusal(argument).say(language)) for name, argument in args.items()}
            )
            for language in LANGUAGES
        }
        super().__init__(self.messages["en"])


def parse_line(text: str, line: LineScope) -> object:
    """Return the Value of the document that a line stands for; an empty line is a missing value.

    Raises:
        NotUnderstood: it is no value of the language.
    """
    names = {written: name for name, written in line.names.items()}
    value = write_value(_parse(text, line))
    return with_document_names(with_role_ids(value, line.role_ids), names)


def print_line(value: object, line: LineScope) -> str:
    """Return a Value of the document as one line; one that is missing, or speaks of what is gone, is empty."""
    expression = _read(value, line)
    return "" if expression == MISSING else write_expression(expression, _LineNames(line))


def type_of_line(value: object, line: LineScope) -> ValueType:
    """Return the type of what a Value of the document gives."""
    return TypeChecker(line.scope.surroundings, line.types, []).type_of(_read(value, line))


def _read(value: object, line: LineScope) -> Expression:
    try:
        return read_value(value, line.names, line.robot_of)
    except UnknownParameter:
        return MISSING


@dataclass(frozen=True, slots=True)
class _LineNames:
    """How names are written in a line."""

    line: LineScope

    def variable(self, name: str) -> str:
        return name

    def reading(self, device: str, property_name: str) -> str:
        description = self.line.scope.description(device)
        known = [] if description is None else [spec.name for spec in description.properties]
        member, name = member_name(property_name, known), self.line.thing("get", device)
        return read_of(name, member, property_name)

    def robot_reading(self, role: str, property_name: str) -> str:
        robots = self.line.scope.robots_of(role)
        return read_of(role, short_reading(robots, property_name), property_name)

    def located(self, located: Located) -> str:
        if located.role is not None:
            return located.role
        if located.device is not None:
            return self.line.thing("get", located.device)
        if located.place is not None:
            return self.line.thing("place", located.place)
        return self.line.thing("zone", located.zone or "")

    def quantity(self, quantity: Quantity) -> str:
        if quantity.unit not in UNITS:
            return quantity_text(quantity)
        return f"{scalar_text(quantity.value)} {unit_symbol(quantity.unit)}"


def _parse(text: str, line: LineScope) -> Expression:
    if len(text) > LONGEST_LINE:
        raise NotUnderstood(LONGEST_LINE, "too_long")
    if not text.strip():
        return MISSING
    margin = len(text) - len(text.lstrip())
    source = desugar(text.strip())
    try:
        tree = ast.parse(source.text, mode="eval")
    except SyntaxError as error:
        at = (error.offset or len(source.text) + 1) - 1
        raise NotUnderstood(margin + _column(source, at), _unfinished(error)) from error
    except (ValueError, RecursionError, MemoryError) as error:
        raise NotUnderstood(1, "not_complete") from error
    try:
        return parse_expression(_Named(line, source, margin).visit(tree.body), line.scope)
    except Refused as refused:
        instead = (
            _USE_A_DEVICE if refused.instead.startswith("Give it in run") else refused.instead.replace("self.", "")
        )
        column = margin + _column(source, _characters(source.text, refused.column - 1))
        raise NotUnderstood(column, "not_in_value", found=refused.found, instead=instead) from refused
    except RecursionError as error:
        raise NotUnderstood(1, "not_complete") from error


def _column(source: Desugared, position: int) -> int:
    return source.origin(max(position, 0)) + 1


def _characters(text: str, offset: int) -> int:
    """Return the position in characters of an offset in UTF-8, which is what Python's trees have."""
    return len(text.encode()[:offset].decode(errors="ignore"))


def _unfinished(error: SyntaxError) -> str:
    return next((code for sign, code in _SYNTAX if sign in (error.msg or "")), "not_complete")


def _bare(text: str) -> str:
    return text.replace("self.", "")


class _Named(ast.NodeTransformer):
    """Puts the task before names, as in the script; a name that means nothing here is refused."""

    def __init__(self, line: LineScope, source: Desugared, margin: int) -> None:
        self.line, self.source, self.margin = line, source, margin
        self.known = frozenset(line.known_names())

    def visit_Call(self, node: ast.Call) -> ast.AST:
        """Functions are not of the task."""
        if isinstance(node.func, ast.Name) and node.func.id in _CALLED:
            node.args = [self.visit(argument) for argument in node.args]
            return node
        return self.generic_visit(node)

    def visit_Attribute(self, node: ast.Attribute) -> ast.AST:
        """A failure that was caught is not of the task."""
        of_problem = isinstance(node.value, ast.Name) and f"{node.value.id}.{node.attr}" in self.line.scope.locals
        return node if of_problem else self.generic_visit(node)

    def visit_Name(self, node: ast.Name) -> ast.AST:
        """Return the attribute of the task that a name stands for."""
        if node.id == "self":
            return node
        if node.id in self.known:
            return ast.copy_location(ast.Attribute(_SELF, node.id, ast.Load()), node)
        if node.id.lower() in _YES_NO:
            return ast.copy_location(ast.Constant(_YES_NO[node.id.lower()]), node)
        column = self.margin + _column(self.source, _characters(self.source.text, node.col_offset))
        near = _alike(node.id, sorted({*self.known, *_CALLED}))
        code = "unknown_name_like" if near else "unknown_name"
        raise NotUnderstood(column, code, name=node.id, options=", ".join(near))


def _alike(name: str, known: list[str]) -> list[str]:
    """Return known names that may be meant: those that are nearly the same, or have it as a part."""
    parts = [other for other in known if len(name) > 2 and name.lower() in other]
    return list(dict.fromkeys([*get_close_matches(name, known, 3, 0.75), *parts]))[:3]


_SELF = ast.Name("self", ast.Load())


LINE_TEXTS: Final[Mapping[str, Mapping[str, str]]] = {
    "too_long": {"en": "The line is too long.", "de": "Die Zeile ist zu lang."},
    "not_complete": {
        "en": "Something is missing, or too much, here. Write for example: oven.temperature > 60.",
        "de": "Hier fehlt etwas, oder etwas ist zu viel. Schreiben Sie zum Beispiel: oven.temperature > 60.",
    },
    "open_bracket": {"en": "A bracket is not closed.", "de": "Eine Klammer ist nicht geschlossen."},
    "open_text": {
        "en": "A text is not closed with a quotation mark.",
        "de": "Ein Text ist nicht mit einem Anführungszeichen geschlossen.",
    },
    "closing_bracket": {
        "en": "A bracket is closed that was never opened.",
        "de": "Eine Klammer wird geschlossen, die nie geöffnet wurde.",
    },
    "bad_braces": {"en": "A value in braces is not complete.", "de": "Ein Wert in Klammern { } ist nicht vollständig."},
    "not_in_value": {"en": "{found} cannot stand here. {instead}", "de": "{found} kann hier nicht stehen. {instead}"},
    "unknown_name": {
        "en": "There is nothing called “{name}” here.",
        "de": "Hier gibt es nichts mit dem Namen „{name}“.",
    },
    "unknown_name_like": {
        "en": "There is nothing called “{name}” here. Do you mean {options}?",
        "de": "Hier gibt es nichts mit dem Namen „{name}“. Meinen Sie {options}?",
    },
}

"""What a node has → how the script writes it; one small function for each type of field."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from operator import attrgetter
from typing import Any

from editor.language.constructs.record import Field, FieldType
from editor.language.constructs.script_form import ScriptCall
from editor.language.expressions.nodes import AnswerSpec, Point
from editor.language.expressions.printing import quote, scalar_text
from editor.language.printing.writer import Printer, point_text
from vipo_device.protocol.units import unit_symbol

Prints = Callable[[Printer, Any, int], None]
_Text = Callable[[Printer, Any], str]


def _route(printer: Printer, route: tuple[Point, ...]) -> str:
    return f"[{', '.join(map(point_text, route))}]"


def _answer(printer: Printer, answer: AnswerSpec) -> str:
    limits = {"minimum": answer.minimum, "maximum": answer.maximum}
    given = [f"type={quote(answer.type)}"]
    given += [f"unit={quote(unit_symbol(answer.unit))}"] if answer.unit else []
    given += [f"{name}={scalar_text(limit)}" for name, limit in limits.items() if limit is not None]
    given += [f"options=[{', '.join(map(quote, answer.options))}]"] if answer.options else []
    return ", ".join(given)


FIELD_TEXTS: Mapping[FieldType, _Text] = {
    "role": lambda printer, role: f"self.{role}",
    "place": Printer.place,
    "value": Printer.value,
    "variable": lambda printer, name: f"{printer.variable(name)} = " if name else "",
    "choice": lambda printer, word: quote(word),
    "route": _route,
    "zone": lambda printer, zone: printer.zone(zone) if zone else "None",
    "answer": _answer,
}


def printer_of(call: ScriptCall) -> Prints:
    """Return what prints a node as a call."""
    filled = tuple((attrgetter(field.attribute), text) for field, text in _holes(call))
    pattern = _pattern(call)

    def print_node(printer: Printer, node: Any, depth: int) -> None:
        printer.line(depth, pattern % tuple([text(printer, get(node)) for get, text in filled]), node.step)

    return print_node


def _pattern(call: ScriptCall) -> str:
    """Return the call with a hole for each field; what may be left out stands at the end, with its comma."""
    given = ["%s" for _ in call.arguments]
    entries = ", ".join(f"{quote(key)}: %s" for key, _ in call.entries)
    given += [f"{{{entries}}}"] if entries else []
    given += ["%s"] if call.spread else []
    given += [f"{key}=%s" for key, field in call.keywords if not field.optional]
    left_out = "%s" * sum(field.optional for _, field in call.keywords)
    assigned, receiver = "%s" if call.variable else "", "%s" if call.role else "self"
    return f"{assigned}{receiver}.{call.method}({', '.join(given)}{left_out})"


def _holes(call: ScriptCall) -> Iterator[tuple[Field, _Text]]:
    """Yield the fields in the order of the pattern's holes, each with what writes it there."""
    required = [field for _, field in call.keywords if not field.optional]
    entries = [field for _, field in call.entries]
    for field in (call.variable, call.role, *call.arguments, *entries, call.spread, *required):
        if field is not None:
            yield field, FIELD_TEXTS[field.type]
    for key, field in call.keywords:
        if field.optional:
            yield field, _if_given(f", {key}=", FIELD_TEXTS[field.type])


def _if_given(label: str, text: _Text) -> _Text:
    return lambda printer, value: "" if value is None or value == () else label + text(printer, value)

"""`self.ask(…)` and `self.notify(…)`: the questions and notices for people."""

from __future__ import annotations

import ast

from editor.language.expressions import nodes as e
from editor.language.expressions.declarations import ANSWER_TYPES, normal_answer
from editor.language.expressions.nodes import AnswerSpec
from editor.language.expressions.units import unit_code
from editor.language.parsing.expressions import Refused, Scope, parse_expression, parse_scalar, quoted
from editor.language.tree import nodes as n

_ASK = 'Write self.dry = self.ask("Is it dry?", type="boolean", timeout=600).'
_NOTIFY = 'Write self.notify("The box is dry.", level="info").'


def parse_ask(call: ast.Call, scope: Scope, variable: str = "") -> n.Ask:
    """Return the question that a call asks; the answer goes into the variable, if there is one.

    Raises:
        Refused: it is not written as the language has it.
    """
    named = {keyword.arg: keyword.value for keyword in call.keywords}
    if len(call.args) != 1 or len(named) != len(call.keywords):
        raise Refused(call, quoted(call), _ASK)
    timeout = named.pop("timeout", None)
    limit = e.MISSING if timeout is None else parse_expression(timeout, scope)
    question, answer = parse_expression(call.args[0], scope), _answer(call, named)
    return n.Ask(question, answer, variable, None if limit == e.MISSING else limit)


def _answer(call: ast.Call, named: dict[str | None, ast.expr]) -> AnswerSpec:
    """Return what may be answered; nothing may be said that does not belong to the type."""
    given: dict[str, object] = {}
    for name, value in named.items():
        if name == "options" and isinstance(value, ast.List):
            given["options"] = [parse_scalar(item) for item in value.elts]
        elif name is not None:
            given[name] = parse_scalar(value)
    if isinstance(given.get("unit"), str):
        given["unit"] = unit_code(str(given["unit"]))
    answer = normal_answer(given)
    said = {"type": answer.type, "unit": answer.unit or None, "minimum": answer.minimum, "maximum": answer.maximum}
    known = {
        name: value for name, value in {**said, "options": list(answer.options) or None}.items() if value is not None
    }
    if {"type": "boolean", **given} != known:
        types = ", ".join(f'"{kind}"' for kind in ANSWER_TYPES)
        raise Refused(call, quoted(call), f"type is one of {types}; unit, minimum and maximum go with \"number\", "
                      'options=["red", "blue"] with "choice".')  # fmt: skip
    return answer


def parse_notify(call: ast.Call, scope: Scope) -> n.Notify:
    """Return what a call tells people.

    Raises:
        Refused: it is not written as the language has it.
    """
    match call:
        case ast.Call(args=[message], keywords=[]):
            return n.Notify(parse_expression(message, scope))
        case ast.Call(args=[message], keywords=[ast.keyword(arg="level", value=ast.Constant(value=level))]) if (
            level in {"info", "warning"}
        ):
            return n.Notify(parse_expression(message, scope), str(level))
    raise Refused(call, quoted(call), _NOTIFY)

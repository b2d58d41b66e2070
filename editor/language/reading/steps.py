"""Steps of a document → nodes of the tree; one small function for each kind of step."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from editor.language.document.outline import Params, mapping
from editor.language.expressions.declarations import normal_answer
from editor.language.expressions.names import local_name
from editor.language.expressions.nodes import MISSING, Expression, Point, is_missing
from editor.language.expressions.values import read_point
from editor.language.messages.diagnostics import Problem, TextArguments
from editor.language.messages.phrases import Options
from editor.language.reading.names import text_of
from editor.language.reading.reader import Reader, Reads
from editor.language.tree.nodes import (
    ERROR_CLASSES,
    Ask,
    Break,
    Call,
    Drop,
    End,
    ForEach,
    If,
    Move,
    Node,
    Notify,
    Operate,
    Parallel,
    Pick,
    Repeat,
    Return,
    Set,
    Try,
    Wait,
    WaitUntil,
    While,
)

_LISTS: Final = (list, tuple)


def _move(reader: Reader, step: str, params: Params) -> tuple[Node, ...]:
    return (Move(reader.role(step, params), reader.place(step, params, "to"), _route(params.get("route")), step),)


def _pick(reader: Reader, step: str, params: Params) -> tuple[Node, ...]:
    return (Pick(reader.role(step, params), reader.place(step, params, "at"), *_load(reader, step, params), step),)


def _drop(reader: Reader, step: str, params: Params) -> tuple[Node, ...]:
    return (Drop(reader.role(step, params), reader.place(step, params, "at"), *_load(reader, step, params), step),)


def _pick_and_drop(reader: Reader, step: str, params: Params) -> tuple[Node, ...]:
    role, (thing, quantity) = reader.role(step, params), _load(reader, step, params)
    source, target = reader.place(step, params, "source"), reader.place(step, params, "target")
    route = _route(params.get("route"))
    return (
        Pick(role, source, thing, quantity, step, "source"),
        Drop(role, target, thing, quantity, step, "target", route),
    )


def _load(reader: Reader, step: str, params: Params) -> tuple[Expression, Expression]:
    return reader.value(step, params, "object"), reader.value(step, params, "quantity")


def _route(value: object) -> tuple[Point, ...]:
    points = [read_point(point) for point in value] if isinstance(value, _LISTS) else []
    return tuple(point for point in points if point is not None)


def _operate(reader: Reader, step: str, params: Params) -> tuple[Node, ...]:
    method = params.get("method")
    arguments = _arguments(reader, step, params)
    return (
        Operate(reader.place(step, params, "device"), method if isinstance(method, str) else "", arguments, step),
    )  # fmt: skip


def _arguments(reader: Reader, step: str, params: Params) -> tuple[tuple[str, Expression], ...]:
    given = mapping(params.get("args"))
    arguments: list[tuple[str, Expression]] = []
    for name in sorted(given, key=str):
        value = reader.value(step, given, name, f"args.{name}")
        if not is_missing(value):
            arguments.append((str(name), value))
    return tuple(arguments)


def _wait(reader: Reader, step: str, params: Params) -> tuple[Node, ...]:
    if params.get("until") is None:
        return (Wait(reader.value(step, params, "duration"), step),)
    timeout = reader.given(step, params, "timeout")
    return (WaitUntil(reader.value(step, params, "until"), timeout, step),)


def _if(reader: Reader, step: str, params: Params) -> tuple[Node, ...]:
    condition = reader.value(step, params, "condition")
    return (If(condition, reader.block(step, "then"), reader.block(step, "else"), step),)


def _while(reader: Reader, step: str, params: Params) -> tuple[Node, ...]:
    return (While(reader.value(step, params, "condition"), reader.block(step, "body"), step),)


def _parallel(reader: Reader, step: str, params: Params) -> tuple[Node, ...]:
    return (Parallel(tuple(reader.block(step, name) for name in reader.outline.branches(step)), step),)


def _try(reader: Reader, step: str, params: Params) -> tuple[Node, ...]:
    named = params.get("kinds")
    wanted = named if isinstance(named, _LISTS) else ()
    kinds = tuple(kind for kind in ERROR_CLASSES if kind in wanted)
    body, catch, final = reader.block(step, "body"), reader.block(step, "catch"), reader.block(step, "finally")
    catches = params.get("catch") is not False
    return (Try(kinds if catches else (), body, catch, final, catches, step),)


def _call(reader: Reader, step: str, params: Params) -> tuple[Node, ...]:
    wanted = params.get("function")
    function = reader.functions.get(wanted) if isinstance(wanted, str) else None
    result = reader.variable(params, "result")
    if function is None:
        if wanted is not None:
            reader.problems.append(Problem("unknown_function", step, "function"))
        return (Call("", result=result, step=step),)
    names = reader.argument_names[function.id]
    given = mapping(params.get("args"))
    arguments: list[tuple[str, Expression]] = []
    for name in sorted(given, key=str):
        value = _call_argument(reader, step, given, name)
        if value != MISSING and name in names:
            arguments.append((names[name], value))
        elif name not in names:
            options = Options(tuple(names))
            details: TextArguments = {"method": function.name, "argument": str(name), "options": options}
            reader.problems.append(Problem("unknown_argument", step, f"args.{name}", details))
    return (Call(function.method, tuple(sorted(arguments, key=lambda pair: pair[0])), result, step),)


def _call_argument(reader: Reader, step: str, given: Params, name: str) -> Expression:
    return reader.value(step, given, name, f"args.{name}")


def _repeat(reader: Reader, step: str, params: Params) -> tuple[Node, ...]:
    return (Repeat(reader.value(step, params, "times"), reader.block(step, "body"), step),)


def _for_each(reader: Reader, step: str, params: Params) -> tuple[Node, ...]:
    """The variable of the loop can be seen in its body, and hides what else has its name."""
    listed, wanted = params.get("items"), text_of(params.get("variable"))
    items = listed if isinstance(listed, list | tuple) else ()
    values = tuple(reader.value(step, {"items": item}, "items") for item in items)
    outside = reader.names
    if wanted:
        hidden = (script for name, script in outside.items() if name != wanted)
        reader.names = {**outside, wanted: local_name(wanted, hidden)}
    body = reader.block(step, "body")
    variable, reader.names = reader.variable(params), outside
    return (ForEach(variable, values, body, step),)


def _set(reader: Reader, step: str, params: Params) -> tuple[Node, ...]:
    return (Set(reader.variable(params), reader.value(step, params, "value"), step),)


def _ask(reader: Reader, step: str, params: Params) -> tuple[Node, ...]:
    question, timeout = reader.value(step, params, "question"), reader.given(step, params, "timeout")
    answer = normal_answer(mapping(params.get("answer")))
    return (Ask(question, answer, reader.variable(params), timeout, step),)


def _notify(reader: Reader, step: str, params: Params) -> tuple[Node, ...]:
    level = "warning" if params.get("level") == "warning" else "info"
    return (Notify(reader.value(step, params, "message"), level, step),)


def _end(reader: Reader, step: str, params: Params) -> tuple[Node, ...]:
    return (End(step),)


def _return(reader: Reader, step: str, params: Params) -> tuple[Node, ...]:
    return (Return(reader.given(step, params, "value"), step),)


def _break(reader: Reader, step: str, params: Params) -> tuple[Node, ...]:
    return (Break(step),)


READERS: Mapping[str, Reads] = {
    "move": _move,
    "pick": _pick,
    "drop": _drop,
    "pick_and_drop": _pick_and_drop,
    "operate": _operate,
    "wait": _wait,
    "if": _if,
    "while": _while,
    "parallel": _parallel,
    "try": _try,
    "call": _call,
    "repeat": _repeat,
    "for_each": _for_each,
    "set": _set,
    "ask": _ask,
    "notify": _notify,
    "end": _end,
    "return": _return,
    "break": _break,
}

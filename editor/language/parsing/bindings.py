"""The parts of a script around its steps: what `run` gives to the task, parameters and arguments of methods."""

from __future__ import annotations

import ast
from dataclasses import dataclass

from editor.language.expressions import nodes as e
from editor.language.expressions.declarations import UnknownType, parse_type
from editor.language.expressions.nodes import Expression
from editor.language.parsing.expressions import (
    Binding,
    Refused,
    Scope,
    attribute_of_self,
    parse_expression,
    parse_scalar,
    quoted,
)
from editor.language.tree import nodes as n


@dataclass(frozen=True, slots=True)
class Entry:
    """An event as `run` has it: its condition is still to be read, and its method to be found."""

    starts: str
    condition: ast.expr
    method: str
    call: ast.Call


_ENTRIES = {"when": "branch", "start_when": "run"}


def parse_run(method: ast.FunctionDef, scope: Scope) -> list[Entry]:
    """Read `run(self, ctx)` into the scope's bindings; return the events.

    Raises:
        Refused: it does anything but give robots, devices, places, parameters and events, and call new_task.
    """
    entries: list[Entry] = []
    if [argument.arg for argument in method.args.args] != ["self", "ctx"]:
        raise Refused(method, "This run", "Write def run(self, ctx):.")
    for statement in method.body:
        match statement:
            case ast.Expr(value=ast.Call(func=function, args=[], keywords=[])) if (
                attribute_of_self(function) == "new_task"
            ):
                continue
            case ast.Expr(value=ast.Constant(value=str())):
                continue
            case ast.Expr(
                value=ast.Call(
                    func=ast.Attribute(value=ast.Name(id="ctx"), attr="when" | "start_when" as when),
                    args=[condition, handler],
                    keywords=[],
                ) as call
            ):
                name = attribute_of_self(handler)
                if name is not None:
                    entries.append(Entry(_ENTRIES[when], condition, name, call))
                    continue
            case ast.Assign(targets=[target], value=ast.Call() as call):
                name = attribute_of_self(target)
                if name is not None:
                    scope.bindings[name] = _binding(call, name)
                    continue
        raise Refused(
            statement, quoted(statement), 'In run, write self.oven = ctx.get("curingOven01") and self.new_task().'
        )
    return entries


def _binding(call: ast.Call, name: str) -> Binding:
    function = call.func
    if isinstance(function, ast.Attribute) and isinstance(function.value, ast.Name) and function.value.id == "ctx":
        if function.attr == "parameter":
            return _parameter_binding(call, name)
        texts = [parse_scalar(argument) for argument in call.args]
        named = {keyword.arg: parse_scalar(keyword.value) for keyword in call.keywords}
        match function.attr, texts, named:
            case "get", [str() as device], {**rest} if device and not rest:
                return Binding("get", device)
            case "get", [str() as device], {"at": str() as at, **rest} if device and at and not rest:
                return Binding("get", device, at=at)
            case "place", [str() as place], {**rest} if place and not rest:
                return Binding("place", place)
            case "any", _, {**rest} if not rest and all(isinstance(text, str) and text for text in texts):
                return Binding("any", can=tuple(dict.fromkeys(str(text) for text in texts)))
            case "zone", [str() as zone], {**rest} if zone and not rest:
                return Binding("zone", zone)
    raise Refused(
        call, quoted(call), 'Use ctx.get("robot01"), ctx.any("pick", "drop"), ctx.place("dock1") or ctx.parameter(…).'
    )


def _parameter_binding(call: ast.Call, name: str) -> Binding:
    """Read `ctx.parameter("count", 0, Number)`."""
    match call.args:
        case [ast.Constant(value=given), *rest] if given == name and len(rest) <= 2 and not call.keywords:
            default = parse_scalar(rest[0]) if rest else None
            kind, unit = read_type(rest[1] if len(rest) == 2 else None)
            return Binding("parameter", default=default, type=kind, unit=unit)
    raise Refused(call, quoted(call), f'Write self.{name} = ctx.parameter("{name}", 0, Number).')


def read_type(node: ast.expr | None) -> tuple[str, str]:
    """Return the type and the unit that stand in a script; both empty where there is none.

    Raises:
        Refused: it is no type of the language.
    """
    try:
        return parse_type(node)
    except UnknownType as error:
        raise Refused(node or ast.Pass(), quoted(node or ast.Pass()), str(error)) from error


def parse_parameters(method: ast.FunctionDef) -> tuple[n.Parameter, ...]:
    """Return the parameters of a function's method.

    Raises:
        Refused: they are of a form that the language does not have.
    """
    a = method.args
    bare_self = a.args and a.args[0].arg == "self" and len(a.defaults) < len(a.args)
    if a.vararg or a.kwarg or a.kwonlyargs or a.posonlyargs or not bare_self:
        raise Refused(method, "This form of parameters", f"Write def {method.name}(self, minutes):.")
    given = a.args[1:]
    defaults = [None] * (len(given) - len(a.defaults)) + [parse_scalar(default) for default in a.defaults]
    return tuple(
        n.Parameter(argument.arg, default, *read_type(argument.annotation))
        for argument, default in zip(given, defaults, strict=True)
    )


def parse_arguments(call: ast.Call, parameters: list[str], scope: Scope) -> n.Arguments:
    """Return a call's arguments by name, sorted; those still to be entered (None) are left out.

    Raises:
        Refused: there are too many, one is given twice, or one has an unknown name.
    """
    takes = f"It takes: {', '.join(parameters) or 'nothing'}."
    if len(call.args) > len(parameters):
        raise Refused(call, quoted(call), takes)
    given: dict[str, Expression] = {}
    pairs = [
        *zip(parameters, call.args, strict=False),
        *((keyword.arg or "", keyword.value) for keyword in call.keywords),
    ]
    for name, value in pairs:
        if name not in parameters or name in given:
            raise Refused(call, quoted(call), takes)
        given[name] = parse_expression(value, scope)
    return tuple(sorted((item for item in given.items() if item[1] != e.MISSING), key=lambda item: item[0]))

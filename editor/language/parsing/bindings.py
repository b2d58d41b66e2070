"""The parts of a script around its steps: what `run` gives to the task, parameters and arguments of methods."""

from __future__ import annotations

import ast
from dataclasses import dataclass, replace
from functools import partial

from editor.language.expressions import nodes as e
from editor.language.expressions.declarations import UnknownType, parse_type
from editor.language.expressions.names import CLOSED_FUNCTIONS, RESERVED_ATTRIBUTES, same_name, unique_name
from editor.language.expressions.nodes import Expression
from editor.language.parsing.answers import closest
from editor.language.parsing.expressions import parse_expression, parse_scalar
from editor.language.parsing.scope import Binding, Refused, Scope, attribute_of_self, quoted, written
from editor.language.parsing.zones import parse_zone
from editor.language.tree import nodes as n
from editor.language.tree.choice import foreign_part
from editor.language.tree.program import Parameter


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
        Refused: it does anything but give robots, devices, places, parameters and events, and call new_task at its end.
    """
    if not takes_only(method, ["self", "ctx"]):
        raise Refused(method, "This run", "Write def run(self, ctx):.")
    calls = [number for number, statement in enumerate(method.body) if _begins(statement)]
    if calls and calls[0] + 1 < len(method.body):
        behind = method.body[calls[0] + 1]
        raise Refused(behind, quoted(behind), "self.new_task() ends run. Put this before it, or leave it out.")
    given = method.body[: calls[0]] if calls else method.body
    entries = [entry for entry in (_given(statement, scope) for statement in given) if entry is not None]
    if not calls:
        raise Refused(method, "A run that begins nothing", "Write self.new_task() as its last line.")
    return entries


def _begins(statement: ast.stmt) -> bool:
    match statement:
        case ast.Expr(value=ast.Call(func=function, args=[], keywords=[])):
            return attribute_of_self(function) == "new_task"
    return False


def _given(statement: ast.stmt, scope: Scope) -> Entry | None:
    """Take what a line of run gives into the scope; return the event, where it is one."""
    match statement:
        case ast.Expr(value=ast.Constant(value=str())) | ast.Pass():
            return None
        case ast.Expr(
            value=ast.Call(
                func=ast.Attribute(value=ast.Name(id="ctx"), attr="when" | "start_when" as when),
                args=[condition, ast.Attribute(value=ast.Name(id="self"), attr=handler)],
                keywords=[],
            ) as call
        ):
            return Entry(_ENTRIES[when], condition, handler, call)
        case ast.Assign(
            targets=[ast.Attribute(value=ast.Name(id="self"), attr=name) as target], value=ast.Call() as call
        ):
            _check_new(name, target, scope)
            where = next((each for each in call.keywords if each.arg == "where"), None)
            plain = [each for each in call.keywords if each is not where]
            scope.bindings[name] = _binding(ast.copy_location(ast.Call(call.func, call.args, plain), call), name, scope)
            if where is not None:
                _read_choice(call, where.value, name, scope)
            return None
    raise Refused(statement, quoted(statement), _instead_in_run(statement))


_CHOICE = 'Write ctx.any("pick", where=lambda robot: robot.battery > 30).'
_OWN_ONLY = "A choice looks only at what the robot itself reports, such as robot.battery > 30."


def _read_choice(call: ast.Call, node: ast.expr, name: str, scope: Scope) -> None:
    """Read the condition of `ctx.any("pick", where=lambda robot: robot.battery > 30)` into the binding."""
    binding = scope.bindings[name]
    if binding.kind != "any" or not isinstance(node, ast.Lambda):
        raise Refused(node, quoted(node) if binding.kind == "any" else "A choice of one robot", _CHOICE)
    a = node.args
    if a.vararg or a.kwarg or a.kwonlyargs or a.posonlyargs or a.defaults or len(a.args) != 1:
        raise Refused(node, quoted(node), _CHOICE)
    scope.chosen = (a.args[0].arg, name)
    for part in ast.walk(node.body):
        if isinstance(part, ast.Name) and part.id not in {scope.chosen[0], *CLOSED_FUNCTIONS}:
            raise Refused(part, quoted(part), _OWN_ONLY)
    where = parse_expression(node.body, scope)
    scope.chosen = ("", "")
    if foreign_part(where) is not None:
        raise Refused(node.body, quoted(node.body), _OWN_ONLY)
    scope.bindings[name] = replace(binding, where=None if where == e.MISSING else where)


def takes_only(method: ast.FunctionDef, names: list[str]) -> bool:
    """Tell whether a method takes these parameters and nothing else, none of them with a value of its own."""
    a = method.args
    more = a.vararg or a.kwarg or a.kwonlyargs or a.posonlyargs or a.defaults
    return not more and [argument.arg for argument in a.args] == names


def _check_new(name: str, target: ast.expr, scope: Scope) -> None:
    if name in scope.bindings:
        raise Refused(target, f"A second {quoted(target)}", "It is given already. Choose another name.")
    if name in scope.methods or name in RESERVED_ATTRIBUTES:
        raise Refused(
            target, f"The name {name}", f"Call it {unique_name(name, {*scope.methods, *RESERVED_ATTRIBUTES})}."
        )


def _instead_in_run(statement: ast.stmt) -> str:
    """Return what to write instead of a statement in run."""
    match statement:
        case ast.For() | ast.While() | ast.If() | ast.Try() | ast.With() | ast.Match():
            return "Put it in new_task. In run there is only what it gives, and self.new_task() once."
        case ast.Assign(targets=[ast.Name(id=name)], value=ast.Call() as call):
            return f"Write self. before it: self.{name} = {written(call)}."
        case ast.Expr(value=ast.Call(func=ast.Name(id="new_task"))) | ast.Return():
            return "Write self.new_task() as its last line."
        case ast.Expr(value=ast.Call(func=ast.Attribute(attr="new_task"))):
            return "Write self.new_task() without values."
        case ast.Expr(value=ast.Call(func=ast.Attribute(value=ast.Name(id="ctx"), attr="when" | "start_when"))):
            return "Write ctx.when(self.oven.temperature > 60, self.when_e1), with a method of the task."
        case ast.Expr(value=ast.Call(func=ast.Attribute(value=ast.Name(id="ctx"))) as call):
            return f"Give it a name: self.oven = {written(call)}."
        case ast.Assign(targets=[ast.Attribute(attr=name)], value=ast.Constant(value=str() as device)):
            return f'Write self.{name} = ctx.get("{device}"), or set it in new_task.'
        case ast.Assign() | ast.AugAssign() | ast.Expr(value=ast.Call(func=ast.Attribute(value=ast.Name(id="self")))):
            return "Put it in new_task. In run there is only what it gives, and self.new_task() once."
    return 'In run, write self.oven = ctx.get("curingOven01") and self.new_task().'


def _binding(call: ast.Call, name: str, scope: Scope) -> Binding:
    function = call.func
    if isinstance(function, ast.Attribute) and isinstance(function.value, ast.Name) and function.value.id == "ctx":
        if function.attr == "parameter":
            return _parameter_binding(call, name)
        if function.attr == "zone":
            return parse_zone(call, scope)
        texts = [parse_scalar(argument) for argument in call.args]
        named = {keyword.arg: parse_scalar(keyword.value) for keyword in call.keywords}
        match function.attr, texts, named:
            case "get", [str() as device], {**rest} if device and not rest:
                return Binding("get", device)
            case "get", [str() as device], {"at": str() as at, **rest} if device and at and not rest:
                return Binding("get", device, at=at)
            case "get", [str() as device], {"kind": "robot", **rest} if device and not rest:
                return Binding("get", device, is_robot=True)
            case "place", [str() as place], {**rest} if place and not rest:
                return Binding("place", place)
            case "any", _, {**rest} if not rest and all(isinstance(text, str) and text for text in texts):
                return Binding("any", can=tuple(dict.fromkeys(str(text) for text in texts)))
    raise Refused(
        call, quoted(call), 'Use ctx.get("robot01"), ctx.any("pick", "drop"), ctx.place("dock1") or ctx.parameter(…).'
    )


def _parameter_binding(call: ast.Call, name: str) -> Binding:
    """Read `ctx.parameter("count", 0, Number)`."""
    match call.args:
        case [ast.Constant(value=str() as given), *rest] if (
            same_name(given) == name and len(rest) <= 2 and not call.keywords
        ):
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


def parse_parameters(method: ast.FunctionDef) -> tuple[Parameter, ...]:
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
        Parameter(argument.arg, default, *read_type(argument.annotation))
        for argument, default in zip(given, defaults, strict=True)
    )


def _instead_of_argument(name: str, parameters: list[str], takes: str) -> str:
    near = closest(name, parameters)
    return f"Did you mean {near}? {takes}" if near else takes


def parse_arguments(call: ast.Call, parameters: list[str], scope: Scope) -> n.Arguments:
    """Return a call's arguments by name, sorted; those still to be entered (None) are left out.

    Raises:
        Refused: there are too many, one is given twice, or one has an unknown name.
    """
    takes = f"It takes: {', '.join(parameters) or 'nothing'}."
    if len(call.args) > len(parameters):
        raise Refused(call.args[len(parameters)], quoted(call.args[len(parameters)]), takes)
    given: dict[str, Expression] = {}
    pairs = [
        *zip(parameters, call.args, strict=False),
        *((keyword.arg or "", keyword.value) for keyword in call.keywords),
    ]
    for name, value in pairs:
        if name in given:
            raise Refused(value, f"A second {name}", takes)
        if name not in parameters:
            raise Refused(value, quoted(call), partial(_instead_of_argument, name, parameters, takes))
        given[name] = parse_expression(value, scope)
    return tuple(sorted((item for item in given.items() if item[1] != e.MISSING), key=lambda item: item[0]))

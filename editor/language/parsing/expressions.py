"""Python expressions → expressions of the language, by walking their `ast`; anything else is refused."""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping
from typing import Final

from editor.language.expressions.names import ROBOT_METHODS, member_name, snake_case
from editor.language.expressions.nodes import (
    MISSING,
    NOWHERE,
    OF_PROBLEM,
    PROBLEM,
    Constant,
    Expression,
    Located,
    PlaceRef,
    Point,
    Quantity,
    Reading,
    Variable,
)
from editor.language.expressions.values import (
    DEEPEST_EXPRESSION,
    FUNCTIONS,
    MOST_ITEMS,
    arity_fits,
    is_number,
    operation,
    plain,
)
from editor.language.messages.syntax_errors import (
    NAMES,
    instead_of_call,
    instead_of_expression,
    instead_of_is,
    instead_of_operator,
)
from editor.language.parsing.answers import (
    closest,
    unknown_device,
    unknown_name,
    unknown_reading,
    unknown_value,
    what_is_called,
)
from editor.language.parsing.scope import Binding, Refused, Scope, attribute_of_self, quoted, written
from editor.language.tree.choice import ITSELF
from editor.language.tree.robots import own_methods, readings_called, readings_of, short_name
from vipo_device.protocol.description import Scalar
from vipo_device.protocol.units import UNITS, unit_code

_BINARY: Mapping[type[ast.operator], str] = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/"}
_COMPARE: Mapping[type[ast.cmpop], str] = {
    ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!=",
    ast.In: "in", ast.NotIn: "not in",
}  # fmt: skip


_NO_SCALARS: Final = (bytes, complex, type(Ellipsis))


def parse_expression(node: ast.expr, scope: Scope, depth: int = 0) -> Expression:
    """Return the expression that a piece of Python stands for; None is a value still to be entered.

    Raises:
        Refused: it is not part of the language.
    """
    if depth > DEEPEST_EXPRESSION + 1:
        raise Refused(node, "An expression as deep as this", "Write it in several steps.")
    parse = _PARSERS.get(type(node))
    if parse is None:
        use = "Use readings of devices, parameters, numbers, texts and comparisons."
        raise Refused(node, quoted(node), instead_of_expression(node) or use)
    return parse(node, scope, depth + 1)


def parse_scalar(node: ast.expr) -> Scalar:
    """Return a value that is written out.

    Raises:
        Refused: it is anything else.
    """
    minus = isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub)
    inner = node.operand if isinstance(node, ast.UnaryOp) and minus else node
    if not isinstance(inner, ast.Constant) or (minus and not is_number(inner.value)):
        if isinstance(node, ast.Name):
            raise Refused(node, quoted(node), f'Write a text in quotation marks: "{node.id}".')
        raise Refused(node, quoted(node), "Write a number, a text, True or False here.")
    value = inner.value
    scalar = None if isinstance(value, _NO_SCALARS) else plain(value)
    if scalar is None and value is not None:
        raise Refused(node, quoted(node), "Write a number below 10¹⁵, a text, True or False here.")
    return -scalar if minus and is_number(scalar) else scalar


def _constant(node: ast.Constant, scope: Scope, depth: int) -> Expression:
    scalar = parse_scalar(node)
    return MISSING if scalar is None else Constant(scalar)


def _list(node: ast.List, scope: Scope, depth: int) -> Expression:
    return operation("list", tuple(parse_expression(item, scope, depth) for item in node.elts))


def _tuple(node: ast.Tuple, scope: Scope, depth: int) -> Expression:
    scalars = tuple(parse_scalar(item) for item in node.elts)
    if not scalars or None in scalars:
        raise Refused(node, quoted(node), "Write at least one value between the brackets.")
    return Constant(scalars)


def _name(node: ast.Name, scope: Scope, depth: int) -> Expression:
    if f"{node.id}.text" in scope.locals:
        raise Refused(node, quoted(node), f"Write {node.id}.text, or {node.id}.kind.")
    if scope.is_chosen(node):
        raise Refused(node, quoted(node), f"Say what it reports: {node.id}.battery > 30.")
    if node.id not in scope.locals:
        raise unknown_name(node, scope)
    return Variable(node.id)


def _attribute(node: ast.Attribute, scope: Scope, depth: int) -> Expression:
    name = attribute_of_self(node)
    if name is not None:
        return _own_attribute(node, name, scope)
    if scope.is_chosen(node.value):
        return _of_role(node, scope.chosen[1], scope, ITSELF)
    if isinstance(node.value, ast.Name) and _is_caught(node, node.value.id, scope):
        return _of_caught(node, node.value.id, scope)
    role = attribute_of_self(node.value)
    if role is not None and role in scope.robots():
        return _of_role(node, role, scope, Located(role=role))
    device = parse_thing(node.value, scope)
    description = scope.description(device.device)
    names = [] if description is None else [spec.name for spec in description.properties]
    found = next((n for n in names if snake_case(n) == node.attr and member_name(n, names)), None)
    if found is None:
        methods = [] if description is None else [method.name for method in description.methods]
        able = [*ROBOT_METHODS, *(snake_case(method) for method in methods)]
        raise unknown_reading(node, [name for name in (member_name(n, names) for n in names) if name], able)
    return Reading(Constant(device.device), found)


def _of_role(node: ast.Attribute, role: str, scope: Scope, robot: Located) -> Expression:
    """Return the reading of a robot that only its role names, under a name that all who may have the role agree on."""
    robots = scope.robots_of(role)
    meant = readings_called(robots, node.attr)
    if len(meant) == 1:
        return Reading(robot, meant[0])
    able = [*ROBOT_METHODS, *filter(None, (short_name(robots, method) for method in own_methods(robots)))]
    raise unknown_reading(node, readings_of(robots), able)


def _is_caught(node: ast.Attribute, name: str, scope: Scope) -> bool:
    return f"{name}.text" in scope.locals or (name not in scope.locals and f"{PROBLEM}.{node.attr}" in OF_PROBLEM)


def _of_caught(node: ast.Attribute, name: str, scope: Scope) -> Expression:
    """Return what `problem.text` or `problem.kind` stands for in an except."""
    if f"{name}.{node.attr}" in scope.locals:
        return Variable(f"{PROBLEM}.{node.attr}")
    if f"{name}.text" in scope.locals:
        raise Refused(node, quoted(node), "What can be read here: text, kind.")
    raise Refused(node, quoted(node), "Write it in an except that names it: except TaskError as problem:.")


def _own_attribute(node: ast.Attribute, name: str, scope: Scope) -> Expression:
    """Return what `self.name` stands for: a variable, or something that has a place."""
    binding = scope.bindings.get(name)
    if name in scope.variables or (binding is not None and binding.kind == "parameter"):
        if name in scope.locals:
            raise Refused(node, quoted(node), f"Here {name} is something else, which hides it. Write {name}.")
        return Variable(name)
    if name in scope.robots():
        return Located(role=name)
    match binding:
        case Binding(kind="get", id=device):
            return Located(device=device)
        case Binding(kind="place", id=place):
            return Located(place=place)
        case Binding(kind="zone", id=zone):
            return Located(zone=zone)
    raise unknown_value(node, name, scope)


def _call(node: ast.Call, scope: Scope, depth: int) -> Expression:
    function = node.func
    if isinstance(function, ast.Name) and not node.keywords:
        if function.id in _MAKERS:
            return _MAKERS[function.id](node)
        if function.id in FUNCTIONS:
            return _function(node, function.id, scope, depth)
    if isinstance(function, ast.Attribute) and function.attr == "read" and len(node.args) == 1:
        name, role = parse_scalar(node.args[0]), attribute_of_self(function.value)
        if role is not None and role in scope.robots() and isinstance(name, str) and name:
            return Reading(Located(role=role), name)
        if scope.is_chosen(function.value) and isinstance(name, str) and name:
            return Reading(ITSELF, name)
        device = parse_thing(function.value, scope)
        if isinstance(name, str) and name and device.device is not None:
            return Reading(Constant(device.device), name)
        if isinstance(name, str) and name and device.value is not None:
            return Reading(device.value, name)
    raise Refused(node, quoted(node), _instead_of_value(node, scope))


def _instead_of_value(call: ast.Call, scope: Scope) -> str:
    """Return what to write instead of a call that gives no value here."""
    function = call.func
    own = attribute_of_self(function)
    if own is not None and own in scope.methods:
        return f"Keep it first, on a line of its own: self.result = self.{own}(…). Then use self.result."
    instead = instead_of_call(call)
    if instead is not None:
        return instead
    if isinstance(function, ast.Attribute) and isinstance(function.value, ast.Name) and function.value.id == "ctx":
        return NAMES["ctx"]
    if own is None and isinstance(function, ast.Attribute) and attribute_of_self(function.value) in scope.bindings:
        return what_is_called(call, function, scope)
    known = [*FUNCTIONS, *_MAKERS]
    near = closest(function.id, known) if isinstance(function, ast.Name) else ""
    listed = f"In expressions only these can be called: {', '.join(known)}."
    return f"Did you mean {near}? {listed}" if near else listed


def _function(node: ast.Call, name: str, scope: Scope, depth: int) -> Expression:
    if not arity_fits(name, len(node.args)):
        least, most = FUNCTIONS[name]
        wanted = "no value" if most == 0 else "one value" if most == 1 else f"{least} values"
        wanted = wanted if least == most else f"{least} values or more"
        raise Refused(node, quoted(node), f"{name} takes {wanted}.")
    return operation(name, tuple(parse_expression(argument, scope, depth) for argument in node.args))


def _quantity(node: ast.Call) -> Expression:
    match [parse_scalar(argument) for argument in node.args]:
        case [value, str(unit)] if is_number(value) and unit:
            return Quantity(value, unit_code(unit))
    units = ", ".join(unit.symbol for unit in UNITS.values())
    raise Refused(node, quoted(node), f'Write quantity(10, "min"), with one of these units: {units}.')


def _point(node: ast.Call) -> Expression:
    match [parse_scalar(argument) for argument in node.args]:
        case [x, y] if is_number(x) and is_number(y):
            return Located(point=(x, y))
    raise Refused(node, quoted(node), "Write a point as point(3.5, -8), in metres.")


_MAKERS: Mapping[str, Callable[[ast.Call], Expression]] = {"quantity": _quantity, "point": _point}


def _formatted(node: ast.JoinedStr, scope: Scope, depth: int) -> Expression:
    """Return the text that an f-string stands for."""
    return operation("text", tuple(_part(part, scope, depth) for part in node.values))


def _part(part: ast.expr, scope: Scope, depth: int) -> Expression:
    if isinstance(part, ast.FormattedValue):
        if part.conversion != -1 or part.format_spec is not None:
            raise Refused(part, quoted(part.value), "Between { and } write only the value.")
        return parse_expression(part.value, scope, depth)
    return parse_expression(part, scope, depth)


def _bool_operation(node: ast.BoolOp, scope: Scope, depth: int) -> Expression:
    name = "and" if isinstance(node.op, ast.And) else "or"
    return operation(name, tuple(parse_expression(value, scope, depth) for value in node.values))


def _unary_operation(node: ast.UnaryOp, scope: Scope, depth: int) -> Expression:
    if not isinstance(node.op, ast.Not | ast.USub):
        raise Refused(node, quoted(node), "Use “not” or “-”.")
    argument = parse_expression(node.operand, scope, depth)
    return operation("not" if isinstance(node.op, ast.Not) else "-", (argument,))


def _binary_operation(node: ast.BinOp, scope: Scope, depth: int) -> Expression:
    name = _BINARY.get(type(node.op))
    if name is None:
        raise Refused(node, quoted(node), instead_of_operator(node))
    return operation(name, (parse_expression(node.left, scope, depth), parse_expression(node.right, scope, depth)))


def _item(node: ast.Subscript, scope: Scope, depth: int) -> Expression:
    """Refuse `items[0]`: what it means differs by one from how people count."""
    match node.slice:
        case ast.Constant(value=int(number)) if 0 <= number < MOST_ITEMS:
            instead = f"Items are counted from 1. Write nth({written(node.value)}, {number + 1})."
        case ast.Constant(value=int()) | ast.UnaryOp():
            instead = f"Items are counted from 1. Write nth({written(node.value)}, len({written(node.value)}))."
        case ast.Slice() | ast.Constant():
            raise Refused(node, quoted(node), "Take one item at a time: nth(self.colours, 1).")
        case position:
            instead = f"Items are counted from 1. Write nth({written(node.value)}, {written(position)} + 1)."
    raise Refused(node, quoted(node), instead)


def _comparison(node: ast.Compare, scope: Scope, depth: int) -> Expression:
    name = _COMPARE.get(type(node.ops[0]))
    if len(node.ops) == 1 and name is None:
        raise Refused(node, quoted(node), instead_of_is(node))
    if name is None or len(node.ops) != 1:
        raise Refused(node, quoted(node), "Compare two values at a time, and join comparisons with “and”.")
    left = parse_expression(node.left, scope, depth)
    return operation(name, (left, parse_expression(node.comparators[0], scope, depth)))


_PARSERS: Mapping[type[ast.expr], Callable[..., Expression]] = {
    ast.Constant: _constant,
    ast.Tuple: _tuple,
    ast.List: _list,
    ast.Name: _name,
    ast.Attribute: _attribute,
    ast.Call: _call,
    ast.BoolOp: _bool_operation,
    ast.UnaryOp: _unary_operation,
    ast.BinOp: _binary_operation,
    ast.Compare: _comparison,
    ast.JoinedStr: _formatted,
    ast.Subscript: _item,
}


def parse_thing(node: ast.expr, scope: Scope) -> PlaceRef:
    """Return the device or place that `self.oven`, a parameter, a point or None stands for.

    Raises:
        Refused: it stands for something else.
    """
    name = attribute_of_self(node)
    binding = scope.bindings.get(name) if name is not None else None
    if binding is not None and binding.kind == "get":
        return PlaceRef(device=binding.id)
    if binding is not None and binding.kind == "place":
        return PlaceRef(place=binding.id)
    if name is not None and (name in scope.variables or (binding is not None and binding.kind == "parameter")):
        return PlaceRef(value=Variable(name))
    if isinstance(node, ast.Name) and node.id in scope.locals:
        return PlaceRef(value=Variable(node.id))
    if isinstance(node, ast.Constant) and node.value is None:
        return NOWHERE
    if isinstance(node, ast.Tuple):
        return PlaceRef(point=parse_point(node))
    if name is not None:
        raise unknown_device(node, name, scope)
    if isinstance(node, ast.Name):
        raise unknown_name(node, scope)
    if isinstance(node, ast.Attribute):
        raise Refused(node, quoted(node), "Name the device or the place itself: self.oven.")
    raise Refused(node, quoted(node), instead_of_expression(node) or "Write the device or the place: self.oven.")


def parse_point(node: ast.expr) -> Point:
    """Return a point in metres that is written as (x, y).

    Raises:
        Refused: it is written otherwise.
    """
    if isinstance(node, ast.Tuple) and len(node.elts) == 2:
        x, y = parse_scalar(node.elts[0]), parse_scalar(node.elts[1])
        if is_number(x) and is_number(y):
            return (x, y)
    raise Refused(node, quoted(node), "Write a point as (x, y) in metres.")


def parse_place(node: ast.expr, scope: Scope) -> PlaceRef:
    """Return where a robot goes: `self.oven.location`, a point, or None.

    Raises:
        Refused: it is something else.
    """
    if isinstance(node, ast.Attribute) and node.attr == "location":
        return parse_thing(node.value, scope)
    if isinstance(node, ast.Tuple) or (isinstance(node, ast.Constant) and node.value is None):
        return parse_thing(node, scope)
    known = attribute_of_self(node) or (node.id if isinstance(node, ast.Name) else getattr(node, "value", None))
    if isinstance(known, str) and known in scope.bindings:
        raise Refused(node, quoted(node), f"Write self.{known}.location.")
    raise Refused(node, quoted(node), "Write where it goes as self.oven.location, or as a point (x, y).")

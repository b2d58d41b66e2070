"""The statements of a script → the nodes of a tree; what is refused is noted, so that all of it is reported at once."""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from string import ascii_lowercase

from editor.language.document.outline import DEEPEST_STEP
from editor.language.expressions import nodes as e
from editor.language.expressions.names import ROBOT_METHODS, member_name
from editor.language.expressions.nodes import Expression, PlaceRef
from editor.language.messages.syntax_errors import instead_of_call, instead_of_statement
from editor.language.parsing.bindings import parse_arguments
from editor.language.parsing.expressions import (
    Refused,
    Scope,
    attribute_of_self,
    parse_expression,
    parse_place,
    parse_point,
    parse_thing,
    quoted,
)
from editor.language.parsing.questions import parse_ask, parse_notify
from editor.language.parsing.variables import check_local, parse_target
from editor.language.tree import nodes as n
from editor.language.tree.nodes import ERROR_CLASSES

_KINDS = {name: kind for kind, name in ERROR_CLASSES.items()}
_STATEMENTS = (
    "Use the robots' move, pick and drop, machines' methods, wait, ask, notify, if, while, for, try, parallel, "
    "variables and functions."
)
_FOR = "Write for _ in range(3): or for oven in [self.oven_a, self.oven_b]:."


@dataclass(slots=True)
class Parser:
    """The methods of a task while they are read; refusals are gathered so that all are reported at once."""

    methods: Mapping[str, ast.FunctionDef]
    scope: Scope
    refusals: list[Refused] = field(default_factory=list)
    functions: dict[str, n.Function] = field(default_factory=dict)
    origins: dict[int, ast.AST] = field(default_factory=dict)
    """The place in the script of each pick and drop, by identity."""
    roles: set[str] = field(default_factory=set)
    branches: set[str] = field(default_factory=set)
    """The branch methods met so far; each belongs to one Parallel."""
    depth: int = 0
    known: dict[tuple[ast.stmt, frozenset[str]], n.Node] = field(default_factory=dict)
    """What statements mean where these names are a function's or a loop's own; one may stand in many places."""

    def block(self, statements: list[ast.stmt]) -> n.Block:
        """Return the nodes of some statements; those that are refused are noted and left out."""
        if self.depth > DEEPEST_STEP:  # the innermost step may still have an empty branch
            raise Refused(statements[0], "A step as deep as this", "Make a function of some of the steps.")
        self.depth += 1
        nodes: list[n.Node] = []
        for statement in statements:
            node = self.known.get((statement, self.scope.locals)) or self._read(statement)
            if node is not None:
                nodes.append(node)
        self.depth -= 1
        return tuple(nodes)

    def _read(self, statement: ast.stmt) -> n.Node | None:
        """Return the node of a statement; None for one that means nothing, or is refused."""
        try:
            node = self.statement(statement)
        except Refused as refusal:
            self.refusals.append(refusal)
            return None
        if node is not None and node.__class__ not in n.COMPOSITES:
            self.known[statement, self.scope.locals] = node
        return node

    def statement(self, statement: ast.stmt) -> n.Node | None:
        """Return the node of a statement; None for one that means nothing."""
        match statement:
            case ast.Pass() | ast.Expr(value=ast.Constant(value=str())):
                return None
            case ast.Expr(value=ast.Call(func=ast.Attribute()) as call):
                return self._call(call)
            case ast.Assign(targets=[target], value=value):
                return self._assign(target, value)
            case ast.AugAssign(target=ast.Name() | ast.Attribute() as target, op=operator, value=value):
                whole = ast.copy_location(ast.BinOp(target, operator, value), statement)
                return n.Set(parse_target(target, self.scope, self.methods), self.value(whole))
            case ast.Return(value=value):
                given = e.MISSING if value is None else self.value(value)
                return n.Return(None if given == e.MISSING else given)
            case ast.Break():
                return n.Break()
        return self._composite(statement)

    def _composite(self, statement: ast.stmt) -> n.Node:
        """Return the node of a statement that holds others."""
        match statement:
            case ast.If(test=test, body=body, orelse=orelse):
                return n.If(self.value(test), self.block(body), self.block(orelse))
            case ast.While(test=test, body=body, orelse=[]):
                return n.While(self.value(test), self.block(body))
            case ast.For(orelse=[]):
                return self._for(statement)
            case ast.Try():
                return self._try(statement)
        raise Refused(statement, quoted(statement), instead_of_statement(statement) or _STATEMENTS)

    def value(self, node: ast.expr) -> Expression:
        """Return an expression."""
        return parse_expression(node, self.scope)

    def _try(self, statement: ast.Try) -> n.Node:
        if len(statement.handlers) > 1 or statement.orelse:
            raise Refused(
                statement,
                "This form of try",
                "Write try: … except TaskError as problem: … finally: …, with one except.",
            )
        body, final = self.block(statement.body), self.block(statement.finalbody)
        if not statement.handlers:
            return n.Try((), body, (), final, catches=False)
        handler = statement.handlers[0]
        return n.Try(_kinds(handler), body, self.block(handler.body), final)

    def _for(self, statement: ast.For) -> n.Node:
        """Return the loop: over `range(…)` its variable is `_`, over a list it has a name."""
        match statement.target, statement.iter:
            case ast.Name(id="_"), ast.Call(func=ast.Name(id="range"), args=[times], keywords=[]):
                return n.Repeat(self.value(times), self.block(statement.body))
            case ast.Name(id=name), ast.List(elts=items):
                values = tuple(self.value(item) for item in items)
                if name == "_":
                    return n.ForEach("", values, self.block(statement.body))
                check_local(name, statement.target)
                outside = self.scope.locals
                self.scope.locals = outside | {name}
                body = self.block(statement.body)
                self.scope.locals = outside
                return n.ForEach(name, values, body)
        raise Refused(statement, "This form of for", _FOR)

    def _assign(self, target: ast.expr, value: ast.expr) -> n.Node:
        """Return the node of `self.x = 1`, `self.x = self.ask(…)` or `self.x = self.function(…)`."""
        variable = parse_target(target, self.scope, self.methods)
        own = attribute_of_self(value.func) if isinstance(value, ast.Call) else None
        if own is None or not isinstance(value, ast.Call):
            return n.Set(variable, self.value(value))
        if own == "ask":
            return parse_ask(value, self.scope, variable)
        call = _missing_call(self, value) if own == "call" else self._function(own, value)
        return replace(call, result=variable)

    def _call(self, call: ast.Call) -> n.Node:
        """Return the node of `self.wait(…)`, `self.function(…)`, `self.robot.pick(…)` or `self.oven.cure(…)`."""
        function = call.func
        assert isinstance(function, ast.Attribute)
        own = attribute_of_self(function)
        if own is not None:
            parse = _OWN_CALLS.get(own)
            return self._function(own, call) if parse is None else parse(self, call)
        robot = attribute_of_self(function.value)
        if function.attr in ROBOT_METHODS and robot is not None:
            binding = self.scope.bindings.get(robot)
            if binding is None or binding.kind not in {"get", "any"}:
                raise Refused(call, quoted(function.value), f'Give it in run: self.{robot} = ctx.any("pick", "drop").')
            self.roles.add(robot)
            node = _ROBOT_CALLS[function.attr](self, call, robot)
            self.origins[id(node)] = call
            return node
        instead = instead_of_call(call)
        if instead is not None:
            raise Refused(call, quoted(call), instead)
        return self._operate(call, function)

    def _operate(self, call: ast.Call, function: ast.Attribute) -> n.Node:
        device = parse_thing(function.value, self.scope)
        if function.attr == "operate":
            return self._operate_by_name(call, device)
        description = self.scope.description(device.device)
        methods = () if description is None else description.methods
        names = [method.name for method in methods]
        method = next((m for m in methods if member_name(m.name, names) == function.attr), None)
        if method is None:
            is_robot = description is not None and description.kind == "robot"
            able = ROBOT_METHODS if is_robot else filter(None, (member_name(name, names) for name in names))
            raise Refused(call, quoted(call), f"What it can do: {', '.join(able) or 'nothing'}.")
        parameters = [parameter.name for parameter in method.parameters]
        return n.Operate(device, method.name, parse_arguments(call, parameters, self.scope))

    def _operate_by_name(self, call: ast.Call, device: PlaceRef) -> n.Node:
        match call.args:
            case [ast.Constant(value=str() | None as name)] if not call.keywords:
                return n.Operate(device, name or "")
            case [ast.Constant(value=str() | None as name), ast.Dict(keys=keys, values=values)] if not call.keywords:
                pairs = [(_text(key, call), self.value(value)) for key, value in zip(keys, values, strict=True)]
                return n.Operate(device, name or "", _sorted_arguments(pairs))
        raise Refused(call, quoted(call), 'Write self.oven.operate("curePaint", {"time": 10}).')

    def _function(self, name: str, call: ast.Call) -> n.Call:
        function = self.functions.get(name)
        if function is None:
            known = ", ".join(self.functions) or "none yet"
            raise Refused(call, quoted(call), f"There is no such function. Functions of this task: {known}.")
        parameters = [parameter.name for parameter in function.parameters]
        return n.Call(name, parse_arguments(call, parameters, self.scope))


def _sorted_arguments(pairs: list[tuple[str, Expression]]) -> n.Arguments:
    return tuple(sorted((pair for pair in dict(pairs).items() if pair[1] != e.MISSING), key=lambda pair: pair[0]))


def _text(node: ast.expr | None, call: ast.Call) -> str:
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value
    raise Refused(call, quoted(call), "Write the names of arguments as texts.")


def _kinds(handler: ast.ExceptHandler) -> tuple[str, ...]:
    classes = handler.type.elts if isinstance(handler.type, ast.Tuple) else [handler.type]
    names = [node.id for node in classes if isinstance(node, ast.Name)]
    if names == ["TaskError"] and len(classes) == 1:
        return ()
    if len(names) != len(classes) or not names or not set(names) <= _KINDS.keys():
        raise Refused(handler, "What is caught here", f"Catch TaskError, or some of: {', '.join(_KINDS)}.")
    caught = {_KINDS[name] for name in names}
    return tuple(kind for kind in ERROR_CLASSES if kind in caught)


def _wait(parser: Parser, call: ast.Call) -> n.Node:
    named = {keyword.arg: keyword.value for keyword in call.keywords}
    if len(call.args) == 1 and not named:
        return n.Wait(parser.value(call.args[0]))
    if call.args or "until" not in named or not named.keys() <= {"until", "timeout"}:
        raise Refused(
            call, quoted(call), "Write self.wait(60), or self.wait(until=self.oven.temperature < 40, timeout=600)."
        )
    timeout = parser.value(named["timeout"]) if "timeout" in named else e.MISSING
    return n.WaitUntil(parser.value(named["until"]), None if timeout == e.MISSING else timeout)


def _parallel(parser: Parser, call: ast.Call) -> n.Node:
    names = [attribute_of_self(argument) for argument in call.args]
    handed_on = all(isinstance(k.value, ast.Name) and k.value.id == k.arg for k in call.keywords)
    if not names or len(names) > len(ascii_lowercase) or None in names or not handed_on:
        raise Refused(
            call, quoted(call), "Write self.parallel(self.branch_a, self.branch_b), a method for each branch."
        )
    branches = []
    for name in names:
        method = parser.methods.get(name or "")
        if method is None or name in parser.branches or name in parser.functions or name in {"new_task", "run"}:
            raise Refused(call, quoted(call), f"Each branch needs a method of its own; {name} is none.")
        parser.branches.add(name or "")
        branches.append(parser.block(method.body))
    return n.Parallel(tuple(branches))


def _missing_set(parser: Parser, call: ast.Call) -> n.Node:
    match call:
        case ast.Call(args=[ast.Constant(value=None), value], keywords=[]):
            return n.Set("", parser.value(value))
    raise Refused(call, quoted(call), "Set a variable by its name: self.count = 1.")


def _end(parser: Parser, call: ast.Call) -> n.Node:
    if call.args or call.keywords:
        raise Refused(call, quoted(call), "Write self.end().")
    return n.End()


def _missing_call(parser: Parser, call: ast.Call) -> n.Call:
    if len(call.args) == 1 and isinstance(call.args[0], ast.Constant) and call.args[0].value is None:
        return n.Call("")
    raise Refused(call, quoted(call), "Call a function by its name: self.mix_paint(minutes=3).")


_OWN_CALLS: Mapping[str, Callable[[Parser, ast.Call], n.Node]] = {
    "wait": _wait,
    "parallel": _parallel,
    "call": _missing_call,
    "set": _missing_set,
    "end": _end,
    "ask": lambda parser, call: parse_ask(call, parser.scope),
    "notify": lambda parser, call: parse_notify(call, parser.scope),
}


def _move(parser: Parser, call: ast.Call, role: str) -> n.Node:
    route: tuple[e.Point, ...] = ()
    match call:
        case ast.Call(args=[to], keywords=[]):
            pass
        case ast.Call(args=[to], keywords=[ast.keyword(arg="via", value=ast.List(elts=points))]):
            route = tuple(parse_point(point) for point in points)
        case _:
            raise Refused(call, quoted(call), "Write self.robot.move(self.oven.location).")
    return n.Move(role, parse_place(to, parser.scope), route)


def _load(kind: type[n.Pick] | type[n.Drop]) -> Callable[[Parser, ast.Call, str], n.Node]:
    def parse(parser: Parser, call: ast.Call, role: str) -> n.Node:
        if len(call.args) == 1 and not call.keywords and isinstance(call.args[0], ast.Dict):
            keys = [key.value if isinstance(key, ast.Constant) else None for key in call.args[0].keys]
            if sorted(map(str, keys)) == ["object", "value"]:
                values = dict(zip(keys, call.args[0].values, strict=True))
                return kind(role, e.NOWHERE, parser.value(values["object"]), parser.value(values["value"]))
        raise Refused(call, quoted(call), 'Write self.robot.pick({"value": 1, "object": "box"}).')

    return parse


_ROBOT_CALLS: Mapping[str, Callable[[Parser, ast.Call, str], n.Node]] = {
    "move": _move,
    "pick": _load(n.Pick),
    "drop": _load(n.Drop),
}

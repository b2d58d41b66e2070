"""The statements of a script → the nodes of a tree; what is refused is noted, so that all of it is reported at once."""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from string import ascii_lowercase

from editor.language.constructs.script_form import OF_THE_FLEET
from editor.language.document.outline import DEEPEST_STEP
from editor.language.expressions import nodes as e
from editor.language.expressions.names import ROBOT_METHODS, member_name, snake_case
from editor.language.expressions.nodes import Expression, PlaceRef
from editor.language.messages.syntax_errors import (
    LIMIT,
    LIMITING,
    instead_of_call,
    instead_of_statement,
)
from editor.language.parsing.answers import (
    alone,
    unknown_device,
    unknown_function,
    unknown_method,
    unknown_name,
    unknown_robot,
)
from editor.language.parsing.bindings import parse_arguments
from editor.language.parsing.calls import ASSIGNED_CALLS, OWN_CALLS, ROBOT_CALLS
from editor.language.parsing.excepts import parse_excepts
from editor.language.parsing.expressions import parse_expression, parse_thing
from editor.language.parsing.loops import MOST_TIMES, parse_loop
from editor.language.parsing.scope import Refused, Scope, attribute_of_self, of_problem, quoted, written
from editor.language.parsing.variables import parse_target
from editor.language.tree import nodes as n
from editor.language.tree.program import Function
from editor.language.tree.robots import Robots, described_alike, methods_called, own_methods, robots_for, short_name

_STATEMENTS = (
    "Use the robots' move, pick and drop, machines' methods, wait, ask, notify, if, while, for, try, parallel, "
    "variables and functions."
)


@dataclass(slots=True)
class Parser:
    """The methods of a task while they are read; refusals are gathered so that all are reported at once."""

    methods: Mapping[str, ast.FunctionDef]
    scope: Scope
    refusals: list[Refused] = field(default_factory=list)
    functions: dict[str, Function] = field(default_factory=dict)
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
            case ast.Assign(targets=[_, second, *_]):
                raise Refused(second, "A second name", "Set one variable on each line: self.count = 1.")
            case ast.AnnAssign(target=target):
                instead = f"Leave the type out: {written(target)} = 1."
                raise Refused(statement.annotation, quoted(statement.annotation), instead)
            case ast.AugAssign(target=ast.Name() | ast.Attribute() as target, op=operator, value=value):
                whole = ast.copy_location(ast.BinOp(target, operator, value), statement)
                return n.Set(parse_target(target, self.scope, self.methods), self.value(whole))
            case ast.Return(value=value):
                given = e.MISSING if value is None else self.value(value)
                return n.Return(None if given == e.MISSING else given)
            case ast.Break() | ast.Continue():
                return n.Break() if isinstance(statement, ast.Break) else n.Continue()
            case ast.Raise(exc=ast.Call(func=ast.Name(id="Failed"), args=[message], keywords=[]), cause=None):
                return n.Fail(self.value(message))
        return self._composite(statement)

    def _composite(self, statement: ast.stmt) -> n.Node:
        """Return the node of a statement that holds others."""
        match statement:
            case ast.If(test=test, body=body, orelse=orelse):
                return n.If(self.value(test), self.block(body), self.block(orelse))
            case ast.While(test=test, body=body, orelse=[]):
                return n.While(self.value(test), self.block(body))
            case ast.For(orelse=[first, *_]) | ast.While(orelse=[first, *_]):
                raise Refused(first, "An else behind a loop", "Write these lines behind the loop, without else.")
            case ast.For():
                return self._for(statement)
            case ast.Try():
                return self._try(statement)
            case ast.With() | ast.AsyncWith() if _speaks_of_limit(statement):
                return n.Limit(_limit(self, statement), self.block(statement.body))
            case ast.Expr(value=ast.Attribute() as value):
                raise alone(value, self.scope)
            case ast.Expr(value=ast.Name() as value):
                raise unknown_name(value, self.scope)
        raise Refused(statement, quoted(statement), instead_of_statement(statement) or _STATEMENTS)

    def value(self, node: ast.expr) -> Expression:
        """Return an expression."""
        return parse_expression(node, self.scope)

    def _try(self, statement: ast.Try) -> n.Node:
        if statement.orelse:
            raise Refused(statement.orelse[0], "An else behind try", "Write these lines at the end of what try holds.")
        body, final = self.block(statement.body), self.block(statement.finalbody)
        return n.Try(body, parse_excepts(statement.handlers, self._catch), final)

    def _catch(self, handler: ast.ExceptHandler) -> n.Block:
        """Return the steps of an except, which see the failure under the name that it has there."""
        outside = self.scope.locals
        self.scope.locals = of_problem(handler.name or "", frozenset(name for name in outside if "." not in name))
        block = self.block(handler.body)
        self.scope.locals = outside
        return block

    def _for(self, statement: ast.For) -> n.Node:
        """Return the loop: over `range(…)` its variable is `_`, over a list it has a name."""
        match statement.target, statement.iter:
            case ast.Name(id="_"), ast.Call(func=ast.Name(id="range"), args=[times], keywords=[]):
                return n.Repeat(self.value(times), self.block(statement.body))
        head = parse_loop(statement, self.scope)
        values = tuple(self.value(item) for item in head.items)
        over = None if head.over is None else self.value(head.over)
        assert over is None or isinstance(over, e.Variable), "the head of a loop names a variable"
        outside = self.scope.locals
        self.scope.locals = outside.union(head.names)
        body = self.block(statement.body)
        self.scope.locals = outside
        return n.ForEach(head.variable, values, head.index, over, body)

    def _assign(self, target: ast.expr, value: ast.expr) -> n.Node:
        """Return the node of `self.x = 1`, `self.x = self.ask(…)` or `self.x = self.function(…)`."""
        variable = parse_target(target, self.scope, self.methods)
        own = attribute_of_self(value.func) if isinstance(value, ast.Call) else None
        if own is None or not isinstance(value, ast.Call):
            return n.Set(variable, self.value(value))
        if own in ASSIGNED_CALLS:
            return OWN_CALLS[own](self.scope, value, variable)
        if own in OWN_CALLS:
            line = "It gives no value. Write it on a line of its own, without the name before it."
            raise Refused(value, quoted(value), line)
        call = _missing_call(self, value) if own == "call" else self._function(own, value)
        return replace(call, result=variable)

    def _call(self, call: ast.Call) -> n.Node:
        """Return the node of `self.wait(…)`, `self.function(…)`, `self.robot.pick(…)` or `self.oven.cure(…)`."""
        function = call.func
        assert isinstance(function, ast.Attribute)
        own = attribute_of_self(function)
        if own is not None:
            described = OWN_CALLS.get(own)
            if described is not None:
                return described(self.scope, call, "")
            parse = _OWN_CALLS.get(own)
            return self._function(own, call) if parse is None else parse(self, call)
        robot = attribute_of_self(function.value)
        if function.attr in ROBOT_METHODS and robot is not None:
            binding = self.scope.bindings.get(robot)
            if binding is None or binding.kind not in {"get", "any"}:
                raise unknown_robot(function.value, robot, self.scope)
            self.roles.add(robot)
            node = ROBOT_CALLS[function.attr](self.scope, call, robot)
            self.origins[id(node)] = call
            return node
        if robot is not None and robot in self.scope.robots():
            if function.attr in OF_THE_FLEET:
                self.roles.add(robot)
                return ROBOT_CALLS[function.attr](self.scope, call, robot)
            return self._perform(call, function, robot)
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
            raise self._unable(call, function, names)
        parameters = [parameter.name for parameter in method.parameters]
        return n.Operate(device, method.name, parse_arguments(call, parameters, self.scope))

    def _unable(self, call: ast.Call, function: ast.Attribute, names: list[str]) -> Refused:
        """Return the refusal of a method that a thing does not have."""
        own = attribute_of_self(function.value)
        binding = self.scope.bindings.get(own or "")
        if own is not None and (binding is None or binding.kind != "get" or self.scope.description(binding.id) is None):
            return unknown_device(function.value, own, self.scope)
        if own is None:
            thing = written(function.value)
            example = f'Which machine it is shows only in the run. Write {thing}.operate("curePaint", {{"time": 10}}).'
            return Refused(call, quoted(call), example)
        description = self.scope.description(binding.id if binding else None)
        readings = [snake_case(each.name) for each in description.properties] if description else []
        return unknown_method(call, function.attr, filter(None, (member_name(name, names) for name in names)), readings)

    def _perform(self, call: ast.Call, function: ast.Attribute, role: str) -> n.Perform:
        """Return the node of `self.robot.honk(5)`: a method of the robot's own, as robots of the site describe it."""
        if function.attr == "operate":
            method, arguments = self._by_name(call)
            self.roles.add(role)
            return n.Perform(role, method, arguments)
        binding = self.scope.bindings[role]
        robots = robots_for(self.scope.surroundings, binding.id if binding.kind == "get" else None, binding.can)
        meant = methods_called(robots, function.attr)
        if len(meant) != 1:
            raise _unknown_of_robot(call, robots, function.attr)
        spec = described_alike(tuple(r for r in robots if r.method(meant[0])), meant[0])
        self.roles.add(role)
        parameters = [parameter.name for parameter in spec.parameters] if spec else []
        return n.Perform(role, meant[0], parse_arguments(call, parameters, self.scope))

    def _operate_by_name(self, call: ast.Call, device: PlaceRef) -> n.Node:
        return n.Operate(device, *self._by_name(call))

    def _by_name(self, call: ast.Call) -> tuple[str, n.Arguments]:
        """Return the method and the arguments of `….operate("curePaint", {"time": 10})`."""
        match call.args:
            case [ast.Constant(value=str() | None as name)] if not call.keywords:
                return name or "", ()
            case [ast.Constant(value=str() | None as name), ast.Dict(keys=keys, values=values)] if not call.keywords:
                pairs = [(_text(key, call), self.value(value)) for key, value in zip(keys, values, strict=True)]
                return name or "", _sorted_arguments(pairs)
        raise Refused(call, quoted(call), 'Write self.oven.operate("curePaint", {"time": 10}).')

    def _function(self, name: str, call: ast.Call) -> n.Call:
        function = self.functions.get(name)
        if function is None:
            raise unknown_function(call, name, self.scope)
        parameters = [parameter.name for parameter in function.parameters]
        return n.Call(name, parse_arguments(call, parameters, self.scope))


def _unknown_of_robot(call: ast.Call, robots: Robots, name: str) -> Refused:
    """Return the refusal of a call that means no one method of the robots."""
    known = own_methods(robots)
    full = next((method for method in known if snake_case(method) == name), None)
    if full is not None:
        instead = f'Write self.robot.operate("{full}", {{…}}): robots describe it differently.'
        return Refused(call, quoted(call), instead)
    listed = (name for name in map(partial(short_name, robots), known) if name is not None)
    return unknown_method(call, name, [*ROBOT_METHODS, *listed])


def _sorted_arguments(pairs: list[tuple[str, Expression]]) -> n.Arguments:
    return tuple(sorted((pair for pair in dict(pairs).items() if pair[1] != e.MISSING), key=lambda pair: pair[0]))


def _text(node: ast.expr | None, call: ast.Call) -> str:
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value
    raise Refused(call, quoted(call), "Write the names of arguments as texts.")


def _parallel(parser: Parser, call: ast.Call) -> n.Node:
    names = [attribute_of_self(argument) for argument in call.args]
    needed = _needed(call)
    passed = (k for k in call.keywords if k.arg != "needed")
    handed_on = all(isinstance(k.value, ast.Name) and k.value.id == k.arg for k in passed)
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
    return n.Parallel(tuple(branches), needed)


def _needed(call: ast.Call) -> int | None:
    """Return how many branches end a Parallel; None where the call does not say it."""
    given = next((k.value for k in call.keywords if k.arg == "needed"), None)
    match given:
        case None | ast.Constant(value=None):
            return None
        case ast.Constant(value=int(needed)) if not isinstance(needed, bool) and needed < MOST_TIMES:
            return needed
        case ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=int(needed))) if needed < MOST_TIMES:
            return -int(needed)
    instead = "Write out how many branches end it: self.parallel(self.branch_a, self.branch_b, needed=1)."
    raise Refused(given, quoted(given), instead)


def _speaks_of_limit(statement: ast.With | ast.AsyncWith) -> bool:
    called = (item.context_expr.func for item in statement.items if isinstance(item.context_expr, ast.Call))
    return any(getattr(each, "attr", getattr(each, "id", "")) in LIMITING for each in called)


def _limit(parser: Parser, statement: ast.With | ast.AsyncWith) -> Expression:
    """Return how long what stands under `with self.limit(quantity(5, "min")):` may take."""
    match statement:
        case ast.With(
            items=[ast.withitem(context_expr=ast.Call(func=function, args=[value], keywords=[]), optional_vars=None)]
        ) if attribute_of_self(function) == "limit" and not isinstance(value, ast.Starred):
            return parser.value(value)
    raise Refused(statement, quoted(statement), LIMIT)


def _missing_set(parser: Parser, call: ast.Call) -> n.Node:
    match call:
        case ast.Call(args=[ast.Constant(value=None), value], keywords=[]):
            return n.Set("", parser.value(value))
    raise Refused(call, quoted(call), "Set a variable by its name: self.count = 1.")


def _missing_call(parser: Parser, call: ast.Call) -> n.Call:
    if len(call.args) == 1 and isinstance(call.args[0], ast.Constant) and call.args[0].value is None:
        return n.Call("")
    raise Refused(call, quoted(call), "Call a function by its name: self.mix_paint(minutes=3).")


_OWN_CALLS: Mapping[str, Callable[[Parser, ast.Call], n.Node]] = {
    "parallel": _parallel,
    "call": _missing_call,
    "set": _missing_set,
}
"""The methods of the task that no record of a construct describes."""

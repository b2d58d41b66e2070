"""Script → tree: the closed subset of Python that the language prints, read by walking its `ast`.

Nothing is ever executed. What is not part of the language is refused with line, column and what to write instead.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache

from editor.language.allocation import paused_collector
from editor.language.analysis.positions import place_loads
from editor.language.expressions import nodes as e
from editor.language.expressions.names import RESERVED_ATTRIBUTES, unique_name
from editor.language.messages.diagnostics import Diagnostic, Problem, put_into_words
from editor.language.messages.syntax_errors import count_characters, explain_syntax
from editor.language.parsing.bindings import Entry, parse_parameters, parse_run, read_type
from editor.language.parsing.expressions import Refused, Scope, attribute_of_self, calls_in, quoted, robots_driven
from editor.language.parsing.steps import Parser
from editor.language.parsing.variables import check_local, names_assigned
from editor.language.site.surroundings import Surroundings, standing_places
from editor.language.tree import nodes as n
from editor.language.tree.traversal import in_reading_order

LONGEST_SCRIPT = 2_000_000


@dataclass(frozen=True, slots=True)
class Parsed:
    """What a script means, or why it means nothing."""

    tree: n.Tree | None
    diagnostics: tuple[Diagnostic, ...] = ()


def parse_script(text: str, surroundings: Surroundings) -> Parsed:
    """Return the tree of a script, or where it leaves the language; nothing in the text makes this raise."""
    if len(text) > LONGEST_SCRIPT:
        return Parsed(None, (_diagnostic("not_python", 1, 1, {"detail": "The script is too long."}),))
    with paused_collector():
        return _parse(text, surroundings)


def _parse(text: str, surroundings: Surroundings) -> Parsed:
    try:
        module = count_characters(ast.parse(text), text)
    except SyntaxError as error:
        detail = {"detail": explain_syntax(error, text)}
        return Parsed(None, (_diagnostic("not_python", error.lineno or 1, error.offset or 1, detail),))
    except (ValueError, RecursionError, MemoryError):
        return Parsed(None, (_diagnostic("not_python", 1, 1, {"detail": "It is nested too deeply, or no text."}),))
    try:
        return _parse_module(module, surroundings)
    except Refused as refusal:
        return Parsed(None, (_refusal(refusal),))
    except RecursionError:
        return Parsed(None, (_diagnostic("not_python", 1, 1, {"detail": "It is nested too deeply."}),))


def _diagnostic(code: str, line: int, column: int, args: Mapping[str, str | int]) -> Diagnostic:
    return put_into_words(Problem(code, args={"line": line, "column": column, **args}), line, column)


def _refusal(refused: Refused) -> Diagnostic:
    end = {"end_line": refused.end_line, "end_column": refused.end_column}
    args = {"found": refused.found, "instead": refused.instead, **end}
    return _diagnostic("not_in_language", refused.line, refused.column, args)


def _parse_module(module: ast.Module, surroundings: Surroundings) -> Parsed:
    methods = _methods(module)
    for needed in ("new_task", "run"):
        if needed not in methods:
            raise Refused(module, "A task without this method", f"Write def {needed}(self…) in class Task.")
    calls = cache(lambda: calls_in(module))
    scope = Scope(surroundings, robots=cache(lambda: robots_driven(calls())))
    entries = parse_run(methods["run"], scope)
    parser = Parser(methods, scope)
    handlers = _handlers(entries, methods)
    shared = [names_assigned(method, methods).attributes for method in (methods["new_task"], *handlers)]
    scope.variables = frozenset[str]().union(*shared)
    known = {"new_task", "run", *(handler.name for handler in handlers)}
    branches = frozenset(_branch_names(calls())) if methods.keys() - known else frozenset()
    for name, method in methods.items():
        if name not in known | branches:
            parser.functions[name] = _signature(name, method)
    body = parser.block(methods["new_task"].body)
    events = tuple(_event(parser, *pair) for pair in zip(entries, handlers, strict=True))
    for name, function in list(parser.functions.items()):
        own = names_assigned(methods[name], methods).bare - scope.variables
        scope.locals = own | frozenset(parameter.name for parameter in function.parameters)
        parser.functions[name] = replace(function, body=parser.block(methods[name].body))
    roles, parameters = _roles_and_parameters(parser)
    tree = in_reading_order(n.Tree(body, tuple(parser.functions.values()), roles, parameters, events))
    placed, unplaced = place_loads(tree, standing_places(surroundings))
    for node in unplaced:
        where = parser.origins[id(node)]
        parser.refusals.append(
            Refused(where, "A pick or drop at an unknown place", f"Put self.{node.role}.move(…) before it.")
        )
    if parser.refusals:
        ordered = sorted(parser.refusals, key=lambda refused: (refused.line, refused.column))
        return Parsed(None, tuple(_refusal(refused) for refused in ordered))
    return Parsed(placed)


def _signature(name: str, method: ast.FunctionDef) -> n.Function:
    """Return a function still without its steps."""
    known = unique_name(name, RESERVED_ATTRIBUTES)
    if known != name:
        raise Refused(method, f"A function called {name}", f"Call it {known}.")
    parameters = parse_parameters(method)
    for argument in method.args.args[1:]:
        check_local(argument.arg, argument)
    return n.Function(name, parameters, (), *read_type(method.returns), name=name)


def _handlers(entries: list[Entry], methods: Mapping[str, ast.FunctionDef]) -> list[ast.FunctionDef]:
    """Return the method of each event; each has its own."""
    handlers: list[ast.FunctionDef] = []
    for entry in entries:
        method = methods.get(entry.method)
        if method is None or entry.method in {"new_task", "run"} or method in handlers:
            raise Refused(entry.call, quoted(entry.call), "Each event needs a method of its own: self.when_e1.")
        if [argument.arg for argument in method.args.args] != ["self"]:
            raise Refused(method, "An event with parameters", f"Write def {method.name}(self):.")
        handlers.append(method)
    return handlers


def _event(parser: Parser, entry: Entry, method: ast.FunctionDef) -> n.Event:
    try:
        condition = parser.value(entry.condition)
    except Refused as refusal:
        parser.refusals.append(refusal)
        condition = e.MISSING
    return n.Event(condition, parser.block(method.body), entry.starts)


def _roles_and_parameters(parser: Parser) -> tuple[tuple[n.Role, ...], tuple[n.Parameter, ...]]:
    bindings = parser.scope.bindings.items()
    roles = tuple(
        n.Role(name, b.id if b.kind == "get" else None, b.can, b.at, name)
        for name, b in bindings
        if name in parser.roles
    )
    return roles, tuple(n.Parameter(name, b.default, b.type, b.unit) for name, b in bindings if b.kind == "parameter")


def _is_method(statement: ast.stmt) -> bool:
    return isinstance(statement, ast.FunctionDef) and [each.arg for each in statement.args.args[:1]] == ["self"]


def _branch_names(calls: Iterable[ast.Call]) -> Iterator[str]:
    """Yield the methods that some `self.parallel(…)` names as branches."""
    for call in calls:
        if attribute_of_self(call.func) == "parallel":
            for argument in call.args:
                name = attribute_of_self(argument)
                if name is not None:
                    yield name


def _methods(module: ast.Module) -> dict[str, ast.FunctionDef]:
    """Return the methods of the task; those that stand behind the class are its own too, as in the paper's listing."""
    match module.body:
        case [
            ast.ClassDef(name="Task", body=body, bases=[] | [ast.Name(id="object")], keywords=[], decorator_list=[]),
            *behind,
        ] if all(map(_is_method, behind)):
            body = [*body, *behind]
        case _:
            first = module.body[0] if module.body else module
            raise Refused(
                first, "A script without class Task", "Begin with class Task(object): and put everything in it."
            )
    methods: dict[str, ast.FunctionDef] = {}
    for statement in body:
        if isinstance(statement, ast.FunctionDef) and not statement.decorator_list:
            if statement.name in methods:
                raise Refused(statement, f"A second method {statement.name}", "Give it another name.")
            methods[statement.name] = statement
        elif not (isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant)):
            raise Refused(statement, quoted(statement), "In the class there are only methods.")
    return methods

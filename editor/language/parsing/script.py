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
from editor.language.messages.syntax_errors import STATEMENTS, count_characters, explain_syntax, instead_of_import
from editor.language.parsing.answers import unplaced_load
from editor.language.parsing.bindings import Entry, parse_parameters, parse_run, read_type, takes_only
from editor.language.parsing.robots import calls_made, robots_driven
from editor.language.parsing.scope import Binding, Refused, Scope, attribute_of_self, quoted, written
from editor.language.parsing.steps import Parser
from editor.language.parsing.variables import check_local, names_assigned
from editor.language.parsing.zones import zones_given
from editor.language.site.surroundings import Surroundings, standing_places
from editor.language.tree import nodes as n
from editor.language.tree.program import Function, Parameter, Role, Tree
from editor.language.tree.traversal import in_reading_order

LONGEST_SCRIPT = 2_000_000
MOST_TOLD = 20
"""More mistakes than these are only counted: who mends the first ones mends many of the others with them."""


@dataclass(frozen=True, slots=True)
class Parsed:
    """What a script means, or why it means nothing."""

    tree: Tree | None
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
    for needed, heading in (("new_task", "def new_task(self):"), ("run", "def run(self, ctx):")):
        if needed not in methods:
            raise Refused(module.body[0], f"A task without {needed}", f"Write {heading} in class Task.")
    if not takes_only(methods["new_task"], ["self"]):
        raise Refused(methods["new_task"], "This new_task", "Write def new_task(self):. Values come by ctx.parameter.")
    calls = cache(lambda: calls_made(methods.values()))
    bindings: dict[str, Binding] = {}  # not the scope, which would hold itself: all of the script would stay longer
    robots = cache(lambda: robots_driven(calls(), bindings, surroundings))
    scope = Scope(surroundings, bindings, robots=robots, methods=methods)
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
    tree = Tree(body, tuple(parser.functions.values()), roles, parameters, events, *zones_given(scope))
    tree = in_reading_order(tree)
    placed, unplaced = place_loads(tree, standing_places(surroundings))
    for node in unplaced:
        where = parser.origins[id(node)]
        parser.refusals.append(unplaced_load(where, node.role, scope))
    return Parsed(None, _told(parser.refusals)) if parser.refusals else Parsed(placed)


def _told(refusals: list[Refused]) -> tuple[Diagnostic, ...]:
    """Return the first of what is refused, in the order of the script, and how much more there is."""
    ordered = sorted(refusals, key=lambda refused: (refused.line, refused.column))
    told = tuple(map(_refusal, ordered[:MOST_TOLD]))
    more = ordered[MOST_TOLD:]
    if not more:
        return told
    place = more[0].line, more[0].column
    return (*told, _diagnostic("more_mistakes", *place, {"count": len(more)}))


def _signature(name: str, method: ast.FunctionDef) -> Function:
    """Return a function still without its steps."""
    known = unique_name(name, RESERVED_ATTRIBUTES)
    if name == "__init__":
        raise Refused(method, "A method __init__", "Put its lines at the beginning of new_task.")
    if known != name:
        raise Refused(method, f"A function called {name}", f"Call it {known}.")
    parameters = parse_parameters(method)
    for argument in method.args.args[1:]:
        check_local(argument.arg, argument)
    return Function(name, parameters, (), *read_type(method.returns), name=name)


def _handlers(entries: list[Entry], methods: Mapping[str, ast.FunctionDef]) -> list[ast.FunctionDef]:
    """Return the method of each event; each has its own."""
    handlers: list[ast.FunctionDef] = []
    for entry in entries:
        method = methods.get(entry.method)
        if method is None or entry.method in {"new_task", "run"} or method in handlers:
            raise Refused(entry.call, quoted(entry.call), "Each event needs a method of its own: self.when_e1.")
        if not takes_only(method, ["self"]):
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


def _roles_and_parameters(parser: Parser) -> tuple[tuple[Role, ...], tuple[Parameter, ...]]:
    bindings = parser.scope.bindings.items()
    roles = tuple(
        Role(name, b.id if b.kind == "get" else None, b.can, b.at, name, where=b.where)
        for name, b in bindings
        if name in parser.roles
    )
    return roles, tuple(Parameter(name, b.default, b.type, b.unit) for name, b in bindings if b.kind == "parameter")


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
            raise _without_task(module)
    methods: dict[str, ast.FunctionDef] = {}
    for statement in body:
        if isinstance(statement, ast.FunctionDef) and not statement.decorator_list:
            if statement.name in methods:
                raise Refused(statement, f"A second method {statement.name}", "Give it another name.")
            methods[statement.name] = statement
        elif not _is_note(statement):
            raise Refused(statement, quoted(statement), _instead_in_class(statement))
    return methods


def _is_note(statement: ast.stmt) -> bool:
    """Tell whether a statement is a text that says something to people."""
    match statement:
        case ast.Expr(value=ast.Constant(value=str())):
            return True
    return False


def _instead_in_class(statement: ast.stmt) -> str:
    """Return what to write instead of a statement that stands in the class, beside its methods."""
    match statement:
        case ast.FunctionDef(decorator_list=[first, *_]):
            return f"Leave @{written(first)} out."
        case ast.AsyncFunctionDef():
            return "Leave “async” out: a script waits by itself until a step is done."
        case ast.Assign(targets=[ast.Name(id=name)]) | ast.AnnAssign(target=ast.Name(id=name)):
            return f"Set it in new_task: self.{name} = 1."
        case ast.Pass():
            return "Write def new_task(self): and def run(self, ctx): in class Task."
    return instead_of_import(statement) or "In the class there are only methods. Put it in one, such as new_task."


def _without_task(module: ast.Module) -> Refused:
    """Return what keeps a script from being one class Task: its heading, or what stands before or behind it."""
    instead = "Begin with class Task(object): and put everything in it."
    tasks = [statement for statement in module.body if isinstance(statement, ast.ClassDef)]
    for statement in module.body:
        if tasks and statement is not tasks[0] and not _is_method(statement):
            return Refused(statement, quoted(statement), instead_of_import(statement) or _beside_task(statement))
    if not tasks:
        return Refused(module.body[0] if module.body else module, "A script without class Task", instead)
    if tasks[0].decorator_list:
        found = tasks[0].decorator_list[0]
        return Refused(found, quoted(found), f"Leave @{written(found)} out.")
    return Refused(
        tasks[0], quoted(tasks[0]).replace("@", ""), "Write class Task(object):, as the script's first line."
    )


def _beside_task(statement: ast.stmt) -> str:
    """Return what to write instead of a statement that stands before or behind the class."""
    match statement:
        case ast.ClassDef():
            return STATEMENTS[ast.ClassDef]
        case ast.FunctionDef(name=name):
            return f"Put it in class Task, with self first: def {name}(self):."
        case ast.If(test=ast.Compare(left=ast.Name(id="__name__"))):
            return "Leave it out: VIPO runs the task by itself."
        case ast.Expr(value=ast.Call()):
            return "Leave it out: VIPO runs the task by itself."
    return "Put it in class Task, or leave it out."

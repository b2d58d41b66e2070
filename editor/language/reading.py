"""Document → tree: what people drew, read into typed nodes; one small function for each kind of step."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Final

from editor.language.answers import settle_answer
from editor.language.diagnostics import Fix, Problem, TextArguments
from editor.language.ladder import FORMAT, format_of
from editor.language.names import RESERVED_ATTRIBUTES, attribute_name, local_name
from editor.language.nodes import (
    MISSING,
    NOWHERE,
    Ask,
    Block,
    Break,
    Call,
    Drop,
    End,
    Event,
    ForEach,
    Function,
    If,
    Move,
    Node,
    Notify,
    Operate,
    Parallel,
    Pick,
    Point,
    Repeat,
    Return,
    Role,
    Set,
    Tree,
    Try,
    Wait,
    WaitUntil,
    While,
    is_missing,
)
from editor.language.outline import EVENTS, PROGRAM, Outline, Params, make_outline, mapping
from editor.language.phrases import Options
from editor.language.plan import Expression, Located, PlaceRef
from editor.language.reading_names import (
    DEFAULT_ROLE,
    by_id,
    read_arguments,
    read_functions,
    read_parameters,
    read_roles,
    text_of,
    variables_by_root,
)
from editor.language.remembering import ReadSteps, StepRead
from editor.language.values import Names, UnknownParameter, read_place, read_point, read_value
from editor.language.walking import in_reading_order

_DRIVING = frozenset({"move", "pick", "drop", "pick_and_drop"})
_LISTS: Final = (list, tuple)
FAILURE_KINDS = ("refused", "failed", "timed_out", "offline", "blocked", "cancelled")


@dataclass(frozen=True, slots=True)
class Reading:
    """A document as it was read: the tree without added moves, and what could not be read."""

    tree: Tree
    outline: Outline
    problems: tuple[Problem, ...]


@dataclass(slots=True)
class _Reader:
    """What is known while reading: names given so far, and the problems met."""

    outline: Outline
    roles: dict[str, Role]
    functions: dict[str, Function]
    """By id, still without their bodies."""
    argument_names: dict[str, dict[str, str]]
    names: Names
    """The parameters and variables that can be seen in the block being read."""
    problems: list[Problem] = field(default_factory=list)
    known: ReadSteps | None = None
    looked_around: bool = False
    """Whether a value was read that depends on other steps."""
    _driven: frozenset[str] | None = None

    def robot(self, role: str) -> Expression:
        """Return what stands for the robot of a role: the role where steps drive it, else the device it is."""
        self.looked_around = True
        if self._driven is None:
            self._driven = _driven_roles(self.outline)
        found = self.roles.get(role)
        if found is None:
            return MISSING
        if role in self._driven:
            return Located(role=found.name)
        return MISSING if found.device is None else Located(device=found.device)

    def value(self, step: str, params: Params, name: str, field_name: str = "") -> Expression:
        """Return the expression in a parameter; what does not exist reads as missing, and is told."""
        value = params.get(name)
        if value is None:
            return MISSING
        try:
            return read_value(value, self.names, self.robot)
        except UnknownParameter as error:
            return self._unknown(step, field_name or name, error)

    def given(self, step: str, params: Params, name: str) -> Expression | None:
        """Return the expression in a parameter that may also be left out."""
        value = self.value(step, params, name)
        return None if is_missing(value) else value

    def place(self, step: str, params: Params, name: str) -> PlaceRef:
        """Return the place in a parameter; what does not exist reads as missing, and is told."""
        try:
            return read_place(params.get(name), self.names)
        except UnknownParameter as error:
            self._unknown(step, name, error)
            return NOWHERE

    def _unknown(self, step: str, field_name: str, error: UnknownParameter) -> Expression:
        self.problems.append(Problem("unknown_parameter", step, field_name, {"parameter": str(error)}))
        return MISSING

    def role(self, step: str, params: Params) -> str:
        """Return the script name of the step's robot."""
        wanted = params.get("role")
        name = wanted if isinstance(wanted, str) and wanted else DEFAULT_ROLE
        if name not in self.roles:
            fix = Fix("choose", step, "role", DEFAULT_ROLE, {"value": self.roles[DEFAULT_ROLE].name})
            self.problems.append(Problem("unknown_role", step, "role", {"role": name}, fix))
            name = DEFAULT_ROLE
        return self.roles[name].name

    def variable(self, params: Params, name: str = "variable") -> str:
        """Return the script name of the variable that a step sets, empty when it is still to be named."""
        wanted = text_of(params.get(name))
        return self.names.get(wanted, "") if wanted else ""

    def block(self, parent: str, branch: str) -> Block:
        """Return the nodes of one branch."""
        nodes: list[Node] = []
        known, kinds, params = self.known, self.outline.kinds, self.outline.params
        for step in self.outline.children.get((parent, branch), ()):
            if known is None:
                nodes.extend(READERS[kinds[step]](self, step, params[step]))
            else:
                nodes.extend(self._remembered(step, known))
        return tuple(nodes)

    def _remembered(self, step: str, known: ReadSteps) -> tuple[Node, ...]:
        """Return the nodes of a step as they were read last, or read it anew."""
        last = known.steps.get(step)
        if last is None or last.names != self.names:
            return self._read(step, known)
        self.problems.extend(last.problems)
        return last.nodes

    def _read(self, step: str, known: ReadSteps) -> tuple[Node, ...]:
        """Read a step and keep what depends on nothing but it and the names that it sees."""
        around, self.looked_around = self.looked_around, False
        told = len(self.problems)
        nodes = READERS[self.outline.kinds[step]](self, step, self.outline.params[step])
        if not self.looked_around:
            known.steps[step] = StepRead(nodes, tuple(self.problems[told:]), self.names)
        self.looked_around = self.looked_around or around
        return nodes


def _driven_roles(outline: Outline) -> frozenset[str]:
    """Return the ids of the roles that some step of the program drives."""
    roots = [key for key in outline.children if key[0] not in outline.kinds]
    steps = outline.with_inner(step for key in roots for step in outline.children[key])
    params = [outline.params[step] for step in steps if outline.kinds[step] in _DRIVING]
    wanted = (one.get("role") for one in params)
    return frozenset(role if isinstance(role, str) and role else DEFAULT_ROLE for role in wanted)


Reads = Callable[[_Reader, str, Params], tuple[Node, ...]]


def _move(reader: _Reader, step: str, params: Params) -> tuple[Node, ...]:
    return (Move(reader.role(step, params), reader.place(step, params, "to"), _route(params.get("route")), step),)


def _pick(reader: _Reader, step: str, params: Params) -> tuple[Node, ...]:
    return (Pick(reader.role(step, params), reader.place(step, params, "at"), *_load(reader, step, params), step),)


def _drop(reader: _Reader, step: str, params: Params) -> tuple[Node, ...]:
    return (Drop(reader.role(step, params), reader.place(step, params, "at"), *_load(reader, step, params), step),)


def _pick_and_drop(reader: _Reader, step: str, params: Params) -> tuple[Node, ...]:
    role, (thing, quantity) = reader.role(step, params), _load(reader, step, params)
    source, target = reader.place(step, params, "source"), reader.place(step, params, "target")
    route = _route(params.get("route"))
    return (
        Pick(role, source, thing, quantity, step, "source"),
        Drop(role, target, thing, quantity, step, "target", route),
    )


def _load(reader: _Reader, step: str, params: Params) -> tuple[Expression, Expression]:
    return reader.value(step, params, "object"), reader.value(step, params, "quantity")


def _route(value: object) -> tuple[Point, ...]:
    points = [read_point(point) for point in value] if isinstance(value, _LISTS) else []
    return tuple(point for point in points if point is not None)


def _operate(reader: _Reader, step: str, params: Params) -> tuple[Node, ...]:
    method = params.get("method")
    arguments = _arguments(reader, step, params)
    return (
        Operate(reader.place(step, params, "device"), method if isinstance(method, str) else "", arguments, step),
    )  # fmt: skip


def _arguments(reader: _Reader, step: str, params: Params) -> tuple[tuple[str, Expression], ...]:
    given = mapping(params.get("args"))
    arguments: list[tuple[str, Expression]] = []
    for name in sorted(given, key=str):
        value = reader.value(step, given, name, f"args.{name}")
        if not is_missing(value):
            arguments.append((str(name), value))
    return tuple(arguments)


def _wait(reader: _Reader, step: str, params: Params) -> tuple[Node, ...]:
    if params.get("until") is None:
        return (Wait(reader.value(step, params, "duration"), step),)
    timeout = reader.given(step, params, "timeout")
    return (WaitUntil(reader.value(step, params, "until"), timeout, step),)


def _if(reader: _Reader, step: str, params: Params) -> tuple[Node, ...]:
    condition = reader.value(step, params, "condition")
    return (If(condition, reader.block(step, "then"), reader.block(step, "else"), step),)


def _while(reader: _Reader, step: str, params: Params) -> tuple[Node, ...]:
    return (While(reader.value(step, params, "condition"), reader.block(step, "body"), step),)


def _parallel(reader: _Reader, step: str, params: Params) -> tuple[Node, ...]:
    return (Parallel(tuple(reader.block(step, name) for name in reader.outline.branches(step)), step),)


def _try(reader: _Reader, step: str, params: Params) -> tuple[Node, ...]:
    named = params.get("kinds")
    wanted = named if isinstance(named, _LISTS) else ()
    kinds = tuple(kind for kind in FAILURE_KINDS if kind in wanted)
    body, catch, final = reader.block(step, "body"), reader.block(step, "catch"), reader.block(step, "finally")
    catches = params.get("catch") is not False
    return (Try(kinds if catches else (), body, catch, final, catches, step),)


def _call(reader: _Reader, step: str, params: Params) -> tuple[Node, ...]:
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


def _call_argument(reader: _Reader, step: str, given: Params, name: str) -> Expression:
    return reader.value(step, given, name, f"args.{name}")


def _repeat(reader: _Reader, step: str, params: Params) -> tuple[Node, ...]:
    return (Repeat(reader.value(step, params, "times"), reader.block(step, "body"), step),)


def _for_each(reader: _Reader, step: str, params: Params) -> tuple[Node, ...]:
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


def _set(reader: _Reader, step: str, params: Params) -> tuple[Node, ...]:
    return (Set(reader.variable(params), reader.value(step, params, "value"), step),)


def _ask(reader: _Reader, step: str, params: Params) -> tuple[Node, ...]:
    question, timeout = reader.value(step, params, "question"), reader.given(step, params, "timeout")
    answer = settle_answer(mapping(params.get("answer")))
    return (Ask(question, answer, reader.variable(params), timeout, step),)


def _notify(reader: _Reader, step: str, params: Params) -> tuple[Node, ...]:
    level = "warning" if params.get("level") == "warning" else "info"
    return (Notify(reader.value(step, params, "message"), level, step),)


def _end(reader: _Reader, step: str, params: Params) -> tuple[Node, ...]:
    return (End(step),)


def _return(reader: _Reader, step: str, params: Params) -> tuple[Node, ...]:
    return (Return(reader.given(step, params, "value"), step),)


def _break(reader: _Reader, step: str, params: Params) -> tuple[Node, ...]:
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


def read_document(document: object, known: ReadSteps | None = None) -> Reading:
    """Read a document (plain JSON, format 2); nothing in it makes this raise.

    `known` has the steps as they were read last, and has them as they are read now.
    """
    whole = mapping(document)
    outline = make_outline(whole) if known is None else known.last.look(whole)
    parameters, names = read_parameters(by_id(whole.get("parameters")).items())
    taken = {*RESERVED_ATTRIBUTES, *names.values()}
    roles = read_roles(by_id(whole.get("roles")), taken)
    taken |= {role.name for role in roles.values()}
    given = by_id(whole.get("functions"))
    functions = read_functions(given, taken)
    taken |= {function.method for function in functions.values()}
    variables = variables_by_root(outline)
    for name in sorted(variables.get(PROGRAM, ())):
        if name not in names:
            names[name] = attribute_name(name, taken)
            taken.add(names[name])
    reader = _Reader(outline, roles, functions, {}, names, known=known)
    for key, function in functions.items():
        listed, reader.argument_names[key] = read_arguments(given[key], names)
        functions[key] = replace(function, parameters=listed)
    if known is not None:
        known.begin(outline, (roles, [(f.id, f.name, f) for f in functions.values()], reader.argument_names))
    body, events = reader.block(PROGRAM, "body"), _read_events(reader)
    finished = [_with_body(reader, function, names, variables.get(key, ())) for key, function in functions.items()]
    tree = in_reading_order(Tree(body, tuple(finished), tuple(roles.values()), parameters, events))
    if format_of(document) > FORMAT:
        reader.problems.append(Problem("newer_format", "", "format", {"format": format_of(document)}))
    return Reading(tree, outline, tuple(reader.problems))


def _read_events(reader: _Reader) -> tuple[Event, ...]:
    """Return the second entries; none of them sees what a function or a loop calls its own."""
    events: list[Event] = []
    for step in reader.outline.children.get((PROGRAM, EVENTS), ()):
        params = reader.outline.params[step]
        starts = "run" if params.get("starts") == "run" else "branch"
        condition = reader.value(step, params, "condition")
        events.append(Event(condition, reader.block(step, "body"), starts, step))
    return tuple(events)


def _with_body(reader: _Reader, function: Function, names: Names, variables: Iterable[str]) -> Function:
    """Return a function with its steps, which see its parameters and its own variables before the program's."""
    if function.id in reader.outline.kinds:
        return function
    seen = {**names, **reader.argument_names[function.id]}
    for name in sorted(variables):
        if name not in reader.argument_names[function.id]:
            seen[name] = local_name(name, (script for other, script in seen.items() if other != name))
    reader.names = seen
    return replace(function, body=reader.block(function.id, "body"))

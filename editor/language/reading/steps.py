"""Steps of a document → nodes of the tree, by the records of constructs."""

from __future__ import annotations

from collections.abc import Mapping

from editor.language.constructs.record import Construct, Form
from editor.language.constructs.table import STEPS
from editor.language.document.catches import KINDS_OF, catches_of
from editor.language.document.outline import Params, mapping
from editor.language.expressions.names import local_name
from editor.language.expressions.nodes import MISSING, OF_PROBLEM, Expression, Variable, is_missing
from editor.language.expressions.values import is_number
from editor.language.messages.diagnostics import Fix, Problem, TextArguments
from editor.language.messages.phrases import Options
from editor.language.reading.fields import FIELD_READERS, LISTS, read_route
from editor.language.reading.names import names_of_loop
from editor.language.reading.reader import Reader, Reads, operated_role
from editor.language.tree.nodes import (
    ERROR_CLASSES,
    NODES,
    Call,
    Catch,
    Drop,
    ForEach,
    Node,
    Operate,
    Parallel,
    Perform,
    Pick,
    Try,
)

MOST_NEEDED = 10**6
"""A number of branches as large as this is none."""


def _pick_and_drop(reader: Reader, step: str, params: Params) -> tuple[Node, ...]:
    role, (thing, quantity) = reader.role(step, params), _load(reader, step, params)
    source, target = reader.place(step, params, "source"), reader.place(step, params, "target")
    route = read_route(params.get("route"))
    return (
        Pick(role, source, thing, quantity, step, "source"),
        Drop(role, target, thing, quantity, step, "target", route),
    )


def _load(reader: Reader, step: str, params: Params) -> tuple[Expression, Expression]:
    return reader.value(step, params, "object"), reader.value(step, params, "quantity")


def _operate(reader: Reader, step: str, params: Params) -> tuple[Node, ...]:
    method = params.get("method")
    name, arguments = method if isinstance(method, str) else "", _arguments(reader, step, params)
    role = operated_role(params)
    if role is not None:
        return (Perform(reader.role(step, role, "device"), name, arguments, step),)
    return (Operate(reader.place(step, params, "device"), name, arguments, step),)


def _arguments(reader: Reader, step: str, params: Params) -> tuple[tuple[str, Expression], ...]:
    given = mapping(params.get("args"))
    arguments: list[tuple[str, Expression]] = []
    for name in sorted(given, key=str):
        value = reader.value(step, given, name, f"args.{name}")
        if not is_missing(value):
            arguments.append((str(name), value))
    return tuple(arguments)


def _parallel(reader: Reader, step: str, params: Params) -> tuple[Node, ...]:
    branches = tuple(reader.block(step, name) for name in reader.outline.branches(step))
    return (Parallel(branches, _needed(reader, step, params, len(branches)), step),)


def _needed(reader: Reader, step: str, params: Params, count: int) -> int | None:
    """Return how many branches end a Parallel; browsers write whole numbers with a point, too."""
    given = params.get("needed")
    if given is None:
        return None
    if is_number(given) and abs(given) < MOST_NEEDED and given == int(given):
        return int(given)
    fix = Fix("all_branches", step, "needed", None)
    reader.problems.append(Problem("needed_out_of_range", step, "needed", {"count": count}, fix))
    return None


_OF_PROBLEM = dict(zip(OF_PROBLEM, OF_PROBLEM, strict=True))
"""What a catch alone can see of the failure."""


def _try(reader: Reader, step: str, params: Params) -> tuple[Node, ...]:
    body, final, outside = reader.block(step, "body"), reader.block(step, "finally"), reader.names
    reader.names = {**outside, **_OF_PROBLEM}
    handlers = tuple(_catch(reader, step, params, branch) for branch in catches_of(params))
    reader.names = outside
    return (Try(body, handlers, final, step),)


def _catch(reader: Reader, step: str, params: Params, branch: str) -> Catch:
    named = params.get(KINDS_OF[branch])
    wanted = named if isinstance(named, LISTS) else ()
    return Catch(tuple(kind for kind in ERROR_CLASSES if kind in wanted), reader.block(step, branch), branch)


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


def _for_each(reader: Reader, step: str, params: Params) -> tuple[Node, ...]:
    """The names of the loop can be seen in its body, and hide what else has these names."""
    written, named = params.get("items"), names_of_loop(params)
    listed = reader.given(step, params, "list")
    over = listed if isinstance(listed, Variable) else None
    items = written if over is None and isinstance(written, list | tuple) else ()
    values = tuple(reader.value(step, {"items": item}, "items") for item in items)
    outside = reader.names
    for wanted in named:
        hidden = (script for name, script in reader.names.items() if name != wanted)
        reader.names = {**reader.names, wanted: local_name(wanted, hidden)}
    body = reader.block(step, "body")
    variable, index = reader.variable(params), reader.variable(params, "index")
    reader.names = outside
    if index and index == variable:
        index = ""
        fix = Fix("remove", step, "index", None, {"value": variable})
        reader.problems.append(Problem("same_name", step, "index", {"variable": variable}, fix))
    return (ForEach(variable, values, index, over, body, step),)


_OWN: Mapping[str, Reads] = {
    "pick_and_drop": _pick_and_drop,
    "operate": _operate,
    "parallel": _parallel,
    "try": _try,
    "call": _call,
    "for_each": _for_each,
}
"""The kinds whose nodes are not just made of their fields."""


def _reader_of(form: Form, branches: tuple[str, ...]) -> Reads:
    """Return what reads a step into the node of a form: its fields, then its branches, then its id."""
    node = NODES[form.node]
    fields = tuple(FIELD_READERS[field.type](field) for field in form.fields)

    def read(reader: Reader, step: str, params: Params) -> tuple[Node, ...]:
        given = [of_field(reader, step, params) for of_field in fields]
        given += [reader.block(step, branch) for branch in branches]
        return (node(*given, step),)

    return read


def _read_as(construct: Construct) -> Reads:
    """Return what reads the steps of a kind; the last form is the one that has no mark."""
    branches = tuple(name for name, _ in construct.branches)
    *marked, plain = ((form.marked_by, _reader_of(form, branches)) for form in construct.forms)
    if not marked:
        return plain[1]

    def read(reader: Reader, step: str, params: Params) -> tuple[Node, ...]:
        chosen = next((reads for mark, reads in marked if params.get(mark) is not None), plain[1])
        return chosen(reader, step, params)

    return read


READERS: Mapping[str, Reads] = {
    construct.kind: _OWN.get(construct.kind) or _read_as(construct)
    for construct in STEPS
    if construct.kind != "on_event"
}

"""The checks: what is wrong with a program, or odd about it; one small function for each construct."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from editor.language import nodes as n
from editor.language.carrying import follow_loads
from editor.language.check_context import Context
from editor.language.check_devices import check_load_place, check_place, check_role, usable_device
from editor.language.check_floor import check_floor
from editor.language.check_flow import check_flow
from editor.language.check_library import check_library
from editor.language.check_parallel import check_branches, check_parallel
from editor.language.check_values import check_argument, check_condition, check_quantity, check_value, has_missing
from editor.language.check_variables import check_variables
from editor.language.diagnostics import Fix, Problem, TextArguments
from editor.language.outline import PROGRAM, Outline
from editor.language.phrases import Options, Span
from editor.language.plan import Constant
from editor.language.reading import Reading
from editor.language.surroundings import Surroundings
from editor.language.typing_of_values import NUMBER, Kind, constant_value, plain_type
from editor.language.walking import needed_of_roles, walk
from editor.language.zones import read_zones
from registry.capability import ParameterSpec


def check(
    reading: Reading, tree: n.Tree, surroundings: Surroundings, document: object = None
) -> list[tuple[Problem, int]]:
    """Return the problems of a program, each with the identity of its node (0: none); the order is always the same.

    `tree` is the reading's tree with the moves that were put in, `document` what was read.
    """
    context = Context(tree, surroundings)
    context.zones = frozenset(zone.id for zone in read_zones(document))
    found = context.found
    found.extend((problem, 0) for problem in reading.problems)
    already = {(problem.step, problem.field) for problem in reading.problems}
    for block, parameters in _blocks(tree):
        context.variables = {p.name: Kind(plain_type(p.type), p.unit) for p in parameters}
        for node in walk(block):
            CHECKS[type(node)](context, node)
    context.found = [
        (p, key) for p, key in found if not (p.code.startswith("missing") and (p.step, p.field) in already)
    ]
    _check_roles(context)
    check_flow(context)
    check_variables(context)
    check_parallel(context)
    check_library(context, document)
    check_floor(context, document)
    context.found.extend(follow_loads(tree, context.capacity, context.robot_name))
    _check_left_over(context, reading)
    return context.found


def _blocks(tree: n.Tree) -> list[tuple[n.Block, tuple[n.Parameter, ...]]]:
    """Return the program's and the functions' blocks with the parameters that can be seen there."""
    functions = [(function.body, (*tree.parameters, *function.parameters)) for function in tree.functions]
    return [(tree.body, tree.parameters), *functions]


def _move(context: Context, node: n.Move) -> None:
    if not node.added:
        check_place(context, node, node.to, "to", "missing_destination")


def _pick(context: Context, node: n.Pick) -> None:
    check_load_place(context, node, gives=True)
    check_quantity(context, node)


def _drop(context: Context, node: n.Drop) -> None:
    check_load_place(context, node, gives=False)
    if node.place_field != "target":  # a Pick-and-Drop says what it carries once, with its pick
        check_quantity(context, node)


def _operate(context: Context, node: n.Operate) -> None:
    device = usable_device(context, node, node.device, "device", "missing_machine")
    if device is None:
        return
    known = Options(tuple(method.name for method in device.methods))
    if not node.method:
        fix = None
        if len(device.methods) == 1:
            only = device.methods[0].name
            fix = Fix("choose", node.step, "method", only, {"value": only})
        context.tell(node, "missing_method", "method", {"device": device.name, "options": known}, fix)
        return
    method = device.method(node.method)
    if method is None:
        details: TextArguments = {"device": device.name, "method": node.method, "options": known}
        context.tell(node, "unknown_method", "method", details)
        return
    given = dict(node.arguments)
    for parameter in method.parameters:
        value = given.pop(parameter.name, n.MISSING)
        check_argument(context, node, parameter, value, node.method, "missing_argument")
    options = Options(tuple(parameter.name for parameter in method.parameters))
    for name in given:
        details = {"method": node.method, "argument": name, "options": options}
        fix = Fix("remove", node.step, f"args.{name}", None, {"value": name})
        context.tell(node, "unknown_argument", f"args.{name}", details, fix)


def _wait(context: Context, node: n.Wait) -> None:
    if has_missing(node.seconds):
        context.tell(node, "missing_seconds", "duration")
    else:
        check_value(context, node, node.seconds, "duration", Kind("number", "SEC"), "The time to wait")
        _check_time(context, node, node.seconds, "duration", "The time to wait")


def _wait_until(context: Context, node: n.WaitUntil) -> None:
    check_condition(context, node, node.condition, "until")
    if node.timeout_s is not None:
        check_value(context, node, node.timeout_s, "timeout", NUMBER, "The time limit")
        _check_time(context, node, node.timeout_s, "timeout", "The time limit")


def _check_time(context: Context, node: n.Node, value: object, field: str, subject: str) -> None:
    if isinstance(value, Constant) and isinstance(value.value, int | float) and value.value < 0:
        context.tell(node, "out_of_range", field, {"subject": subject, "range": Span(0, None, "s")})


def _if(context: Context, node: n.If) -> None:
    check_condition(context, node, node.condition, "condition")
    always = constant_value(node.condition)
    if always is False:
        context.tell(node, "never_runs", "condition")
    elif always is True and node.otherwise:
        context.tell(node, "always_true", "condition")


def _while(context: Context, node: n.While) -> None:
    check_condition(context, node, node.condition, "condition")
    if has_missing(node.condition):
        return
    if constant_value(node.condition) is False:
        context.tell(node, "never_runs", "condition")


def _try(context: Context, node: n.Try) -> None:
    """A Try asks for nothing: no kinds mean any, and an empty catch is allowed."""


def _parallel(context: Context, node: n.Parallel) -> None:
    check_branches(context, node)


def _call(context: Context, node: n.Call) -> None:
    function = context.functions.get(node.function)
    if function is None:
        if not any(p.step == node.step and p.code == "unknown_function" for p, _ in context.found):
            context.tell(node, "missing_function", "function")
        return
    given = dict(node.arguments)
    for parameter in function.parameters:
        value = given.get(parameter.name, n.MISSING)
        kind = parameter.type if parameter.type in {"number", "text", "boolean", "object", "device", "place"} else ""
        if value != n.MISSING or parameter.default is None:
            spec = ParameterSpec(parameter.name, kind or "text", parameter.unit)  # type: ignore[arg-type]
            name = function.name or function.method
            check_argument(context, node, spec, value, name, "missing_function_argument", typed=bool(kind))


CHECKS: Mapping[type[n.Node], Callable[..., None]] = {
    n.Move: _move,
    n.Pick: _pick,
    n.Drop: _drop,
    n.Operate: _operate,
    n.Wait: _wait,
    n.WaitUntil: _wait_until,
    n.If: _if,
    n.While: _while,
    n.Parallel: _parallel,
    n.Try: _try,
    n.Call: _call,
}


def _check_roles(context: Context) -> None:
    """Check every robot at the first step that uses it."""
    tree = context.tree
    needed = needed_of_roles((tree.body, *(function.body for function in tree.functions)))
    first: dict[str, n.Node] = {}
    for block, _ in _blocks(tree):
        for node in walk(block):
            if isinstance(node, n.Move | n.Pick | n.Drop):
                first.setdefault(node.role, node)
    for role in tree.roles:
        check_role(context, first[role.name], role, needed[role.name])


def _check_left_over(context: Context, reading: Reading) -> None:
    outline = reading.outline
    if not context.tree.body:
        context.found.append((Problem("empty_program"), 0))
    for step in outline.drafts:
        context.found.append((_left_over(outline, step), 0))
    for step in outline.unknown:
        context.found.append((Problem("unknown_kind", step, "kind", fix=Fix("delete_step", step, "delete", None)), 0))


def _left_over(outline: Outline, step: str) -> Problem:
    """Return what to say of a step that is no part of the program; one that is joined to nothing may be joined."""
    if step in outline.too_deep:
        return Problem("too_deep", step, "place", fix=Fix("delete_step", step, "delete", None))
    branch = "events" if outline.kinds[step] == "on_event" else "body"
    return Problem("draft", step, "place", fix=Fix("join_at_end", step, "place", [PROGRAM, branch]))

"""All checks of a program, in their order; one small function for each kind of node."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import cast

from editor.language.analysis.given import known_of_all
from editor.language.analysis.memo import Memos
from editor.language.checks.bodies import Body, find_bodies
from editor.language.checks.context import Checked, Context
from editor.language.checks.covers import check_cover, check_covers
from editor.language.checks.devices import (
    check_floor,
    check_load_place,
    check_place,
    check_role,
    check_route_length,
)
from editor.language.checks.exits import check_exits
from editor.language.checks.idle import check_idle
from editor.language.checks.library import check_library
from editor.language.checks.limits import check_limited
from editor.language.checks.machine_methods import check_operate
from editor.language.checks.parallel import check_branches, check_needed, check_parallel
from editor.language.checks.paths import check_paths
from editor.language.checks.robot_methods import check_own_method
from editor.language.checks.role_choices import check_choice
from editor.language.checks.updates import check_updates
from editor.language.checks.use import check_use
from editor.language.checks.values import (
    check_argument,
    check_condition,
    check_difference,
    check_kept,
    check_length,
    check_limits,
    check_quantity,
    check_value,
    has_missing,
    range_in,
)
from editor.language.document.catches import KINDS_OF
from editor.language.document.outline import LONGEST_ID, PROGRAM, Outline
from editor.language.expressions import nodes as e
from editor.language.expressions.constant_values import constant_value
from editor.language.expressions.nodes import Expression
from editor.language.expressions.ranges import NOTHING_KNOWN
from editor.language.expressions.value_types import LIST, NUMBER, SECONDS, TEXT, ValueType
from editor.language.messages.diagnostics import Fix, Problem, fix_value
from editor.language.messages.phrases import Options
from editor.language.reading.document import ReadDocument
from editor.language.site.surroundings import Surroundings, what_programs_see
from editor.language.tree import nodes as n
from editor.language.tree.nodes import walk
from editor.language.tree.program import Tree
from editor.language.tree.traversal import first_uses, needed_of_roles
from editor.language.tree.variable_types import type_of_items
from vipo_device.protocol.description import ParameterSpec
from vipo_device.protocol.units import PLAIN


def check(
    reading: ReadDocument,
    tree: Tree,
    surroundings: Surroundings,
    document: object = None,
    memos: Memos | None = None,
) -> Checked:
    """Return the problems of a program, always in the same order, and what the paths through it ask of robots.

    `tree` is the reading's tree with the moves that were put in, `document` what was read; `memos` have what was
    found at the last look.
    """
    context = Context(tree, surroundings, memos=memos, params=reading.outline.params)
    context.zones = frozenset(zone.id for zone in tree.zones)
    found = context.found
    found.extend((problem, 0) for problem in reading.problems)
    already = {(problem.step, problem.field) for problem in reading.problems}
    bodies = find_bodies(context)
    _check_steps(context, bodies)
    context.found = [
        (p, key) for p, key in found if not (p.code.startswith("missing") and (p.step, p.field) in already)
    ]
    _check_roles(context)
    check_exits(context)
    check_paths(context, bodies, CHECKS)
    check_use(context)
    check_idle(context)
    check_limited(context)
    _check_starts(context)
    check_parallel(context)
    check_updates(context)
    check_library(context, document)
    check_floor(context, document)
    check_covers(context)
    _check_left_over(context, reading)
    return Checked(context.found, context.holds)


def _check_steps(context: Context, bodies: list[Body]) -> None:
    """Check every step for itself, with what is known wherever it stands."""
    if context.memos is not None:
        context.memos.begin_checks(_all_around(context))
    for body in bodies:
        body.check(context, CHECKS)
        if body.event is not None:
            event = cast("n.Node", body.event)  # an event has a step as nodes do
            body.enter(context, event)
            context.known = known_of_all(context.tree.parameters, context.changing())
            check_condition(context, event, body.event.condition, "condition")
            context.known = NOTHING_KNOWN
    context.result = ValueType()


def _all_around(context: Context) -> object:
    """Return all that the check of a step looks at beside the step, but for where robots are and other steps."""
    functions = [(f.id, f.name, replace(f, body=())) for f in context.tree.functions]
    roles = [(role.id, role) for role in context.tree.roles]
    return functions, roles, context.zones, what_programs_see(context.surroundings)


def _bodies(tree: Tree) -> tuple[n.Block, ...]:
    return (tree.body, *(function.body for function in tree.functions), *(event.body for event in tree.events))


def _move(context: Context, node: n.Move) -> None:
    if not node.added:
        check_place(context, node, node.to, "to", "missing_destination")
    check_route_length(context, node)


def _pick(context: Context, node: n.Pick) -> None:
    check_load_place(context, node, gives=True)
    check_quantity(context, node)


def _drop(context: Context, node: n.Drop) -> None:
    check_load_place(context, node, gives=False)
    if node.place_field != "target":  # a Pick-and-Drop says what it carries once, with its pick
        check_quantity(context, node)


def _wait(context: Context, node: n.Wait) -> None:
    if has_missing(node.seconds):
        context.report(node, "missing_seconds", "duration")
    else:
        check_value(context, node, node.seconds, "duration", SECONDS, "The time to wait")
        _check_time(context, node, node.seconds, "duration", "The time to wait")


def _wait_until(context: Context, node: n.WaitUntil) -> None:
    check_condition(context, node, node.condition, "until")
    if node.timeout_s is not None:
        check_value(context, node, node.timeout_s, "timeout", SECONDS, "The time limit")
        _check_time(context, node, node.timeout_s, "timeout", "The time limit")


def _check_time(context: Context, node: n.Node, value: Expression, field: str, subject: str) -> None:
    check_limits(context, node, field, range_in(context, value, "SEC"), (0, None), subject, "SEC")


def _limit(context: Context, node: n.Limit) -> None:
    if has_missing(node.seconds):
        context.report(node, "missing_limit", "duration")
    elif check_value(context, node, node.seconds, "duration", SECONDS, "The time limit"):
        if range_in(context, node.seconds, "SEC").most <= 0:
            context.report(node, "limit_not_positive", "duration")
        else:
            _check_time(context, node, node.seconds, "duration", "The time limit")


def _if(context: Context, node: n.If) -> None:
    check_condition(context, node, node.condition, "condition")
    always = constant_value(node.condition)
    if always is False:
        context.report(node, "never_runs", "condition")
    elif always is True and node.otherwise:
        context.report(node, "always_true", "condition")


def _while(context: Context, node: n.While) -> None:
    check_condition(context, node, node.condition, "condition")
    if has_missing(node.condition):
        return
    if constant_value(node.condition) is False:
        context.report(node, "never_runs", "condition")


def _try(context: Context, node: n.Try) -> None:
    """A Try asks for nothing: no kinds mean any, and an empty catch is allowed; but each should be come to."""
    taken: set[str] = set()
    for usual, handler in zip(KINDS_OF, node.handlers, strict=False):
        kinds, field = {*(handler.kinds or n.ERROR_CLASSES)}, KINDS_OF[handler.branch or usual]
        if kinds <= taken:
            context.report(node, "catch_never_reached", field)
        elif handler.kinds and kinds & taken:
            context.report(node, "caught_before", field)
        taken |= kinds


def _parallel(context: Context, node: n.Parallel) -> None:
    check_needed(context, node)
    check_branches(context, node)


def _only_function(context: Context, node: n.Call) -> Fix | None:
    """Return the fix that chooses the program's only function, if the call does not stand in it."""
    if len(context.tree.functions) != 1:
        return None
    only = context.tree.functions[0]
    if any(inner is node for inner in walk(only.body)):
        return None
    return Fix("choose", node.step, "function", only.id, {"value": only.name or only.method})


def _call(context: Context, node: n.Call) -> None:
    function = context.functions.get(node.function)
    if function is None:
        if not any(p.step == node.step and p.code == "unknown_function" for p, _ in context.found):
            context.report(node, "missing_function", "function", fix=_only_function(context, node))
        return
    given = dict(node.arguments)
    for parameter in function.parameters:
        value = given.get(parameter.name, e.MISSING)
        kind = parameter.type if parameter.type in {"number", "text", "boolean", "object", "device", "place"} else ""
        if value != e.MISSING or parameter.default is None:
            unit = parameter.unit or (PLAIN if kind == "number" else "")
            spec = ParameterSpec(parameter.name, kind or "text", unit)  # type: ignore[arg-type]
            name = function.name or function.method
            check_argument(context, node, spec, value, name, "missing_function_argument", typed=bool(kind))
            subject = parameter.name.capitalize()
            check_difference(context, node, value, f"args.{parameter.name}", parameter.unit, subject)

    if node.result and not function.result_type:
        fix = Fix("remove", node.step, "result", None, {"value": node.result})
        context.report(node, "gives_nothing", "result", {"function": function.name or function.method}, fix)


def _repeat(context: Context, node: n.Repeat) -> None:
    if has_missing(node.times):
        context.report(node, "missing_times", "times")
    elif check_value(context, node, node.times, "times", NUMBER, "How many times"):
        times = range_in(context, node.times, "")
        if times.is_fraction or times.most < 0:
            fix = fix_value(node.step, "times", max(0, round(times.most)))
            context.report(node, "times_not_whole", "times", fix=fix)


def _for_each(context: Context, node: n.ForEach) -> None:
    if not node.variable:
        context.report(node, "missing_variable", "variable")
    if node.over is not None:
        check_value(context, node, node.over, "list", LIST, "What the loop goes through")
    elif not node.items or any(map(has_missing, node.items)):
        chosen = context.raw_value(node.step, "list") is not None
        context.report(node, "missing_items", "list" if chosen else "items")
    else:
        check_length(context, node, node.items, "items")
    items = type_of_items(node, context.variables, context.surroundings, context.tree)
    for item in node.items:
        if not has_missing(item):
            check_kept(context, node, item, "items", items if items.type == "number" else ValueType(), "A value")


def _set(context: Context, node: n.Set) -> None:
    if not node.variable:
        context.report(node, "missing_variable", "variable")
    if has_missing(node.value):
        context.report(node, "missing_value", "value")
    else:
        known = context.variables.get(node.variable, ValueType())
        check_kept(context, node, node.value, "value", known, "The variable")


def _ask(context: Context, node: n.Ask) -> None:
    if has_missing(node.question):
        context.report(node, "missing_question", "question")
    else:
        check_value(context, node, node.question, "question", TEXT, "The question")
    if node.answer.type == "choice" and len(node.answer.options) < 2:
        context.report(node, "missing_options", "answer")
    least, most = node.answer.minimum, node.answer.maximum
    if least is not None and most is not None and least > most:
        context.report(node, "no_answer_fits", "answer", {"least": least, "most": most})
    if node.timeout_s is not None:
        check_value(context, node, node.timeout_s, "timeout", SECONDS, "The time limit")
        _check_time(context, node, node.timeout_s, "timeout", "The time limit")


def _notify(context: Context, node: n.Notify) -> None:
    if has_missing(node.message):
        context.report(node, "missing_message", "message")
    else:
        check_value(context, node, node.message, "message", TEXT, "The message")


def _fail(context: Context, node: n.Fail) -> None:
    if has_missing(node.message):
        context.report(node, "missing_reason", "message")
    else:
        check_value(context, node, node.message, "message", TEXT, "The message")


def _return(context: Context, node: n.Return) -> None:
    if node.value is not None:
        if has_missing(node.value):
            context.report(node, "missing_value", "value")
        else:
            check_value(context, node, node.value, "value", context.result, "The result")
            check_difference(context, node, node.value, "value", context.result.unit, "The result")


CHECKS: Mapping[type[n.Node], Callable[..., None]] = {
    n.Move: _move,
    n.Pick: _pick,
    n.Drop: _drop,
    n.Cover: check_cover,
    n.Operate: check_operate,
    n.Perform: check_own_method,
    n.Wait: _wait,
    n.WaitUntil: _wait_until,
    n.If: _if,
    n.While: _while,
    n.Parallel: _parallel,
    n.Try: _try,
    n.Limit: _limit,
    n.Call: _call,
    n.Repeat: _repeat,
    n.ForEach: _for_each,
    n.Set: _set,
    n.Ask: _ask,
    n.Notify: _notify,
    n.Fail: _fail,
    n.Return: _return,
}
"""Of each kind of node that can be wrong in itself. What a Release leaves is checked along the paths to it."""


def _check_roles(context: Context) -> None:
    """Check every robot at the first step that uses it."""
    tree = context.tree
    needed, first = needed_of_roles(tree, tree.functions), first_uses(tree, tree.functions)
    for role in tree.roles:
        check_role(context, first[role.name], role, needed[role.name])
        check_choice(context, first[role.name], role)


def _check_starts(context: Context) -> None:
    """What starts a program by itself asks nobody for the values of its parameters."""
    missing = tuple(parameter.name for parameter in context.tree.parameters if parameter.default is None)
    for event in context.tree.events if missing else ():
        if event.starts == "run":
            context.report_step(event.step, "starts_unasked", "starts", {"parameters": Options(missing, "and")})


def _check_left_over(context: Context, reading: ReadDocument) -> None:
    outline = reading.outline
    if not context.tree.body:
        context.found.append((Problem("empty_program"), 0))
    for step in outline.drafts:
        context.found.append((_left_over(outline, step), 0))
    for step in outline.kinds:
        if len(step) > LONGEST_ID:
            context.found.append((_long_id(step), 0))
    for step in outline.unknown:
        context.found.append((Problem("unknown_kind", step, "kind", fix=Fix("delete_step", step, "delete", None)), 0))


def _long_id(step: str) -> Problem:
    return Problem("long_id", step, "id", {"most": LONGEST_ID}, Fix("delete_step", step, "delete", None))


def _left_over(outline: Outline, step: str) -> Problem:
    """Return what to say of a step that is no part of the program; one that is joined to nothing may be joined."""
    if step in outline.too_deep:
        return Problem("too_deep", step, "place", fix=Fix("delete_step", step, "delete", None))
    branch = "events" if outline.kinds[step] == "on_event" else "body"
    return Problem("draft", step, "place", fix=Fix("join_at_end", step, "place", [PROGRAM, branch]))

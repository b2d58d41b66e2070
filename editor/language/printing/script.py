"""Tree → script: Python text in the paper's shape."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from editor.language.analysis.memo import Memo
from editor.language.expressions.declarations import write_type
from editor.language.expressions.names import RESERVED_ATTRIBUTES
from editor.language.expressions.nodes import Zone
from editor.language.expressions.printing import quote, scalar_text
from editor.language.printing.steps import PRINTERS
from editor.language.printing.writer import CHOSEN, Printer, point_text
from editor.language.site.surroundings import Surroundings, what_programs_see
from editor.language.tree.nodes import DRIVES, Block, Event
from editor.language.tree.program import Function, Parameter, Role, Tree
from editor.language.tree.robots import is_robot
from editor.language.tree.variables import local_variables, program_variables
from editor.language.tree.zones import rule_text


@dataclass(frozen=True, slots=True)
class Script:
    """A printed script: each line's step (empty for glue) and the line of each node, by the node's identity."""

    text: str
    lines: tuple[str, ...]
    line_of: Mapping[int, int]


def print_tree(
    tree: Tree,
    surroundings: Surroundings,
    numbers: Mapping[str, str],
    zone_names: Mapping[str, str] | None = None,
    memo: Memo | None = None,
) -> Script:
    """Return the script of a tree whose steps have these numbers; zones are called by `zone_names`, by id.

    `memo` has what was printed last.
    """
    names = {role.name for role in tree.roles} | {function.method for function in tree.functions}
    shared = program_variables(tree)
    taken = RESERVED_ATTRIBUTES | names | shared | {parameter.name for parameter in tree.parameters}
    printer = Printer(tree, surroundings, numbers, set(taken), PRINTERS, zone_names=zone_names or {}, memo=memo)
    if memo is not None:
        roles = [(role.name, role.device, role.can) for role in tree.roles]
        memo.begin((what_programs_see(surroundings), roles))
    printer.line(0, "class Task(object):")
    _print_method(printer, "def new_task(self):", tree.body)
    for function in tree.functions:
        own = (*(parameter.name for parameter in function.parameters), *local_variables(tree, function))
        _print_method(printer, _heading(function), function.body, own)
    for event in tree.events:
        _print_method(printer, f"def {_event_method(printer, event)}(self):", event.body, step=event.step)
    _print_run(printer)
    return Script("\n".join(printer.texts) + "\n", tuple(printer.steps), printer.places)


def _heading(function: Function) -> str:
    result = write_type(function.result_type, function.result_unit)
    given = ", ".join(["self", *_signature(function.parameters)])
    return f"def {function.method}({given}) -> {result}:" if result else f"def {function.method}({given}):"


def _event_method(printer: Printer, event: Event) -> str:
    return f"when_{printer.numbers[event.step]}"


def _print_method(printer: Printer, heading: str, body: Block, own: tuple[str, ...] = (), step: str = "") -> None:
    """Print a method that calls some names its own, and behind it those of the parallel branches in it."""
    left: list[tuple[str, tuple[str, ...], Block]] = [(heading, own, body)]
    while left:
        first_line, printer.locals, block = left.pop()
        printer.line(1, first_line, step)
        printer.branches, step = [], ""
        printer.block(block, 2)
        printer.line(0, "")
        branches = [(f"def {name}({', '.join(['self', *seen])}):", seen, b) for name, seen, b in printer.branches]
        left.extend(reversed(branches))


def _signature(parameters: tuple[Parameter, ...]) -> list[str]:
    """Python wants a default behind every parameter that follows one with a default; None says that it has none."""
    written: list[str] = []
    bare = True
    for parameter in parameters:
        kind = write_type(parameter.type, parameter.unit)
        name = f"{parameter.name}: {kind}" if kind else parameter.name
        bare = bare and parameter.default is None
        default = f" = {scalar_text(parameter.default)}" if kind else f"={scalar_text(parameter.default)}"
        written.append(name if bare else f"{name}{default}")
    return written


def _print_run(printer: Printer) -> None:
    printer.line(1, "def run(self, ctx):")
    printer.locals = ()
    watched = [(event, printer.value(event.condition)) for event in printer.tree.events]
    for parameter in printer.tree.parameters:
        printer.line(2, f"self.{parameter.name} = ctx.parameter({_given_to_parameter(parameter)})")
    driven = printer.tree.roles_of(*DRIVES)
    for role in printer.tree.roles:
        sure = role.name in driven or is_robot(printer.surroundings, role.device)
        printer.line(2, f"self.{role.name} = {_binding(printer, role, sure=sure)}")
    for key, attribute in printer.attributes.items():
        get = f"ctx.get({quote(key)})" if isinstance(key, str) else f"ctx.place({quote(key.place or '')})"
        printer.line(2, f"{attribute} = {get}")
    _print_zones(printer)
    for event, condition in watched:
        printer.places[id(event)] = len(printer.steps) + 1
        when = "ctx.start_when" if event.starts == "run" else "ctx.when"
        printer.line(2, f"{when}({condition}, self.{_event_method(printer, event)})", event.step)
    printer.line(2, "self.new_task()")


def _print_zones(printer: Printer) -> None:
    """Print the zones as they are drawn: first those that steps ask about, then the others by id."""
    drawn = {zone.id: zone for zone in printer.tree.zones}
    for zone_id in drawn:
        printer.zone(zone_id)
    for zone_id, attribute in printer.zones.items():
        zone = drawn.get(zone_id)
        printer.line(2, f"{attribute} = ctx.zone({quote(zone_id) if zone is None else _drawn(zone)})")


def _drawn(zone: Zone) -> str:
    """Return `"z1", [(0, 0), (3, 0), (3, 2)], rule="slow", speed=0.3, name="Ramp"`; the name where it is not the id."""
    points = ", ".join(map(point_text, zone.points))
    speed = "" if zone.speed_m_s is None else f", speed={scalar_text(zone.speed_m_s)}"
    door = f", door={quote(zone.door) if zone.door else None}" if zone.rule == "door" else ""
    name = "" if zone.name == zone.id else f", name={quote(zone.name)}"
    return f"{quote(zone.id)}, [{points}], rule={quote(rule_text(zone.rule))}{door}{speed}{name}"


def _given_to_parameter(parameter: Parameter) -> str:
    """Return `"count", 0, Number`; what is not known is left out at the end."""
    kind = write_type(parameter.type, parameter.unit)
    if kind:
        return f"{quote(parameter.name)}, {scalar_text(parameter.default)}, {kind}"
    return quote(parameter.name) + ("" if parameter.default is None else f", {scalar_text(parameter.default)}")


def _binding(printer: Printer, role: Role, *, sure: bool) -> str:
    """Return what gives a role its robot; it says that it is one where neither the steps nor the site tell."""
    if role.device is None:
        given = [*map(quote, role.can)]
        if role.where is not None:
            printer.chosen = role.name
            given.append(f"where=lambda {CHOSEN}: {printer.value(role.where)}")
        return f"ctx.any({', '.join(given)})"
    at = "" if role.at is None else f", at={quote(role.at)}"
    mark = "" if sure else ', kind="robot"'
    return f"ctx.get({quote(role.device)}{at}{mark})"

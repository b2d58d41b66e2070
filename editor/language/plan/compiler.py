"""Tree → plan: flat instructions for the run machine; one small function for each kind of node."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace
from typing import Any, get_args

from editor.language.expressions import nodes as e
from editor.language.expressions.unit_conversion import into_unit
from editor.language.expressions.values import rename_roles
from editor.language.plan import control_flow as flow
from editor.language.plan import instructions as p
from editor.language.plan.builder import Builder, Compiler, Leaves
from editor.language.plan.choices import binding_of
from editor.language.site.surroundings import Surroundings
from editor.language.tree import nodes as n
from editor.language.tree.program import Function, Tree
from editor.language.tree.robots import described_alike, robots_for
from editor.language.tree.variable_types import types_in_function, types_in_program
from editor.language.tree.variables import local_variables, program_variables
from vipo_device.protocol.description import Description


def _move(builder: Builder, node: n.Move, leaves: Leaves) -> None:
    builder.add(p.Move(node.role, builder.place(node.to), node.route), node, leaves=leaves)


def _pick(builder: Builder, node: n.Pick, leaves: Leaves) -> None:
    _serve(builder, node, "dispense", gives=True)
    at, thing, quantity = builder.place(node.at), builder.value(node.object), builder.value(node.quantity)
    builder.add(p.Pick(node.role, at, thing, quantity), node, leaves=leaves)


def _drop(builder: Builder, node: n.Drop, leaves: Leaves) -> None:
    _serve(builder, node, "accept", gives=False)
    at, thing, quantity = builder.place(node.at), builder.value(node.object), builder.value(node.quantity)
    builder.add(p.Drop(node.role, at, thing, quantity), node, leaves=leaves)


def _serve(builder: Builder, node: n.Pick | n.Drop, method: str, *, gives: bool) -> None:
    """A machine that must act for it does so when the robot stands there, before anything is taken or left.

    Of the machines that a variable may hold some need not act: then the run goes by which of them it is.
    """
    devices = builder.devices(node.at)
    acting = [device for device in devices if builder.can(device, method) and _handles(device, node, gives=gives)]
    if not acting:
        return
    values = {"object": builder.value(node.object), "value": builder.value(node.quantity)}
    call = p.Call(builder.place(node.at), method, values, node.role)
    if node.at.value is None or len(acting) == len(devices):
        builder.add(call, node)
        return
    branch = builder.add(p.Jump(0), node)
    builder.add(call, node)
    acts = e.Operation("in", (builder.value(node.at.value), e.Constant(tuple(device.id for device in acting))))
    builder.patch(branch, p.Branch(acts, builder.here()))


def _handles(device: Description, node: n.Pick | n.Drop, *, gives: bool) -> bool:
    """Tell whether a machine gives, or takes, what is carried; true where only the run tells what that is."""
    return not isinstance(node.object, e.Constant) or node.object.value in (device.gives if gives else device.takes)


def _operate(builder: Builder, node: n.Operate, leaves: Leaves) -> None:
    units = builder.units_taken(node.device, node.method)
    arguments = {name: builder.value(value, units.get(name, "")) for name, value in node.arguments}
    builder.add(p.Call(builder.place(node.device), node.method, arguments), node, leaves=leaves)


def _perform(builder: Builder, node: n.Perform, leaves: Leaves) -> None:
    role = next(role for role in builder.tree.roles if role.name == node.role)
    method = described_alike(robots_for(builder.surroundings, role.device, role.can), node.method)
    units = {parameter.name: parameter.unit for parameter in method.parameters} if method else {}
    arguments = {name: builder.value(value, units.get(name, "")) for name, value in node.arguments}
    builder.add(p.Perform(node.role, node.method, arguments), node, leaves=leaves)


def _release(builder: Builder, node: n.Release, leaves: Leaves) -> None:
    builder.add(p.Release(node.role), node, leaves=leaves)


def _cover(builder: Builder, node: n.Cover, leaves: Leaves) -> None:
    builder.add(p.Cover(node.role, node.zone, builder.given(node.lane_m, "M")), node, leaves=leaves)


def _wait(builder: Builder, node: n.Wait, leaves: Leaves) -> None:
    builder.add(p.Wait(builder.value(node.seconds, "SEC")), node, leaves=leaves)


def _wait_until(builder: Builder, node: n.WaitUntil, leaves: Leaves) -> None:
    condition, timeout = builder.value(node.condition), builder.given(node.timeout_s, "SEC")
    builder.add(p.WaitUntil(condition, timeout), node, leaves=leaves)


def _call(builder: Builder, node: n.Call, leaves: Leaves) -> None:
    function = builder.functions[node.function]
    given = dict(node.arguments)
    arguments: dict[str, e.Expression] = {}
    for parameter in function.parameters:
        value = given.get(parameter.name)
        arguments[parameter.name] = (
            e.Constant(parameter.default) if value is None else builder.value(value, parameter.unit)
        )
    result = builder.name(node.result) if node.result else None
    invoke = p.Invoke(0, function.name or function.method, arguments, result, builder.is_shared(node.result))
    settle = _settle(builder, node.result, function.result_unit)
    address = builder.add(invoke, node, enters=(node.step,), leaves=() if settle else leaves)
    builder.calls.append((address, node.function))
    if settle:
        builder.add(settle, node, leaves=leaves)


def _settle(builder: Builder, variable: str, unit: str) -> p.Assign | None:
    """Return what brings a result that was given in this unit into that of its variable, if it is another one."""
    result = e.Variable(builder.name(variable))
    settled = into_unit(result, unit, builder.unit_of(variable)) if variable else result
    return None if settled is result else p.Assign(result.name, settled, builder.is_shared(variable))


def _set(builder: Builder, node: n.Set, leaves: Leaves) -> None:
    value = builder.value(node.value, builder.unit_of(node.variable))
    assign = p.Assign(builder.name(node.variable), value, builder.is_shared(node.variable))
    builder.add(assign, node, enters=(node.step,), leaves=leaves)


def _ask(builder: Builder, node: n.Ask, leaves: Leaves) -> None:
    result, shared = builder.name(node.variable) or None, builder.is_shared(node.variable)
    question, timeout = builder.value(node.question), builder.given(node.timeout_s, "SEC")
    settle = _settle(builder, node.variable, node.answer.unit)
    ask = p.AskPerson(question, node.answer, result, shared, timeout)
    builder.add(ask, node, enters=(node.step,), leaves=() if settle else leaves)
    if settle:
        builder.add(settle, node, leaves=leaves)


def _notify(builder: Builder, node: n.Notify, leaves: Leaves) -> None:
    builder.add(p.Notify(builder.value(node.message), node.level), node, enters=(node.step,), leaves=leaves)


def _fail(builder: Builder, node: n.Fail, leaves: Leaves) -> None:
    builder.add(p.Fail(builder.value(node.message)), node, enters=(node.step,), leaves=leaves)


def _end(builder: Builder, node: n.End, leaves: Leaves) -> None:
    builder.add(p.End(early=True), node, enters=(node.step,), leaves=leaves)


COMPILERS: Mapping[type[n.Node], Compiler] = {
    n.Move: _move,
    n.Pick: _pick,
    n.Drop: _drop,
    n.Operate: _operate,
    n.Perform: _perform,
    n.Cover: _cover,
    n.Release: _release,
    n.Wait: _wait,
    n.WaitUntil: _wait_until,
    n.If: flow.compile_if,
    n.While: flow.compile_while,
    n.Repeat: flow.compile_repeat,
    n.ForEach: flow.compile_for_each,
    n.Parallel: flow.compile_parallel,
    n.Try: flow.compile_try,
    n.Limit: flow.compile_limit,
    n.Call: _call,
    n.Set: _set,
    n.Ask: _ask,
    n.Notify: _notify,
    n.End: _end,
    n.Fail: _fail,
    n.Return: flow.compile_return,
    n.Break: flow.compile_break,
    n.Continue: flow.compile_continue,
}


def compile_tree(tree: Tree, surroundings: Surroundings, line_of: Mapping[int, int]) -> p.Plan:
    """Return the plan of a tree that the checks found no error in; `line_of` gives the script line of each node."""
    shared = program_variables(tree)
    types = types_in_program(tree, shared, surroundings)
    builder = Builder(tree, surroundings, line_of, COMPILERS, shared, types)
    builder.block(tree.body)
    builder.add(p.End())
    entries = {function.method: _function(builder, function) for function in tree.functions}
    builder.types, builder.own, builder.function = types, frozenset(), None
    events = tuple(_event(builder, event) for event in tree.events)
    for address, method in builder.calls:
        invoke = builder.instructions[address].do
        assert isinstance(invoke, p.Invoke)
        builder.patch(address, replace(invoke, entry=entries[method]))
    roles = {role.id or role.name: binding_of(role, surroundings) for role in tree.roles}
    parameters = {parameter.name: parameter.default for parameter in tree.parameters}
    instructions, events = _with_role_ids(tree, builder.instructions, events)
    return p.Plan(instructions, roles, parameters, tuple(sorted(builder.readings)), events=events, zones=tree.zones)


def _function(builder: Builder, function: Function) -> int:
    """Compile a function and return where it begins."""
    entry = builder.here()
    outside, builder.types = (
        builder.types,
        types_in_function(builder.tree, function, builder.types, builder.surroundings),
    )
    own = (*(parameter.name for parameter in function.parameters), *local_variables(builder.tree, function))
    builder.own, builder.function = frozenset(own), function
    builder.block(function.body)
    builder.add(p.Return())
    builder.types = outside
    return entry


def _event(builder: Builder, event: n.Event) -> p.EventEntry:
    """Compile the body of an event."""
    entry, starts = builder.here(), event.starts
    builder.block(event.body)
    builder.add(p.EventEnd(), event, leaves=(event.step,))
    return p.EventEntry(event.step, entry, builder.value(event.condition), "run" if starts == "run" else "branch")


Compiled = tuple[tuple[p.Instruction, ...], tuple[p.EventEntry, ...]]


def _with_role_ids(tree: Tree, instructions: list[p.Instruction], events: tuple[p.EventEntry, ...]) -> Compiled:
    """The plan knows roles by their ids in the document, the script by their names."""
    renamed = {role.name: role.id for role in tree.roles if role.id and role.id != role.name}
    if not renamed:
        return tuple(instructions), events
    known = tuple(replace(event, condition=rename_roles(event.condition, renamed)) for event in events)
    return tuple(_rename(instruction, renamed) for instruction in instructions), known


def _rename(instruction: p.Instruction, renamed: Mapping[str, str]) -> p.Instruction:
    do: Any = instruction.do
    match do:
        case p.Move() | p.Pick() | p.Drop() | p.Cover() | p.Perform() | p.Release():
            do = replace(do, role=renamed.get(do.role, do.role))
        case p.Call(serves=str(role)):
            do = replace(do, serves=renamed.get(role, role))
    changed = {name: _with_roles(getattr(do, name), renamed) for name in _EXPRESSIONS.get(type(do), ())}
    return replace(instruction, do=replace(do, **changed)) if changed or do is not instruction.do else instruction


_EXPRESSIONS: Mapping[type[p.Action], tuple[str, ...]] = {
    action: tuple(field.name for field in fields(action) if "Expression" in str(field.type))
    for action in get_args(p.Action)
}
"""The fields of instructions that hold values."""


def _with_roles(value: Any, renamed: Mapping[str, str]) -> Any:
    """Return a value, or values by name, in which robots go by the ids of their roles."""
    if isinstance(value, Mapping):
        return {name: rename_roles(inner, renamed) for name, inner in value.items()}
    return None if value is None else rename_roles(value, renamed)

"""Tree → plan: flat instructions for the run machine; one small function for each construct."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

from editor.language import nodes as n
from editor.language import plan as p
from editor.language.surroundings import Surroundings
from editor.language.values import parts_of
from editor.language.walking import walk
from registry.capability import Description


@dataclass(slots=True)
class _Builder:
    """The instructions so far; jumps are written when their address is known."""

    tree: n.Tree
    surroundings: Surroundings
    line_of: Mapping[int, int]
    instructions: list[p.Instruction] = field(default_factory=list)
    calls: list[tuple[int, str]] = field(default_factory=list)
    """Addresses of calls, with the functions that they call; filled in at the end."""

    def here(self) -> int:
        return len(self.instructions)

    def add(
        self, do: p.Action, node: n.Node | None = None, enters: tuple[str, ...] = (), leaves: tuple[str, ...] = ()
    ) -> int:
        """Add an instruction and return its address."""
        step, line = ("", 0) if node is None else (node.step, self.line_of.get(id(node), 0))
        self.instructions.append(p.Instruction(do, step, line, enters, leaves))
        return len(self.instructions) - 1

    def patch(self, address: int, do: p.Action) -> None:
        """Write an instruction again, now that its target is known."""
        self.instructions[address] = replace(self.instructions[address], do=do)

    def block(self, block: n.Block) -> None:
        for index, node in enumerate(block):
            last = index + 1 == len(block) or block[index + 1].step != node.step
            COMPILERS[type(node)](self, node, (node.step,) if last else ())

    def leave(self, node: n.Node) -> None:
        """Mark a composite step as over, where its ways out meet."""
        self.add(p.Jump(self.here() + 1), node, leaves=(node.step,))

    def describe(self, place: p.PlaceRef) -> Description | None:
        facts = self.surroundings.devices.get(place.device or "")
        return None if facts is None else facts.description


Leaves = tuple[str, ...]


def _move(builder: _Builder, node: n.Move, leaves: Leaves) -> None:
    builder.add(p.Move(node.role, node.to, node.route), node, leaves=leaves)


def _pick(builder: _Builder, node: n.Pick, leaves: Leaves) -> None:
    _serve(builder, node, "dispense", gives=True)
    builder.add(p.Pick(node.role, node.at, node.object, node.quantity), node, leaves=leaves)


def _drop(builder: _Builder, node: n.Drop, leaves: Leaves) -> None:
    _serve(builder, node, "accept", gives=False)
    builder.add(p.Drop(node.role, node.at, node.object, node.quantity), node, leaves=leaves)


def _serve(builder: _Builder, node: n.Pick | n.Drop, method: str, *, gives: bool) -> None:
    """A machine that must act for it does so when the robot stands there, before anything is taken or left."""
    device = builder.describe(node.at)
    if device is None or device.method(method) is None:
        return
    things = device.gives if gives else device.takes
    if isinstance(node.object, p.Constant) and node.object.value not in things:
        return
    builder.add(p.Call(node.at, method, {"object": node.object, "value": node.quantity}, node.role), node)


def _operate(builder: _Builder, node: n.Operate, leaves: Leaves) -> None:
    builder.add(p.Call(node.device, node.method, dict(node.arguments)), node, leaves=leaves)


def _wait(builder: _Builder, node: n.Wait, leaves: Leaves) -> None:
    builder.add(p.Wait(node.seconds), node, leaves=leaves)


def _wait_until(builder: _Builder, node: n.WaitUntil, leaves: Leaves) -> None:
    builder.add(p.WaitUntil(node.condition, node.timeout_s), node, leaves=leaves)


def _if(builder: _Builder, node: n.If, leaves: Leaves) -> None:
    branch = builder.add(p.Jump(0), node, enters=(node.step,))
    builder.block(node.then)
    over = builder.add(p.Jump(0)) if node.otherwise else -1
    builder.patch(branch, p.Branch(node.condition, builder.here()))
    builder.block(node.otherwise)
    if node.otherwise:
        builder.patch(over, p.Jump(builder.here()))
    builder.leave(node)


def _while(builder: _Builder, node: n.While, leaves: Leaves) -> None:
    branch = builder.add(p.Jump(0), node, enters=(node.step,))
    builder.block(node.body)
    builder.add(p.Jump(branch))
    builder.patch(branch, p.Branch(node.condition, builder.here()))
    builder.leave(node)


def _parallel(builder: _Builder, node: n.Parallel, leaves: Leaves) -> None:
    fork = builder.add(p.Jump(0), node, enters=(node.step,), leaves=leaves)
    entries: list[int] = []
    for branch in node.branches:
        entries.append(builder.here())
        builder.block(branch)
        builder.add(p.Join())
    builder.patch(fork, p.Fork(tuple(entries), builder.here()))


def _try(builder: _Builder, node: n.Try, leaves: Leaves) -> None:
    begin = builder.add(p.Jump(0), node, enters=(node.step,))
    builder.block(node.body)
    builder.add(p.TryEnd())
    over = builder.add(p.Jump(0))
    builder.patch(begin, p.TryBegin(builder.here(), node.kinds))
    builder.block(node.catch)
    builder.patch(over, p.Jump(builder.here()))
    builder.leave(node)


def _call(builder: _Builder, node: n.Call, leaves: Leaves) -> None:
    function = next(f for f in builder.tree.functions if f.method == node.function)
    given = dict(node.arguments)
    defaults = {q.name: p.Constant(q.default) for q in function.parameters if q.default is not None}
    arguments = {q.name: given.get(q.name) or defaults[q.name] for q in function.parameters}
    name = function.name or function.method
    address = builder.add(p.Invoke(0, name, arguments), node, enters=(node.step,), leaves=leaves)
    builder.calls.append((address, node.function))


COMPILERS: Mapping[type[n.Node], Callable[..., None]] = {
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


def compile_tree(tree: n.Tree, surroundings: Surroundings, line_of: Mapping[int, int]) -> p.Plan:
    """Return the plan of a tree that the checks found no error in; `line_of` gives the script line of each node."""
    builder = _Builder(tree, surroundings, line_of)
    builder.block(tree.body)
    builder.add(p.End())
    entries: dict[str, int] = {}
    for function in tree.functions:
        entries[function.method] = builder.here()
        builder.block(function.body)
        builder.add(p.Return())
    for address, method in builder.calls:
        invoke = builder.instructions[address].do
        assert isinstance(invoke, p.Invoke)
        builder.patch(address, replace(invoke, entry=entries[method]))
    roles = {role.id or role.name: p.RoleBinding(role.id or role.name, role.device, role.can) for role in tree.roles}
    parameters = {parameter.name: parameter.default for parameter in tree.parameters}
    return p.Plan(_with_role_ids(tree, builder.instructions), roles, parameters, _readings(tree))


def _with_role_ids(tree: n.Tree, instructions: list[p.Instruction]) -> tuple[p.Instruction, ...]:
    """The plan knows roles by their ids in the document, the script by their names."""
    renamed = {role.name: role.id for role in tree.roles if role.id and role.id != role.name}
    if not renamed:
        return tuple(instructions)
    return tuple(_rename(instruction, renamed) for instruction in instructions)


def _rename(instruction: p.Instruction, renamed: Mapping[str, str]) -> p.Instruction:
    match instruction.do:
        case p.Move(role=role) | p.Pick(role=role) | p.Drop(role=role):
            return replace(instruction, do=replace(instruction.do, role=renamed.get(role, role)))
        case p.Call(serves=str(role)):
            return replace(instruction, do=replace(instruction.do, serves=renamed.get(role, role)))
    return instruction


def _readings(tree: n.Tree) -> tuple[tuple[str, str], ...]:
    """Return the (device, property) pairs that the program looks at, sorted."""
    found: set[tuple[str, str]] = set()
    for block in (tree.body, *(function.body for function in tree.functions)):
        for node in walk(block):
            for expression in expressions_of(node):
                found.update(_pairs(expression))
    return tuple(sorted(found))


def _pairs(expression: p.Expression) -> set[tuple[str, str]]:
    return {
        (str(part.device.value), part.property)
        for part in parts_of(expression)
        if isinstance(part, p.Reading) and isinstance(part.device, p.Constant)
    }


def expressions_of(node: n.Node) -> tuple[p.Expression, ...]:
    """Return the values of a node."""
    match node:
        case n.Pick(object=thing, quantity=quantity) | n.Drop(object=thing, quantity=quantity):
            return (thing, quantity)
        case n.Operate(arguments=arguments) | n.Call(arguments=arguments):
            return tuple(value for _, value in arguments)
        case n.Wait(seconds=seconds):
            return (seconds,)
        case n.WaitUntil(condition=condition, timeout_s=timeout):
            return (condition,) if timeout is None else (condition, timeout)
        case n.If(condition=condition) | n.While(condition=condition):
            return (condition,)
    return ()

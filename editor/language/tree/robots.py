"""The robots that may take a role, what they do beside moving and carrying, and that each of them has a role."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial

from editor.language.expressions.names import RELEASE, RESERVED_ATTRIBUTES, ROBOT_METHODS, member_name, unique_name
from editor.language.site.surroundings import Surroundings
from editor.language.tree.nodes import COMPOSITES, Block, Node, Operate, Perform, Role, Tree, blocks_of, with_blocks
from editor.language.tree.traversal import in_reading_order
from editor.language.tree.variables import program_variables
from vipo_device.protocol.description import Description, MethodSpec

Robots = tuple[Description, ...]


def robots_for(surroundings: Surroundings, device: str | None, can: Sequence[str]) -> Robots:
    """Return the robots that can take a role, sorted by id: that of a bound one, or all that can do this much."""
    if device is not None:
        facts = surroundings.devices.get(device)
        return () if facts is None else (facts.description,)
    approved = (facts.description for facts in surroundings.devices.values() if facts.lifecycle == "approved")
    able = (d for d in approved if d.kind == "robot" and all(d.method(name) for name in can))
    return tuple(sorted(able, key=lambda description: description.id))


def is_robot(surroundings: Surroundings, device: str | None) -> bool:
    """Tell whether a device is known to be a robot."""
    facts = surroundings.devices.get(device or "")
    return facts is not None and facts.description.kind == "robot"


def own_methods(robots: Robots) -> tuple[str, ...]:
    """Return the methods that some of the robots offer beside those that are steps of their own."""
    found = dict.fromkeys(method.name for robot in robots for method in robot.methods)
    return tuple(name for name in found if name not in ROBOT_METHODS)


def described_alike(robots: Robots, name: str) -> MethodSpec | None:
    """Return a method that all of the robots have and describe with the same parameters, as the first does."""
    methods = [robot.method(name) for robot in robots]
    first = methods[0] if methods else None
    if first is None:
        return None
    alike = all(method is not None and _signature(method) == _signature(first) for method in methods)
    return first if alike else None


def _signature(method: MethodSpec) -> object:
    """Return what a caller must know of a method; within which limits the values lie is each robot's own."""
    return [(p.name, p.type, p.unit, p.required) for p in method.parameters]


def short_name(robots: Robots, name: str) -> str | None:
    """Return what the script calls a method of these robots; None where only its full name is clear."""
    if name in ROBOT_METHODS or described_alike(robots, name) is None:
        return None
    names = {member_name(name, [method.name for method in robot.methods]) for robot in robots}
    return names.pop() if len(names) == 1 and names != {RELEASE} else None


def methods_called(robots: Robots, short: str) -> tuple[str, ...]:
    """Return the methods of some of the robots that the script could mean by a name; one, where it is clear."""
    names = own_methods(robots)
    return tuple(name for name in names if short_name(tuple(r for r in robots if r.method(name)), name) == short)


def with_roles_of_robots(tree: Tree, surroundings: Surroundings) -> Tree:
    """Return the tree in which every Operate of a robot is done by a role; one that is bound to the robot already."""
    if not tree.holds(Operate):
        return tree
    bodies = (tree.body, *(f.body for f in tree.functions), *(event.body for event in tree.events))
    operated = (node.device.device for body in bodies for node in tree.walked(body) if isinstance(node, Operate))
    robots = dict.fromkeys(device for device in operated if device and is_robot(surroundings, device))
    if not robots:
        return tree
    roles = {role.device: role for role in reversed(tree.roles) if role.device is not None}
    taken = {*RESERVED_ATTRIBUTES, *(role.name for role in tree.roles), *(f.method for f in tree.functions)}
    taken |= {*program_variables(tree), *(parameter.name for parameter in tree.parameters)}
    for robot in robots:
        if robot not in roles:
            name = unique_name(surroundings.devices[robot].description.name, taken)
            taken.add(name)
            roles[robot] = Role(name, robot, id=name)
    names = {robot: roles[robot].name for robot in robots}
    functions = tuple(replace(f, body=_with_roles(f.body, names)) for f in tree.functions)
    events = tuple(replace(event, body=_with_roles(event.body, names)) for event in tree.events)
    added = tuple(roles[robot] for robot in robots if roles[robot] not in tree.roles)
    changed = Tree(_with_roles(tree.body, names), functions, (*tree.roles, *added), tree.parameters, events)
    return in_reading_order(changed)


def _with_roles(block: Block, names: Mapping[str, str]) -> Block:
    return tuple(map(partial(_with_role, names=names), block))


def _with_role(node: Node, names: Mapping[str, str]) -> Node:
    """Return a step whose robot has a role, and the step itself where there is none in it."""
    if isinstance(node, Operate):
        role = names.get(node.device.device or "")
        return node if role is None else Perform(role, node.method, node.arguments, node.step)
    if node.__class__ not in COMPOSITES:
        return node
    before = blocks_of(node)
    after = tuple(_with_roles(block, names) for block in before)
    return node if all(map(_is_same, before, after)) else with_blocks(node, after)


def _is_same(before: Block, after: Block) -> bool:
    return all(one is other for one, other in zip(before, after, strict=True))

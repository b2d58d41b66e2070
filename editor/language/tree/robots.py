"""The robots that may take a role, what they do beside moving and carrying, and that each of them has a role."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial

from editor.language.constructs.script_form import OF_THE_FLEET
from editor.language.expressions.names import (
    RESERVED_ATTRIBUTES,
    ROBOT_METHODS,
    member_name,
    member_names,
    unique_name,
)
from editor.language.expressions.value_types import plain_type
from editor.language.site.surroundings import Counting, HeldDevice, Surroundings, Told
from editor.language.tree.held_devices import Held
from editor.language.tree.nodes import COMPOSITES, Block, Node, Operate, Perform, blocks_of, with_blocks
from editor.language.tree.program import Role, Tree
from editor.language.tree.traversal import in_reading_order
from editor.language.tree.variables import program_variables
from vipo_device.protocol.description import Description, MethodSpec, PropertySpec
from vipo_device.protocol.units import UNSAID, declared_unit

Robots = tuple[Description, ...]
Devices = tuple[Description, ...]


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


def units_taken(devices: Sequence[Description], name: str) -> dict[str, Counting]:
    """Return in which units the devices that have a method take its numbers, by the names of its parameters."""
    taken: dict[str, Counting] = {}
    for device in devices:
        method = device.method(name)
        for parameter in method.parameters if method is not None else ():
            if parameter.type == "number":
                one = device, declared_unit(parameter.unit)
                taken[parameter.name] = _also(taken.get(parameter.name), one)
    return taken


def joined_spec(specs: Sequence[PropertySpec]) -> PropertySpec | None:
    """Return what several devices say together of one property; None where they differ in kind or unit."""
    first = specs[0] if specs else None
    if first is None or all(spec == first for spec in specs):
        return first
    if len({(plain_type(spec.type), declared_unit(spec.unit)) for spec in specs}) > 1:
        return None
    least = [spec.minimum for spec in specs if spec.minimum is not None]
    most = [spec.maximum for spec in specs if spec.maximum is not None]
    return replace(
        first,
        minimum=min(least) if len(least) == len(specs) else None,
        maximum=max(most) if len(most) == len(specs) else None,
        options=tuple(dict.fromkeys(o for s in specs for o in s.options)) if all(s.options for s in specs) else (),
    )


def _told_together(devices: Sequence[Description], name: str) -> Told:
    """Return what devices report under a name; one that says no unit counts as the others do."""
    told = [(device, spec) for device in devices if (spec := device.property(name)) is not None]
    kinds = {plain_type(spec.type) for _, spec in told}
    counting: Counting | None = None
    for device, spec in told:
        one = device, declared_unit(spec.unit)
        if spec.type != "number" or (counting is not None and one[1] == UNSAID):
            continue
        counting = Counting(one) if counting is None or counting.first[1] == UNSAID else _also(counting, one)
    return Told(kinds.pop() if len(kinds) == 1 else "", counting)


def _also(counting: Counting | None, one: tuple[Description, str]) -> Counting:
    """Return how devices count with one more of them."""
    if counting is None:
        return Counting(one)
    differs = counting.other is None and one[1] != counting.first[1]
    return Counting(counting.first, one) if differs else counting


def _signature(method: MethodSpec) -> object:
    """Return what a caller must know of a method; within which limits the values lie is each robot's own."""
    return [(p.name, p.type, p.unit, p.required) for p in method.parameters]


def short_name(robots: Robots, name: str) -> str | None:
    """Return what the script calls a method of these robots; None where only its full name is clear."""
    if name in ROBOT_METHODS or described_alike(robots, name) is None:
        return None
    names = {member_name(name, [method.name for method in robot.methods]) for robot in robots}
    return names.pop() if len(names) == 1 and names.isdisjoint(OF_THE_FLEET) else None


def methods_called(robots: Robots, short: str) -> tuple[str, ...]:
    """Return the methods of some of the robots that the script could mean by a name; one, where it is clear."""
    names = own_methods(robots)
    return tuple(name for name in names if short_name(tuple(r for r in robots if r.method(name)), name) == short)


def readings_told(robots: Robots) -> tuple[str, ...]:
    """Return the properties that some of the robots tell."""
    return tuple(dict.fromkeys(spec.name for robot in robots for spec in robot.properties))


def short_reading(robots: Robots, name: str) -> str | None:
    """Return what the script calls a property of these robots; None where only its full name is clear."""
    members = {member_name(name, [*names]) for names in _different_readings(robots) if name in names}
    short = members.pop() if len(members) == 1 else None
    return short if short is not None and readings_called(robots, short) == (name,) else None


def readings_of(robots: Robots) -> list[str]:
    """Return what can be read of such robots, as the script calls it."""
    return [short for short in (short_reading(robots, name) for name in readings_told(robots)) if short]


def readings_called(robots: Robots, short: str) -> tuple[str, ...]:
    """Return the properties of some of the robots that the script could mean by a name; one, where it is clear."""
    told = map(member_names, _different_readings(robots))
    return tuple(dict.fromkeys(names[short] for names in told if short in names))


def _different_readings(robots: Robots) -> Iterable[tuple[str, ...]]:
    """Return what the robots report, once for all that report the same."""
    return dict.fromkeys(tuple(spec.name for spec in robot.properties) for robot in robots)


class Candidates:
    """The robots that may take a program's roles on one site, and what its variables may hold; found when asked for."""

    def __init__(self, roles: Sequence[Role], surroundings: Surroundings) -> None:
        """Know the roles and the site."""
        self._roles = {role.name: role for role in roles}
        self._surroundings = surroundings
        self._found: dict[str, Robots] = {}
        self._told: dict[tuple[str, str], tuple[PropertySpec | None, ...]] = {}
        self._readings: dict[tuple[str, str], PropertySpec | None] = {}
        self._held: dict[Held | None, Devices] = {}
        self._able: dict[Held | None, Devices] = {}
        self._units_taken: dict[tuple[Held | None, str], Mapping[str, Counting]] = {}
        self._told_by_held: dict[tuple[Held | None, str], Told] = {}

    def robots(self, role: str) -> Robots:
        """Return the robots that may take a role, by its name in the script."""
        if role not in self._found:
            known = self._roles.get(role)
            self._found[role] = robots_for(self._surroundings, known.device, known.can) if known else ()
        return self._found[role]

    def told_by(self, role: str, name: str) -> tuple[PropertySpec | None, ...]:
        """Return what each robot that may take a role says of a property."""
        key = (role, name)
        if key not in self._told:
            self._told[key] = tuple(robot.property(name) for robot in self.robots(role))
        return self._told[key]

    def reading(self, role: str, name: str) -> PropertySpec | None:
        """Return what they say together of a property."""
        key = (role, name)
        if key not in self._readings:
            self._readings[key] = joined_spec([spec for spec in self.told_by(role, name) if spec is not None])
        return self._readings[key]

    def held(self, held: Held | None) -> Devices:
        """Return the devices that a variable may hold, sorted by id; None, not known: all approved ones."""
        if held not in self._held:
            self._held[held] = self._devices_of(held, chosen_can=False)
        return self._held[held]

    def units_taken(self, held: Held | None, method: str) -> Mapping[str, Counting]:
        """Return in which units these take the numbers of a method, by the names of its parameters.

        None that has the method is left out: a machine that people may choose is never told a number in a wrong unit.
        """
        key = (held, method)
        if key not in self._units_taken:
            self._units_taken[key] = units_taken(self.held(held), method)
        return self._units_taken[key]

    def told_by_held(self, held: Held | None, name: str) -> Told:
        """Return what these report under a name; one that says no unit counts as the others do.

        Those that people may choose are left out where they can do nothing of what the program does with them: no run
        starts with such a one.
        """
        key = (held, name)
        if key not in self._told_by_held:
            if held not in self._able:
                self._able[held] = self._devices_of(held, chosen_can=True)
            self._told_by_held[key] = _told_together(self._able[held], name)
        return self._told_by_held[key]

    def _devices_of(self, held: Held | None, *, chosen_can: bool) -> Devices:
        devices = self._surroundings.devices
        found: dict[str, Description] = {}
        for each in (HeldDevice(),) if held is None else held:
            if each.device is not None:
                found.update({each.device: devices[each.device].description} if each.device in devices else {})
            elif each.role is not None:
                found.update((robot.id, robot) for robot in self.robots(each.role))
            else:
                approved = (facts.description for facts in devices.values() if facts.lifecycle == "approved")
                found.update((d.id, d) for d in approved if not chosen_can or _can(d, each))
        return tuple(found[key] for key in sorted(found))


def _can(device: Description, wanted: HeldDevice) -> bool:
    """Tell whether a device has any of the methods that a program uses of it, if it uses any."""
    return not wanted.methods or any(map(device.method, wanted.methods))


def with_crew(surroundings: Surroundings, roles: Sequence[Role]) -> Surroundings:
    """Return the site, which knows then whose readings those of a role are."""
    return replace(surroundings, crew=Candidates(roles, surroundings))


def with_holds(tree: Tree, holds: Mapping[str, int]) -> Tree:
    """Return the tree whose roles for any robot say how many objects that one must be able to hold."""
    if not any(role.device is None and role.name in holds for role in tree.roles):
        return tree
    roles = (replace(r, holds=holds.get(r.name, 0)) if r.device is None else r for r in tree.roles)
    return replace(tree, roles=tuple(roles))


def with_roles_of_robots(tree: Tree, surroundings: Surroundings) -> Tree:
    """Return the tree in which every Operate of a robot is done by a role; one that is bound to the robot already."""
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
    body, roles_now = _with_roles(tree.body, names), (*tree.roles, *added)
    return in_reading_order(replace(tree, body=body, functions=functions, roles=roles_now, events=events))


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

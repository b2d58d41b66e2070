"""What the checks share: the tree, the site, and the problems found so far."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from editor.language.analysis.memo import Memos
from editor.language.expressions import nodes as e
from editor.language.expressions.ranges import NOTHING_KNOWN, Variables
from editor.language.expressions.value_types import UNKNOWN_TYPE, ValueType
from editor.language.messages.diagnostics import Fix, Problem, TextArguments
from editor.language.messages.phrases import Driver, Robot
from editor.language.site.surroundings import DeviceFacts, Surroundings
from editor.language.tree import nodes as n
from editor.language.tree.program import Function, Role, Tree
from editor.language.tree.variables import set_by
from vipo_device.protocol.description import Description

_NUMBER_AT_THE_END = re.compile(r"[\s_-]*\d+$")


class Checked(NamedTuple):
    """What the checks found: problems, each with the identity of its node (0: none), and what roles need."""

    found: list[tuple[Problem, int]]
    holds: Mapping[str, int]
    """Role → how many objects its robot may have to hold at once, where that is more than one."""


@dataclass(slots=True)
class Context:
    """One checking of one program."""

    tree: Tree
    surroundings: Surroundings
    variables: Mapping[str, ValueType] = field(default_factory=dict)
    """What is known of the parameters and variables that can be seen in the block being checked."""
    known: Variables = NOTHING_KNOWN
    """What is known of them where the step stands that is being checked."""
    body: str = ""
    """The name of the body that is being checked."""
    result: ValueType = UNKNOWN_TYPE
    """What the function being checked gives back."""
    slow: frozenset[str] | None = None
    """The functions in which any step takes time, where a check has asked for them."""
    zones: frozenset[str] = frozenset()
    """The ids of the zones that the document has."""
    found: list[tuple[Problem, int]] = field(default_factory=list)
    functions: Mapping[str, Function] = field(init=False)
    roles: Mapping[str, Role] = field(init=False)
    memos: Memos | None = None
    """What was found at the last look."""
    params: Mapping[str, Mapping[str, object]] = field(default_factory=dict)
    """The parameters of each step as the document has them."""
    holds: dict[str, int] = field(default_factory=dict)
    """How many objects a role's robot may have to hold at once, where that is more than one; found along the paths."""
    stations: dict[tuple[str, str], tuple[e.Point | None, ...]] = field(default_factory=dict)
    """Where each robot of a role would stand to serve a device, as far as it was asked for."""
    _changing: frozenset[str] | None = None
    _robots: dict[str, tuple[Description, ...]] = field(default_factory=dict)
    _names: dict[str, Robot] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.functions = {function.method: function for function in self.tree.functions}
        self.roles = {role.name: role for role in self.tree.roles}

    def report(
        self, node: n.Node, code: str, field_name: str, args: TextArguments | None = None, fix: Fix | None = None
    ) -> None:
        """Note a problem with a field of a node's step."""
        self.found.append((Problem(code, node.step, field_name, args or {}, fix), id(node)))

    def raw_value(self, step: str, field_name: str) -> object:
        """Return a value of a step as the document has it; None where it has none, or several."""
        value: object = self.params.get(step)
        for key in field_name.split("."):
            value = value.get(key) if isinstance(value, Mapping) else None
        return None if isinstance(value, list) else value

    def report_step(
        self, step: str, code: str, field_name: str, args: TextArguments | None = None, fix: Fix | None = None
    ) -> None:
        """Note a problem with a step that has no node of its own."""
        self.found.append((Problem(code, step, field_name, args or {}, fix), 0))

    def changing(self) -> frozenset[str]:
        """Return the names that some step or loop gives a value: what a parameter of that name holds, they may hide."""
        if self._changing is None:
            tree = self.tree
            bodies = (tree.body, *(event.body for event in tree.events), *(each.body for each in tree.functions))
            nodes = [node for body in bodies for node in tree.walked(body)]
            loops = {name for node in nodes if isinstance(node, n.ForEach) for name in node.names}
            self._changing = frozenset(loops.union(map(set_by, nodes)))
        return self._changing

    def robots(self, role: str) -> tuple[Description, ...]:
        """Return the robots that can take the role."""
        if role not in self._robots:
            found = self.surroundings.devices.values()
            fitting = (facts.description for facts in found if self.fits(facts, self.roles[role]))
            self._robots[role] = tuple(sorted(fitting, key=lambda description: description.id))
        return self._robots[role]

    def fits(self, facts: DeviceFacts, role: Role) -> bool:
        """Tell whether a device can take a role, now or when it is back."""
        description = facts.description
        if role.device is not None:
            return description.id == role.device
        able = all(description.method(method) for method in role.can)
        return description.kind == "robot" and facts.lifecycle == "approved" and able

    def largest_radius_m(self, usual_m: float) -> float:
        """Return the radius of the site's largest robot, for which traffic keeps room everywhere; else the usual."""
        found = self.surroundings.devices.values()
        robots = (f.description for f in found if f.lifecycle == "approved" and f.description.kind == "robot")
        return max((robot.radius_m for robot in robots), default=0.0) or usual_m

    def capacity(self, role: str) -> int:
        """Return how many objects the role's robot holds at most; 0 when that is not known."""
        return max((robot.capacity for robot in self.robots(role)), default=0)

    def robot_name(self, role: str) -> Robot:
        """Return what to call the role's robot: its name, or that of its sort where any will do."""
        if role not in self._names:
            self._names[role] = self._robot_name(role)
        return self._names[role]

    def _robot_name(self, role: str) -> Robot:
        robots, device = self.robots(role), self.roles[role].device
        if device is not None:
            return Robot(robots[0].name if robots else device)
        sorts = {_NUMBER_AT_THE_END.sub("", robot.name) for robot in robots}
        return Robot(sorts.pop() if len(sorts) == 1 else "", sort=True)

    def driver_name(self, role: str) -> Driver:
        """Return what to call the one robot that has the role, in the middle of a sentence."""
        bound = self.roles[role].device is not None
        return Driver(self.robot_name(role).name if bound else self.roles[role].name, bound)

    def robot_key(self, role: str) -> tuple[str, str]:
        """Return what tells robots apart: the device for a bound role, else the role."""
        device = self.roles[role].device
        return ("role", role) if device is None else ("device", device)

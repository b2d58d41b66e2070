"""What the checks share: the tree, the site, and the problems found so far."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field

from editor.language import nodes as n
from editor.language.diagnostics import Fix, Problem, TextArguments
from editor.language.surroundings import DeviceFacts, Surroundings
from editor.language.typing_of_values import Kind
from registry.capability import Description

_NUMBER_AT_THE_END = re.compile(r"[\s_-]*\d+$")


@dataclass(slots=True)
class Context:
    """One checking of one program."""

    tree: n.Tree
    surroundings: Surroundings
    variables: Mapping[str, Kind] = field(default_factory=dict)
    """The parameters that can be seen in the block being checked."""
    found: list[tuple[Problem, int]] = field(default_factory=list)
    functions: Mapping[str, n.Function] = field(init=False)
    roles: Mapping[str, n.Role] = field(init=False)
    _robots: dict[str, tuple[Description, ...]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.functions = {function.method: function for function in self.tree.functions}
        self.roles = {role.name: role for role in self.tree.roles}

    def tell(
        self, node: n.Node, code: str, field_name: str, args: TextArguments | None = None, fix: Fix | None = None
    ) -> None:
        """Note a problem with a field of a node's step."""
        self.found.append((Problem(code, node.step, field_name, args or {}, fix), id(node)))

    def robots(self, role: str) -> tuple[Description, ...]:
        """Return the robots that can take the role."""
        if role not in self._robots:
            found = self.surroundings.devices.values()
            fitting = (facts.description for facts in found if self.fits(facts, self.roles[role]))
            self._robots[role] = tuple(sorted(fitting, key=lambda description: description.id))
        return self._robots[role]

    def fits(self, facts: DeviceFacts, role: n.Role) -> bool:
        """Tell whether a device can take a role, now or when it is back."""
        description = facts.description
        if role.device is not None:
            return description.id == role.device
        able = all(description.method(method) for method in role.can)
        return description.kind == "robot" and facts.lifecycle == "approved" and able

    def capacity(self, role: str) -> int:
        """Return how many objects the role's robot holds at most; 0 when that is not known."""
        return max((robot.capacity for robot in self.robots(role)), default=0)

    def robot_name(self, role: str) -> str:
        """Return what to call the role's robot: its name, or that of its sort where any will do."""
        robots = self.robots(role)
        if self.roles[role].device is not None:
            return robots[0].name if robots else str(self.roles[role].device)
        sorts = {_NUMBER_AT_THE_END.sub("", robot.name) for robot in robots}
        only = sorts.pop() if len(sorts) == 1 else "robot"
        return f"{'An' if only[:1].upper() in 'AEIOU' else 'A'} {only}" if only else "A robot"

    def driver_name(self, role: str) -> str:
        """Return what to call the one robot that has the role, in the middle of a sentence."""
        bound = self.roles[role].device is not None
        return self.robot_name(role) if bound else f"the robot “{self.roles[role].name}”"

    def robot_key(self, role: str) -> tuple[str, str]:
        """Return what tells robots apart: the device for a bound role, else the role."""
        device = self.roles[role].device
        return ("role", role) if device is None else ("device", device)


def span(minimum: float | None, maximum: float | None, unit: str = "") -> str:
    """Return a range in words: `1 to 30 min`, `15 °C or more`; empty when there is none."""
    behind = f" {unit}" if unit and unit != "%" else unit
    if minimum is not None and maximum is not None:
        return f"{minimum:g} to {maximum:g}{behind}"
    if minimum is not None:
        return f"{minimum:g}{behind} or more"
    return "" if maximum is None else f"{maximum:g}{behind} or less"


def amounts(capacity: int) -> str:
    """Return how many a robot carries at a time, in words."""
    if capacity <= 2:
        return {1: "1", 2: "1 or 2"}.get(capacity, "1 or more")
    return f"1 to {capacity}"


def plural(thing: str) -> str:
    """Return the plural of a kind of object."""
    if thing.endswith(("s", "x", "ch", "sh")):
        return f"{thing}es"
    return f"{thing[:-1]}ies" if thing.endswith("y") and thing[-2:-1] not in "aeiou" else f"{thing}s"

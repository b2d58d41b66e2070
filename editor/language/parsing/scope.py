"""What is known while a script is read: the site, what `run` gives, variables and functions; and how it is refused."""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Literal

from editor.language.expressions.nodes import OF_PROBLEM, PROBLEM, Expression, Zone
from editor.language.site.surroundings import Surroundings
from editor.language.tree.robots import Robots, robots_for
from vipo_device.protocol.description import Description, Scalar

Answer = str | Callable[[], str]
"""What to write instead; where that takes a search among the names, it is made only for what is told."""


class Refused(Exception):
    """A piece of Python that the language does not have; `instead` says what to write."""

    def __init__(self, node: ast.AST, found: str, instead: Answer) -> None:
        super().__init__(found)
        self.line, self.column = getattr(node, "lineno", 1), getattr(node, "col_offset", 0) + 1
        self.end_line = getattr(node, "end_lineno", None) or self.line
        self.end_column = (getattr(node, "end_col_offset", None) or self.column) + 1
        self.found, self._instead = found, instead

    @property
    def instead(self) -> str:
        """Return what to write instead."""
        return self._instead if isinstance(self._instead, str) else self._instead()


@dataclass(frozen=True, slots=True)
class Binding:
    """What `run` gives to an attribute of the task."""

    kind: Literal["get", "any", "place", "parameter", "zone"]
    id: str = ""
    can: tuple[str, ...] = ()
    at: str | None = None
    is_robot: bool = False
    """The script says that the device is a robot."""
    where: Expression | None = None
    """What must hold of any robot when it is chosen."""
    default: Scalar = None
    type: str = ""
    unit: str = ""


@dataclass(slots=True)
class Scope:
    """The names that can be used, and the site."""

    surroundings: Surroundings
    bindings: dict[str, Binding] = field(default_factory=dict)
    locals: frozenset[str] = frozenset()
    variables: frozenset[str] = frozenset()
    """The variables of the program, which are attributes of the task."""
    robots: Callable[[], frozenset[str]] = frozenset
    """The attributes that some step drives as a robot."""
    methods: Mapping[str, ast.FunctionDef] = field(default_factory=dict)
    """The methods of the task: its functions, branches and events, new_task and run."""
    chosen: tuple[str, str] = ("", "")
    """In the condition of a choice: what it calls the robot, and the attribute that the robot is given to."""
    drawn_zones: dict[str, Zone] = field(default_factory=dict)
    """The zones of which the script says all, by id."""
    _robots: dict[str, Robots] = field(default_factory=dict)

    def description(self, device_id: str | None) -> Description | None:
        """Return a device's description, if the site has the device."""
        facts = self.surroundings.devices.get(device_id or "")
        return None if facts is None else facts.description

    def is_chosen(self, node: ast.expr) -> bool:
        """Tell whether a name stands for the robot that may be chosen, in the condition of a choice."""
        return isinstance(node, ast.Name) and node.id == self.chosen[0]

    def robots_of(self, name: str) -> Robots:
        """Return the robots that a role may be, by its attribute."""
        binding = self.bindings.get(name)
        if binding is None:
            return self.surroundings.crew.robots(name)
        if name not in self._robots:
            device = binding.id if binding.kind == "get" else None
            self._robots[name] = robots_for(self.surroundings, device, binding.can)
        return self._robots[name]


def written(node: ast.AST) -> str:
    """Return a piece of the script on one line, as Python writes it."""
    try:
        return " ".join(ast.unparse(node).splitlines())
    except ValueError:  # a number of more digits than Python writes
        return "…"


def quoted(node: ast.AST) -> str:
    """Return the first line of a piece of the script for a message, shortened."""
    try:
        text = ast.unparse(node).splitlines()[0]
    except ValueError:
        return "“…”"
    return f"“{text[:60]}…”" if len(text) > 60 else f"“{text}”"


def attribute_of_self(node: ast.AST) -> str | None:
    """Return x of `self.x`."""
    if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "self":
        return node.attr
    return None


def of_problem(name: str, outside: frozenset[str]) -> frozenset[str]:
    """Return the names that an except can see: `problem.text` and `problem.kind` beside those outside."""
    return outside | {known.replace(PROBLEM, name, 1) for known in OF_PROBLEM} if name else outside

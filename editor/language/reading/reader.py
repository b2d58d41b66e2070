"""What is known while a document is read: names given so far, what was read last, and the problems met."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from editor.language.analysis.memo import ReadMemo, StepRead
from editor.language.constructs.table import fields_by_kind
from editor.language.document.outline import Outline, Params
from editor.language.expressions.nodes import MISSING, NOWHERE, OF_PROBLEM, Expression, Located, PlaceRef, is_missing
from editor.language.expressions.values import Names, UnknownParameter, read_place, read_value
from editor.language.messages.diagnostics import Fix, Problem
from editor.language.reading.names import DEFAULT_ROLE, text_of
from editor.language.tree.nodes import Block, Node
from editor.language.tree.program import Function, Role

_DRIVING = fields_by_kind("role")


@dataclass(slots=True)
class Reader:
    """What is known while reading: names given so far, and the problems met."""

    outline: Outline
    roles: dict[str, Role]
    functions: dict[str, Function]
    """By id, still without their bodies."""
    argument_names: dict[str, dict[str, str]]
    names: Names
    """The parameters and variables that can be seen in the block being read."""
    readers: Mapping[str, Reads]
    """How each kind of step is read."""
    problems: list[Problem] = field(default_factory=list)
    memo: ReadMemo | None = None
    looked_around: bool = False
    """Whether a value was read that depends on other steps."""
    _driven: frozenset[str] | None = None

    def robot(self, role: str) -> Expression:
        """Return what stands for the robot of a role: the role where steps drive it, else the device it is."""
        self.looked_around = True
        if self._driven is None:
            self._driven = _driven_roles(self.outline)
        found = self.roles.get(role)
        if found is None:
            return MISSING
        if role in self._driven:
            return Located(role=found.name)
        return MISSING if found.device is None else Located(device=found.device)

    def value(self, step: str, params: Params, name: str, field_name: str = "") -> Expression:
        """Return the expression in a parameter; what does not exist reads as missing, and is reported."""
        value = params.get(name)
        if value is None:
            return MISSING
        try:
            return read_value(value, self.names, self.robot)
        except UnknownParameter as error:
            return self._unknown(step, field_name or name, error)

    def given(self, step: str, params: Params, name: str) -> Expression | None:
        """Return the expression in a parameter that may also be left out."""
        value = self.value(step, params, name)
        return None if is_missing(value) else value

    def place(self, step: str, params: Params, name: str) -> PlaceRef:
        """Return the place in a parameter; what does not exist reads as missing, and is reported."""
        try:
            return read_place(params.get(name), self.names)
        except UnknownParameter as error:
            self._unknown(step, name, error)
            return NOWHERE

    def _unknown(self, step: str, field_name: str, error: UnknownParameter) -> Expression:
        code = "problem_outside_catch" if str(error) in OF_PROBLEM else "unknown_parameter"
        self.problems.append(Problem(code, step, field_name, {"parameter": str(error)}))
        return MISSING

    def role(self, step: str, params: Params, field_name: str = "role") -> str:
        """Return the script name of the step's robot; `field_name` is the parameter of the step that names it."""
        wanted = params.get("role")
        name = wanted if isinstance(wanted, str) and wanted else DEFAULT_ROLE
        if name not in self.roles:
            instead: object = DEFAULT_ROLE if field_name == "role" else {"role": DEFAULT_ROLE}
            fix = Fix("choose", step, field_name, instead, {"value": self.roles[DEFAULT_ROLE].name})
            self.problems.append(Problem("unknown_role", step, field_name, {"role": name}, fix))
            name = DEFAULT_ROLE
        return self.roles[name].name

    def variable(self, params: Params, name: str = "variable") -> str:
        """Return the script name of the variable that a step sets, empty when it is still to be named."""
        wanted = text_of(params.get(name))
        return self.names.get(wanted, "") if wanted else ""

    def block(self, parent: str, branch: str) -> Block:
        """Return the nodes of one branch."""
        nodes: list[Node] = []
        memo, kinds, params = self.memo, self.outline.kinds, self.outline.params
        for step in self.outline.children.get((parent, branch), ()):
            if memo is None:
                nodes.extend(self.readers[kinds[step]](self, step, params[step]))
            else:
                nodes.extend(self._remembered(step, memo))
        return tuple(nodes)

    def _remembered(self, step: str, memo: ReadMemo) -> tuple[Node, ...]:
        """Return the nodes of a step as they were read last, or read it anew."""
        last = memo.steps.get(step)
        if last is None or last.names != self.names:
            return self._read(step, memo)
        self.problems.extend(last.problems)
        return last.nodes

    def _read(self, step: str, memo: ReadMemo) -> tuple[Node, ...]:
        """Read a step and keep what depends on nothing but it and the names that it sees."""
        around, self.looked_around = self.looked_around, False
        reported = len(self.problems)
        nodes = self.readers[self.outline.kinds[step]](self, step, self.outline.params[step])
        if not self.looked_around:
            memo.steps[step] = StepRead(nodes, tuple(self.problems[reported:]), self.names)
        self.looked_around = self.looked_around or around
        return nodes


def operated_role(params: Params) -> Params | None:
    """Return what names the robot's role that an Operate speaks to; None where it speaks to a device or a place."""
    device = params.get("device")
    return device if isinstance(device, Mapping) and device.keys() == {"role"} else None


def _driven_roles(outline: Outline) -> frozenset[str]:
    """Return the ids of the roles that some step of the program drives."""
    roots = [key for key in outline.children if key[0] not in outline.kinds]
    steps = outline.with_inner(step for key in roots for step in outline.children[key])
    kinds = outline.kinds
    params = [outline.params[step] for step in steps if kinds[step] in _DRIVING]
    operated = (operated_role(outline.params[step]) for step in steps if kinds[step] == "operate")
    wanted = [*(one.get("role") for one in params), *(role.get("role") for role in operated if role is not None)]
    return frozenset(role if isinstance(role, str) and role else DEFAULT_ROLE for role in wanted)


Reads = Callable[[Reader, str, Params], tuple[Node, ...]]
"""Reads a step of one kind, by its id and parameters."""

"""The plan while it is being built: instructions, jumps that are still open, and what stands around a step."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from itertools import zip_longest

from editor.language.expressions import nodes as e
from editor.language.expressions.unit_conversion import convert_units
from editor.language.expressions.value_types import UNKNOWN_TYPE, TypeChecker, ValueType
from editor.language.plan import instructions as p
from editor.language.site.surroundings import Counting, HeldDevice, Surroundings
from editor.language.tree import nodes as n
from editor.language.tree.program import Function, Tree
from editor.language.tree.robots import units_taken
from vipo_device.protocol.description import Description

Leaves = tuple[str, ...]
Compiler = Callable[..., None]


@dataclass(slots=True, eq=False)
class Guard:
    """A guarded stretch around the step being compiled; one with a `flag` has a final part with exits."""

    flag: str = ""
    exits: list[tuple[int, int]] = field(default_factory=list)
    """Addresses of the jumps into the final part, each with the address where the path goes on behind it."""


@dataclass(slots=True, eq=False)
class Loop:
    """A loop around the step being compiled, with the addresses of the jumps that leave it, or its round."""

    jumps: list[int] = field(default_factory=list)
    rounds: list[int] = field(default_factory=list)
    """The jumps to the end of the body, where the next round begins."""


@dataclass(slots=True, eq=False)
class Composite:
    """A step that holds the one being compiled."""

    step: str


Around = Guard | Loop | Composite


@dataclass(slots=True)
class Builder:
    """The instructions so far; jumps are written when their address is known."""

    tree: Tree
    surroundings: Surroundings
    line_of: Mapping[int, int]
    compilers: Mapping[type[n.Node], Compiler]
    shared: frozenset[str]
    """The variables of the program."""
    types: Mapping[str, ValueType] = field(default_factory=dict)
    """What is known of the variables that can be seen here."""
    instructions: list[p.Instruction] = field(default_factory=list)
    calls: list[tuple[int, str]] = field(default_factory=list)
    """Addresses of calls, with the functions that they call; filled in at the end."""
    around: list[Around] = field(default_factory=list)
    own: frozenset[str] = frozenset()
    """The parameters and variables of the function being compiled."""
    renamed: dict[str, str] = field(default_factory=dict)
    """The variables of the loops around, each with its hidden name."""
    function: Function | None = None
    functions: Mapping[str, Function] = field(init=False)
    hidden: dict[str, int] = field(default_factory=dict)
    methods: dict[str, frozenset[str]] = field(default_factory=dict)
    """What devices can do, as far as it was asked for."""
    readings: set[tuple[str, str]] = field(default_factory=set)
    """The (device, property) pairs that the values of the plan look at."""

    def __post_init__(self) -> None:
        self.functions = {function.method: function for function in self.tree.functions}

    def here(self) -> int:
        """Return the address of the next instruction."""
        return len(self.instructions)

    def add(
        self,
        do: p.Action,
        node: n.Node | n.Event | None = None,
        enters: tuple[str, ...] = (),
        leaves: Leaves = (),
    ) -> int:
        """Add an instruction and return its address."""
        instructions = self.instructions
        if node is None:
            instructions.append(p.Instruction(do, "", 0, enters, leaves))
        else:
            instructions.append(p.Instruction(do, node.step, self.line_of.get(id(node), 0), enters, leaves))
        return len(instructions) - 1

    def patch(self, address: int, do: p.Action) -> None:
        """Write an instruction again, now that its target is known."""
        before = self.instructions[address]
        self.instructions[address] = p.Instruction(do, before.step, before.line, before.enters, before.leaves)

    def block(self, block: n.Block) -> None:
        """Compile the nodes of a block; the last node of each step tells that it is over."""
        compilers = self.compilers
        for node, following in zip_longest(block, block[1:]):
            last = following is None or following.step != node.step
            compilers[node.__class__](self, node, (node.step,) if last else ())

    def leave(self, node: n.Node) -> None:
        """Mark a composite step as over, where its exits meet."""
        self.add(p.Jump(self.here() + 1), node, leaves=(node.step,))

    def inside(self, *around: Around) -> Inside:
        """Compile what stands in a step; without a step it stands in a function, a branch or an event of its own."""
        return Inside(self, [*self.around, *around] if around else [])

    def devices(self, place: e.PlaceRef) -> tuple[Description, ...]:
        """Return the devices that may stand for a place: the one that it names, or those that its variable may hold."""
        if place.value is not None:
            return self.surroundings.crew.held(self._held_at(place.value))
        facts = self.surroundings.devices.get(place.device or "")
        return () if facts is None else (facts.description,)

    def units_taken(self, place: e.PlaceRef, method: str) -> dict[str, str]:
        """Return in which units the numbers of a method are taken by all that may stand for a place."""
        if place.value is None:
            taken: Mapping[str, Counting] = units_taken(self.devices(place), method)
        else:
            taken = self.surroundings.crew.units_taken(self._held_at(place.value), method)
        return {name: counting.first[1] for name, counting in taken.items()}

    def _held_at(self, value: e.Expression) -> frozenset[HeldDevice] | None:
        return TypeChecker(self.surroundings, self.types, []).type_of(value).held

    def can(self, device: Description, method: str) -> bool:
        """Tell whether a device has a method."""
        known = self.methods.get(device.id)
        if known is None:
            known = self.methods[device.id] = frozenset(each.name for each in device.methods)
        return method in known

    def hide(self, name: str) -> str:
        """Return a name for a variable that only the plan knows."""
        count = self.hidden.get(name, 0) + 1
        self.hidden[name] = count
        return f"#{name}" if count == 1 else f"#{name}_{count}"

    def is_shared(self, name: str) -> bool:
        """Tell whether a variable belongs to the program, not to the function that runs."""
        return name in self.shared and name not in self.own and name not in self.renamed

    def name(self, variable: str) -> str:
        """Return the name that a variable has in the plan."""
        return self.renamed.get(variable, variable)

    def value(self, expression: e.Expression, unit: str = "") -> e.Expression:
        """Return an expression as a plan has it: without quantities, in the wanted unit if one is wanted."""
        if isinstance(expression, e.Constant):
            return expression
        checker = TypeChecker(self.surroundings, self.types, [])
        converted = self._named(convert_units(expression, unit, checker))
        self._note_readings(converted)
        return converted

    def _note_readings(self, expression: e.Expression) -> None:
        if isinstance(expression, e.Operation):
            for argument in expression.arguments:
                self._note_readings(argument)
        elif isinstance(expression, e.Reading) and isinstance(expression.device, e.Constant):
            self.readings.add((str(expression.device.value), expression.property))
        elif isinstance(expression, e.Reading) and isinstance(expression.device, e.Located):
            bound = next((role.device for role in self.tree.roles if role.name == expression.device.role), None)
            self.readings.update([(bound, expression.property)] if bound is not None else [])

    def given(self, expression: e.Expression | None, unit: str = "") -> e.Expression | None:
        """Return an expression that may be left out as a plan has it."""
        return None if expression is None else self.value(expression, unit)

    def unit_of(self, variable: str) -> str:
        """Return the unit that a variable is kept in, empty when it is not known."""
        return self.types.get(variable, UNKNOWN_TYPE).unit

    def _named(self, expression: e.Expression) -> e.Expression:
        return rename_variables(expression, self.renamed) if self.renamed else expression

    def place(self, place: e.PlaceRef) -> e.PlaceRef:
        """Return a place as a plan has it."""
        if place.value is None or not self.renamed:
            return place
        return replace(place, value=self._named(place.value))


@dataclass(slots=True)
class Inside:
    """A stretch of the plan that is built with other things around it."""

    builder: Builder
    around: list[Around]

    def __enter__(self) -> None:
        """Begin the stretch."""
        self.builder.around, self.around = self.around, self.builder.around

    def __exit__(self, *failure: object) -> None:
        """End it, with the things around that were there before."""
        self.builder.around = self.around


def rename_variables(expression: e.Expression, renamed: Mapping[str, str]) -> e.Expression:
    """Return an expression with other names for some variables."""
    match expression:
        case e.Variable(name=name):
            return e.Variable(renamed[name]) if name in renamed else expression
        case e.Reading(device=device, property=name):
            return e.Reading(rename_variables(device, renamed), name)
        case e.Operation(operator=operator, arguments=arguments):
            return e.Operation(operator, tuple(rename_variables(argument, renamed) for argument in arguments))
    return expression

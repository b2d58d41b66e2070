"""What the variables of a program hold: type and unit, found together for all that are worked out from each other.

A variable is kept in one unit: that of the first step that gives it one. What is never given a unit is a plain
number. So a value's unit is known wherever it is read, and no step can make of minutes a mere number.
"""

from __future__ import annotations

from collections import ChainMap, Counter, deque
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace

from editor.language.expressions.nodes import OF_PROBLEM, Expression, Variable
from editor.language.expressions.temperatures import is_temperature, kept_unit
from editor.language.expressions.value_types import NUMBER, TEXT, UNKNOWN_TYPE, TypeChecker, ValueType, declared_type
from editor.language.expressions.values import parts_of
from editor.language.site.surroundings import Surroundings
from editor.language.tree import nodes as n
from editor.language.tree.held_devices import Held, Key, held_devices
from editor.language.tree.program import Function, Parameter, Tree
from editor.language.tree.traversal import Loops, with_loops
from editor.language.tree.variables import read_by, set_by
from vipo_device.protocol.units import PLAIN, UNSAID, is_measure

Types = Mapping[str, ValueType]
MOST_CHANGES = 8
"""So often a type may become another one: variables in a circle through an empty list would change theirs for ever."""


def types_of_parameters(parameters: Iterable[Parameter]) -> dict[str, ValueType]:
    """Return what parameters hold, by their names."""
    return {p.name: declared_type(p.type, p.unit) for p in parameters}


def _holding(types: Types, tree: Tree, owner: object) -> dict[str, ValueType]:
    """Return types that say, too, which devices these variables of one owner may hold."""
    held = held_devices(tree)
    return {name: _held_by(found, held, (owner, name)) for name, found in types.items()}


def _held_by(found: ValueType, held: Mapping[Key, Held], key: Key) -> ValueType:
    devices = held.get(key)
    return found if devices == found.held else replace(found, held=devices)


def types_in_program(tree: Tree, shared: frozenset[str], surroundings: Surroundings) -> dict[str, ValueType]:
    """Return what the program's parameters and variables hold."""
    known = {**dict.fromkeys(OF_PROBLEM, TEXT), **_holding(types_of_parameters(tree.parameters), tree, None)}
    bodies = (tree.body, *(event.body for event in tree.events))
    return _with_types_set_in(bodies, shared, known, tree, surroundings)


def types_in_function(tree: Tree, function: Function, outside: Types, surroundings: Surroundings) -> Types:
    """Return what can be seen in a function; `outside` is what the program's parameters and variables hold."""
    known = {**outside, **_holding(types_of_parameters(function.parameters), tree, function.method)}
    own = frozenset(map(set_by, n.walk(function.body))) - known.keys() - {""}
    return _with_types_set_in((function.body,), own, known, tree, surroundings, function.method)


def type_of_items(loop: n.ForEach, types: Types, surroundings: Surroundings, tree: Tree) -> ValueType:
    """Return what the variable of a loop over values holds, in one of the tree's bodies."""
    found = _item_type(loop, TypeChecker(surroundings, types, [])) or UNKNOWN_TYPE
    return _held_by(_settled(found), held_devices(tree), (id(loop), loop.variable))


def _item_type(loop: n.ForEach, checker: TypeChecker) -> ValueType | None:
    if loop.over is not None:
        return checker.type_of(loop.over).item
    return _joined(map(checker.type_of, loop.items))


def _given_to(loop: n.ForEach) -> tuple[Expression, ...]:
    return loop.items if loop.over is None else (loop.over,)


def types_in_loops(block: n.Block, types: Types, surroundings: Surroundings, tree: Tree) -> dict[int, Types]:
    """Return what can be seen where loops over values hide other names, by the identity of the steps there."""
    found: dict[int, Types] = {}
    inside: dict[Loops, Types] = {(): types}
    for node, loops in with_loops(block):
        if loops not in inside:
            around, loop = inside[loops[:-1]], loops[-1]
            items = type_of_items(loop, around, surroundings, tree)
            inside[loops] = {**around, loop.index: NUMBER, loop.variable: items}
        if loops:
            found[id(node)] = inside[loops]
    return found


@dataclass(frozen=True, slots=True)
class _Setter:
    """A step that sets a variable, with the loops over values that it stands in."""

    node: n.Node
    loops: Loops

    def reads(self) -> Iterator[str]:
        """Yield the names of variables on whose types the type that it sets depends."""
        hidden: set[str] = set()
        for loop in self.loops:
            yield from (name for name in _names_in(_given_to(loop)) if name not in hidden)
            hidden.update(loop.names)
        yield from (name for name in read_by(self.node) if name not in hidden)


@dataclass(slots=True)
class _Inference:
    """The types that are known so far; each may become more exact, in a few steps.

    An item of a list that is empty as yet may have any unit, until more is known of the list: that alone makes a type
    less exact again. Where variables are in a circle through such a list, their unit is left open in the end.
    """

    functions: Mapping[str, Function]
    surroundings: Surroundings
    wanted: Collection[str]
    types: dict[str, ValueType]
    held: Mapping[Key, Held]
    owner: object
    """Whose variables they are: a function's by its method, None: the program's."""
    setters: dict[str, list[_Setter]] = field(default_factory=dict)

    def run(self) -> None:
        """Find the types of all wanted variables; what is set from a variable is looked at again with it."""
        dependents: dict[str, set[str]] = {}
        for name, setters in self.setters.items():
            for setter in setters:
                for read in setter.reads():
                    dependents.setdefault(read, set()).add(name)
        changes: Counter[str] = Counter()
        left = deque(self.setters)
        waiting = set(left)
        while left:
            name = left.popleft()
            waiting.discard(name)
            found = self._type_of_variable(name)
            if found is not None and found != self.types.get(name) and changes[name] <= MOST_CHANGES:
                changes[name] += 1
                self.types[name] = found if changes[name] <= MOST_CHANGES else replace(found, unit=UNSAID)
                again = sorted(dependents.get(name, set()) - waiting)
                left.extend(again)
                waiting.update(again)

    def _type_of_variable(self, name: str) -> ValueType | None:
        ready = (setter for setter in self.setters[name] if not any(map(self._is_open, setter.reads())))
        found = _joined(map(self._type_set_by, ready))
        return None if found is None else _held_by(found, self.held, (self.owner, name))

    def _is_open(self, name: str) -> bool:
        return name in self.wanted and name not in self.types

    def _type_set_by(self, setter: _Setter) -> ValueType:
        match setter.node:
            case n.Set(value=value):
                return TypeChecker(self.surroundings, self._types_at(setter.loops), []).type_of(value)
            case n.Ask(answer=answer):
                return declared_type("text" if answer.type == "choice" else answer.type, answer.unit)
            case n.Call(function=method) if method in self.functions:
                return declared_type(self.functions[method].result_type, self.functions[method].result_unit)
        return UNKNOWN_TYPE

    def _types_at(self, loops: Loops) -> Types:
        types: Types = self.types
        for loop in loops:
            checker = TypeChecker(self.surroundings, types, [])
            found = _item_type(loop, checker) or UNKNOWN_TYPE
            item = _held_by(found, self.held, (id(loop), loop.variable))
            types = ChainMap({loop.index: NUMBER, loop.variable: item}, types)  # type: ignore[arg-type]  # only read
        return types


def _with_types_set_in(
    bodies: Iterable[n.Block],
    wanted: frozenset[str],
    known: dict[str, ValueType],
    tree: Tree,
    site: Surroundings,
    owner: object = None,
) -> dict[str, ValueType]:
    """Return what is known with the types of the wanted variables."""
    wanted = wanted - known.keys()
    if not wanted:
        return known
    functions = {function.method: function for function in tree.functions}
    inference = _Inference(functions, site, wanted, dict(known), held_devices(tree), owner)
    for body in bodies:
        for node, loops in with_loops(body):
            name = set_by(node)
            if name in wanted and all(name not in loop.names for loop in loops):
                inference.setters.setdefault(name, []).append(_Setter(node, loops))
    inference.run()
    return {name: found if name in known else _settled(found) for name, found in inference.types.items()}


def _names_in(values: Iterable[Expression]) -> Iterator[str]:
    return (part.name for value in values for part in parts_of(value) if isinstance(part, Variable))


def _joined(found: Iterable[ValueType]) -> ValueType | None:
    """Return the type of what may be any of these: the first that is known, in the first unit that is measured."""
    joined: ValueType | None = None
    units: set[str] = set()
    for each in found:
        other = each if each.type or is_measure(each.unit) else ValueType("", UNSAID)
        units.add(other.unit)
        if joined is None or (not joined.type and other.type and other.type != "number"):
            joined = other
        elif {joined.type, other.type} <= {"number", ""}:
            unit, measured = max(joined.unit, other.unit, key=_exactness), joined.measured or other.measured
            joined = ValueType(joined.type or other.type, unit, measured=measured)
        elif joined.type == other.type == "list" and (joined.of == other.of or not (joined.of and other.of)):
            unit, measured = max(joined.unit, other.unit, key=_exactness), joined.measured or other.measured
            joined = ValueType("list", unit, joined.of or other.of, measured)
    if joined is not None and is_temperature(joined.unit):
        return replace(joined, unit=kept_unit(joined.unit, units, measured=joined.measured))
    return joined


def _exactness(unit: str) -> int:
    """Return how much a unit says; the first of two measures counts."""
    if is_measure(unit):
        return 3
    return {UNSAID: 2, PLAIN: 1}.get(unit, 0)


def _settled(found: ValueType) -> ValueType:
    """Return the type of a variable of which all is known: what was given no unit is a plain number."""
    if found.type == "list":
        return replace(found, unit=found.unit or PLAIN if found.of == "number" else "")
    if found.type == "number":
        return replace(found, unit=found.unit or PLAIN)
    return ValueType(found.type, found.unit if not found.type and is_measure(found.unit) else "", held=found.held)

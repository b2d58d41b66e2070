"""Between which numbers variables and parameters lie, whatever path a run takes; one range for each in its own unit.

What is set from each other is worked out together until nothing widens any more. A range that keeps widening, as that
of a counter does, is given up: nothing is said then. So what lies wholly outside of what is allowed is wrong in every
run that comes there.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from editor.language.expressions.nodes import Constant, Expression, Variable
from editor.language.expressions.ranges import ANY, Range, range_of
from editor.language.expressions.unit_conversion import convert_units
from editor.language.expressions.value_types import UNKNOWN_TYPE, TypeChecker, ValueType
from editor.language.expressions.values import parts_of
from editor.language.site.surroundings import Surroundings
from editor.language.tree import nodes as n
from editor.language.tree.variable_types import with_loops
from editor.language.tree.variables import set_by

MOST_CHANGES = 4
"""A range that has widened so often is given up."""
PROGRAM = ""
Types = Mapping[str, ValueType]
_Key = tuple[object, str]
"""Where a name belongs, and the name: the program, a function by its method, or a loop by its node's identity."""


@dataclass(frozen=True, slots=True)
class Scope:
    """A body of the program: the program's own, an event's or a function's, with the names of its own and the types."""

    name: str
    body: n.Block
    types: Types
    types_in_loops: Mapping[int, Types]
    own: frozenset[str] = frozenset()


@dataclass(frozen=True, slots=True)
class _Setter:
    """A value that a name takes somewhere, with all that tells what it means there; without one it may be anything."""

    value: Expression | None
    scope: Scope
    node: n.Node
    loops: tuple[n.ForEach, ...]
    unit: str

    def key_of(self, name: str) -> _Key:
        """Return whose name a name is here."""
        return _key(self.scope, self.loops, name)


@dataclass(slots=True)
class _Widening:
    """The ranges so far; each widens a few times at most."""

    surroundings: Surroundings
    setters: dict[_Key, list[_Setter]] = field(default_factory=dict)
    ranges: dict[_Key, Range] = field(default_factory=dict)
    changes: dict[_Key, int] = field(default_factory=dict)

    def run(self) -> None:
        """Widen until nothing changes."""
        dependents: dict[_Key, list[_Key]] = {}
        for key, setters in self.setters.items():
            for setter in setters:
                for name in () if setter.value is None else _names_in(setter.value):
                    dependents.setdefault(setter.key_of(name), []).append(key)
        left = deque(self.setters)
        waiting = set(left)
        while left:
            key = left.popleft()
            waiting.discard(key)
            found = self._range_of_name(key)
            if found is not None and found != self.ranges.get(key):
                self.changes[key] = self.changes.get(key, 0) + 1
                self.ranges[key] = ANY if self.changes[key] > MOST_CHANGES else found
                again = [each for each in dict.fromkeys(dependents.get(key, ())) if each not in waiting]
                left.extend(again)
                waiting.update(again)

    def _range_of_name(self, key: _Key) -> Range | None:
        if self.ranges.get(key) == ANY:
            return ANY
        found = [self._range_of_setter(setter) for setter in self.setters[key]]
        known = [each for each in found if each is not None]
        return _joined(known) if known else None

    def _range_of_setter(self, setter: _Setter) -> Range | None:
        """Return what a name takes there; None while what it is worked out from has no value yet."""
        if setter.value is None:
            return ANY
        names: dict[str, Range] = {}
        for name in _names_in(setter.value):
            key = setter.key_of(name)
            if key in self.setters and key not in self.ranges:
                return None
            names[name] = self.ranges.get(key, ANY)
        types = setter.scope.types_in_loops.get(id(setter.node), setter.scope.types)
        checker = TypeChecker(self.surroundings, types, [])
        return range_of(convert_units(setter.value, setter.unit, checker), self.surroundings, names)


Ranges = Mapping[object, Mapping[str, Range]]
"""The ranges that are known: where a name belongs, and then by the name."""


def find_ranges(tree: n.Tree, scopes: Iterable[Scope], surroundings: Surroundings) -> Ranges:
    """Return the ranges of the names of which one is known."""
    widening = _Widening(surroundings)
    for key, setter in _all_setters(tree, tuple(scopes)):
        widening.setters.setdefault(key, []).append(setter)
    for parameter in tree.parameters:
        widening.setters.pop((PROGRAM, parameter.name), None)
    widening.run()
    ranges: dict[object, dict[str, Range]] = {}
    for (where, name), found in widening.ranges.items():
        if found != ANY:
            ranges.setdefault(where, {})[name] = found
    return ranges


def ranges_at(ranges: Ranges, scope: Scope, loops: tuple[n.ForEach, ...]) -> Mapping[str, Range]:
    """Return the ranges that can be seen from a step."""
    shared = ranges.get(PROGRAM, {})
    own = ranges.get(scope.name, {}) if scope.name else {}
    found = {**{name: known for name, known in shared.items() if name not in scope.own}, **own}
    for loop in loops:
        found.pop(loop.variable, None)
        found.update(ranges.get(id(loop), {}))
    return found


def _all_setters(tree: n.Tree, scopes: Iterable[Scope]) -> Iterator[tuple[_Key, _Setter]]:
    functions = {function.method: function for function in tree.functions}
    known = {scope.name for scope in scopes}
    for scope in scopes:
        for node, loops in with_loops(scope.body):
            types = scope.types_in_loops.get(id(node), scope.types)
            name = set_by(node)
            if name:
                value = node.value if isinstance(node, n.Set) else None
                yield _key(scope, loops, name), _Setter(value, scope, node, loops, _unit(types, name))
            if isinstance(node, n.ForEach):
                inner = next((scope.types_in_loops[id(each)] for each in node.body[:1]), types)
                for item in node.items:
                    yield (id(node), node.variable), _Setter(item, scope, node, loops, _unit(inner, node.variable))
            elif isinstance(node, n.Call) and node.function in functions and node.function in known:
                yield from _arguments(functions[node.function], scope, node, loops)


def _arguments(
    function: n.Function, scope: Scope, node: n.Call, loops: tuple[n.ForEach, ...]
) -> Iterator[tuple[_Key, _Setter]]:
    given = dict(node.arguments)
    for parameter in function.parameters:
        value = given.get(parameter.name, Constant(parameter.default))
        yield (function.method, parameter.name), _Setter(value, scope, node, loops, parameter.unit)


def _key(scope: Scope, loops: tuple[n.ForEach, ...], name: str) -> _Key:
    loop = next((loop for loop in reversed(loops) if loop.variable == name), None)
    if loop is not None:
        return id(loop), name
    return (scope.name if name in scope.own else PROGRAM), name


def _unit(types: Types, name: str) -> str:
    return types.get(name, UNKNOWN_TYPE).unit


def _names_in(value: Expression) -> set[str]:
    return {part.name for part in parts_of(value) if isinstance(part, Variable)}


def _joined(found: list[Range]) -> Range:
    low = min((each.least, each.least_open) for each in found)
    high = max((each.most, not each.most_open) for each in found)
    return Range(low[0], high[0], low[1], not high[1])

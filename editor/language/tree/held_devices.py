"""Which devices variables may hold: all that any step puts into each, and whoever calls a function into its parameters.

The order of steps has no say, so that this is known before their types, on which the paths through a program depend.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from editor.language.expressions.nodes import OF_PROBLEM, Constant, Expression, Located, Operation, Reading, Variable
from editor.language.expressions.values import parts_of
from editor.language.site.surroundings import HeldDevice
from editor.language.tree import nodes as n
from editor.language.tree.program import Function, Tree
from editor.language.tree.traversal import Loops, with_loops
from editor.language.tree.variables import local_variables

Key = tuple[object, str]
"""Whose a name is (the method of a function, the identity of a loop, None: the program), and the name."""
Held = frozenset[HeldDevice]
"""The devices that a variable may hold; empty: not known."""
NOT_KNOWN: Held = frozenset()
_RESULT = ""


def held_devices(tree: Tree) -> Mapping[Key, Held]:
    """Return the devices that the variables of a program may hold; of one that is not there nothing is known."""
    return tree.derived(_held_devices)


def _held_devices(tree: Tree) -> Mapping[Key, Held]:
    if not any(map(_names_device, _given(tree))):
        return {}
    gathering = _Gathering(tree)
    for body in (tree.body, *(event.body for event in tree.events)):
        gathering.take_block(body, None)
    for function in tree.functions:
        gathering.take_block(function.body, function)
    return gathering.spread()


def _given(tree: Tree) -> Iterator[Expression]:
    """Yield the values that loops, steps and calls give to variables."""
    for loop in tree.of_kind(n.ForEach):
        yield from loop.items
    yield from (node.value for node in tree.of_kind(n.Set))
    yield from (value for call in tree.of_kind(n.Call) for _, value in call.arguments)


def _names_device(value: Expression) -> bool:
    if value.__class__ is Constant or value.__class__ is Variable:
        return False
    return any(isinstance(part, Located) and (part.device or part.role) is not None for part in parts_of(value))


@dataclass(slots=True)
class _Gathering:
    """What is put into each variable: devices, other variables, or something of which nothing is known."""

    tree: Tree
    functions: Mapping[str, Function] = field(init=False)
    own: dict[str, frozenset[str]] = field(default_factory=dict)
    """The parameters and variables of each function."""
    devices: defaultdict[Key, set[HeldDevice]] = field(default_factory=lambda: defaultdict(set))
    taken_by: defaultdict[Key, set[Key]] = field(default_factory=lambda: defaultdict(set))
    """The variables into which what another one holds is put."""
    anything: set[Key] = field(default_factory=set)

    def __post_init__(self) -> None:
        self.functions = {function.method: function for function in self.tree.functions}
        for function in self.tree.functions:
            parameters = [parameter.name for parameter in function.parameters]
            self.own[function.method] = frozenset([*parameters, *local_variables(self.tree, function)])
        self.anything = {(None, name) for name in (*OF_PROBLEM, *(given.name for given in self.tree.parameters))}

    def take_block(self, block: n.Block, function: Function | None) -> None:
        """Take what the steps of a body put into variables."""
        for node, loops in with_loops(block):
            scope = _Scope(loops, function, self.own)
            match node:
                case n.Set(variable=name, value=value):
                    self._put(scope.key(name), value, scope)
                case n.ForEach(variable=name, items=items, over=over):
                    for item in items if over is None else (over,):
                        self._put((id(node), name), item, scope)
                case n.Ask(variable=name):
                    self.anything.add(scope.key(name))
                case n.Return(value=value) if value is not None and function is not None:
                    self._put((function.method, _RESULT), value, scope)
                case n.Call(function=method) if method in self.functions:
                    self._take_call(node, self.functions[method], scope)

    def _take_call(self, node: n.Call, function: Function, scope: _Scope) -> None:
        given = dict(node.arguments)
        for parameter in function.parameters:
            value = given.get(parameter.name, Constant(parameter.default))
            self._put((function.method, parameter.name), value, scope)
        self.taken_by[function.method, _RESULT].add(scope.key(node.result))

    def _put(self, key: Key, value: Expression, scope: _Scope) -> None:
        for part in _whole(value):
            match part:
                case Located(device=str() as device):
                    self.devices[key].add(HeldDevice(device))
                case Located(role=str() as role):
                    self.devices[key].add(HeldDevice(role=role))
                case Constant(value=str(device)):
                    self.devices[key].add(HeldDevice(device))
                case Constant(value=tuple(devices)):
                    self.devices[key].update(HeldDevice(each) for each in devices if isinstance(each, str))
                case Variable(name=name):
                    self.taken_by[scope.key(name)].add(key)
                case Reading() | Operation():
                    self.anything.add(key)

    def spread(self) -> Mapping[Key, Held]:
        """Return what each variable may hold, also by way of others; without those that may hold anything."""
        left = [*self.devices.keys(), *self.anything]
        while left:
            key = left.pop()
            for taker in self.taken_by.get(key, ()):
                before = len(self.devices[taker]), taker in self.anything
                self.devices[taker] |= self.devices[key]
                self.anything |= {taker} if key in self.anything else set()
                if before != (len(self.devices[taker]), taker in self.anything):
                    left.append(taker)
        return {key: frozenset(held) for key, held in self.devices.items() if held and key not in self.anything}


@dataclass(frozen=True, slots=True)
class _Scope:
    """Where a step stands: it tells whose a name is there."""

    loops: Loops
    function: Function | None
    own: Mapping[str, frozenset[str]]

    def key(self, name: str) -> Key:
        """Return the variable that a name means here, the nearest of several."""
        for loop in reversed(self.loops):
            if name in loop.names:
                return id(loop), name
        if self.function is not None and name in self.own[self.function.method]:
            return self.function.method, name
        return None, name


_COMPUTED = frozenset({"<", "<=", ">", ">=", "==", "!=", "in", "not in", "and", "or", "not", "abs", "round", "len"})


def _whole(value: Expression) -> Iterable[Expression]:
    """Yield the parts of a value of which it may be one, or of whose items its own may be some."""
    match value:
        case Operation(operator="list" | "+", arguments=arguments):
            return [part for argument in arguments for part in _whole(argument)]
        case Operation(operator="nth", arguments=(whole, _)):
            return _whole(whole)
        case Operation(operator="nearest", arguments=(_, *candidates)):
            return [part for candidate in candidates for part in _whole(candidate)]
        case Operation(operator=name) if name in _COMPUTED:
            return ()
    return (value,)

"""Which devices variables may hold: all that any step puts into each, and whoever calls a function into its parameters.

The order of steps has no say, so that this is known before their types, on which the paths through a program depend.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Final, NamedTuple

from editor.language.expressions.nodes import (
    OF_PROBLEM,
    Constant,
    Expression,
    Located,
    Operation,
    PlaceRef,
    Quantity,
    Reading,
    Variable,
)
from editor.language.site.surroundings import HeldDevice
from editor.language.tree import nodes as n
from editor.language.tree.program import Function, Tree
from editor.language.tree.traversal import Loops, with_loops
from editor.language.tree.variables import SETTERS, VALUES, local_variables

Key = tuple[object, str]
"""Whose a name is (the method of a function, the identity of a loop, None: the program), and the name."""
Held = frozenset[HeldDevice]
"""The devices that a variable may hold; with none, it holds no device."""
_RESULT = ""


def held_devices(tree: Tree) -> Mapping[Key, Held]:
    """Return the devices that the variables of a program may hold; of one that is not there nothing is known.

    Where texts are put into variables only those are there that are used as a device.
    """
    return tree.derived(_held_devices)


def _held_devices(tree: Tree) -> Mapping[Key, Held]:
    if not _has_variables(tree):
        return {}
    chosen = any(parameter.type in _CHOSEN for parameter in tree.parameters)
    gathering = _Gathering(tree, _uses(tree) if chosen else {})
    for event in tree.events:
        gathering.note_uses(event, _Scope((), None, gathering.own))
    for body in (tree.body, *(event.body for event in tree.events)):
        gathering.take_block(body, None)
    for function in tree.functions:
        gathering.take_block(function.body, function)
    if not gathering.takes_texts:
        return gathering.spread()
    uses = gathering.uses if chosen else _uses(tree)
    names = {use.variable for used in uses.values() for use in used}
    return {key: held for key, held in gathering.spread().items() if key[1] in names} if names else {}


def _has_variables(tree: Tree) -> bool:
    has_parameters = tree.parameters or any(function.parameters for function in tree.functions)
    return bool(has_parameters) or tree.holds(*SETTERS, n.ForEach)


class _Use(NamedTuple):
    """That a step has to do with the device that a variable holds, and which method it carries out there, if any."""

    variable: str
    method: str = ""


def _uses(tree: Tree) -> dict[int, list[_Use]]:
    """Return what steps and events do with the devices that variables hold, by their identity; most do nothing."""
    found: dict[int, list[_Use]] = {}
    for kind, fields in VALUES.items():
        attributes = [attribute for attribute, _ in fields]
        for node in tree.of_kind(kind):
            used: list[_Use] = []
            for attribute in attributes:
                value = getattr(node, attribute)
                if value.__class__ is Operation:
                    _add_readings(value, used)
                elif value.__class__ not in _WITHOUT_USES:
                    _add_uses(node, value, used)
            if used:
                found[id(node)] = used
    for event in tree.events:
        used = []
        _add_readings(event.condition, used)
        found.update({id(event): used} if used else {})
    return found


_WITHOUT_USES: Final = frozenset({Constant, Quantity, Variable, Located, type(None)})


def _add_uses(node: n.Node, value: object, used: list[_Use]) -> None:
    """Add what a step does with devices that variables hold by one of its fields."""
    match value:
        case PlaceRef(value=Variable(name=name)):
            used.append(_Use(name, node.method if isinstance(node, n.Operate) else ""))
        case tuple():
            for each in value:
                _add_readings(each[1] if isinstance(each, tuple) else each, used)
        case _:
            _add_readings(value, used)


def _add_readings(value: object, used: list[_Use]) -> None:
    """Add what a value reads of devices that variables hold."""
    if isinstance(value, Operation):
        for argument in value.arguments:
            if argument.__class__ not in _WITHOUT_USES:
                _add_readings(argument, used)
    elif isinstance(value, Reading) and isinstance(value.device, Variable):
        used.append(_Use(value.device.name))


@dataclass(slots=True)
class _Gathering:
    """What is put into each variable: devices, other variables, or something of which nothing is known."""

    tree: Tree
    uses: Mapping[int, list[_Use]]
    """What steps do with devices that variables hold, where people choose one."""
    functions: Mapping[str, Function] = field(init=False)
    own: dict[str, frozenset[str]] = field(default_factory=dict)
    """The parameters and variables of each function."""
    devices: defaultdict[Key, set[HeldDevice]] = field(default_factory=lambda: defaultdict(set))
    taken_by: defaultdict[Key, set[Key]] = field(default_factory=lambda: defaultdict(set))
    """The variables into which what another one holds is put."""
    anything: set[Key] = field(default_factory=set)
    takes_texts: bool = False
    """A text, which may be the id of a device, is put into some variable."""
    used: defaultdict[Key, set[_Use]] = field(default_factory=lambda: defaultdict(set))

    def __post_init__(self) -> None:
        self.functions = {function.method: function for function in self.tree.functions}
        for function in self.tree.functions:
            parameters = [parameter.name for parameter in function.parameters]
            self.own[function.method] = frozenset([*parameters, *local_variables(self.tree, function)])
            self.devices.update({(function.method, name): set() for name in parameters})
        not_chosen = (parameter.name for parameter in self.tree.parameters if parameter.type not in _CHOSEN)
        self.anything = {(None, name) for name in (*OF_PROBLEM, *not_chosen)}

    def take_block(self, block: n.Block, function: Function | None) -> None:
        """Take what the steps of a body put into variables, and what they do with devices that these hold."""
        has_loops = self.tree.holds(n.ForEach)
        for node, loops in with_loops(block) if has_loops else ((node, ()) for node in self.tree.walked(block)):
            if node.__class__ in _GIVING or id(node) in self.uses:
                scope = _Scope(loops, function, self.own)
                self.note_uses(node, scope)
                self._take(node, scope)

    def note_uses(self, node: n.Node | n.Event, scope: _Scope) -> None:
        """Note what a step, or an event with its condition, does with devices that variables hold."""
        for use in self.uses.get(id(node), ()):
            self.used[scope.key(use.variable)].add(use)

    def _take(self, node: n.Node, scope: _Scope) -> None:
        match node:
            case n.Set(variable=name, value=value):
                self._put(scope.key(name), value, scope)
            case n.ForEach(variable=name, items=items, over=over):
                for item in items if over is None else (over,):
                    self._put((id(node), name), item, scope)
            case n.Ask(variable=name):
                self.anything.add(scope.key(name))
            case n.Return(value=value) if value is not None and scope.function is not None:
                self._put((scope.function.method, _RESULT), value, scope)
            case n.Call(function=method) if method in self.functions:
                self._take_call(node, self.functions[method], scope)
            case n.Call(result=name):
                self.anything.add(scope.key(name))

    def _take_call(self, node: n.Call, function: Function, scope: _Scope) -> None:
        given = dict(node.arguments)
        for parameter in function.parameters:
            value = given.get(parameter.name, Constant(parameter.default))
            self._put((function.method, parameter.name), value, scope)
        self._flow((function.method, _RESULT), scope.key(node.result))

    def _flow(self, key: Key, taker: Key) -> None:
        """Note that one variable takes what another one holds."""
        self.taken_by[key].add(taker)
        self.devices[taker] |= set()

    def _put(self, key: Key, value: Expression, scope: _Scope) -> None:
        held = self.devices[key]
        for part in _whole(value):
            match part:
                case Located(device=str() as device):
                    held.add(HeldDevice(device))
                case Located(role=str() as role):
                    held.add(HeldDevice(role=role))
                case Constant(value=str(device)):
                    self.takes_texts = True
                    held.add(HeldDevice(device))
                case Constant(value=tuple(devices)):
                    self.takes_texts = True
                    held.update(HeldDevice(each) for each in devices if isinstance(each, str))
                case Variable(name=name):
                    self._flow(scope.key(name), key)
                case Reading() | Operation():
                    self.anything.add(key)

    def spread(self) -> Mapping[Key, Held]:
        """Return what each variable may hold, also by way of others; without those that may hold anything."""
        for parameter in self.tree.parameters:
            if parameter.type in _CHOSEN:
                key: Key = (None, parameter.name)
                default = {HeldDevice(parameter.default)} if isinstance(parameter.default, str) else set()
                self.devices[key] |= {self._chosen(key), *default}
        left = [*self.devices.keys(), *self.anything]
        while left:
            key = left.pop()
            for taker in self.taken_by.get(key, ()):
                before = len(self.devices[taker]), taker in self.anything
                self.devices[taker] |= self.devices[key]
                self.anything |= {taker} if key in self.anything else set()
                if before != (len(self.devices[taker]), taker in self.anything):
                    left.append(taker)
        return {key: frozenset(held) for key, held in self.devices.items() if key not in self.anything}

    def _chosen(self, parameter: Key) -> HeldDevice:
        """Return the device that people choose for a parameter of the program, with what it is told to do."""
        reached, left = {parameter}, [parameter]
        while left:
            new = self.taken_by.get(left.pop(), set()) - reached
            reached |= new
            left.extend(new)
        return HeldDevice(methods=frozenset(u.method for key in reached for u in self.used.get(key, ()) if u.method))


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


_GIVING: Final = frozenset({*SETTERS, n.ForEach, n.Return})
"""The steps that give a variable something, or a call's result."""
_CHOSEN: Final = frozenset({"device", "place"})
"""The types of a program's parameters for which people choose a device."""
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

"""The domain of variables: which have a value here, and what is known of it: numbers between two, texts, truths.

Each variable is kept in one unit, and so are its numbers here. What something beside the path may set is not known.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import reduce
from math import ceil, floor, inf
from typing import ClassVar, Final

from editor.language.analysis.domain import Domain, Place, Transfer
from editor.language.analysis.effects import Effects
from editor.language.analysis.given import known_of, known_of_all
from editor.language.expressions.nodes import Constant, Expression, Operation, Reading, Variable
from editor.language.expressions.ranges import ANY, MOST_WORDS, Here, Items, Known, Range, either_known, limited
from editor.language.expressions.unit_conversion import convert_units
from editor.language.expressions.value_types import UNKNOWN_TYPE, TypeChecker, ValueType
from editor.language.expressions.values import MOST_ITEMS, is_number
from editor.language.site.surroundings import Surroundings
from editor.language.tree import nodes as n
from editor.language.tree.program import Function, Parameter

UNSET, MAYBE, SET = 0, 1, 2
Content = tuple[int, Known]
"""Whether a variable has a value, and what is known of it."""
Key = str | tuple[object, str]
"""A variable of the program by its name; one of a function or a loop with whose it is."""
Env = dict[Key, Content]
_EMPTY: Final[Content] = (UNSET, None)
_ANYTHING: Final[Content] = (SET, None)
_ELSE: Final = ("", "")
"""The key of what holds for every variable of the program that is not named."""
_RESULT: Final = ("", "result")


@dataclass(frozen=True, slots=True)
class Seen:
    """The variables as they are seen from a place."""

    domain: Variables
    place: Place
    env: Env

    def get(self, name: str, /) -> Known:
        """Return what is known of a variable."""
        return self.domain.content(self.place, self.env, name)[1]


@dataclass(slots=True)
class Variables(Domain[Env]):
    """The domain of variables of one program on one site."""

    surroundings: Surroundings
    parameters: Sequence[Parameter]
    types_at: Callable[[str, n.Node], Mapping[str, ValueType]]
    """Returns the types that are seen at a step of a body, which is told by its name."""
    tracked: frozenset[str]
    """The variables that some step sets."""
    _bare: Surroundings = field(init=False)
    _converted: dict[tuple[int, str, str], Expression] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._bare = replace(self.surroundings, devices={})

    # how it begins, and where paths meet

    def begin(self) -> Env:
        """Return that the program's parameters have a value."""
        return {each.name: (SET, known_of(each)) for each in self.parameters}

    def somewhere(self) -> Env:
        """Return that every variable of the program may have any value."""
        return {_ELSE: _ANYTHING}

    def in_event(self) -> Env:
        """Return that parameters which no step sets are still what the run was given."""
        known = known_of_all(self.parameters, self.tracked)
        return {_ELSE: _ANYTHING, **{name: (SET, each) for name, each in known.items()}}

    def copy(self, known: Env) -> Env:
        """Return the same for another path: an environment is changed in place by the steps of its path."""
        return dict(known)

    def meet(self, place: Place, before: Env, ends: Sequence[Env], effects: Effects) -> Env:
        """Return what holds where paths meet; what none of them sets is as it was before."""
        met = dict(before)
        for key in (*self._keys(place, effects), _RESULT):
            met[key] = reduce(_either, [_content(end, key) for end in ends])
        return met

    def widen(self, place: Place, entry: Env, after: Env, effects: Effects) -> Env:
        """Return what no round leaves: a number that grows has no end."""
        widened = dict(entry)
        for key in self._keys(place, effects):
            widened[key] = _widened(_content(entry, key), _content(after, key))
        return widened

    def disturb(self, place: Place, known: Env, effects: Effects) -> Env:
        """Return that what may have been set may have any value."""
        left = dict(known)
        for key in self._keys(place, effects):
            left[key] = (max(_content(known, key)[0], MAYBE), None)
        return left

    def beside(self, place: Place, known: Env, ends: Sequence[Env], effects: Effects) -> Env:
        """Return that what others set may have a value; what it may be is asked for where it is read."""
        inside = dict(known)
        for key in self._keys(place, effects):
            state, value = _content(known, key)
            inside[key] = (max(state, MAYBE), value)
        return inside

    def join(self, place: Place, before: Env, ends: Sequence[tuple[Env, Effects]]) -> Env:
        """Return what each branch set; of what several set nobody knows who was the last."""
        joined = dict(before)
        setters: dict[Key, list[Env]] = {}
        for env, effects in ends:
            for key in self._keys(place, effects):
                setters.setdefault(key, []).append(env)
        for key, envs in setters.items():
            contents = [_content(env, key) for env in envs]
            joined[key] = (max(each[0] for each in contents), contents[0][1] if len(envs) == 1 else None)
        return joined

    def interrupted(self, place: Place, known: Env, effects: Effects, passed: Env) -> Env:
        """Return that what may have been set may be any of what it was set to; what functions set is not known."""
        if effects.calls or place.put is None:
            return self.disturb(place, known, effects)
        left = dict(known)
        for key in self._keys(place, effects):
            state, value = _content(known, key)
            put = place.put.get(key) if isinstance(key, str) else None
            left[key] = (max(state, MAYBE), put if state == UNSET or put is None else either_known(value, put))
        return left

    def key(self, place: Place, known: Env, node: n.Call, function: Function) -> object:
        """Return what is known of the arguments, and of the program's variables that the function reads or sets."""
        effects = place.effects.functions[function.method]
        names = sorted(effects.reads | effects.shared)
        given = tuple(content for _, content in self._arguments(place, known, node, function))
        return given, tuple(_content(known, name) for name in names)

    def enter(self, place: Place, known: Env, node: n.Call, function: Function) -> Env:
        """Return the program's variables and the arguments; the function's own variables have no value yet."""
        inside: Env = {key: content for key, content in known.items() if isinstance(key, str) or key == _ELSE}
        inside.update(self._arguments(place, known, node, function))
        return inside

    def leave(self, place: Place, known: Env, after: Env, function: Function) -> Env:
        """Return what the caller knows, with what the function set."""
        left = dict(known)
        for name in place.effects.functions[function.method].shared:
            left[name] = _content(after, name)
        left[_RESULT] = after.get(_RESULT, _EMPTY)
        return left

    def _arguments(
        self, place: Place, known: Env, node: n.Call, function: Function
    ) -> Iterator[tuple[Key, Content]]:  # fmt: skip
        given = dict(node.arguments)
        for parameter in function.parameters:
            value = given.get(parameter.name, Constant(parameter.default))
            yield (function.method, parameter.name), (SET, self._value(place, known, value, parameter.unit, node))

    def enter_round(
        self, place: Place, known: Env, node: n.ForEach, items: Sequence[Expression], rounds: Range
    ) -> Env:  # fmt: skip
        """Return that the loop's variable is one of the items, and its number one of the rounds."""
        inside = self.types_at(place.frame.name, node.body[0]) if node.body else {}
        unit = inside.get(node.variable, UNKNOWN_TYPE).unit
        contents = [(SET, self._value(place, known, item, unit, node)) for item in items]
        if node.over is not None:
            listed = self._value(place, known, node.over, "", node)
            contents = [(SET, listed.each if isinstance(listed, Items) else None)]
        known[id(node), node.index] = (SET, rounds)
        known[id(node), node.variable] = reduce(_either, contents) if contents else _ANYTHING
        return known

    # what steps make of it

    def _set(self, place: Place, node: n.Set, known: Env) -> Env:
        unit = self._types(place, node).get(node.variable, UNKNOWN_TYPE).unit
        return self._put(place, known, node.variable, self._value(place, known, node.value, unit, node))

    def _ask(self, place: Place, node: n.Ask, known: Env) -> Env:
        answer = node.answer
        found: Known = None
        if answer.type == "number" and not answer.unit:
            found = Range(
                -inf if answer.minimum is None else answer.minimum, inf if answer.maximum is None else answer.maximum
            )
        elif answer.type == "choice" and len(answer.options) <= MOST_WORDS:
            found = frozenset(answer.options) or None
        return self._put(place, known, node.variable, None if found == ANY else found)

    def _return(self, place: Place, node: n.Return, known: Env) -> Env:
        function = place.frame.function
        if node.value is not None and function is not None:
            known[_RESULT] = (SET, self._value(place, known, node.value, function.result_unit, node))
        return known

    def _call(self, place: Place, node: n.Call, known: Env) -> Env:
        found = known.pop(_RESULT, _EMPTY)[1]
        return self._put(place, known, node.result, found)

    transfers: ClassVar[Mapping[type[n.Node], Transfer]] = {
        n.Set: _set,
        n.Ask: _ask,
        n.Return: _return,
        n.Call: _call,
    }

    def _put(self, place: Place, known: Env, name: str, value: Known) -> Env:
        if name:
            key = self._key_of(place, name)
            if place.put is not None and isinstance(key, str):
                place.put[key] = either_known(place.put.get(key, value), value)
            known[key] = (SET, value)
        return known

    # what is known

    def content(self, place: Place, known: Env, name: str) -> Content:
        """Return whether a variable has a value here, and what is known of it."""
        key = self._key_of(place, name)
        found = _content(known, key)
        if name not in place.volatile or not isinstance(key, str):
            return found
        beside = place.volatile[name]
        return found[0], beside if found[0] == UNSET or beside is None else either_known(found[1], beside)

    def state_of(self, place: Place, name: str) -> int:
        """Return whether a variable has a value at a place: `SET`, `MAYBE` or `UNSET`."""
        return self.content(place, place.states[0], name)[0] if name in self.tracked else SET

    def seen(self, place: Place) -> Seen:
        """Return the variables as they are seen from a place."""
        return Seen(self, place, place.states[0])

    def truth(self, place: Place, known: Env, node: n.If | n.While) -> bool | None:
        """Tell whether a step's condition holds here, as far as variables decide it."""
        return self._here(place, known).truth(self._convert(place, node.condition, "", node))

    def count(self, place: Place, known: Env, node: n.Repeat) -> tuple[int, int | None]:
        """Return how often a counted loop goes round, at least and at most."""
        found = self._here(place, known).range(self._convert(place, node.times, "", node))
        if found.least == found.most and found.least != int(found.least):
            return 0, None
        least = max(0, int(found.least)) if found.least > -inf else 0
        return least, None if found.most == inf else max(0, int(found.most))

    def length(self, place: Place, known: Env, node: n.ForEach) -> tuple[int, int]:
        """Return how many items a loop goes through, at least and at most."""
        if node.over is None:
            return len(node.items), len(node.items)
        listed = self._value(place, known, node.over, "", node)
        return (listed.least, listed.most) if isinstance(listed, Items) else (0, MOST_ITEMS)

    def value(self, place: Place, expression: Expression, node: n.Node) -> Known:
        """Return what is known of a value at a place."""
        return self._value(place, place.states[0], expression, "", node)

    def _value(self, place: Place, known: Env, expression: Expression, unit: str, node: n.Node) -> Known:
        found = self._here(place, known).known(self._convert(place, expression, unit, node))
        return None if isinstance(found, frozenset) and len(found) > MOST_WORDS else found

    def _here(self, place: Place, known: Env) -> Here:
        """Paths go by variables alone: devices may leave the ranges that they declare."""
        return Here(self._bare, Seen(self, place, known))

    def _convert(self, place: Place, expression: Expression, unit: str, node: n.Node) -> Expression:
        key = id(expression), unit, place.frame.name
        if key not in self._converted:
            types = self.types_at(place.frame.name, node)
            self._converted[key] = convert_units(expression, unit, TypeChecker(self.surroundings, types, []))
        return self._converted[key]

    def _types(self, place: Place, node: n.Node) -> Mapping[str, ValueType]:
        return self.types_at(place.frame.name, node)

    def assume(self, place: Place, known: Env, node: n.If | n.While, *, holds: bool) -> Env:
        """Narrow what is known of variables by a step's condition that holds, or does not."""
        self._assume(place, known, self._convert(place, node.condition, "", node), holds=holds)
        return known

    def _assume(self, place: Place, known: Env, condition: Expression, *, holds: bool) -> None:
        match condition:
            case Operation(operator="not", arguments=(inner,)):
                self._assume(place, known, inner, holds=not holds)
            case Operation(operator="and" | "or" as name, arguments=arguments) if (name == "and") == holds:
                for argument in arguments:
                    self._assume(place, known, argument, holds=holds)
            case Variable(name=name):
                self._narrow(place, known, name, frozenset({holds}))
            case Operation(
                operator="==" | "!=" as name, arguments=(Variable(name=variable), Constant(value=value))
            ) if isinstance(value, str | bool):
                if (name == "==") == holds:
                    self._narrow(place, known, variable, frozenset({value}))
            case Operation(
                operator="==" | "!=" as name, arguments=(Variable(name=variable), Constant(value=value))
            ) if is_number(value) and (name == "!=") == holds:
                self._narrow(place, known, variable, _without(self.content(place, known, variable)[1], value))
            case Operation(operator=name, arguments=arguments) if name in _OPPOSITE:
                self._limit(place, known, condition if holds else Operation(_OPPOSITE[name], arguments))

    def _limit(self, place: Place, known: Env, comparison: Operation) -> None:
        """Take in a comparison that holds: of a variable with a number, or of how long its list is."""
        match comparison:
            case Operation(
                operator=name, arguments=(Operation(operator="len", arguments=(Variable() as whole,)), most)
            ):
                self._narrow_length(place, known, whole.name, limited(Operation(name, (whole, most))))
                return
        found = limited(comparison)
        if found is not None and isinstance(found[0], Variable):
            self._narrow(place, known, found[0].name, found[1])

    def _narrow_length(
        self, place: Place, known: Env, name: str, found: tuple[Reading | Variable, Range] | None
    ) -> None:  # fmt: skip
        """Take in that a list has so many items."""
        listed = self.content(place, known, name)[1]
        if found is None:
            return
        items, limits = listed if isinstance(listed, Items) else Items(), found[1]
        least = floor(limits.least) + 1 if limits.least_open else ceil(limits.least) if limits.least > -inf else 0
        most = ceil(limits.most) - 1 if limits.most_open else floor(limits.most) if limits.most < inf else items.most
        least, most = max(items.least, least), min(items.most, most)
        if least <= most:
            self._narrow(place, known, name, Items(least, most, items.each, items.sure))

    def _narrow(self, place: Place, known: Env, name: str, to: Known) -> None:
        state, value = self.content(place, known, name)
        if name in place.volatile or state == UNSET or to is None:
            return
        if isinstance(value, Range) and isinstance(to, Range):
            met = value.meet(to)
            to = value if met.empty else met
        known[self._key_of(place, name)] = (state, to)

    # whose a name is

    def _key_of(self, place: Place, name: str) -> Key:
        frame = place.frame
        for loop in reversed(frame.loops):
            if name in loop.names:
                return id(loop), name
        function = frame.function
        if function is not None and name in place.effects.own[function.method]:
            return function.method, name
        return name

    def _keys(self, place: Place, effects: Effects) -> set[Key]:
        return {self._key_of(place, name) for name in effects.names} | effects.shared


_OPPOSITE: Final[Mapping[str, str]] = {"<": ">=", ">=": "<", ">": "<=", "<=": ">", "==": "!=", "!=": "=="}


def _content(env: Env, key: Key) -> Content:
    found = env.get(key)
    if found is None:
        found = env.get(_ELSE, _EMPTY) if isinstance(key, str) else _EMPTY
    return found


def _either(first: Content, second: Content) -> Content:
    """Return what holds after one path or the other; what has no value on one of them may have one."""
    if first == second:
        return first
    state = first[0] if first[0] == second[0] else MAYBE
    if UNSET in {first[0], second[0]}:
        return state, first[1] if second[0] == UNSET else second[1]
    return state, either_known(first[1], second[1])


def _without(known: Known, number: float) -> Known:
    """Return what is left of a range when it is not this number, as far as a range can say that."""
    if not isinstance(known, Range):
        return None
    low, high = known.least_open or known.least == number, known.most_open or known.most == number
    return Range(known.least, known.most, low, high, known.not_zero or number == 0)


def _widened(before: Content, after: Content) -> Content:
    state, value = _either(before, after)
    first = before[1]
    if isinstance(first, Range) and isinstance(value, Range) and value != first:
        falls, grows = value.least < first.least, value.most > first.most
        found = Range(-inf if falls else value.least, inf if grows else value.most)
        return state, None if found == ANY else found
    if isinstance(first, Items) and isinstance(value, Items) and value != first:
        least, most = 0 if value.least < first.least else first.least, first.most
        each = value.each if value.each == first.each else None
        return state, Items(least, MOST_ITEMS if value.most > most else most, each)
    return state, value

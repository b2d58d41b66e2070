"""The nodes of a tree → the lines of a script; one small function for each construct."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from editor.language.expression_text import quantity_text, scalar_text, write_expression
from editor.language.names import RESERVED_MEMBERS, snake_case, unique_name
from editor.language.nodes import (
    COMPOSITES,
    Ask,
    Block,
    Break,
    Call,
    Drop,
    End,
    ForEach,
    If,
    Move,
    Node,
    Notify,
    Operate,
    Parallel,
    Pick,
    Point,
    Repeat,
    Return,
    Set,
    Tree,
    Try,
    Wait,
    WaitUntil,
    While,
)
from editor.language.numbering import letters_of
from editor.language.plan import Expression, Located, PlaceRef, Quantity
from editor.language.quoting import quote
from editor.language.remembering import Memory
from editor.language.surroundings import Surroundings

ERROR_CLASSES: Mapping[str, str] = {
    "refused": "Refused",
    "failed": "Failed",
    "timed_out": "TimedOut",
    "offline": "Offline",
    "blocked": "Blocked",
    "cancelled": "Cancelled",
}
_INDENTS = tuple("    " * depth for depth in range(80))


@dataclass(frozen=True, slots=True)
class _Printed:
    """The lines of a step that holds others, and where each node stands in them, counted from 1."""

    texts: tuple[str, ...]
    steps: tuple[str, ...]
    places: tuple[tuple[int, int], ...]
    names: Mapping[PlaceRef | Located | str, str]


@dataclass(slots=True)
class Printer:
    """The text so far, and the names that devices and places have in it."""

    tree: Tree
    surroundings: Surroundings
    numbers: Mapping[str, str]
    taken: set[str]
    texts: list[str] = field(default_factory=list)
    steps: list[str] = field(default_factory=list)
    places: list[tuple[int, int]] = field(default_factory=list)
    """The line of each node, by the node's identity."""
    attributes: dict[PlaceRef | str, str] = field(default_factory=dict)
    """Devices (by id) and places, with their names in the script, in the order of first use."""
    locals: tuple[str, ...] = ()
    """The parameters and variables that belong to the method being printed, or to a loop in it."""
    branches: list[tuple[str, tuple[str, ...], Block]] = field(default_factory=list)
    """Methods of parallel branches that are still to be printed, each with what it can see."""
    method_names: dict[tuple[str, str], str | None] = field(default_factory=dict)
    property_names: dict[tuple[str, str], str | None] = field(default_factory=dict)
    zone_names: Mapping[str, str] = field(default_factory=dict)
    """What people call the zones, by id."""
    zones: dict[str, str] = field(default_factory=dict)
    """Zones (by id) with their names in the script, in the order of first use."""
    known: Memory | None = None
    used: dict[PlaceRef | Located | str, str] = field(default_factory=dict)
    """The devices, places and zones that the step being printed names, in the order of first use."""

    def line(self, depth: int, text: str, step: str = "") -> None:
        """Add a line."""
        self.texts.append(_INDENTS[depth] + text)
        self.steps.append(step)

    def block(self, block: Block, depth: int) -> None:
        """Print a block; an empty one says so."""
        for node in block:
            if self.known is not None and node.__class__ in COMPOSITES:
                self._holding(self.known, node, depth)
            else:
                self.places.append((id(node), len(self.texts) + 1))
                PRINTERS[type(node)](self, node, depth)
        if not block:
            self.line(depth, "pass")

    def _holding(self, memory: Memory, node: Node, depth: int) -> None:
        """Print a step that holds others, or take its lines as they were when all names are still the same."""
        given = depth, self.locals
        known: _Printed | None = memory.recall(node, given)
        begin = len(self.texts)
        if known is None or not self._names_still(known.names):
            known = self._print_anew(node, depth)
            if known is not None:
                memory.keep(node, known, given)
        else:
            self.texts.extend(known.texts)
            self.steps.extend(known.steps)
            self.used.update(known.names)
            self.places.extend([(key, begin + line) for key, line in known.places])

    def _names_still(self, names: Mapping[PlaceRef | Located | str, str]) -> bool:
        """Tell whether things have these names still; those that have none yet get theirs, in this order."""
        return all(self._name_of(key) == name for key, name in names.items())

    def _print_anew(self, node: Node, depth: int) -> _Printed | None:
        """Print a step that holds others; None where its lines depend on its number, or print more elsewhere."""
        outside, self.used = self.used, {}
        begin, branches, placed = len(self.texts), len(self.branches), len(self.places)
        self.places.append((id(node), begin + 1))
        PRINTERS[type(node)](self, node, depth)
        names, self.used = self.used, outside
        self.used.update(names)
        if len(self.branches) != branches:
            return None
        places = tuple((key, line - begin) for key, line in self.places[placed:])
        return _Printed(tuple(self.texts[begin:]), tuple(self.steps[begin:]), places, names)

    def _name_of(self, key: PlaceRef | Located | str) -> str:
        if isinstance(key, str):
            return self.device(key)
        return self.named_place(key) if isinstance(key, PlaceRef) else self.zone(key.zone or "")

    def device(self, device_id: str) -> str:
        """Return the attribute of a device, giving it one at its first use."""
        known = self.attributes.get(device_id)
        if known is None:
            facts = self.surroundings.devices.get(device_id)
            known = self._new_attribute(device_id, facts.description.name if facts else device_id)
        self.used[device_id] = known
        return known

    def named_place(self, place: PlaceRef) -> str:
        """Return the attribute of a named place, giving it one at its first use."""
        known = self.attributes.get(place)
        if known is None:
            facts = self.surroundings.places.get(place.place or "")
            known = self._new_attribute(place, facts.name if facts else place.place or "")
        self.used[place] = known
        return known

    def zone(self, zone_id: str) -> str:
        """Return the attribute of a zone, giving it one at its first use."""
        if zone_id not in self.zones:
            attribute = unique_name(self.zone_names.get(zone_id) or zone_id, self.taken)
            self.taken.add(attribute)
            self.zones[zone_id] = f"self.{attribute}"
        self.used[Located(zone=zone_id)] = self.zones[zone_id]
        return self.zones[zone_id]

    def located(self, located: Located) -> str:
        """Return how a device, a named place, a role's robot or a zone is written."""
        if located.device is not None:
            return self.device(located.device)
        if located.place is not None:
            return self.named_place(PlaceRef(place=located.place))
        return f"self.{located.role}" if located.role is not None else self.zone(located.zone or "")

    def quantity(self, quantity: Quantity) -> str:
        """Return how a number with its unit is written."""
        return quantity_text(quantity)

    def _new_attribute(self, key: PlaceRef | str, name: str) -> str:
        attribute = unique_name(name, self.taken)
        self.taken.add(attribute)
        self.attributes[key] = f"self.{attribute}"
        return self.attributes[key]

    def variable(self, name: str) -> str:
        """Return a parameter or a variable as it is written here: the method's or loop's own, or the program's."""
        return name if name in self.locals else f"self.{name}"

    def reading(self, device: str, property_name: str) -> str:
        """Return how a device's property is written."""
        key = (device, property_name)
        if key not in self.property_names:
            facts = self.surroundings.devices.get(device)
            known = [p.name for p in facts.description.properties] if facts else []
            self.property_names[key] = member_name(property_name, known)
        member = self.property_names[key]
        attribute = self.device(device)
        return f"{attribute}.{member}" if member else f"{attribute}.read({quote(property_name)})"

    def value(self, expression: Expression) -> str:
        """Return an expression as text."""
        return write_expression(expression, self)

    def place(self, place: PlaceRef) -> str:
        """Return where a robot goes as text."""
        if place.device is not None:
            return f"{self.device(place.device)}.location"
        if place.place is not None:
            return f"{self.named_place(place)}.location"
        if place.point is not None:
            return _point(place.point)
        return "None" if place.value is None else f"{self.value(place.value)}.location"


def member_name(wanted: str, known: list[str]) -> str | None:
    """Return the script name of a method or property; None where it would not be clear which one is meant."""
    name = snake_case(wanted)
    alike = [other for other in known if snake_case(other) == name]
    return name if alike == [wanted] and name not in RESERVED_MEMBERS else None


def _point(point: Point) -> str:
    return f"({scalar_text(point[0])}, {scalar_text(point[1])})"


def _move(printer: Printer, node: Move, depth: int) -> None:
    via = f", via=[{', '.join(map(_point, node.route))}]" if node.route else ""
    printer.line(depth, f"self.{node.role}.move({printer.place(node.to)}{via})", node.step)


def _pick(printer: Printer, node: Pick, depth: int) -> None:
    printer.line(depth, f"self.{node.role}.pick({_load(printer, node)})", node.step)


def _drop(printer: Printer, node: Drop, depth: int) -> None:
    printer.line(depth, f"self.{node.role}.drop({_load(printer, node)})", node.step)


def _load(printer: Printer, node: Pick | Drop) -> str:
    return f'{{"value": {printer.value(node.quantity)}, "object": {printer.value(node.object)}}}'


def _operate(printer: Printer, node: Operate, depth: int) -> None:
    device = node.device
    if device.device is not None:
        target = printer.device(device.device)
    elif device.value is not None:
        target = printer.value(device.value)
    else:
        target = "None" if device == PlaceRef() else printer.place(device).removesuffix(".location")
    printer.line(depth, f"{target}.{_order(printer, node)}", node.step)


def _order(printer: Printer, node: Operate) -> str:
    """Return `cure_paint(10)`, or the long form where the device's description does not say enough."""
    given = dict(node.arguments)
    facts = printer.surroundings.devices.get(node.device.device or "")
    method = facts.description.method(node.method) if facts else None
    if facts is not None and method is not None and given.keys() <= {p.name for p in method.parameters}:
        key = (facts.description.id, node.method)
        if key not in printer.method_names:
            printer.method_names[key] = member_name(node.method, [m.name for m in facts.description.methods])
        member = printer.method_names[key]
        if member:
            ordered = [given.get(parameter.name) for parameter in method.parameters]
            while ordered and ordered[-1] is None and not method.parameters[len(ordered) - 1].required:
                ordered.pop()
            values = ("None" if value is None else printer.value(value) for value in ordered)
            return f"{member}({', '.join(values)})"
    name = quote(node.method) if node.method else "None"
    arguments = ", ".join(f"{quote(key)}: {printer.value(value)}" for key, value in node.arguments)
    return f"operate({name}, {{{arguments}}})" if arguments else f"operate({name})"


def _wait(printer: Printer, node: Wait, depth: int) -> None:
    printer.line(depth, f"self.wait({printer.value(node.seconds)})", node.step)


def _wait_until(printer: Printer, node: WaitUntil, depth: int) -> None:
    timeout = "" if node.timeout_s is None else f", timeout={printer.value(node.timeout_s)}"
    printer.line(depth, f"self.wait(until={printer.value(node.condition)}{timeout})", node.step)


def _if(printer: Printer, node: If, depth: int) -> None:
    printer.line(depth, f"if {printer.value(node.condition)}:", node.step)
    printer.block(node.then, depth + 1)
    if node.otherwise:
        printer.line(depth, "else:", node.step)
        printer.block(node.otherwise, depth + 1)


def _while(printer: Printer, node: While, depth: int) -> None:
    printer.line(depth, f"while {printer.value(node.condition)}:", node.step)
    printer.block(node.body, depth + 1)


def _parallel(printer: Printer, node: Parallel, depth: int) -> None:
    number = printer.numbers[node.step].replace(".", "_")
    names = [(f"branch_{number}{letter}", printer.locals, block) for letter, block in letters_of(node)]
    printer.branches.extend(names)
    references = [f"self.{name}" for name, _, _ in names]
    handed_on = [f"{name}={name}" for name in printer.locals]
    printer.line(depth, f"self.parallel({', '.join([*references, *handed_on])})", node.step)


def _try(printer: Printer, node: Try, depth: int) -> None:
    printer.line(depth, "try:", node.step)
    printer.block(node.body, depth + 1)
    if node.catches:
        classes = [ERROR_CLASSES[kind] for kind in node.kinds] or ["TaskError"]
        caught = classes[0] if len(classes) == 1 else f"({', '.join(classes)})"
        printer.line(depth, f"except {caught} as problem:", node.step)
        printer.block(node.catch, depth + 1)
    if node.final or not node.catches:
        printer.line(depth, "finally:", node.step)
        printer.block(node.final, depth + 1)


def _call(printer: Printer, node: Call, depth: int) -> None:
    arguments = ", ".join(f"{name}={printer.value(value)}" for name, value in node.arguments)
    text = f"self.{node.function}({arguments})" if node.function else "self.call(None)"
    printer.line(depth, _taken(printer, node.result, text), node.step)


def _taken(printer: Printer, variable: str, text: str) -> str:
    """Return a call whose value goes into a variable, if there is one."""
    return f"{printer.variable(variable)} = {text}" if variable else text


def _repeat(printer: Printer, node: Repeat, depth: int) -> None:
    printer.line(depth, f"for _ in range({printer.value(node.times)}):", node.step)
    printer.block(node.body, depth + 1)


def _for_each(printer: Printer, node: ForEach, depth: int) -> None:
    items = ", ".join(map(printer.value, node.items))
    printer.line(depth, f"for {node.variable or '_'} in [{items}]:", node.step)
    outside = printer.locals
    if node.variable and node.variable not in outside:
        printer.locals = (*outside, node.variable)
    printer.block(node.body, depth + 1)
    printer.locals = outside


def _set(printer: Printer, node: Set, depth: int) -> None:
    value = printer.value(node.value)
    text = f"{printer.variable(node.variable)} = {value}" if node.variable else f"self.set(None, {value})"
    printer.line(depth, text, node.step)


def _ask(printer: Printer, node: Ask, depth: int) -> None:
    answer = node.answer
    limits = {"minimum": answer.minimum, "maximum": answer.maximum}
    given = [printer.value(node.question), f"type={quote(answer.type)}"]
    given += [f"unit={quote(answer.unit)}"] if answer.unit else []
    given += [f"{name}={scalar_text(limit)}" for name, limit in limits.items() if limit is not None]
    given += [f"options=[{', '.join(map(quote, answer.options))}]"] if answer.options else []
    given += [] if node.timeout_s is None else [f"timeout={printer.value(node.timeout_s)}"]
    printer.line(depth, _taken(printer, node.variable, f"self.ask({', '.join(given)})"), node.step)


def _notify(printer: Printer, node: Notify, depth: int) -> None:
    printer.line(depth, f"self.notify({printer.value(node.message)}, level={quote(node.level)})", node.step)


def _end(printer: Printer, node: End, depth: int) -> None:
    printer.line(depth, "self.end()", node.step)


def _return(printer: Printer, node: Return, depth: int) -> None:
    printer.line(depth, "return" if node.value is None else f"return {printer.value(node.value)}", node.step)


def _break(printer: Printer, node: Break, depth: int) -> None:
    printer.line(depth, "break", node.step)


PRINTERS: Mapping[type[Node], Callable[..., None]] = {
    Move: _move,
    Pick: _pick,
    Drop: _drop,
    Operate: _operate,
    Wait: _wait,
    WaitUntil: _wait_until,
    If: _if,
    While: _while,
    Parallel: _parallel,
    Try: _try,
    Call: _call,
    Repeat: _repeat,
    ForEach: _for_each,
    Set: _set,
    Ask: _ask,
    Notify: _notify,
    End: _end,
    Return: _return,
    Break: _break,
}

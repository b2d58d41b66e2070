"""The text of a script while it is being printed, and the names that things have in it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from editor.language.analysis.memo import Memo
from editor.language.expressions.names import member_name, unique_name
from editor.language.expressions.nodes import OF_PROBLEM, Expression, Located, PlaceRef, Point, Quantity
from editor.language.expressions.printing import quantity_text, read_of, scalar_text, write_expression
from editor.language.site.surroundings import Surroundings
from editor.language.tree.nodes import COMPOSITES, Block, Node
from editor.language.tree.program import Tree
from editor.language.tree.robots import described_alike, robots_for, short_name, short_reading
from vipo_device.protocol.description import MethodSpec

CHOSEN = "robot"
"""What the condition of a choice calls the robot that may be chosen."""
_INDENTS = tuple("    " * depth for depth in range(80))


@dataclass(frozen=True, slots=True)
class _Printed:
    """The lines of a step that holds others, and where each node stands in them, counted from 1."""

    text: str
    steps: tuple[str, ...]
    places: Mapping[int, int]
    names: Mapping[PlaceRef | Located | str, str]


@dataclass(slots=True)
class Printer:
    """The text so far, and the names that devices and places have in it."""

    tree: Tree
    surroundings: Surroundings
    numbers: Mapping[str, str]
    taken: set[str]
    printers: Mapping[type[Node], Callable[..., None]]
    """How each construct is printed."""
    texts: list[str] = field(default_factory=list)
    """Lines, and where steps are taken as they were, several of them in one."""
    steps: list[str] = field(default_factory=list)
    """The step of each line."""
    places: dict[int, int] = field(default_factory=dict)
    """The line of each node, by the node's identity."""
    attributes: dict[PlaceRef | str, str] = field(default_factory=dict)
    """Devices (by id) and places, with their names in the script, in the order of first use."""
    locals: tuple[str, ...] = ()
    """The parameters and variables that belong to the method being printed, or to a loop in it."""
    branches: list[tuple[str, tuple[str, ...], Block]] = field(default_factory=list)
    """Methods of parallel branches that are still to be printed, each with what it can see."""
    method_names: dict[tuple[str, str], str | None] = field(default_factory=dict)
    property_names: dict[tuple[str | Located, str], str | None] = field(default_factory=dict)
    own_methods: dict[tuple[str, str], tuple[str | None, MethodSpec | None]] = field(default_factory=dict)
    """What the methods of a role's robot are called, with their parameters, by role and method."""
    zone_names: Mapping[str, str] = field(default_factory=dict)
    """What people call the zones, by id."""
    zones: dict[str, str] = field(default_factory=dict)
    """Zones (by id) with their names in the script, in the order of first use."""
    memo: Memo | None = None
    chosen: str = ""
    """The role whose choice is being printed."""
    used: dict[PlaceRef | Located | str, str] = field(default_factory=dict)
    """The devices, places and zones that the step being printed names, in the order of first use."""

    def line(self, depth: int, text: str, step: str = "") -> None:
        """Add a line."""
        self.texts.append(_INDENTS[depth] + text)
        self.steps.append(step)

    def block(self, block: Block, depth: int) -> None:
        """Print a block; an empty one says so."""
        for node in block:
            if self.memo is not None and node.__class__ in COMPOSITES:
                self._holding(self.memo, node, depth)
            else:
                self.places[id(node)] = len(self.steps) + 1
                self.printers[type(node)](self, node, depth)
        if not block:
            self.line(depth, "pass")

    def _holding(self, memo: Memo, node: Node, depth: int) -> None:
        """Print a step that holds others, or take its lines as they were when all names are still the same."""
        given = depth, self.locals
        known: _Printed | None = memo.get(node, given)
        if known is None or not (known.names.items() <= self.used.items() or self._names_still(known.names)):
            known = self._print_anew(node, depth)
            if known is not None:
                memo.put(node, known, given)
        else:
            begin = len(self.steps)
            self.texts.append(known.text)
            self.steps += known.steps
            self.used.update(known.names)
            for key, line in known.places.items():
                self.places[key] = begin + line

    def _names_still(self, names: Mapping[PlaceRef | Located | str, str]) -> bool:
        """Tell whether things have these names still; those that have none yet get theirs, in this order."""
        return all(self._name_of(key) == name for key, name in names.items())

    def _print_anew(self, node: Node, depth: int) -> _Printed | None:
        """Print a step that holds others; None where its lines depend on its number, or print more elsewhere."""
        outside = self.used, self.places
        self.used, self.places = {}, {id(node): len(self.steps) + 1}
        first, begin, branches = len(self.texts), len(self.steps), len(self.branches)
        self.printers[type(node)](self, node, depth)
        names, places = self.used, self.places
        self.used, self.places = outside
        self.used.update(names)
        self.places.update(places)
        if len(self.branches) != branches:
            return None
        inside = {key: line - begin for key, line in places.items()}
        return _Printed("\n".join(self.texts[first:]), tuple(self.steps[begin:]), inside, names)

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
        return name if name in self.locals or name in OF_PROBLEM else f"self.{name}"

    def own_method(self, role: str, method: str) -> tuple[str | None, MethodSpec | None]:
        """Return the short name of a method of a role's robot, and its description; None where it is not clear."""
        key = (role, method)
        if key not in self.own_methods:
            found = next(each for each in self.tree.roles if each.name == role)
            robots = robots_for(self.surroundings, found.device, found.can)
            self.own_methods[key] = short_name(robots, method), described_alike(robots, method)
        return self.own_methods[key]

    def reading(self, device: str, property_name: str) -> str:
        """Return how a device's property is written."""
        key = (device, property_name)
        if key not in self.property_names:
            facts = self.surroundings.devices.get(device)
            known = [p.name for p in facts.description.properties] if facts else []
            self.property_names[key] = member_name(property_name, known)
        member = self.property_names[key]
        attribute = self.device(device)
        return read_of(attribute, member, property_name)

    def robot_reading(self, role: str, property_name: str) -> str:
        """Return how a property of a role's robot is written."""
        key = (Located(role=role or self.chosen), property_name)
        if key not in self.property_names:
            self.property_names[key] = short_reading(self.surroundings.crew.robots(role or self.chosen), property_name)
        return read_of(f"self.{role}" if role else CHOSEN, self.property_names[key], property_name)

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
            return point_text(place.point)
        return "None" if place.value is None else f"{self.value(place.value)}.location"


def point_text(point: Point) -> str:
    """Return how a point on the map is written."""
    return f"({scalar_text(point[0])}, {scalar_text(point[1])})"

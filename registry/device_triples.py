"""What triples say of one device: the canonical description out of RDF, in whatever form it came."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from math import isfinite
from typing import Any, cast

from registry.capability import (
    Description,
    DeviceKind,
    MethodSpec,
    ParameterSpec,
    Pose,
    PropertySpec,
    Size,
    ValueType,
)
from registry.rdf_text import NAMESPACES, BadDescription
from registry.triples import BLANK, FIRST, NIL, RDF, REST, Node, Text, Triples
from registry.wire import down_topic

MOST_ITEMS = 256
_KINDS: dict[str, DeviceKind] = {"vipo:Machine": "machine", "vipo:Robot": "robot"}


def describe(triples: Triples) -> Description:
    """Return what the triples say of their one device. Raises BadDescription."""
    device, kind = _the_device(triples)
    own_id, radius = device.text("dct:identifier"), device.number("vipo:radius", 0.0)
    if not own_id:
        raise BadDescription('The description needs the device\'s id: dct:identifier "lamp01".')
    return Description(
        id=own_id,
        name=device.text("dct:title") or own_id,
        kind=kind,
        device_class=device.text("vipo:deviceClass"),
        pose=_pose(device),
        size=_size(device, radius if kind == "robot" else 0.0),
        description=device.text("dct:description"),
        image=device.text("schema:image"),
        site=device.text("vipo:site"),
        done=device.truth("vipo:done", default=True),
        simulated=device.truth("vipo:simulated", default=False),
        gives=device.words("vipo:gives"),
        takes=device.words("vipo:takes"),
        capacity=device.whole("vipo:capacity"),
        radius_m=radius,
        speed_m_s=device.number("vipo:speed", 0.0),
        properties=tuple(_property(each) for each in device.in_order("td:hasPropertyAffordance")),
        methods=tuple(_method(each, own_id) for each in device.in_order("td:hasActionAffordance")),
    )


@cache
def _full(short: str) -> str:
    prefix, _, name = short.partition(":")
    return NAMESPACES[prefix] + name


@dataclass(frozen=True, slots=True)
class _Thing:
    """A node and what is said of it; every question names its predicate in short. Raises BadDescription."""

    triples: Triples
    node: Node

    def one(self, short: str) -> Node | None:
        found = self.triples.objects(self.node, _full(short))
        if len(found) > 1:
            raise BadDescription(f"The description gives {short} more than once.")
        return found[0] if found else None

    def text(self, short: str) -> str:
        found = self.one(short)
        return "" if found is None else _text_of(found, short)

    def number(self, short: str, default: float) -> float:
        found = self.one(short)
        return default if found is None else _number_of(found, short)

    def limit(self, short: str) -> float | None:
        found = self.one(short)
        return None if found is None else _number_of(found, short)

    def whole(self, short: str) -> int:
        number = self.number(short, 0.0)
        if not number.is_integer():
            raise BadDescription(f"The description needs a whole number for {short}.")
        return int(number)

    def truth(self, short: str, *, default: bool) -> bool:
        found = self.one(short)
        if found is None:
            return default
        said = _text_of(found, short).lower()
        if said not in {"true", "false", "0", "1"}:
            raise BadDescription(f"The description needs true or false for {short}.")
        return said in {"true", "1"}

    def words(self, short: str) -> tuple[str, ...]:
        found = self.triples.objects(self.node, _full(short))
        return tuple(sorted({_text_of(word, short) for word in found}))

    def items(self, short: str) -> list[Node]:
        """Return an RDF list's members; a list that bites its tail ends where it repeats."""
        node, items, seen = self.one(short), list[Node](), set[Node]()
        while node is not None and node != NIL and node not in seen and len(items) <= MOST_ITEMS:
            seen.add(node)
            first, rest = self.triples.objects(node, FIRST), self.triples.objects(node, REST)
            if len(first) != 1 or len(rest) > 1:
                raise BadDescription(f"The description needs a list for {short}.")
            items.append(first[0])
            node = rest[0] if rest else None
        return items

    def numbers(self, short: str) -> list[float]:
        return [_number_of(item, short) for item in self.items(short)]

    def in_order(self, short: str) -> list[_Thing]:
        """Return affordances by schema:position where it is given, then by name: RDF itself has no order."""
        found = [_Thing(self.triples, node) for node in self.triples.objects(self.node, _full(short))]
        return sorted(found, key=lambda each: (each.number("schema:position", 1000.0), each.text("td:name")))


def _text_of(node: Node, short: str) -> str:
    if isinstance(node, Text):
        return node.text
    if node.startswith(BLANK):
        raise BadDescription(f"The description needs text for {short}.")
    return node


def _number_of(node: Node, short: str) -> float:
    """Read a literal's text, whatever its datatype says of it."""
    try:
        number = float(node.text) if isinstance(node, Text) else float("nan")
    except ValueError:
        number = float("nan")
    if not isfinite(number):
        raise BadDescription(f"The description needs a number for {short}.")
    return number


def _the_device(triples: Triples) -> tuple[_Thing, DeviceKind]:
    found = [(node, kind) for short, kind in _KINDS.items() for node in triples.subjects_of(_full(short))]
    if len(found) != 1:
        count = "no" if not found else "more than one"
        raise BadDescription(
            f"The description names {count} vipo:Machine or vipo:Robot. It needs exactly one, such as "
            f"'<urn:vipo:device:lamp01> a vipo:Machine', where vipo: is {NAMESPACES['vipo']}.{_kinds_said(triples)}"
        )
    return _Thing(triples, found[0][0]), found[0][1]


def _kinds_said(triples: Triples) -> str:
    """Return what kinds of things are spoken of instead: a misspelt one is seen at once."""
    kinds = {str(kind)[:100] for _, predicate, kind in triples if predicate == RDF + "type"}
    said = sorted(kinds - {_full(short) for short in _KINDS})
    return f" It speaks of {', '.join(said[:3])}." if said else ""


def _pose(device: _Thing) -> Pose:
    numbers = device.numbers("vipo:location")
    if len(numbers) not in (2, 3, 4):
        raise BadDescription("The description needs vipo:location ( x y z theta ) in metres and radians.")
    return Pose(*numbers)


def _size(device: _Thing, radius: float) -> Size:
    numbers = device.numbers("vipo:size")
    if not numbers and radius:
        return Size(2 * radius, 2 * radius, 2 * radius)
    if len(numbers) != 3:
        raise BadDescription("The description needs vipo:size ( x y z ) in metres.")
    return Size(*numbers)


def _value_fields(value: _Thing) -> dict[str, Any]:
    return {
        "name": value.text("td:name"),
        "type": cast("ValueType", value.text("vipo:type") or "number"),
        "unit": value.text("qudt:hasUnit").removeprefix(NAMESPACES["unit"]),
        "minimum": value.limit("schema:minValue"),
        "maximum": value.limit("schema:maxValue"),
        "options": tuple(_text_of(item, "vipo:options") for item in value.items("vipo:options")),
    }


def _property(value: _Thing) -> PropertySpec:
    return PropertySpec(**_value_fields(value), title=value.text("dct:title"))


def _method(method: _Thing, own_id: str) -> MethodSpec:
    name = method.text("td:name")
    return MethodSpec(
        name=name,
        topic=method.text("vipo:topic") or down_topic(own_id, name),
        message_type=method.text("vipo:messageType"),
        title=method.text("dct:title"),
        parameters=tuple(_parameters(method)),
    )


def _parameters(method: _Thing) -> Iterator[ParameterSpec]:
    for node in method.items("vipo:parameters"):
        value = _Thing(method.triples, node)
        yield ParameterSpec(**_value_fields(value), required=value.truth("vipo:required", default=True))

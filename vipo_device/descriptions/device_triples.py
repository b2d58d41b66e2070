"""What triples say of one device: the canonical description out of RDF, in whatever form it came."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from math import isfinite
from typing import Any, NoReturn, cast

from vipo_device.descriptions.forms import NAMESPACES, refuse
from vipo_device.descriptions.triples import BLANK, FIRST, NIL, RDF, REST, Node, Text, Triples
from vipo_device.protocol.description import (
    Description,
    DeviceKind,
    MethodSpec,
    ParameterSpec,
    Pose,
    PropertySpec,
    Size,
    ValueType,
)
from vipo_device.protocol.messages import down_topic
from vipo_device.protocol.units import device_unit

MOST_ITEMS = 256
_LISTS = frozenset({"vipo:location", "vipo:size", "vipo:parameters", "vipo:options"})
_KINDS: dict[str, DeviceKind] = {"vipo:Machine": "machine", "vipo:Robot": "robot"}


def describe(triples: Triples) -> Description:
    """Return what the triples say of their one device. Raises BadDescription."""
    device, kind = _the_device(triples)
    own_id, radius = device.text("dct:identifier"), device.number("vipo:radius", 0.0)
    if not own_id:
        refuse("rdf_no_id")
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


def list_own_terms(triples: Triples) -> set[str]:
    """Return which of VIPO's own terms the triples use as predicates, in short, whether there are such or not."""
    own = NAMESPACES["vipo"]
    said = {predicate for _, predicate, _ in triples}
    return {f"vipo:{predicate.removeprefix(own)}" for predicate in said if predicate.startswith(own)}


@cache
def _full(short: str) -> str:
    prefix, _, name = short.partition(":")
    return NAMESPACES[prefix] + name


@dataclass(frozen=True, slots=True)
class _Thing:
    """A node and what is said of it; every question names its predicate in short. Raises BadDescription."""

    triples: Triples
    node: Node

    def key(self, short: str) -> str:
        """Return how a refusal calls what a predicate says, with the name of the affordance that it says it of."""
        names = [node.text for node in self.triples.objects(self.node, _full("td:name")) if isinstance(node, Text)]
        return f"{short} ({', '.join(names)[:64]})" if names else short

    def one(self, short: str) -> Node | None:
        found = self.triples.objects(self.node, _full(short))
        if len(found) > 1:
            refuse("rdf_list" if short in _LISTS else "rdf_more", key=self.key(short))
        return found[0] if found else None

    def text(self, short: str) -> str:
        found = self.one(short)
        return "" if found is None else _text_of(found, self.key(short))

    def number(self, short: str, default: float) -> float:
        found = self.one(short)
        return default if found is None else _number_of(found, self.key(short))

    def limit(self, short: str) -> float | None:
        found = self.one(short)
        return None if found is None else _number_of(found, self.key(short))

    def whole(self, short: str) -> int:
        number = self.number(short, 0.0)
        if not number.is_integer():
            refuse("rdf_whole", key=self.key(short))
        return int(number)

    def truth(self, short: str, *, default: bool) -> bool:
        found = self.one(short)
        if found is None:
            return default
        said = _text_of(found, self.key(short)).lower()
        if said not in {"true", "false", "0", "1"}:
            refuse("rdf_truth", key=self.key(short))
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
                refuse("rdf_list", key=self.key(short))
            items.append(first[0])
            node = rest[0] if rest else None
        return items

    def numbers(self, short: str) -> list[float]:
        return [_number_of(item, short) for item in self.items(short)]

    def in_order(self, short: str) -> list[_Thing]:
        """Return affordances by schema:position where it is given, then by name: RDF itself has no order."""
        found = [_Thing(self.triples, node) for node in self.triples.objects(self.node, _full(short))]
        return sorted(found, key=lambda each: (each.number("schema:position", 1000.0), each.text("td:name")))


def _text_of(node: Node, key: str) -> str:
    if isinstance(node, Text):
        return node.text
    if node.startswith(BLANK):
        refuse("rdf_text", key=key)
    return node


def _number_of(node: Node, key: str) -> float:
    """Read a literal's text, whatever its datatype says of it."""
    try:
        number = float(node.text) if isinstance(node, Text) else float("nan")
    except ValueError:
        number = float("nan")
    if not isfinite(number):
        refuse("rdf_number", key=key)
    return number


def _the_device(triples: Triples) -> tuple[_Thing, DeviceKind]:
    found = [(node, kind) for short, kind in _KINDS.items() for node in triples.subjects_of(_full(short))]
    if len(found) > 1:
        refuse("rdf_kinds")
    if not found:
        _refuse_kinds(triples)
    return _Thing(triples, found[0][0]), found[0][1]


def _refuse_kinds(triples: Triples) -> NoReturn:
    """Say what is spoken of instead: a kind that is misspelt, or whose prefix is unknown, is seen at once."""
    kinds = sorted({str(kind)[:100] for _, predicate, kind in triples if predicate == RDF + "type"})
    if unknown := [kind for kind in kinds if kind in _KINDS]:
        refuse("rdf_no_vipo", kind=unknown[0])
    if kinds:
        refuse("rdf_other_kinds", kinds=", ".join(kinds[:3]))
    refuse("rdf_no_kind")


def _pose(device: _Thing) -> Pose:
    numbers = device.numbers("vipo:location")
    if len(numbers) not in (2, 3, 4):
        refuse("rdf_location")
    return Pose(*numbers)


def _size(device: _Thing, radius: float) -> Size:
    numbers = device.numbers("vipo:size")
    if not numbers and radius:
        return Size(2 * radius, 2 * radius, 2 * radius)
    if len(numbers) != 3:
        refuse("rdf_size")
    return Size(*numbers)


def _value_fields(value: _Thing) -> dict[str, Any]:
    return {
        "name": value.text("td:name"),
        "type": cast("ValueType", value.text("vipo:type") or "number"),
        "unit": device_unit(value.text("qudt:hasUnit").removeprefix(NAMESPACES["unit"])),
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

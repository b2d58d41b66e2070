"""RDF in and out: Turtle, N-Triples and JSON-LD become the canonical description, and the other way round.

Nothing is ever fetched: JSON-LD contexts are the pinned ones or written out, and RDF/XML is refused.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from decimal import Decimal
from math import isfinite
from typing import Any, cast
from typing import Literal as LiteralType

from rdflib import RDF, XSD, BNode, Graph, Literal, Namespace, URIRef
from rdflib.exceptions import Error as RdfError
from rdflib.exceptions import ParserError
from rdflib.plugins.parsers.jsonld import to_rdf
from rdflib.term import Node

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
from registry.rdf_text import NAMESPACES, BadDescription, Fault, check_turtle, pin_contexts, place_in
from registry.wire import down_topic

VIPO = Namespace(NAMESPACES["vipo"])
TD = Namespace(NAMESPACES["td"])
SOSA = Namespace(NAMESPACES["sosa"])
QUDT = Namespace(NAMESPACES["qudt"])
UNIT = Namespace(NAMESPACES["unit"])
SCHEMA = Namespace(NAMESPACES["schema"])
DCT = Namespace(NAMESPACES["dct"])
PREFIXES: Mapping[str, Namespace] = {prefix: Namespace(name) for prefix, name in NAMESPACES.items()}
MOST_TRIPLES = 4000
_KINDS: Mapping[str, Node] = {"machine": VIPO.Machine, "robot": VIPO.Robot}
_SOSA_KINDS: Mapping[str, Node] = {"machine": SOSA.Actuator, "robot": SOSA.Platform}
_PARSER_FAILURES = (
    RdfError,
    ParserError,
    SyntaxError,
    ValueError,
    LookupError,
    TypeError,
    AttributeError,
    AssertionError,
    ArithmeticError,
    RecursionError,
)


def describe_turtle(text: str) -> Description:
    """Return what Turtle, and N-Triples as a part of it, says of one device. Raises BadDescription."""
    return _describe(graph_of_turtle(text))


def describe_json_ld(body: Any) -> Description:
    """Return what a JSON-LD value says of one device. Raises BadDescription."""
    return _describe(graph_of_json_ld(body))


def graph_of_turtle(text: str) -> Graph:
    """Return the triples of a text. Raises BadDescription."""
    check_turtle(text)
    try:
        return _bounded(Graph(bind_namespaces="none").parse(data=text, format="turtle"))
    except _PARSER_FAILURES as error:
        raise BadDescription(_parser_fault(text, error)) from error


def graph_of_json_ld(body: Any) -> Graph:
    """Return the triples of a JSON-LD value; nothing is fetched for it. Raises BadDescription."""
    pinned = pin_contexts(body)
    try:
        return _bounded(to_rdf(pinned, Graph(bind_namespaces="none"), base=""))
    except _PARSER_FAILURES as error:
        raise BadDescription("The description is not JSON-LD: the parser could not follow it.") from error


def _bounded(graph: Graph) -> Graph:
    if len(graph) > MOST_TRIPLES:
        raise BadDescription(f"The description has {len(graph)} triples; {MOST_TRIPLES} is the most.")
    return graph


def _parser_fault(text: str, error: BaseException) -> Fault:
    says = "The description is not RDF (Turtle, N-Triples or JSON-LD)"
    at, why = getattr(error, "_i", None), getattr(error, "_why", "")
    if not isinstance(at, int):
        return Fault(f"{says}: the parser could not follow it.")
    line, column = place_in(text, min(at, len(text)))
    told = str(why).rstrip(".")[:120]
    return Fault(f"{says}: {told}. Look just before it for a missing dot, quote, bracket or prefix.", line, column)


def _describe(graph: Graph) -> Description:
    subject, kind = _the_device(graph)
    said_id = _one_text(graph, subject, DCT.identifier)
    radius = _one_number(graph, subject, VIPO.radius, 0.0)
    return Description(
        id=said_id,
        name=_one_text(graph, subject, DCT.title) or said_id,
        kind=kind,
        device_class=_one_text(graph, subject, VIPO.deviceClass),
        pose=_pose(graph, subject),
        size=_size(graph, subject, radius if kind == "robot" else 0.0),
        description=_one_text(graph, subject, DCT.description),
        image=_one_text(graph, subject, SCHEMA.image),
        site=_one_text(graph, subject, VIPO.site),
        done=_one_truth(graph, subject, VIPO.done, default=True),
        simulated=_one_truth(graph, subject, VIPO.simulated, default=False),
        gives=_words(graph, subject, VIPO.gives),
        takes=_words(graph, subject, VIPO.takes),
        capacity=_one_whole(graph, subject, VIPO.capacity),
        radius_m=radius,
        speed_m_s=_one_number(graph, subject, VIPO.speed, 0.0),
        properties=tuple(_properties(graph, subject)),
        methods=tuple(_methods(graph, subject, said_id)),
    )


def _the_device(graph: Graph) -> tuple[Node, DeviceKind]:
    found = [(s, kind) for kind, of in _KINDS.items() for s in graph.subjects(RDF.type, of)]
    if len(found) != 1:
        count = "no" if not found else "more than one"
        raise BadDescription(f"The description names {count} vipo:Machine or vipo:Robot. It needs exactly one.")
    return found[0][0], cast("DeviceKind", found[0][1])


def _one(graph: Graph, subject: Node, predicate: URIRef) -> Node | None:
    found = list(graph.objects(subject, predicate))
    if len(found) > 1:
        raise BadDescription(f"The description gives {_short(predicate)} more than once.")
    return found[0] if found else None


def _short(predicate: Node) -> str:
    return next((f"{p}:{predicate[len(n) :]}" for p, n in PREFIXES.items() if str(predicate).startswith(n)), "it")  # type: ignore[index] # a URIRef is text


def _one_text(graph: Graph, subject: Node, predicate: URIRef) -> str:
    found = _one(graph, subject, predicate)
    if isinstance(found, BNode):
        raise BadDescription(f"The description needs text for {_short(predicate)}.")
    return "" if found is None else str(found)


def _one_number(graph: Graph, subject: Node, predicate: URIRef, default: float) -> float:
    found = _one(graph, subject, predicate)
    return default if found is None else _as_number(found, predicate)


def _one_whole(graph: Graph, subject: Node, predicate: URIRef) -> int:
    number = _one_number(graph, subject, predicate, 0.0)
    if not number.is_integer():
        raise BadDescription(f"The description needs a whole number for {_short(predicate)}.")
    return int(number)


def _as_number(node: Node, predicate: URIRef) -> float:
    """Read a literal's text, not rdflib's value: a datatype that does not fit its text would be let through."""
    try:
        number = float(str(node)) if isinstance(node, Literal) else float("nan")
    except ValueError:
        number = float("nan")
    if not isfinite(number):
        raise BadDescription(f"The description needs a number for {_short(predicate)}.")
    return number


def _one_truth(graph: Graph, subject: Node, predicate: URIRef, *, default: bool) -> bool:
    found = _one(graph, subject, predicate)
    if found is None:
        return default
    if str(found).lower() not in {"true", "false", "0", "1"}:
        raise BadDescription(f"The description needs true or false for {_short(predicate)}.")
    return str(found).lower() in {"true", "1"}


def _words(graph: Graph, subject: Node, predicate: URIRef) -> tuple[str, ...]:
    return tuple(sorted({str(o) for o in graph.objects(subject, predicate)}))


def _items(graph: Graph, subject: Node, predicate: URIRef) -> list[Node]:
    """Return an RDF list's members; a list that bites its tail ends where it repeats."""
    node, items, seen = _one(graph, subject, predicate), list[Node](), set[Node]()
    while node is not None and node != RDF.nil and node not in seen and len(items) <= 256:
        seen.add(node)
        first = _one(graph, node, RDF.first)
        if first is None:
            raise BadDescription(f"The description needs a list for {_short(predicate)}.")
        items.append(first)
        node = _one(graph, node, RDF.rest)
    return items


def _numbers(graph: Graph, subject: Node, predicate: URIRef) -> list[float]:
    return [_as_number(item, predicate) for item in _items(graph, subject, predicate)]


def _pose(graph: Graph, subject: Node) -> Pose:
    numbers = _numbers(graph, subject, VIPO.location)
    if len(numbers) not in (2, 3, 4):
        raise BadDescription("The description needs vipo:location ( x y z theta ) in metres and radians.")
    return Pose(*numbers)


def _size(graph: Graph, subject: Node, radius: float) -> Size:
    numbers = _numbers(graph, subject, VIPO.size)
    if not numbers and radius:
        return Size(2 * radius, 2 * radius, 2 * radius)
    if len(numbers) != 3:
        raise BadDescription("The description needs vipo:size ( x y z ) in metres.")
    return Size(*numbers)


def _in_order(graph: Graph, subject: Node, predicate: URIRef) -> list[Node]:
    """Return affordances by schema:position where it is given, then by name: RDF itself has no order."""
    found = [
        (_one_number(graph, o, SCHEMA.position, 1000.0), _one_text(graph, o, TD.name), o)
        for o in graph.objects(subject, predicate)
    ]
    return [node for _, _, node in sorted(found, key=lambda f: f[:2])]


def _value_fields(graph: Graph, node: Node) -> dict[str, Any]:
    unit = _one_text(graph, node, QUDT.hasUnit)
    limits = {
        name: _as_number(found, predicate)
        for name, predicate in (("minimum", SCHEMA.minValue), ("maximum", SCHEMA.maxValue))
        if (found := _one(graph, node, predicate)) is not None
    }
    return {
        "name": _one_text(graph, node, TD.name),
        "type": cast("ValueType", _one_text(graph, node, VIPO.type) or "number"),
        "unit": unit.removeprefix(str(UNIT)),
        "options": tuple(str(o) for o in _items(graph, node, VIPO.options)),
        **limits,
    }


def _properties(graph: Graph, subject: Node) -> Iterator[PropertySpec]:
    for node in _in_order(graph, subject, TD.hasPropertyAffordance):
        yield PropertySpec(**_value_fields(graph, node), title=_one_text(graph, node, DCT.title))


def _methods(graph: Graph, subject: Node, device_id: str) -> Iterator[MethodSpec]:
    for node in _in_order(graph, subject, TD.hasActionAffordance):
        name = _one_text(graph, node, TD.name)
        yield MethodSpec(
            name=name,
            topic=_one_text(graph, node, VIPO.topic) or down_topic(device_id, name),
            message_type=_one_text(graph, node, VIPO.messageType),
            title=_one_text(graph, node, DCT.title),
            parameters=tuple(_parameter(graph, item) for item in _items(graph, node, VIPO.parameters)),
        )


def _parameter(graph: Graph, node: Node) -> ParameterSpec:
    return ParameterSpec(**_value_fields(graph, node), required=_one_truth(graph, node, VIPO.required, default=True))


def write_rdf(description: Description, form: LiteralType["turtle", "n-triples", "json-ld"]) -> str:
    """Return a description as RDF; the same description always gives the same text."""
    graph = graph_of(description)
    if form == "json-ld":
        context = {k: str(v) for k, v in PREFIXES.items()}
        return str(graph.serialize(format="json-ld", context=context, indent=2, sort_keys=True))
    if form == "turtle":
        return str(graph.serialize(format="turtle"))
    return "".join(sorted(str(graph.serialize(format="nt")).splitlines(keepends=True)))


def graph_of(d: Description) -> Graph:
    """Return the triples that say what a description says."""
    graph = Graph(bind_namespaces="none")
    for prefix, namespace in (*PREFIXES.items(), ("rdf", RDF)):
        graph.bind(prefix, namespace)
    me = URIRef(f"urn:vipo:device:{d.id}")
    for kind in (TD.Thing, _SOSA_KINDS[d.kind], _KINDS[d.kind]):
        graph.add((me, RDF.type, kind))
    _add_texts(graph, me, d)
    _add_numbers(graph, me, d)
    for position, spec in enumerate(d.properties, 1):
        node = _add_value(graph, BNode(f"p{position:02}"), spec)
        _add_if(graph, node, DCT.title, spec.title)
        graph.add((node, SCHEMA.position, Literal(position)))
        graph.add((me, TD.hasPropertyAffordance, node))
    for position, method in enumerate(d.methods, 1):
        graph.add((me, TD.hasActionAffordance, _add_method(graph, position, method)))
    return graph


def _add_texts(graph: Graph, me: URIRef, d: Description) -> None:
    graph.add((me, DCT.identifier, Literal(d.id)))
    graph.add((me, DCT.title, Literal(d.name)))
    _add_if(graph, me, DCT.description, d.description)
    _add_if(graph, me, VIPO.deviceClass, d.device_class)
    _add_if(graph, me, VIPO.site, d.site)
    _add_if(graph, me, SCHEMA.image, d.image)
    for predicate, words in ((VIPO.gives, d.gives), (VIPO.takes, d.takes)):
        for word in words:
            graph.add((me, predicate, Literal(word)))


def _add_numbers(graph: Graph, me: URIRef, d: Description) -> None:
    graph.add((me, VIPO.done, Literal(d.done)))
    graph.add((me, VIPO.simulated, Literal(d.simulated)))
    _add_list(graph, me, VIPO.location, "location", (d.pose.x, d.pose.y, d.pose.z, d.pose.theta))
    _add_list(graph, me, VIPO.size, "size", (d.size.x, d.size.y, d.size.z))
    for predicate, number in ((VIPO.capacity, d.capacity), (VIPO.radius, d.radius_m), (VIPO.speed, d.speed_m_s)):
        if number:
            graph.add((me, predicate, _number(number)))


def _number(value: float) -> Literal:
    """Write a number as a decimal that reads back the same; as a double, rdflib would round it to six digits."""
    if isinstance(value, int):
        return Literal(str(value), datatype=XSD.integer)
    plain = f"{Decimal(repr(value)):f}"
    return Literal(plain if "." in plain else f"{plain}.0", datatype=XSD.decimal)


def _add_if(graph: Graph, node: Node, predicate: URIRef, text: str) -> None:
    if text:
        graph.add((node, predicate, Literal(text)))


def _add_list(graph: Graph, node: Node, predicate: URIRef, label: str, values: Iterable[float | Node | str]) -> None:
    items = [v if isinstance(v, Node) else _number(v) if isinstance(v, float | int) else Literal(v) for v in values]
    cells = [BNode(f"{label}{i:02}") for i in range(len(items))]
    for cell, item, rest in zip(cells, items, [*cells[1:], RDF.nil], strict=True):
        graph.add((cell, RDF.first, item))
        graph.add((cell, RDF.rest, rest))
    graph.add((node, predicate, cells[0] if cells else RDF.nil))


def _add_value(graph: Graph, node: BNode, spec: PropertySpec | ParameterSpec) -> BNode:
    graph.add((node, TD.name, Literal(spec.name)))
    graph.add((node, VIPO.type, Literal(spec.type)))
    if spec.unit:
        graph.add((node, QUDT.hasUnit, UNIT[spec.unit]))
    for predicate, limit in ((SCHEMA.minValue, spec.minimum), (SCHEMA.maxValue, spec.maximum)):
        if limit is not None:
            graph.add((node, predicate, _number(limit)))
    if spec.options:
        _add_list(graph, node, VIPO.options, f"{node}o", spec.options)
    return node


def _add_method(graph: Graph, position: int, method: MethodSpec) -> BNode:
    node = BNode(f"m{position:02}")
    graph.add((node, TD.name, Literal(method.name)))
    graph.add((node, SCHEMA.position, Literal(position)))
    graph.add((node, VIPO.topic, Literal(method.topic)))
    _add_if(graph, node, VIPO.messageType, method.message_type)
    _add_if(graph, node, DCT.title, method.title)
    if method.parameters:
        nodes = [_add_value(graph, BNode(f"{node}a{i:02}"), p) for i, p in enumerate(method.parameters)]
        for inner, spec in zip(nodes, method.parameters, strict=True):
            if not spec.required:
                graph.add((inner, VIPO.required, Literal(False)))
        _add_list(graph, node, VIPO.parameters, f"{node}l", nodes)
    return node

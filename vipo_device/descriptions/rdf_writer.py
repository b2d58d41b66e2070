"""RDF out, in every form, and graphs for those who work with rdflib's; RDF is read in `rdf_reader.py`."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from decimal import Decimal
from typing import Literal as LiteralType

from rdflib import RDF, XSD, BNode, Graph, Literal, Namespace, URIRef
from rdflib.term import Node

from vipo_device.descriptions.forms import NAMESPACES
from vipo_device.descriptions.triples import BLANK, Text, Triples
from vipo_device.descriptions.triples import Node as PlainNode
from vipo_device.protocol.description import Description, MethodSpec, ParameterSpec, PropertySpec

VIPO = Namespace(NAMESPACES["vipo"])
TD = Namespace(NAMESPACES["td"])
SOSA = Namespace(NAMESPACES["sosa"])
QUDT = Namespace(NAMESPACES["qudt"])
UNIT = Namespace(NAMESPACES["unit"])
SCHEMA = Namespace(NAMESPACES["schema"])
DCT = Namespace(NAMESPACES["dct"])
PREFIXES: Mapping[str, Namespace] = {prefix: Namespace(name) for prefix, name in NAMESPACES.items()}
_KINDS: Mapping[str, Node] = {"machine": VIPO.Machine, "robot": VIPO.Robot}
_SOSA_KINDS: Mapping[str, Node] = {"machine": SOSA.Actuator, "robot": SOSA.Platform}


def graph_of_triples(triples: Triples) -> Graph:
    """Return triples as rdflib keeps them, for those who work with its graphs."""
    graph = Graph(bind_namespaces="none")
    for subject, predicate, value in triples:
        graph.add((_term(subject), URIRef(predicate), _term(value)))
    return graph


def _term(node: PlainNode) -> Node:
    if isinstance(node, Text):
        return Literal(node.text, lang=node.language or None, datatype=URIRef(node.datatype) if node.datatype else None)
    return BNode(node.removeprefix(BLANK)) if node.startswith(BLANK) else URIRef(node)


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

"""RDF in: Turtle, N-Triples as a part of it, and JSON-LD become triples (docs/adr/0009).

Nothing is ever fetched: JSON-LD contexts are the pinned ones or written out, and RDF/XML is refused.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from typing import Any

from pyoxigraph import BlankNode, Literal, NamedNode, QuadParser, RdfFormat, parse

from vipo_device.descriptions.forms import (
    NAMESPACES,
    SCHEMA_OVER_HTTP,
    BadDescription,
    check_turtle,
    pin_contexts,
    refuse,
)
from vipo_device.descriptions.triples import BLANK, RDF, Node, Text, Triple, Triples
from vipo_device.protocol.faults import Fault, fault

NOWHERE = "relative:/"
"""What an address that is not complete is completed with: a description has no address of its own."""
_PLACE = re.compile(r"Parser error [^:]*: ")
_COMPLAINTS = {
    "rdf_prefix": re.compile(r"The prefix (?P<prefix>\S*:) has not been declared"),
    "rdf_commas": re.compile(r", "),
    "rdf_dot": re.compile(r"A dot is expected"),
    "rdf_end": re.compile(r"Unexpected end of file"),
    "rdf_predicate": re.compile(r"(?P<said>.+) is not a valid predicate"),
    "rdf_subject": re.compile(r"(?P<said>.+) is not a valid subject"),
}
"""The codes of what the parser complains of, by how its words begin."""
_PLAIN = frozenset({"http://www.w3.org/2001/XMLSchema#string", RDF + "langString", RDF + "dirLangString"})


def read_turtle(text: str) -> Triples:
    """Return the triples of a text. Raises BadDescription."""
    check_turtle(text)
    try:
        return Triples(_plain(parse(text, RdfFormat.TURTLE, base_iri=NOWHERE)))
    except SyntaxError as error:
        raise BadDescription(_fault(_reason(error), error.lineno or 0, error.offset or 0)) from error


def read_json_ld(body: Any) -> Triples:
    """Return the triples of a JSON-LD value. Raises BadDescription."""
    text = json.dumps(pin_contexts(body), ensure_ascii=False)
    try:
        return Triples(_plain(parse(text, RdfFormat.JSON_LD, base_iri=NOWHERE)))
    except SyntaxError as error:
        raise BadDescription(fault("json_ld", reason=_reason(error))) from error


def _plain(found: QuadParser) -> Iterator[Triple]:
    for quad in found:
        yield _name(quad.subject), _predicate(quad.predicate.value), _node(quad.object)


def _predicate(name: str) -> str:
    """Return a predicate as VIPO names it: much of what is published writes schema.org with http."""
    if name.startswith(SCHEMA_OVER_HTTP):
        return NAMESPACES["schema"] + name.removeprefix(SCHEMA_OVER_HTTP)
    return name


def _node(value: object) -> Node:
    if isinstance(value, Literal):
        datatype = value.datatype.value
        return Text(value.value, "" if datatype in _PLAIN else datatype, value.language or "")
    return _name(value)


def _name(node: object) -> str:
    if isinstance(node, NamedNode):
        return node.value
    if isinstance(node, BlankNode):
        return BLANK + node.value
    return refuse("rdf_statements")


def _reason(error: SyntaxError) -> str:
    """Return the parser's reason, without the place that it begins with."""
    return _PLACE.sub("", error.msg).rstrip(".")[:120]


def _fault(reason: str, line: int, column: int) -> Fault:
    """Return what the parser complains of, with what mends it as far as that can be told from its words."""
    for code, pattern in _COMPLAINTS.items():
        if found := pattern.match(reason):
            return fault(code, line, column, **found.groupdict())
    return fault("rdf_syntax", line, column, reason=reason)

"""RDF in: Turtle, N-Triples as a part of it, and JSON-LD become triples (docs/adr/0009).

Nothing is ever fetched: JSON-LD contexts are the pinned ones or written out, and RDF/XML is refused.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from typing import Any

from pyoxigraph import BlankNode, Literal, NamedNode, QuadParser, RdfFormat, parse

from registry.rdf_text import BadDescription, Fault, check_turtle, pin_contexts
from registry.triples import BLANK, RDF, Node, Text, Triple, Triples

NOWHERE = "relative:/"
"""What an address that is not complete is completed with: a description has no address of its own."""
_UNKNOWN_PREFIX = re.compile(r"The prefix (\S*:) has not been declared")
_PLAIN = frozenset({"http://www.w3.org/2001/XMLSchema#string", RDF + "langString", RDF + "dirLangString"})


def read_turtle(text: str) -> Triples:
    """Return the triples of a text. Raises BadDescription."""
    check_turtle(text)
    says = "The description is not RDF (Turtle, N-Triples or JSON-LD)"
    try:
        return Triples(_plain(parse(text, RdfFormat.TURTLE, base_iri=NOWHERE)))
    except SyntaxError as error:
        reason = _reason(error)
        fault = Fault(f"{says}: {reason}. {_remedy(reason)}", error.lineno or 0, error.offset or 0)
        raise BadDescription(fault) from error


def read_json_ld(body: Any) -> Triples:
    """Return the triples of a JSON-LD value. Raises BadDescription."""
    text = json.dumps(pin_contexts(body), ensure_ascii=False)
    try:
        return Triples(_plain(parse(text, RdfFormat.JSON_LD, base_iri=NOWHERE)))
    except SyntaxError as error:
        raise BadDescription(f"The description is not JSON-LD: {_reason(error)}.") from error


def _plain(found: QuadParser) -> Iterator[Triple]:
    for quad in found:
        yield _name(quad.subject), quad.predicate.value, _node(quad.object)


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
    raise BadDescription("The description makes statements about statements (RDF 1.2). Keep to RDF 1.1.")


def _reason(error: SyntaxError) -> str:
    """Return the parser's reason, without the place that it begins with."""
    place, _, reason = error.msg.partition(": ")
    return (reason if place.startswith("Parser error at") else error.msg).rstrip(".")[:120]


def _remedy(reason: str) -> str:
    """Return what mends what the parser complains of, as far as that can be told from its words."""
    if reason.startswith(", "):
        return "The members of a list, ( 1 2 3 ), have blanks between them and no commas."
    if prefix := _UNKNOWN_PREFIX.match(reason):
        said = f"@prefix {prefix[1]} <…> ."
        return f"Begin the text with {said!r}; docs/protocol.md and registry/demo/devices/ have those that VIPO knows."
    return "Look just before it for a missing dot, semicolon, quote, bracket or prefix."

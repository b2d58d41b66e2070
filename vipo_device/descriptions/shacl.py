"""The SHACL shapes that are shipped, and whether RDF keeps to them; too slow for every description (docs/adr/0006).

What holds RDF against them is `pyshacl`, an extra that a server does not need: `pip install 'vipo[shacl]'`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

from vipo_device.descriptions.forms import FORMS, BadDescription, is_json, plain_text, read_json
from vipo_device.descriptions.rdf_reader import read_json_ld, read_turtle
from vipo_device.descriptions.rdf_writer import graph_of, graph_of_triples
from vipo_device.descriptions.reader import Reading
from vipo_device.protocol.errors import VipoError
from vipo_device.protocol.faults import Fault, bare

SHAPES = Path(__file__).parent / "shapes" / "device.ttl"
_RESULTS = """
PREFIX sh: <http://www.w3.org/ns/shacl#>
SELECT DISTINCT ?message ?value WHERE {
  ?report sh:result ?result . ?result sh:resultMessage ?message . OPTIONAL { ?result sh:value ?value }
} ORDER BY ?message ?value
"""


class ShaclMissing(VipoError):
    """The package that holds RDF against shapes is not installed here."""

    code = "shacl_missing"
    status = 501


@cache
def _shapes() -> Any:
    return graph_of_triples(read_turtle(SHAPES.read_text(encoding="utf-8")))


def check_rdf(payload: bytes) -> tuple[Fault, ...]:
    """Return where RDF leaves the shapes, in the order of the sentences.

    Raises:
        BadDescription: it is no RDF.
        ShaclMissing: pyshacl is not installed.
    """
    text = plain_text(payload)
    triples = read_json_ld(read_json(text)) if is_json(text) else read_turtle(text)
    return tuple(_faults(graph_of_triples(triples)))


def check_reading(reading: Reading, payload: bytes) -> tuple[Fault, ...]:
    """Hold a description against the shapes: RDF as it was sent, the other forms by the RDF that VIPO makes of them.

    Raises:
        ShaclMissing: pyshacl is not installed.
    """
    if FORMS[reading.form].is_rdf:
        return check_rdf(payload)
    return tuple(_faults(graph_of(reading.description)))


def find_validator() -> Callable[..., tuple[bool, Any, str]]:
    """Return pyshacl's own function; imported late, for it takes a third of a second. Raises ShaclMissing."""
    try:
        from pyshacl import validate
    except ModuleNotFoundError as error:
        raise ShaclMissing(
            "Nothing can be held against the SHACL shapes: pyshacl is not installed. "
            "Install it with: pip install 'vipo[shacl]'"
        ) from error
    found: Callable[..., tuple[bool, Any, str]] = validate
    return found


def _faults(graph: Any) -> Iterator[Fault]:
    validate = find_validator()
    conforms, report, _ = validate(graph, shacl_graph=_shapes(), inference="none", advanced=False)
    if conforms:
        return
    if not hasattr(report, "query"):
        raise BadDescription("The description could not be held against the SHACL shapes.")
    for message, value in report.query(_RESULTS):
        told = f" It is {str(value)[:60]!r}." if value is not None and value.__class__.__name__ == "Literal" else ""
        yield bare(f"{message}{told}")

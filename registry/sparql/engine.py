"""Answers one SPARQL query over a site's descriptions, in a process of its own that may be killed at any time.

A job comes on standard input as JSON, the answer goes to standard output; the exit code says which kind of answer it
is. Nothing is fetched and nothing is changed: only queries are understood, without SERVICE, FROM and FROM NAMED.
"""

from __future__ import annotations

import json
import os
import resource
import sys
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from math import ceil
from typing import Any

import rdflib.plugins.sparql
from rdflib import XSD, BNode, Graph, Literal, URIRef
from rdflib.plugins.sparql.parser import parseQuery
from rdflib.plugins.sparql.parserutils import CompValue
from rdflib.query import Result
from rdflib.term import Node

from vipo_device.descriptions.rdf_writer import PREFIXES, TD, VIPO, graph_of
from vipo_device.protocol.description import description_from_json

ANSWERED, REFUSED, TOO_LARGE = 0, 3, 4
BEHIND_THE_SERVER = 10
"""How much the kernel prefers everything else: a heavy query does not slow the pages down."""
GRAPH_S = 20
"""So long it may take to put a site's descriptions together; a thousand devices take three."""
MOST_ROWS = 10_000
MOST_TRIPLES = 50_000
MOST_BYTES = 5_000_000
MEDIA_TYPES: Mapping[str, str] = {
    "json": "application/sparql-results+json",
    "xml": "application/sparql-results+xml",
    "csv": "text/csv",
    "turtle": "text/turtle",
    "n-triples": "application/n-triples",
    "json-ld": "application/ld+json",
}
_WRITERS: Mapping[str, str] = {"turtle": "turtle", "n-triples": "nt", "json-ld": "json-ld"}
_TABLES: Mapping[str, tuple[str, ...]] = {"SELECT": ("json", "xml", "csv"), "ASK": ("json", "xml")}
_WORDS = (
    "CONSTRUCT and DESCRIBE are answered as turtle, n-triples or json-ld",
    "SELECT is answered as json, xml or csv, ASK as json or xml",
)
_FORBIDDEN: Mapping[str, str] = {"ServiceGraphPattern": "SERVICE", "DatasetClause": "FROM"}


class Refused(Exception):
    """The query is not answered; the sentence says why."""

    def __init__(self, sentence: str, code: int = REFUSED) -> None:
        super().__init__(sentence)
        self.code = code


def main() -> int:
    """Read a job `{"query", "forms", "devices", "cpu_s", "memory_bytes"}`, answer it, and return how it went."""
    job = json.load(sys.stdin)
    os.nice(BEHIND_THE_SERVER)
    resource.setrlimit(resource.RLIMIT_AS, (job["memory_bytes"], job["memory_bytes"]))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    try:
        _limit_computing(job["cpu_s"])
        check_query(job["query"])
        _limit_computing(GRAPH_S)
        graph = graph_of_devices(job["devices"])
        _limit_computing(job["cpu_s"])
        form, body = answer(graph, job["query"], job["forms"])
    except Refused as error:
        return _say(str(error).encode(), error.code)
    except (MemoryError, RecursionError):
        return _say(b"The query needs more memory than it may have. Ask for less at once.", TOO_LARGE)
    except Exception as error:  # noqa: BLE001 - the edge of the process: whatever the engine stumbles over is the query's
        return _say(f"The query cannot be carried out: {str(error)[:200]}".encode(), REFUSED)
    if len(body) > MOST_BYTES:
        told = f"The result has over {MOST_BYTES // 1_000_000} MB. Ask for less, or add a LIMIT."
        return _say(told.encode(), TOO_LARGE)
    return _say(f"{MEDIA_TYPES[form]}\n".encode() + body, ANSWERED)


def _limit_computing(seconds: int) -> None:
    """Let the kernel end this process when it has computed for so long from now on."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    until = ceil(used.ru_utime + used.ru_stime) + seconds
    resource.setrlimit(resource.RLIMIT_CPU, (until, resource.RLIM_INFINITY))


def _say(body: bytes, code: int) -> int:
    sys.stdout.buffer.write(body)
    sys.stdout.buffer.flush()
    return code


def answer(graph: Graph, query: str, forms: Sequence[str]) -> tuple[str, bytes]:
    """Return the form of the answer and its text: the first of `forms` that can hold it, or (none given) any."""
    rdflib.plugins.sparql.SPARQL_LOAD_GRAPHS = False
    result = graph.query(query, initNs=dict(PREFIXES))
    fitting = _TABLES.get(result.type, tuple(_WRITERS))
    form = next((form for form in forms if form in fitting), None if forms else fitting[0])
    if form is None:
        raise Refused(f"{_WORDS[result.type in _TABLES]}, not as {' or '.join(forms)}.")
    return form, (_table if result.type in _TABLES else _triples)(result, form)


def check_query(query: str) -> None:
    """Refuse what is no query, and what reaches out of the site. Raises Refused."""
    try:
        parsed = parseQuery(query)
    except Exception as error:
        told = str(error)[:200]
        raise Refused(f"This is no SPARQL query (SELECT, ASK, CONSTRUCT or DESCRIBE): {told}") from error
    for part in _parts(parsed):
        word = _FORBIDDEN.get(part.name)
        if word:
            raise Refused(f"{word} is not allowed: a query is answered from this site's descriptions alone.")


def _parts(value: Any) -> Iterator[CompValue]:
    """Go through everything that the parser has found."""
    waiting = [value]
    while waiting:
        found = waiting.pop()
        if isinstance(found, CompValue):
            yield found
            waiting.extend(found.values())
        elif isinstance(found, list | tuple) or type(found).__name__ == "ParseResults":
            waiting.extend(found)


def _table(result: Result, form: str) -> bytes:
    if result.type == "SELECT":
        rows = list(islice(result.bindings, MOST_ROWS + 1))
        if len(rows) > MOST_ROWS:
            raise Refused(f"The result has more than {MOST_ROWS} rows. Add a LIMIT.", TOO_LARGE)
        result.bindings = rows
    return result.serialize(format=form) or b""


def _triples(result: Result, form: str) -> bytes:
    assert result.graph is not None
    if len(result.graph) > MOST_TRIPLES:
        raise Refused(f"The result has more than {MOST_TRIPLES} triples. Add a LIMIT.", TOO_LARGE)
    for prefix, namespace in PREFIXES.items():
        result.graph.bind(prefix, namespace)
    return result.graph.serialize(format=_WRITERS[form], encoding="utf-8")


def graph_of_devices(devices: list[Mapping[str, Any]]) -> Graph:
    """Return what the devices say of themselves and how they are, as one graph."""
    whole = Graph(bind_namespaces="none")
    for number, device in enumerate(devices):
        described = graph_of(description_from_json(device["description"]))
        _add_state(described, device)
        for triple in described:
            whole.add(tuple(_apart(term, number) for term in triple))  # type: ignore[arg-type] # three terms again
    return whole


def _apart(term: Node, number: int) -> Node:
    """Keep the blank nodes of different devices apart: each description names its own alike."""
    return BNode(f"d{number}{term}") if isinstance(term, BNode) else term


def _add_state(graph: Graph, device: Mapping[str, Any]) -> None:
    me = URIRef(f"urn:vipo:device:{device['description']['id']}")
    for name in ("status", "lifecycle", "online"):
        graph.add((me, VIPO[name], Literal(device[name])))
    if device["last_seen_at"]:
        graph.add((me, VIPO.lastSeen, Literal(device["last_seen_at"], datatype=XSD.dateTime)))
    graph.remove((me, VIPO.done, None))
    graph.add((me, VIPO.done, Literal(device["done"])))
    for node in list(graph.objects(me, TD.hasPropertyAffordance)):
        value = device["values"].get(str(graph.value(node, TD.name)))
        if value is not None:
            graph.add((node, VIPO.value, Literal(value)))


if __name__ == "__main__":
    sys.exit(main())

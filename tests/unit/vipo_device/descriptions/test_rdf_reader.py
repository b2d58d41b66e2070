"""RDF is read as rdflib reads it, which is another implementation of the same W3C texts."""

from __future__ import annotations

import json
import logging
import re
from collections.abc import Iterator
from typing import Any

import pytest
import rdflib
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from rdflib.compare import isomorphic
from rdflib.plugins.parsers.jsonld import to_rdf

from registry.demo.devices import describe_devices
from vipo_device.descriptions.forms import BadDescription, check_turtle, plain_text
from vipo_device.descriptions.rdf_reader import NOWHERE, read_json_ld, read_turtle
from vipo_device.descriptions.rdf_writer import graph_of_triples
from vipo_device.descriptions.reader import write_description

ADDRESSES = st.sampled_from(
    ["urn:vipo:ns#a", "https://schema.org/b", "urn:x:ä", "relative:/c", "http://a.example/?q#f"]
)
LABELS = st.sampled_from(["b0", "b1", "b2"]).map(rdflib.BNode)
NAMES = ADDRESSES.map(rdflib.URIRef)
WORDS = st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0"), max_size=8)
NUMBERS = st.sampled_from(["1", "-2", "0.50", "007"])
TYPES = st.sampled_from(["integer", "decimal", "double", "boolean", "date"]).map(lambda name: rdflib.XSD[name])
LITERALS = st.one_of(
    st.builds(rdflib.Literal, WORDS),
    st.builds(lambda text, tag: rdflib.Literal(text, lang=tag), WORDS, st.sampled_from(["en", "de-at"])),
    st.builds(lambda text, of: rdflib.Literal(text, datatype=of, normalize=False), NUMBERS, TYPES),
)
TRIPLES = st.lists(st.tuples(NAMES | LABELS, NAMES, NAMES | LABELS | LITERALS), max_size=8)

EVERYTHING = """@prefix vipo: <urn:vipo:ns#> . PREFIX td: <https://www.w3.org/2019/wot/td#>
<urn:vipo:device:m1> a vipo:Machine ; vipo:location ( 1 2.5 -1e0 ) ; vipo:done true ; td:x [ td:name 'a' ;
 td:title \"\"\"x"y
z\"\"\" ; ], [] , "m\\u00e4\\n"@en . _:a td:b _:c, <rel>, "t"^^vipo:dt . # a comment
"""
SENTENCES = (EVERYTHING, *(write_description(device)[:1200] for device in describe_devices()[:2]))
PIECES = [
    *"<>\"'.;,()[]^_:\\ \n\t%~|{}=!&/-+019eEaxä\u2028",
    '"""',
    "'''",
    "^^",
    "@en",
    "@prefix ",
    "PREFIX ",
    "<<",
    ">>",
]
PIECES += [
    "{|",
    "|}",
    "a ",
    "true",
    "_:x",
    "<urn:q>",
    "vipo:",
    "\\u0041",
    "1.",
    ".5",
    "()",
    "[]",
    "is ",
    "^",
    "<=",
    "=>",
]
EDITS = st.lists(
    st.tuples(st.floats(0, 1), st.integers(0, 12), st.one_of(st.just(""), st.sampled_from(PIECES))),
    min_size=1,
    max_size=3,
)
UNLIKE = re.compile(r"[\"']\s+@|<[^>\s]*[?#][^>\s:]*:")
"""What rdflib refuses though W3C's grammar has it, and addresses that it completes wrongly."""


@pytest.fixture(autouse=True)
def _as_written(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Let rdflib keep its literals as they are written, and not complain of those that do not fit their type."""
    monkeypatch.setattr(rdflib, "NORMALIZE_LITERALS", False)
    logging.disable(logging.WARNING)
    yield
    logging.disable(logging.NOTSET)


def read_by_rdflib(text: str) -> rdflib.Graph:
    check_turtle(text)
    return rdflib.Graph(bind_namespaces="none").parse(data=text, format="turtle", publicID=NOWHERE)


def plain(graph: rdflib.Graph) -> rdflib.Graph:
    """Return a graph without rdflib's own spelling: `0.5` for `.5`, `0` for `-0`, languages in small letters."""
    found = rdflib.Graph()
    for subject, predicate, value in graph:
        found.add((subject, predicate, _plain(value) if isinstance(value, rdflib.Literal) else value))
    return found


def _plain(value: rdflib.Literal) -> rdflib.Literal:
    language = value.language.lower() if value.language else None
    if value.datatype in (rdflib.XSD.integer, rdflib.XSD.decimal, rdflib.XSD.double):
        try:
            return rdflib.Literal(repr(float(str(value)) + 0.0))
        except ValueError:
            pass
    return rdflib.Literal(str(value), lang=language, datatype=None if language else value.datatype)


@pytest.mark.parametrize("form", ["turtle", "nt"])
@settings(max_examples=100, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(triples=TRIPLES)
def test_what_rdflib_writes_is_read_as_rdflib_reads_it(
    form: str, triples: list[tuple[rdflib.term.Node, rdflib.term.Node, rdflib.term.Node]]
) -> None:
    graph = rdflib.Graph()
    for triple in triples:
        graph.add(triple)
    text = graph.serialize(format=form)
    assert isomorphic(plain(graph_of_triples(read_turtle(text))), plain(read_by_rdflib(text)))


@settings(max_examples=600, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(text=st.sampled_from(SENTENCES), edits=EDITS)
def test_of_broken_texts_none_is_taken_that_rdflib_refuses_and_none_means_something_else(
    text: str, edits: list[tuple[float, int, str]]
) -> None:
    for at, length, piece in edits:
        position = int(at * len(text))
        text = text[:position] + piece + text[position + (0 if piece else length) :]
    assume(not UNLIKE.search(text))
    try:
        found = graph_of_triples(read_turtle(plain_text(text.encode())))
    except BadDescription:
        return
    assert isomorphic(plain(found), plain(read_by_rdflib(text)))


def test_every_construct_of_the_grammar_is_read_alike() -> None:
    assert isomorphic(graph_of_triples(read_turtle(EVERYTHING)), read_by_rdflib(EVERYTHING))


@pytest.mark.parametrize(
    "text",
    [
        "<urn:a> <urn:b> <<( <urn:c> <urn:d> 1 )>> .",
        "<<<urn:a> <urn:b> 1>> <urn:c> 2 .",
        "<urn:a> <urn:b> 1 {| <urn:c> 2 |} .",
        "<urn:a> <urn:b> 1 ~ <urn:r> .",
    ],
)
def test_what_is_newer_than_rdf_1_1_is_refused(text: str) -> None:
    with pytest.raises(BadDescription, match=r"RDF 1\.2"):
        read_turtle(text)


@pytest.mark.parametrize(
    ("text", "line", "column", "says"),
    [
        ("<urn:a> <urn:b> <urn:c>\n\n", 3, 1, "Unexpected end"),
        ('<urn:a> <urn:b> "ä" .\n<urn:a> ä:b 1 .', 2, 9, "prefix ä: has not been declared"),
        ("<urn:a> <urn:b> 'x\n' .", 1, 19, "Line jumps"),
        ("<urn:a> <urn:b c> 1 .", 1, 9, "Invalid IRI"),
        ("<urn:a> <urn:b> [ <urn:c> 1 .", 1, 29, "is not RDF"),
    ],
)
def test_a_fault_is_shown_where_it_is(text: str, line: int, column: int, says: str) -> None:
    with pytest.raises(BadDescription, match=says) as refusal:
        read_turtle(text)
    (fault,) = refusal.value.faults
    assert (fault.line, fault.column) == (line, column)


def test_so_many_triples_are_too_many_but_the_same_one_counts_once() -> None:
    assert len(list(read_turtle("<a:b> <a:c> " + ",".join("1" * 6000) + " ."))) == 1
    with pytest.raises(BadDescription, match="4001 triples; 4000 is the most"):
        read_turtle("<a:b> <a:c> " + ",".join(str(n) for n in range(4001)) + " .")


def read_json_by_rdflib(body: Any) -> rdflib.Graph:
    return to_rdf(body, rdflib.Graph(bind_namespaces="none"), base=NOWHERE)


@settings(max_examples=100, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(triples=TRIPLES)
def test_json_ld_that_rdflib_writes_is_read_as_rdflib_reads_it(
    triples: list[tuple[rdflib.term.Node, rdflib.term.Node, rdflib.term.Node]],
) -> None:
    graph = rdflib.Graph()
    for triple in triples:
        graph.add(triple)
    body = json.loads(graph.serialize(format="json-ld"))
    assert isomorphic(plain(graph_of_triples(read_json_ld(body))), plain(read_json_by_rdflib(body)))


NAMED = {"vipo": "urn:vipo:ns#", "dct": "http://purl.org/dc/terms/"}
ONE = {"@context": NAMED, "@id": "urn:vipo:device:m1", "@type": "vipo:Machine", "vipo:size": {"@list": [1, 1.5]}}


@pytest.mark.parametrize(
    "more",
    [
        {"@context": {**NAMED, "type": "@type", "id": "@id"}, "type": "vipo:Robot"},
        {"@context": [NAMED, {"title": "dct:title"}], "title": "T"},
        {"@context": {**NAMED, "@vocab": "urn:vipo:ns#"}, "done": False, "speed": 0.1, "far": 1e21},
        {"@context": {**NAMED, "@language": "en"}, "dct:title": "x"},
        {"@context": {**NAMED, "list": {"@id": "vipo:list", "@container": "@list"}}, "list": [1, [2]]},
        {"@context": {**NAMED, "s": {"@id": "vipo:s", "@type": "@id"}}, "s": "urn:x"},
        {"@context": {**NAMED, "p": {"@id": "vipo:p", "@container": "@language"}}, "p": {"en": "a", "de": "b"}},
        {"@context": {**NAMED, "p": {"@id": "vipo:p", "@context": {"q": "vipo:q"}}}, "p": {"q": 1}},
        {"@context": {**NAMED, "p": {"@id": "vipo:p", "@container": "@index"}}, "p": {"k": {"vipo:q": 1}}},
        {"@reverse": {"vipo:has": {"@id": "urn:y"}}},
        {"@included": [{"@id": "urn:z", "vipo:a": 1}]},
        {"@graph": [{"@id": "urn:z", "vipo:a": 1}]},
        {"vipo:json": {"@value": {"a": 1}, "@type": "@json"}},
        {"dct:title": None, "unknown": 1, "vipo:set": {"@set": [1, 2]}, "@index": "x"},
    ],
)
def test_the_words_of_json_ld_are_read_alike(more: dict[str, Any]) -> None:
    body = {**ONE, **more}
    assert isomorphic(plain(graph_of_triples(read_json_ld(body))), plain(read_json_by_rdflib(body)))


@pytest.mark.parametrize(
    ("body", "says"),
    [
        ({**ONE, "@id": 5}, "@id value must be a string"),
        ({**ONE, "@context": 5}, "@context value must be"),
        ({**ONE, "dct:title": {"@value": [1]}}, "@value value must be"),
    ],
)
def test_json_ld_that_is_none_is_refused_with_the_reason(body: Any, says: str) -> None:
    with pytest.raises(BadDescription, match=f"not JSON-LD: {says}"):
        read_json_ld(body)


@pytest.mark.parametrize("name", ["XMLLiteral", "HTML"])
def test_markup_in_literals_is_refused_however_it_is_named(name: str) -> None:
    whole = f"http://www.w3.org/1999/02/22-rdf-syntax-ns#{name}"
    with pytest.raises(BadDescription, match="XML or HTML"):
        read_turtle(f'@prefix r: <{whole[:-2]}> . <urn:a> <urn:b> "<x/>"^^r:{whole[-2:]} .')
    context = {"r": {"@id": whole[:-2], "@prefix": True}}
    with pytest.raises(BadDescription, match="XML or HTML"):
        read_json_ld({"@context": context, "urn:b": {"@value": "<x/>", "@type": f"r:{whole[-2:]}"}})
    assert read_turtle(f'<urn:a> <urn:b> "rdf:{name}" .').objects("urn:a", "urn:b") == ((f"rdf:{name}", "", ""),)

"""Triples as plain values, the same whichever library has read them: a node is text, a literal is a `Text`."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from vipo_device.descriptions.forms import refuse

MOST_TRIPLES = 4000
RDF = "http://www.w3.org/1999/02/22-rdf-syntax-ns#"
TYPE, FIRST, REST, NIL = RDF + "type", RDF + "first", RDF + "rest", RDF + "nil"
_MARKUP = frozenset({RDF + "XMLLiteral", RDF + "HTML"})
BLANK = "_:"
"""Before a blank node's label; no address begins so."""


class Text(NamedTuple):
    """A literal as it is written; `datatype` is empty for plain text and for text in a language."""

    text: str
    datatype: str = ""
    language: str = ""


Node = str | Text
Triple = tuple[str, str, Node]


class Triples:
    """A set of triples, found by their subject and predicate, in the order of their first coming."""

    def __init__(self, triples: Iterable[Triple]) -> None:
        """Raises BadDescription for more than 4000, and for XML or HTML in literals."""
        self._about: defaultdict[str, defaultdict[str, dict[Node, None]]] = defaultdict(lambda: defaultdict(dict))
        for subject, predicate, value in triples:
            if isinstance(value, Text) and value.datatype in _MARKUP:
                refuse("rdf_literals")
            self._about[subject][predicate][value] = None
        count = sum(len(values) for said in self._about.values() for values in said.values())
        if count > MOST_TRIPLES:
            refuse("rdf_triples", count=count, most=MOST_TRIPLES)

    def __iter__(self) -> Iterator[Triple]:
        for subject, said in self._about.items():
            for predicate, values in said.items():
                for value in values:
                    yield subject, predicate, value

    def objects(self, subject: Node | None, predicate: str) -> tuple[Node, ...]:
        """Return what is said of a subject; nothing of a literal."""
        said: Mapping[str, dict[Node, None]] = self._about.get(subject, {}) if isinstance(subject, str) else {}
        return tuple(said.get(predicate, ()))

    def subjects_of(self, type_of: str) -> tuple[str, ...]:
        """Return what is of a type."""
        return tuple(subject for subject, said in self._about.items() if type_of in said.get(TYPE, ()))

"""The outside of a description: which form it is in, what is refused at sight, and no context from elsewhere."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, Literal, NamedTuple, NoReturn

from vipo_device.protocol.errors import VipoError
from vipo_device.protocol.faults import Fault, bare, facts_of, fault
from vipo_device.protocol.messages import MAX_BYTES, MAX_DEPTH, BadMessage, parse_json

DescriptionForm = Literal["turtle", "n-triples", "json-ld", "td", "paper"]


class Form(NamedTuple):
    """A form of descriptions: what people call it within a sentence, its type over HTTP, and whether it is RDF."""

    name: str
    content_type: str
    is_rdf: bool = False


FORMS: Mapping[DescriptionForm, Form] = {
    "turtle": Form("Turtle", "text/turtle", is_rdf=True),
    "n-triples": Form("N-Triples", "application/n-triples", is_rdf=True),
    "json-ld": Form("JSON-LD", "application/ld+json", is_rdf=True),
    "td": Form("a Thing Description", "application/td+json"),
    "paper": Form("the paper's message", "text/plain"),
}
CONTENT_TYPES: Mapping[DescriptionForm, str] = {form: record.content_type for form, record in FORMS.items()}
*_FIRST_NAMES, _LAST_NAME = (record.name for record in FORMS.values())
ANY_FORM = f"{', '.join(_FIRST_NAMES)} or {_LAST_NAME}"
"""All forms by their names, for sentences: “Turtle, …, a Thing Description or the paper's message”."""
NAMESPACES: Mapping[str, str] = {
    "vipo": "urn:vipo:ns#",
    "td": "https://www.w3.org/2019/wot/td#",
    "sosa": "http://www.w3.org/ns/sosa/",
    "qudt": "http://qudt.org/schema/qudt/",
    "unit": "http://qudt.org/vocab/unit/",
    "schema": "https://schema.org/",
    "dct": "http://purl.org/dc/terms/",
}
SCHEMA_OVER_HTTP = "http://schema.org/"
"""How schema.org's own context, and much that is published, write the same terms."""
CONTEXT = "urn:vipo:context"
DESCRIPTION = "The description"
MOST_TOLD = 5
PINNED_CONTEXTS: Mapping[str, Mapping[str, str]] = {CONTEXT: NAMESPACES}
TD_CONTEXT = "https://www.w3.org/2022/wot/td/v1.1"
TD_CONTEXT_1_0 = "https://www.w3.org/2019/wot/td/v1"
TD_CONTEXTS = frozenset({TD_CONTEXT, TD_CONTEXT_1_0})
PAPER_KEYS = frozenset(
    {"id", "name", "description", "location", "size", "imgurl", "done", "properties", "methods", "kind"}
)
_MARKUP = re.compile(rb"\s*<(?:\?xml|!DOCTYPE|!--|rdf:|html[\s>])", re.IGNORECASE)
_FIRST_LINE = re.compile(r"(?m)^(?:---)?[ \t]*(?!#|---)(\S.*)$")
_PAPER_LINE = re.compile(r"\"?([A-Za-z](?:[A-Za-z_ -]*[A-Za-z_])?)\"?\s*(?::(?:\s|$|[\"'\[])|$)")
_TRIPLE = re.compile(r"\s*(?:(?:<[^>]*>|_:\S+)\s+<[^>]*>\s.*\.\s*)?(?:#.*)?")
_BRACKET = re.compile(
    r'"""(?:[^"\\]|\\.|"(?!""))*+(?:"""|\\?\Z)'
    r"|'''(?:[^'\\]|\\.|'(?!''))*+(?:'''|\\?\Z)"
    r'|"(?:[^"\\\n]|\\.)*+"?'
    r"|'(?:[^'\\\n]|\\.)*+'?"
    r"|<[^<>\s]*>|#[^\n]*|[\[(]|[\])]",
    re.DOTALL,
)
_SURROGATE = re.compile(r"\\u[dD][89a-fA-F]|\\U0000[dD][89a-fA-F]")


class BadDescription(VipoError):
    """A description that cannot be read or believed; `faults` say why, each in a sentence with its place."""

    code = "bad_description"
    status = 422

    def __init__(self, *faults: Fault | str, heading: str = "") -> None:
        self.faults = tuple(bare(fault) if isinstance(fault, str) else fault for fault in faults)
        told = " ".join([heading, *(fault.sentence for fault in self.faults[:MOST_TOLD])]).strip()
        super().__init__(told, facts_of(self.faults[:MOST_TOLD]))


def refuse(code: str, line: int = 0, column: int = 0, path: str = "", /, **args: str | float) -> NoReturn:
    """Say what is wrong with a description. Raises BadDescription."""
    raise BadDescription(fault(code, line, column, path, **args))


def form_of(payload: bytes) -> DescriptionForm:
    """Return the form that a payload is in; raises BadDescription for what is refused at sight."""
    text = plain_text(payload)
    if is_json(text):
        return form_of_json(read_json(text))
    return form_of_text(text)


def plain_text(payload: bytes) -> str:
    """Return a payload's text. Raises BadDescription for what is too long, XML, not UTF-8, or holds NUL."""
    if len(payload) > MAX_BYTES:
        refuse("too_many_bytes", it=DESCRIPTION, bytes=len(payload), most=MAX_BYTES)
    if _MARKUP.match(payload.removeprefix(b"\xef\xbb\xbf")) or b"<rdf:RDF" in payload:
        refuse("markup", accepted=ANY_FORM)
    try:
        text = payload.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise BadDescription(fault("not_utf8", it=DESCRIPTION)) from error
    if "\0" in text or "\\u0000" in text or "\\U00000000" in text:
        refuse("nul")
    if not text.strip():
        refuse("empty")
    return text


def is_json(text: str) -> bool:
    """Tell whether a description is written as JSON: no other form begins with a brace, and Turtle's `[` has no `"`."""
    start = text.lstrip()
    return start.startswith("{") or bool(re.match(r"\[\s*(?:\{|\]\s*$)", start))


def form_of_json(body: Any) -> DescriptionForm:
    """Return which form a JSON value is: a Thing Description names its context, the paper's message has no `@`."""
    fields = body if isinstance(body, dict) else {}
    context = fields.get("@context")
    named = context if isinstance(context, list) else [context]
    if any(isinstance(name, str) and name in TD_CONTEXTS for name in named):
        return "td"
    keys = {paper_key(key) for key in fields}
    return "paper" if keys & PAPER_KEYS and not any(key.startswith("@") for key in fields) else "json-ld"


def form_of_text(text: str) -> DescriptionForm:
    """Return which form a text is: the paper's message begins with one of its keys, where Turtle needs a prefix."""
    first = _FIRST_LINE.search(text)
    found = _PAPER_LINE.match(first.group(1)) if first else None
    if found and paper_key(found.group(1)) in PAPER_KEYS:
        return "paper"
    triples = first is not None and all(_TRIPLE.fullmatch(line) for line in text.splitlines())
    return "n-triples" if triples else "turtle"


def paper_key(key: str) -> str:
    """Return a key of the paper's message without what its spelling differs in: case, `_`, `-` and spaces."""
    return re.sub(r"[_\s-]", "", key).lower()


def check_turtle(text: str) -> None:
    """Refuse Turtle that is nested too deep, or that writes half a surrogate pair. Raises BadDescription."""
    depth = 0
    for found in _BRACKET.finditer(text):
        mark = found.group()
        depth += (mark in "[(") - (mark in "])")
        if depth > MAX_DEPTH:
            line, column = place_in(text, found.start())
            refuse("rdf_deep", line, column, most=MAX_DEPTH)
    if half := _SURROGATE.search(text):
        line, column = place_in(text, half.start())
        refuse("half_pair", line, column)


def place_in(text: str, at: int) -> tuple[int, int]:
    """Return the line and column of a position, both from 1."""
    return text.count("\n", 0, at) + 1, at - text.rfind("\n", 0, at)


def read_json(text: str) -> Any:
    """Return the JSON value of a description. Raises BadDescription."""
    try:
        return parse_json(text.encode())
    except BadMessage as error:
        raise BadDescription(error.fault.about(DESCRIPTION)) from error


def pin_contexts(value: Any) -> Any:
    """Put the pinned contexts in place of their names, and refuse every other one: a name would be fetched."""
    if isinstance(value, list):
        return [pin_contexts(v) for v in value]
    if not isinstance(value, dict):
        return value
    if "@import" in value:
        refuse("context_import")
    return {k: _pin_context(v) if k == "@context" else pin_contexts(v) for k, v in value.items()}


def _pin_context(context: Any) -> Any:
    if isinstance(context, list):
        return [_pin_context(c) for c in context]
    if isinstance(context, str):
        if context not in PINNED_CONTEXTS:
            refuse("context_unknown", named=context[:100], known=CONTEXT)
        return dict(PINNED_CONTEXTS[context])
    return pin_contexts(context)

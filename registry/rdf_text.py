"""The outside of an RDF payload: which form it is in, what is refused at sight, and no context from elsewhere."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from registry.errors import RegistryError
from registry.wire import MAX_BYTES, BadMessage, parse_json

NAMESPACES: Mapping[str, str] = {
    "vipo": "urn:vipo:ns#",
    "td": "https://www.w3.org/2019/wot/td#",
    "sosa": "http://www.w3.org/ns/sosa/",
    "qudt": "http://qudt.org/schema/qudt/",
    "unit": "http://qudt.org/vocab/unit/",
    "schema": "https://schema.org/",
    "dct": "http://purl.org/dc/terms/",
}
CONTEXT = "urn:vipo:context"
PINNED_CONTEXTS: Mapping[str, Mapping[str, str]] = {CONTEXT: NAMESPACES}
CONTENT_TYPES = {"turtle": "text/turtle", "nt": "application/n-triples", "json-ld": "application/ld+json"}


class BadDescription(RegistryError):
    """A description that cannot be read or believed; the sentence says why."""

    code = "bad_description"
    status = 422


def detect_content_type(payload: bytes) -> str:
    """Return the content type that a payload looks like; raises BadDescription for what is refused at sight."""
    if len(payload) > MAX_BYTES:
        raise BadDescription(f"The description has {len(payload)} bytes; {MAX_BYTES} is the most.")
    start = payload.lstrip()[:200]
    if start.startswith((b"<?xml", b"<rdf:", b"<!DOCTYPE", b"<!--")) or b"<rdf:RDF" in payload[:4000]:
        raise BadDescription("The description is RDF/XML, which is not accepted. Send Turtle, N-Triples or JSON-LD.")
    return CONTENT_TYPES["json-ld"] if start[:1] in (b"{", b"[") else CONTENT_TYPES["turtle"]


def plain_text(payload: bytes) -> str:
    """Return a payload's text; raises BadDescription for NUL and for literals that hold markup."""
    try:
        text = payload.decode("utf-8")
    except UnicodeDecodeError as error:
        raise BadDescription("The description is not UTF-8.") from error
    if "\0" in text or "\\u0000" in text or "\\U00000000" in text:
        raise BadDescription("The description holds the character NUL. Remove it.")
    if "XMLLiteral" in text or "rdf-syntax-ns#HTML" in text or "rdf:HTML" in text:
        raise BadDescription("The description holds XML or HTML literals. Use plain text.")
    return text


def pinned_json(payload: bytes) -> Any:
    """Return a JSON-LD payload with the pinned contexts written out. Raises BadDescription."""
    plain_text(payload)
    try:
        return _pin(parse_json(payload))
    except BadMessage as error:
        raise BadDescription(f"The description is not JSON-LD. {error.detail}") from error


def _pin(value: Any) -> Any:
    """Put the pinned contexts in place of their names, and refuse every other one: a name would be fetched."""
    if isinstance(value, list):
        return [_pin(v) for v in value]
    if not isinstance(value, dict):
        return value
    if "@import" in value:
        raise BadDescription("The description imports a JSON-LD context. Write the context out.")
    return {k: _pin_context(v) if k == "@context" else _pin(v) for k, v in value.items()}


def _pin_context(context: Any) -> Any:
    if isinstance(context, list):
        return [_pin_context(c) for c in context]
    if isinstance(context, str):
        if context not in PINNED_CONTEXTS:
            raise BadDescription(f"The JSON-LD context {context[:100]!r} is not known here. Use {CONTEXT!r}.")
        return dict(PINNED_CONTEXTS[context])
    return _pin(context)

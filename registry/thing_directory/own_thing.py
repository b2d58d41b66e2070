"""The directory's own Thing Description (WoT Discovery, class ThingDirectory): what it offers, and to whom."""

from __future__ import annotations

from typing import Any
from urllib.parse import urlsplit

from registry.devices.thing_forms import CONTEXTS, TOKEN
from registry.devices.things import EVENTS
from registry.thing_directory.pages import DISCOVERY_CONTEXT, MOST_AT_ONCE, SORTED_BY

PROBLEM = "application/problem+json"
THING_ID = {"id": {"@type": "ThingID", "type": "string", "format": "iri-reference", "title": "The Thing's id"}}
PAGES = {
    "offset": {"type": "integer", "minimum": 0, "default": 0, "title": "How many Things to leave out"},
    "limit": {"type": "integer", "minimum": 1, "maximum": MOST_AT_ONCE, "default": 50, "title": "How many to list"},
    "format": {"type": "string", "enum": ["array", "collection"], "default": "array"},
    "sort_by": {"type": "string", "enum": list(SORTED_BY), "default": "id"},
    "sort_order": {"type": "string", "enum": ["asc", "desc"], "default": "asc"},
}
SECURITY = {
    "token": dict(TOKEN),
    "session": {
        "scheme": "apikey",
        "in": "cookie",
        "name": "sessionid",
        "description": "Taken in place of a token: the cookie that POST /api/sign-in sets. Changes need the header "
        "X-CSRFToken, too. That either will do could only be said by a `combo`, which clients do not know.",
    },
}


def directory_thing(base: str) -> dict[str, Any]:
    """Return the directory's Thing Description; `base` is where it is served."""
    return {
        "@context": [*CONTEXTS, DISCOVERY_CONTEXT, {"htv": "http://www.w3.org/2011/http#"}],
        "@type": "ThingDirectory",
        "id": f"urn:vipo:directory:{urlsplit(base).netloc}",
        "title": "VIPO",
        "description": "The robots and machines of all sites of which the caller is a member.",
        "base": base,
        "securityDefinitions": SECURITY,
        "security": ["token"],
        "links": [{"rel": "service-desc", "href": "/api/openapi.json", "type": "application/json"}],
        "properties": {"things": _things()},
        "actions": {"retrieveThing": _retrieve(), "partiallyUpdateThing": _patch()},
        "events": {_camel(name): _event(name) for name in EVENTS},
    }


def _form(method: str, href: str, op: str, media_type: str, *refused: int, **more: Any) -> dict[str, Any]:
    refusals = [{"success": False, "contentType": PROBLEM, "htv:statusCodeValue": status} for status in refused]
    return {"href": href, "op": op, "htv:methodName": method, "contentType": media_type, **more,
            "additionalResponses": refusals}  # fmt: skip


def _things() -> dict[str, Any]:
    href = "/things{?offset,limit,format,sort_by,sort_order}"
    return {
        "description": "All Things, a page at a time; the header Link names the next page.",
        "type": "array",
        "readOnly": True,
        "uriVariables": PAGES,
        "forms": [_form("GET", href, "readproperty", "application/ld+json", 400, 401, 501)],
    }


def _retrieve() -> dict[str, Any]:
    return {
        "description": "One Thing Description, with an ETag.",
        "uriVariables": THING_ID,
        "output": {"type": "object"},
        "safe": True,
        "idempotent": True,
        "forms": [_form("GET", "/things/{id}", "invokeaction", "application/td+json", 401, 404)],
    }


def _patch() -> dict[str, Any]:
    media_type = "application/merge-patch+json"
    form = _form("PATCH", "/things/{id}", "invokeaction", media_type, 400, 401, 403, 404, 412, 415)
    changes = {
        "title": {"type": "string", "description": "A name that people give it; null: its own again."},
        "vipo:location": {
            "oneOf": [{"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 4}, {"type": "null"}],
            "description": "Where people put it; null: where it says itself again.",
        },
    }
    return {
        "description": "Name or place a Thing, for admins of its site; If-Match keeps others' changes.",
        "uriVariables": THING_ID,
        "input": {"type": "object", "properties": changes},
        "forms": [form],
    }


def _event(name: str) -> dict[str, Any]:
    form = _form("GET", f"/events/{name}{{?diff}}", "subscribeevent", "text/event-stream", 401, 429, subprotocol="sse")
    return {
        "description": "With `diff`: the whole Thing when it is new, a merge patch (RFC 7396) of what changed.",
        "uriVariables": {"diff": {"type": "boolean", "default": False}},
        "data": {"type": "object", "properties": {"id": {"type": "string"}}, "required": ["id"]},
        "forms": [form],
    }


def _camel(name: str) -> str:
    first, *rest = name.split("_")
    return first + "".join(map(str.title, rest))

"""A device as the Thing that programs use: over HTTP, with a token, every value as its schema says.

What a device says of itself names its own MQTT topics; those are for VIPO alone, so that runs, stops and people's calls
meet at one place. Addresses are relative to the Thing's `base`, since what became of Things is kept for every reader;
values are also told on topics of VIPO's own, at the broker of VIPO_BROKER_URL.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from django.conf import settings

from vipo_device.descriptions.forms import TD_CONTEXT, TD_CONTEXT_1_0
from vipo_device.descriptions.thing_description import schema_of, thing_of
from vipo_device.protocol.description import Description, MethodSpec, PropertySpec
from vipo_device.protocol.topics import property_topic

TOKEN: Mapping[str, Any] = {
    "scheme": "bearer",
    "in": "header",
    "name": "Authorization",
    "format": "opaque",
    "description": "A token that a member has made for a program, on VIPO's pages.",
}
BROKER_TOKEN: Mapping[str, Any] = {
    "scheme": "basic",
    "description": "A token that was made for the broker, too: user name token:ID, password the token.",
}
"""Without saying where in a packet: clients of version 1.0 of the standard know no `auto`."""
CONTEXTS = (TD_CONTEXT_1_0, TD_CONTEXT)
"""Both, as the standard wants it of Things that clients of its version 1.0 may read, too, such as node-wot 0.8."""
CALL_ID = {"call": {"type": "string", "format": "uuid", "title": "The call, as `href` names it at its end"}}
STATUS = {
    "type": "object",
    "properties": {
        "status": {"type": "string", "enum": ["pending", "running", "completed", "failed"]},
        "href": {"type": "string", "format": "uri-reference", "description": "Where it is asked how it goes on."},
        "timeRequested": {"type": "string", "format": "date-time"},
        "timeEnded": {"type": "string", "format": "date-time"},
        "output": {"type": "object", "description": "What the device answered, once it is completed."},
        "error": {"type": "object", "description": "Why it failed (RFC 9457)."},
    },
    "required": ["status", "href", "timeRequested"],
}


def things_address(site: str, device_id: str = "") -> str:
    """Return where a site's Things are, or one of them."""
    return f"/api/sites/{site}/things" + (f"/{device_id}" if device_id else "")


def consumed_thing(said: Description, site: str) -> dict[str, Any]:
    """Return a device's Thing Description with the forms by which programs use it."""
    address = things_address(site, said.id)
    described = thing_of(said)
    everything = {"op": "readallproperties", **_form("GET", f"{address}/properties")}
    broker = str(settings.VIPO_BROKER_URL)
    tokens = {"token": dict(TOKEN), **({"broker_token": dict(BROKER_TOKEN)} if broker else {})}
    return {
        **described,
        "@context": [*CONTEXTS, *described["@context"][1:]],
        "securityDefinitions": tokens,
        "security": ["token"],
        "properties": {
            spec.name: _property_of(spec, address, _told(broker, property_topic(site, said.id, spec.name)))
            for spec in said.properties
        },
        "actions": {method.name: _action_of(method, address) for method in said.methods},
        "forms": [everything],
    }


def _form(method: str, href: str) -> dict[str, Any]:
    return {"href": href, "htv:methodName": method, "contentType": "application/json"}


def _told(broker: str, topic: str) -> list[dict[str, Any]]:
    """Return the form by which a value is heard at the broker, if it is known where that is."""
    subscribe = {"mqv:controlPacket": "subscribe", "mqv:filter": topic, "mqv:qos": "0", "mqv:retain": True}
    form = {"href": f"{broker.rstrip('/')}/{topic}", "contentType": "application/json", "security": ["broker_token"]}
    return [{"op": ["observeproperty", "unobserveproperty"], **form, **subscribe}] if broker else []


def _property_of(spec: PropertySpec, address: str, told: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Return a property; of the ways to observe it the first is the one that carries a token everywhere.

    That form names no method: node-wot asks by HEAD first, unless a method is named.
    """
    here = f"{address}/properties/{spec.name}"
    observe = {"op": ["observeproperty", "unobserveproperty"]}
    title = {"title": spec.title} if spec.title else {}
    forms = [
        {"op": "readproperty", **_form("GET", here)},
        {**observe, "href": f"{here}/next", "contentType": "application/json", "subprotocol": "longpoll"},
        {**observe, **_form("GET", f"{here}/events"), "subprotocol": "sse"},
        *told,
    ]
    return {**title, **value_schema(spec), "readOnly": True, "observable": True, "forms": forms}


def value_schema(spec: PropertySpec) -> dict[str, Any]:
    """Return what a property's values are: devices say a location as a text, as all that is no number or truth."""
    schema = schema_of(spec)
    return {**schema, "type": "string"} if spec.type == "location" else schema


def _action_of(method: MethodSpec, address: str) -> dict[str, Any]:
    here = f"{address}/actions/{method.name}"
    arguments = {spec.name: schema_of(spec) for spec in method.parameters}
    needed = [spec.name for spec in method.parameters if spec.required]
    title = {"title": method.title} if method.title else {}
    given = {"input": {"type": "object", "properties": arguments, "required": needed}} if arguments else {}
    forms = [
        {"op": "invokeaction", **_form("POST", here)},
        {"op": "queryaction", **_form("GET", here + "/{call}")},
        {"op": "cancelaction", **_form("DELETE", here + "/{call}")},
    ]
    return {**title, **given, "output": STATUS, "uriVariables": CALL_ID, "forms": forms}

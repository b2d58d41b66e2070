"""A device as a W3C Thing Description 1.1, read and written; docs/protocol.md names VIPO's own terms."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Any, cast
from urllib.parse import SplitResult, urljoin, urlsplit

from vipo_device.descriptions.forms import CONTEXT, NAMESPACES, SCHEMA_OVER_HTTP, TD_CONTEXT, TD_CONTEXTS, refuse
from vipo_device.descriptions.json_fields import Fields, read_pose, read_size
from vipo_device.protocol.arguments import is_number
from vipo_device.protocol.description import Description, DeviceKind, MethodSpec, ParameterSpec, PropertySpec, ValueType
from vipo_device.protocol.messages import down_topic, up_topic
from vipo_device.protocol.units import device_unit

DEVICE_URN = "urn:vipo:device:"
TERMS: Mapping[str, str] = {
    **{prefix: name for prefix, name in NAMESPACES.items() if prefix != "td"},
    "mqv": "http://www.w3.org/2018/wot/mqtt#",
}
_KINDS: Mapping[DeviceKind, list[str]] = {
    "machine": ["sosa:Actuator", "vipo:Machine"],
    "robot": ["sosa:Platform", "vipo:Robot"],
}
_TD_TYPES: Mapping[ValueType, str] = {
    "number": "number",
    "text": "string",
    "boolean": "boolean",
    "object": "string",
    "device": "string",
    "place": "string",
    "location": "array",
}
_TYPES: Mapping[str, ValueType] = {"number": "number", "integer": "number", "string": "text", "boolean": "boolean"}
_TD_TYPES_OF: Mapping[type, str] = {str: "string", bool: "boolean", int: "number", float: "number"}
COMMAND = "vipo:Command"
INVOKE = "invokeaction"
"""What a form of an action is for, where it does not say so."""


def describe_thing(body: Mapping[str, Any]) -> Description:
    """Return what a Thing Description says of a device; it keeps to the TD schema. Raises BadDescription."""
    fields = Fields(_with_our_prefixes(body))
    kind = _kind(fields)
    device_id = _device_id(fields)
    radius = fields.number("vipo:radius") or 0.0
    return Description(
        id=device_id,
        name=fields.text("title") or device_id,
        kind=kind,
        device_class=fields.text("vipo:deviceClass"),
        pose=read_pose(fields, "vipo:location"),
        size=read_size(fields, "vipo:size", radius if kind == "robot" else 0.0),
        description=fields.text("description"),
        image=fields.text("schema:image"),
        site=fields.text("vipo:site"),
        done=fields.truth("vipo:done", default=True),
        simulated=fields.truth("vipo:simulated", default=False),
        gives=tuple(sorted(set(fields.words("vipo:gives")))),
        takes=tuple(sorted(set(fields.words("vipo:takes")))),
        capacity=fields.whole("vipo:capacity"),
        radius_m=radius,
        speed_m_s=fields.number("vipo:speed") or 0.0,
        properties=tuple(
            PropertySpec(**_value(name, item), title=item.text("title")) for name, item in fields.named("properties")
        ),
        methods=tuple(_method(device_id, name, item, fields.text("base")) for name, item in fields.named("actions")),
    )


def _with_our_prefixes(body: Mapping[str, Any]) -> dict[str, Any]:
    """Return the Thing with VIPO's own prefixes, whatever its context calls them; no context is ever fetched."""
    context = body.get("@context")
    own = {}
    for part in context if isinstance(context, list) else [context]:
        if isinstance(part, str) and part not in {*TD_CONTEXTS, CONTEXT}:
            refuse("context_unknown", 0, 0, "/@context", named=part[:100], known=TD_CONTEXT)
        own.update(part if isinstance(part, dict) else {})
    ours = {name: prefix for prefix, name in TERMS.items()} | {SCHEMA_OVER_HTTP: "schema"}
    renamed = {p: ours[n] for p, n in own.items() if isinstance(n, str) and n in ours and p != ours[n]}
    foreign = [p for p, n in own.items() if p in TERMS and not (isinstance(n, str) and ours.get(n) == p)]
    if foreign:
        refuse("context_meaning", 0, 0, "/@context", prefix=foreign[0], meaning=TERMS[foreign[0]])
    rest = {key: value for key, value in body.items() if key != "@context"}
    return cast("dict[str, Any]", _renamed(rest, renamed, ours))


def list_own_keys(body: Mapping[str, Any]) -> set[str]:
    """Return which of VIPO's own terms a Thing uses as keys, in short, whether there are such or not."""
    found = set[str]()
    left: list[Any] = [_with_our_prefixes(body)]
    for value in left:
        if isinstance(value, dict):
            found.update(key for key in value if key.startswith("vipo:"))
            left.extend(value.values())
        elif isinstance(value, list):
            left.extend(value)
    return found


def _renamed(value: Any, prefixes: Mapping[str, str], ours: Mapping[str, str]) -> Any:
    if isinstance(value, list):
        return [_renamed(item, prefixes, ours) for item in value]
    if not isinstance(value, dict):
        return value
    if "@context" in value:
        refuse("context_within")
    found = {_short(key, prefixes, ours): _renamed(inner, prefixes, ours) for key, inner in value.items()}
    if len(found) != len(value):
        refuse("term_twice")
    if "@type" in found:
        kinds = found["@type"] if isinstance(found["@type"], list) else [found["@type"]]
        found["@type"] = [_short(kind, prefixes, ours) for kind in kinds if isinstance(kind, str)]
    return found


def _short(term: str, prefixes: Mapping[str, str], ours: Mapping[str, str]) -> str:
    prefix, colon, name = term.partition(":")
    if colon and prefix in prefixes:
        return f"{prefixes[prefix]}:{name}"
    whole = next((namespace for namespace in ours if term.startswith(namespace)), None)
    return f"{ours[whole]}:{term.removeprefix(whole)}" if whole else term


def _device_id(fields: Fields) -> str:
    said = fields.text("dct:identifier")
    named = fields.text("id")
    if not said and named.startswith(DEVICE_URN):
        return named.removeprefix(DEVICE_URN)
    if not said:
        fields.refuse("id", "need_td_id")
    return said


def _kind(fields: Fields) -> DeviceKind:
    types = fields.body.get("@type", [])
    kinds: list[DeviceKind] = [kind for kind, names in _KINDS.items() if names[-1] in types]
    if len(kinds) != 1:
        fields.refuse("@type", "need_td_kind")
    return kinds[0]


def _value(name: str, item: Fields) -> dict[str, Any]:
    kind, minimum, maximum = _type(item), item.number("minimum"), item.number("maximum")
    allowed, options = _allowed(item), tuple[str, ...]()
    if kind == "number" and allowed and all(map(is_number, allowed)):
        # Choices are texts here; what is left of numbers are their limits.
        minimum = max([float(min(allowed)), *([] if minimum is None else [minimum])])
        maximum = min([float(max(allowed)), *([] if maximum is None else [maximum])])
    elif not (kind == "boolean" and all(isinstance(each, bool) for each in allowed)):
        options = Fields({"enum": allowed}, item.path, item.places).words("enum")
    return {
        "name": name,
        "type": kind,
        "unit": device_unit(item.text("unit").removeprefix(TERMS["unit"]).removeprefix("unit:")),
        "minimum": minimum,
        "maximum": maximum,
        "options": options,
    }


def _allowed(item: Fields) -> list[Any]:
    """Return the values that alone are allowed; none where any is."""
    if item.has("const"):
        return [item.body["const"]]
    return list(item.body["enum"]) if item.has("enum") else []


def _type(item: Fields) -> ValueType:
    if item.has("vipo:type"):
        return cast("ValueType", item.text("vipo:type"))
    kinds = [_TD_TYPES_OF.get(type(value), "string") for value in _allowed(item)]
    said = item.text("type") or next(iter(kinds), "number")
    if said not in _TYPES:
        item.refuse("type", "value_type", type=said[:20])
    return _TYPES[said]


def _method(device_id: str, name: str, item: Fields, base: str) -> MethodSpec:
    return MethodSpec(
        name=name,
        topic=_topic(_mqtt_form(item, base), base) or down_topic(device_id, name),
        message_type=item.text("vipo:messageType"),
        title=item.text("title"),
        parameters=tuple(_parameters(item.inside("input"))),
    )


def _mqtt_form(item: Fields, base: str) -> Fields:
    for form in item.each("forms"):
        operations = form.body.get("op", INVOKE)
        is_call = operations == INVOKE or (isinstance(operations, list) and INVOKE in operations)
        if is_call and (form.has("mqv:topic") or _address(form, base).scheme in ("", "mqtt", "mqtts")):
            return form
    return item.refuse("forms", "need_mqtt")


def _address(form: Fields, base: str) -> SplitResult:
    """Return where a form leads to, within the base of its Thing; without a base, a topic alone has no scheme."""
    try:
        linked, within = urlsplit(form.text("href")), urlsplit(base)
        if linked.scheme or not within.scheme:
            return linked
        # urljoin joins only addresses of schemes that it knows.
        joined = urlsplit(urljoin(within._replace(scheme="http").geturl(), linked.geturl()))
        return joined._replace(scheme=within.scheme)
    except ValueError:
        return SplitResult("unknown", "", "", "", "")


def _topic(form: Fields, base: str) -> str:
    """Return the topic of a form; where it is said twice, both must agree."""
    named, linked = form.text("mqv:topic"), _address(form, base).path.lstrip("/")
    if named and linked and not linked.endswith(named):
        form.refuse("mqv:topic", "two_topics", named=named[:80], linked=linked[:80])
    return named or linked


def _parameters(given: Fields) -> Iterator[ParameterSpec]:
    """Read the arguments of a command; a plain input that is no object is one argument called `value`."""
    types = given.body.get("@type", [])
    plain = given.inside("properties").inside("v") if COMMAND in types else given
    if given.body and "properties" not in plain.body and plain.body.get("type", "object") != "object":
        yield ParameterSpec(**_value("value", plain))
        return
    required = plain.words("required")
    for name, item in plain.named("properties"):
        yield ParameterSpec(**_value(name, item), required=name in required)


def write_thing(description: Description, base: str = "") -> str:
    """Return a description as a Thing Description; `base` is the broker's address, such as mqtt://host:1883/."""
    within = f"{base.rstrip('/')}/" if base else ""
    return json.dumps(thing_of(description, within), ensure_ascii=False, indent=2, allow_nan=False) + "\n"


def thing_of(d: Description, base: str = "") -> dict[str, Any]:
    """Return a description as a Thing Description's JSON."""
    said = {
        "description": d.description,
        "schema:image": d.image,
        "vipo:deviceClass": d.device_class,
        "vipo:site": d.site,
        "vipo:gives": list(d.gives),
        "vipo:takes": list(d.takes),
        "vipo:capacity": d.capacity,
        "vipo:radius": d.radius_m,
        "vipo:speed": d.speed_m_s,
    }
    return {
        "@context": [TD_CONTEXT, dict(TERMS)],
        "@type": list(_KINDS[d.kind]),
        "id": f"{DEVICE_URN}{d.id}",
        "title": d.name,
        "securityDefinitions": {"device_key": {"scheme": "basic", "in": "auto"}},
        "security": ["device_key"],
        "vipo:location": [d.pose.x, d.pose.y, d.pose.z, d.pose.theta],
        "vipo:size": [d.size.x, d.size.y, d.size.z],
        "vipo:done": d.done,
        "vipo:simulated": d.simulated,
        **{key: value for key, value in said.items() if value},
        "properties": {spec.name: _property_of(d.id, spec, base) for spec in d.properties},
        "actions": {method.name: _action_of(method, base) for method in d.methods},
    }


def _property_of(device_id: str, spec: PropertySpec, base: str) -> dict[str, Any]:
    topic = up_topic(device_id, "state")
    form = {
        "href": base + topic,
        "op": ["observeproperty", "unobserveproperty"],
        "contentType": "application/json",
        "mqv:controlPacket": "subscribe",
        "mqv:filter": topic,
        "mqv:qos": "1",
        "vipo:pointer": f"/props/{spec.name}",
    }
    title = {"title": spec.title} if spec.title else {}
    return {**title, **schema_of(spec), "readOnly": True, "observable": True, "forms": [form]}


def _action_of(method: MethodSpec, base: str) -> dict[str, Any]:
    form = {
        "href": base + method.topic,
        "op": "invokeaction",
        "contentType": "application/json",
        "mqv:controlPacket": "publish",
        "mqv:topic": method.topic,
        "mqv:qos": "1",
        "mqv:retain": False,
    }
    arguments = {
        "type": "object",
        "properties": {spec.name: schema_of(spec) for spec in method.parameters},
        "required": [spec.name for spec in method.parameters if spec.required],
    }
    said = {"title": method.title, "vipo:messageType": method.message_type}
    return {**{key: value for key, value in said.items() if value}, "input": _command(arguments), "forms": [form]}


def _command(arguments: dict[str, Any]) -> dict[str, Any]:
    """Return the schema of the whole message that is published: docs/protocol.md, Commands."""
    fields = {"id": {"type": "string"}, "v": arguments, "ttl_s": {"type": "number", "unit": "unit:SEC"}}
    return {"@type": COMMAND, "type": "object", "properties": fields, "required": ["id", "v"]}


def schema_of(spec: PropertySpec | ParameterSpec) -> dict[str, Any]:
    """Return the schema of a value."""
    td_type = _TD_TYPES[spec.type]
    exact = {} if _TYPES.get(td_type) == spec.type else {"vipo:type": spec.type}
    said = {
        "unit": f"unit:{spec.unit}" if spec.unit else None,
        "minimum": spec.minimum,
        "maximum": spec.maximum,
        "enum": list(spec.options) or None,
    }
    return {"type": td_type, **exact, **{key: value for key, value in said.items() if value is not None}}

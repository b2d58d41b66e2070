"""What a device says it is and can do: the canonical description that every form is turned into."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from math import isfinite
from typing import Any, Literal, get_args

from registry.topic_rules import find_topic_fault, find_twice, list_asked

ValueType = Literal["number", "text", "boolean", "object", "device", "place", "location"]
DeviceKind = Literal["machine", "robot"]
Scalar = float | int | str | bool | None


@dataclass(frozen=True, slots=True)
class Pose:
    """A place on the site's map: metres and radians in the ROS map frame (x right, y up, theta anticlockwise)."""

    x: float
    y: float
    z: float = 0.0
    theta: float = 0.0


@dataclass(frozen=True, slots=True)
class Size:
    """The box a device fills, in metres."""

    x: float
    y: float
    z: float


@dataclass(frozen=True, slots=True)
class PropertySpec:
    """A reading a device offers; `unit` is a QUDT unit's short name such as `DEG_C`, `MIN`, `PERCENT`, or empty."""

    name: str
    type: ValueType
    unit: str = ""
    minimum: float | None = None
    maximum: float | None = None
    title: str = ""
    options: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class ParameterSpec:
    """One argument of a method."""

    name: str
    type: ValueType
    unit: str = ""
    minimum: float | None = None
    maximum: float | None = None
    options: tuple[str, ...] = ()
    required: bool = True


@dataclass(frozen=True, slots=True)
class MethodSpec:
    """Something a device can be told to do; it is told by a message on `topic`."""

    name: str
    topic: str
    message_type: str = ""
    title: str = ""
    parameters: tuple[ParameterSpec, ...] = ()

    def parameter(self, name: str) -> ParameterSpec | None:
        """Return the parameter of that name, if the method has it."""
        return next((p for p in self.parameters if p.name == name), None)


@dataclass(frozen=True, slots=True)
class Description:
    """The canonical description of a device (see docs/protocol.md)."""

    id: str
    name: str
    kind: DeviceKind
    device_class: str
    pose: Pose
    size: Size
    description: str = ""
    image: str = ""
    site: str = ""
    done: bool = True
    simulated: bool = False
    gives: tuple[str, ...] = ()
    takes: tuple[str, ...] = ()
    capacity: int = 0
    radius_m: float = 0.0
    speed_m_s: float = 0.0
    properties: tuple[PropertySpec, ...] = ()
    methods: tuple[MethodSpec, ...] = ()

    def method(self, name: str) -> MethodSpec | None:
        """Return the method of that name, if the device has it."""
        return next((m for m in self.methods if m.name == name), None)

    def property(self, name: str) -> PropertySpec | None:
        """Return the property of that name, if the device has it."""
        return next((p for p in self.properties if p.name == name), None)


@dataclass(frozen=True, slots=True)
class DeviceState:
    """The last thing a device said of itself."""

    boot: int
    seq: int
    done: bool
    pose: Pose | None = None
    command: str = ""
    properties: Mapping[str, Scalar] = field(default_factory=dict)


_CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069\ud800-\udfff\ufffe\uffff]")
_IMAGE = re.compile(r"https?://[^\s<>\"{}|\\^`]+")
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]{0,63}")
_WORD = re.compile(r"[A-Za-z0-9_.-]{0,64}")
MOST_PROPERTIES = MOST_METHODS = 64
MOST_PARAMETERS = 16


def description_to_json(description: Description) -> dict[str, Any]:
    """Return the canonical description as plain JSON, the form that is kept, compared and exchanged."""
    return {
        **_fields(description),
        "pose": _fields(description.pose),
        "size": _fields(description.size),
        "gives": list(description.gives),
        "takes": list(description.takes),
        "properties": [{**_fields(p), "options": list(p.options)} for p in description.properties],
        "methods": [_method_to_json(method) for method in description.methods],
    }


def _method_to_json(method: MethodSpec) -> dict[str, Any]:
    parameters = [{**_fields(p), "options": list(p.options)} for p in method.parameters]
    return {**_fields(method), "parameters": parameters}


def _fields(record: Any) -> dict[str, Any]:
    """Return a record's own fields by name, in their order; dataclasses.asdict takes ten times as long."""
    return {name: getattr(record, name) for name in record.__slots__}


def description_from_json(body: Mapping[str, Any]) -> Description:
    """Return the description that description_to_json wrote; fields that are left out have their defaults."""
    fields = dict(body)
    fields["pose"], fields["size"] = Pose(**fields["pose"]), Size(**fields["size"])
    fields["gives"], fields["takes"] = tuple(fields.get("gives", ())), tuple(fields.get("takes", ()))
    fields["properties"] = tuple(PropertySpec(**_with_options(p)) for p in fields.get("properties", ()))
    fields["methods"] = tuple(_method_from_json(m) for m in fields.get("methods", ()))
    return Description(**fields)


def _with_options(body: Mapping[str, Any]) -> dict[str, Any]:
    return {**body, "options": tuple(body.get("options", ()))}


def _method_from_json(body: Mapping[str, Any]) -> MethodSpec:
    return MethodSpec(
        **{**body, "parameters": tuple(ParameterSpec(**_with_options(p)) for p in body.get("parameters", ()))}
    )


def find_faults(description: Description) -> tuple[str, ...]:
    """Return what is implausible in a description, one sentence each; nothing when it may be believed."""
    return (
        *_faults_of_numbers(description),
        *_faults_of_words(description),
        *_faults_of_properties(description),
        *(fault for method in description.methods for fault in _faults_of_method(description.id, method)),
    )


def _faults_of_numbers(d: Description) -> Iterator[str]:
    if not all(isfinite(v) and abs(v) <= 1e6 for v in (d.pose.x, d.pose.y, d.pose.z, d.pose.theta)):
        yield "Its location is not within a million metres."
    if not all(isfinite(v) and 0 < v <= 100 for v in (d.size.x, d.size.y, d.size.z)):
        yield "Its size must be three lengths between 0 and 100 metres."
    if not 0 <= d.capacity <= 1000:
        yield "Its capacity must lie between 0 and 1000 objects."
    if not (0 <= d.radius_m <= 10 and 0 <= d.speed_m_s <= 20):
        yield "Its radius must be at most 10 m and its speed at most 20 m/s."
    if d.kind == "robot" and not d.radius_m:
        yield "A robot must give its radius."


def _faults_of_words(d: Description) -> Iterator[str]:
    if not d.id or not _WORD.fullmatch(d.id):
        yield "Its id must be 1 to 64 letters, digits, '_', '.' or '-'."
    if not d.name.strip() or len(d.name) > 100 or len(d.description) > 1000 or len(d.image) > 500:
        yield "Its name must have 1 to 100 characters, its description at most 1000, its image's address at most 500."
    if "\n" in d.name or "\t" in d.name or any(_CONTROL.search(text) for text in (d.name, d.description, *_titles(d))):
        yield "Its name, description and titles must not hold control characters."
    if d.image and not _IMAGE.fullmatch(d.image):
        yield "Its image must be an address that begins with http:// or https://, or be left out."
    if not _WORD.fullmatch(d.device_class) or not _WORD.fullmatch(d.site):
        yield "Its class and site must be words of at most 64 letters, digits, '_', '.' or '-'."
    if len(d.gives) + len(d.takes) > 64 or not all(w and _WORD.fullmatch(w) for w in (*d.gives, *d.takes)):
        yield "What it gives and takes must be words, 64 at most."


def _titles(d: Description) -> Iterator[str]:
    yield from (spec.title for spec in d.properties)
    yield from (method.title for method in d.methods)


def _faults_of_properties(d: Description) -> Iterator[str]:
    if len(d.properties) > MOST_PROPERTIES or len(d.methods) > MOST_METHODS:
        yield f"It has more than {MOST_PROPERTIES} properties or {MOST_METHODS} methods."
    yield from _faults_of_names([p.name for p in d.properties], "property")
    yield from _faults_of_names([m.name for m in d.methods], "method")
    if twice := find_twice([m.topic for m in list_asked(d)]):
        yield f"Two of its methods name the topic {twice[:80]}; a device could not tell them apart."
    for spec in d.properties:
        yield from _faults_of_value(spec)
        if len(spec.title) > 100:
            yield f"Its property {spec.name[:64]!r} has a title of more than 100 characters."


def _faults_of_method(device_id: str, method: MethodSpec) -> Iterator[str]:
    if len(method.parameters) > MOST_PARAMETERS:
        yield f"Its method {method.name[:64]!r} has more than {MOST_PARAMETERS} parameters."
    if method.name == "credential":
        yield "It has a method called credential, by which VIPO tells a device its new key; give it another name."
    if fault := find_topic_fault(device_id, method.name, method.topic):
        yield f"Its method {method.name[:64]!r} {fault}."
    if len(method.title) > 100 or not _WORD.fullmatch(method.message_type):
        yield f"Its method {method.name[:64]!r} has a title or message type that is too long."
    yield from _faults_of_names([p.name for p in method.parameters], "parameter")
    for spec in method.parameters:
        yield from _faults_of_value(spec)


def _faults_of_names(names: list[str], what: str) -> Iterator[str]:
    for name in names:
        if not _NAME.fullmatch(name):
            yield f"The {what} name {name[:64]!r} must be letters, digits and '_', beginning with a letter."
    if len(set(names)) != len(names):
        yield f"It names a {what} twice."


def _faults_of_value(spec: PropertySpec | ParameterSpec) -> Iterator[str]:
    if spec.type not in get_args(ValueType):
        yield f"{spec.name[:64]!r} has the unknown type {spec.type[:64]!r}; use {', '.join(get_args(ValueType))}."
    if not _WORD.fullmatch(spec.unit):
        yield f"{spec.name[:64]!r} has a unit that is not a QUDT unit's short name, such as DEG_C."
    limits = [v for v in (spec.minimum, spec.maximum) if v is not None]
    if not all(isfinite(v) for v in limits) or limits != sorted(limits):
        yield f"{spec.name[:64]!r} has limits that are not numbers in order."
    if len(spec.options) > 64 or any(len(o) > 64 for o in spec.options):
        yield f"{spec.name[:64]!r} has more than 64 options, or one of more than 64 characters."
    if len(set(spec.options)) != len(spec.options) or any(not o or _CONTROL.search(o) for o in spec.options):
        yield f"{spec.name[:64]!r} has an option that is empty, comes twice, or holds control characters."

"""What a device says it is and can do: the canonical description that every form is turned into."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

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
        for method in self.methods:
            if method.name == name:
                return method
        return None

    def property(self, name: str) -> PropertySpec | None:
        """Return the property of that name, if the device has it."""
        for known in self.properties:
            if known.name == name:
                return known
        return None


@dataclass(frozen=True, slots=True)
class DeviceState:
    """The last thing a device said of itself."""

    boot: int
    seq: int
    done: bool
    pose: Pose | None = None
    command: str = ""
    properties: Mapping[str, Scalar] = field(default_factory=dict)


SLOWEST_M_S = 0.001
"""A speed is at least so much, or 0 where a device tells none: distances are divided by it."""
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
    """Return the description that description_to_json wrote; fields that are left out have their defaults.

    A speed below what is believed today, of a description that was taken in before, counts as none.
    """
    fields = dict(body)
    if fields.get("speed_m_s", 0.0) < SLOWEST_M_S:
        fields["speed_m_s"] = 0.0
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

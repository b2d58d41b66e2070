"""The paper's own message (its Figure 5), as text or JSON: what it says of a device, and how VIPO writes one."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from typing import Any, cast

from vipo_device.descriptions.forms import paper_key
from vipo_device.descriptions.json_fields import Fields, read_pose, read_size
from vipo_device.descriptions.paper_text import KEYS, SECTIONS
from vipo_device.protocol.description import (
    Description,
    DeviceKind,
    MethodSpec,
    ParameterSpec,
    PropertySpec,
    Size,
    ValueType,
)
from vipo_device.protocol.faults import Fault, note
from vipo_device.protocol.messages import down_topic
from vipo_device.protocol.units import device_unit

SIZES_M: Mapping[str, float] = {"small": 0.5, "medium": 1.0, "large": 2.0}
"""The paper calls sizes by name; a word stands for a cube of that many metres."""
MESSAGE_TYPES: Mapping[str, tuple[ParameterSpec, ...]] = {
    "time": (ParameterSpec("time", "number", "MIN"),),
    "object": (ParameterSpec("object", "object"), ParameterSpec("value", "number")),
    "location": (ParameterSpec("path", "location"),),
}
"""The arguments that a method of the paper's has by its message type, when it lists none."""
_SPELLINGS: Mapping[str, str] = {paper_key(key): key for key in KEYS}
_ROS_NAME = re.compile(r"/[A-Za-z0-9_ ]{1,100}")


def describe_message(
    body: Mapping[str, Any], places: Mapping[str, tuple[int, int]] | None = None, notes: tuple[Fault, ...] = ()
) -> tuple[Description, tuple[Fault, ...]]:
    """Return what a message says of a device, and what was mended or left out. Raises BadDescription."""
    told = list(notes)
    fields = Fields(_spelt(body, "", told), "", places or {})
    if not fields.text("id"):
        fields.refuse("id", "need_id")
    description = _description(fields, told)
    return description, tuple({each.text: each for each in told}.values())


def _spelt(value: Any, path: str, told: list[Fault]) -> Any:
    """Return the message with every key as it is spelt here; keys that mean nothing are left out, and told."""
    if isinstance(value, list):
        return [_spelt(item, f"{path}/{i}", told) for i, item in enumerate(value)]
    if not isinstance(value, dict):
        return value
    found: dict[str, Any] = {}
    for written, inner in value.items():
        key = _SPELLINGS.get(paper_key(written))
        if key is None:
            told.append(note("left_key", key=f"{path}/{written}"[:80]))
            continue
        if key != written:
            told.append(note("mended_key", written=written[:40], key=key))
        if key in found:
            Fields(value, path).refuse(written, "said_twice", meant=key)
        found[key] = _spelt(inner, f"{path}/{key}", told)
    return found


def _description(fields: Fields, told: list[Fault]) -> Description:
    kind = fields.text("kind") or "machine"
    if kind not in ("machine", "robot"):
        fields.refuse("kind", "need_kind")
    radius = fields.number("radius") or 0.0
    device_id = fields.text("id")
    return Description(
        id=device_id,
        name=fields.text("name") or device_id,
        kind=cast("DeviceKind", kind),
        device_class=fields.text("device_class"),
        pose=read_pose(fields, "location"),
        size=_size(fields, radius if kind == "robot" else 0.0),
        description=fields.text("description"),
        image=_image(fields, told),
        site=fields.text("site"),
        done=fields.truth("done", default=True),
        simulated=fields.truth("simulated", default=False),
        gives=tuple(sorted(set(fields.words("gives")))),
        takes=tuple(sorted(set(fields.words("takes")))),
        capacity=fields.whole("capacity"),
        radius_m=radius,
        speed_m_s=fields.number("speed") or 0.0,
        properties=tuple(_property(item, told) for item in fields.each("properties")),
        methods=tuple(_method(device_id, item, told) for item in fields.each("methods")),
    )


def _size(fields: Fields, radius: float) -> Size:
    if not isinstance(fields.body.get("size"), str):
        return read_size(fields, "size", radius)
    side = SIZES_M.get(fields.text("size").lower())
    if side is None:
        fields.refuse("size", "need_size_word")
    return Size(side, side, side)


def _image(fields: Fields, told: list[Fault]) -> str:
    image = fields.text("imgUrl")
    if image and re.match(r"[A-Za-z][A-Za-z0-9+.-]*:", image) is None:
        told.append(note("left_image", image=image[:80]))
        return ""
    return image


def _property(item: Fields, told: list[Fault]) -> PropertySpec:
    if item.has("value"):
        told.append(note("left_value", name=item.text("name")[:64]))
    return PropertySpec(**_value(item), title=item.text("title"))


def _value(item: Fields) -> dict[str, Any]:
    return {
        "name": item.text("name"),
        "type": item.text("type") or _type_of(item.body.get("value")),
        "unit": device_unit(item.text("unit")),
        "minimum": item.number("minimum"),
        "maximum": item.number("maximum"),
        "options": item.words("options"),
    }


def _type_of(value: object) -> ValueType:
    if isinstance(value, bool):
        return "boolean"
    return "text" if isinstance(value, str) else "number"


def _method(device_id: str, item: Fields, told: list[Fault]) -> MethodSpec:
    name, message_type = item.text("name"), item.text("vipo_msg_type")
    given = tuple(
        ParameterSpec(**_value(parameter), required=parameter.truth("required", default=True))
        for parameter in item.each("parameters")
    )
    return MethodSpec(
        name=name,
        topic=_topic(device_id, name, item.text("topic_name"), told),
        message_type=message_type,
        title=item.text("title"),
        parameters=given if "parameters" in item.body else MESSAGE_TYPES.get(message_type, ()),
    )


def _topic(device_id: str, method: str, said: str, told: list[Fault]) -> str:
    """Return the topic of a method; a name of ROS, which no MQTT client is told on, gives way to the device's own."""
    own = down_topic(device_id, method)
    if _ROS_NAME.fullmatch(said):
        told.append(note("own_topic", method=method[:64], topic=own, said=said))
        return own
    return said or own


def write_message(description: Description) -> str:
    """Return a description in the shape of the paper's Figure 5, with keys of our own for what that does not say."""
    return "\n".join(_lines(message_of(description))) + "\n"


def message_of(description: Description) -> dict[str, Any]:
    """Return what any form of keys and values says of a description; `describe_message` makes the description of it."""
    d = description
    said: dict[str, Any] = {
        "id": d.id,
        "name": d.name,
        "description": d.description,
        "kind": d.kind,
        "device_class": d.device_class,
        "site": d.site,
        "location": [d.pose.x, d.pose.y, d.pose.z, d.pose.theta],
        "size": [d.size.x, d.size.y, d.size.z],
        "imgUrl": d.image,
        "done": d.done,
        "simulated": d.simulated,
        "gives": list(d.gives),
        "takes": list(d.takes),
        "capacity": d.capacity,
        "radius": d.radius_m,
        "speed": d.speed_m_s,
    }
    return {
        **{key: value for key, value in said.items() if _is_said(key, value)},
        "properties": [_said_of_property(spec) for spec in d.properties],
        "methods": [_said_of_method(method) for method in d.methods],
    }


def _is_said(key: str, value: object) -> bool:
    return key in ("id", "name", "kind", "location", "size", "done") or value not in ("", [], 0, None)


def _said_of_property(spec: PropertySpec) -> dict[str, Any]:
    return _said_of_value(spec) | ({"title": spec.title} if spec.title else {})


def _said_of_value(spec: PropertySpec | ParameterSpec) -> dict[str, Any]:
    texts = {"unit": spec.unit, "options": list(spec.options)}
    limits = {"minimum": spec.minimum, "maximum": spec.maximum}
    return {
        "name": spec.name,
        "type": spec.type,
        **{key: value for key, value in texts.items() if value},
        **{key: limit for key, limit in limits.items() if limit is not None},
    }


def _said_of_method(method: MethodSpec) -> dict[str, Any]:
    return {
        "name": method.name,
        "vipo_msg_type": method.message_type,
        "topic_name": method.topic,
        **({"title": method.title} if method.title else {}),
        "parameters": [_said_of_parameter(spec) for spec in method.parameters],
    }


def _said_of_parameter(spec: ParameterSpec) -> dict[str, Any]:
    return _said_of_value(spec) | ({} if spec.required else {"required": False})


def _lines(said: Mapping[str, Any]) -> Iterator[str]:
    """Yield the lines of a message: what a list of objects says stands under its key, set in."""
    for key, value in said.items():
        if value and key in SECTIONS:
            yield f"{key}:"
            yield from (f"  {line}" for item in value for line in _lines(item))
        else:
            text = str(value) if isinstance(value, bool) else json.dumps(value, ensure_ascii=False, allow_nan=False)
            yield f"{key}: {text}"

"""MTConnect 1.2 documents of a site: its devices, how they are, what they said, and what was asked wrongly."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Literal
from xml.etree import ElementTree

from registry.devices.samples import DONE, ONLINE
from registry.devices.views import DeviceView
from registry.mtconnect import data_items as items
from registry.mtconnect.data_items import DataItem
from registry.mtconnect.xpath import Node
from vipo_device.protocol.description import Scalar

VERSION = "1.2"
BUFFER_SIZE = 131_072
ErrorCode = Literal["NO_DEVICE", "OUT_OF_RANGE", "INVALID_REQUEST", "INVALID_PATH", "TOO_MANY"]
Element = ElementTree.Element


@dataclass(frozen=True, slots=True)
class Agent:
    """Who answers: `instance` is another one whenever sequence numbers begin anew; `at` is now."""

    site: str
    instance: int
    at: datetime


@dataclass(frozen=True, slots=True)
class Sequences:
    """Which observations can be asked for, and where to go on."""

    first: int
    last: int
    next: int


@dataclass(frozen=True, slots=True)
class Observation:
    """A value of a device's property, or of `$done` and `$online`, as JSON; `at_ms` since 1970."""

    device: str
    property: str
    value: str
    at_ms: int
    sequence: int


@dataclass(frozen=True, slots=True)
class Situation:
    """Devices as they are or were; `latest` gives the numbers of their readings, `placed` says whether robots' places
    are known.
    """

    devices: Sequence[DeviceView]
    latest: Iterable[Observation]
    placed: bool = True


def write_devices(agent: Agent, devices: Sequence[DeviceView]) -> bytes:
    """Return the document MTConnectDevices: which devices there are and what they tell."""
    root, header = _document("MTConnectDevices", agent)
    header.set("assetBufferSize", "1")
    header.set("assetCount", "0")
    listed = ElementTree.SubElement(root, "Devices")
    for view in devices:
        _add_device(listed, agent, view)
    return _text(root)


def _document(name: str, agent: Agent) -> tuple[Element, Element]:
    root = Element(name, {"xmlns": f"urn:mtconnect.org:{name}:{VERSION}"})
    said = {
        "version": VERSION,
        "creationTime": _moment(agent.at),
        "instanceId": str(agent.instance),
        "sender": "vipo",
        "bufferSize": str(BUFFER_SIZE),
    }
    return root, ElementTree.SubElement(root, "Header", said)


def _moment(at: datetime) -> str:
    return at.astimezone(UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")


def _text(root: Element) -> bytes:
    ElementTree.indent(root)
    text: bytes = ElementTree.tostring(root, encoding="utf-8", xml_declaration=True)
    return text


def _add_device(listed: Element, agent: Agent, view: DeviceView) -> None:
    told = {"id": items.component_id(view.id), "name": view.id, "uuid": uuid_of(view.id)}
    device = ElementTree.SubElement(listed, "Device", told)
    about = ElementTree.SubElement(device, "Description", {"station": agent.site})
    about.text = items.sayable(". ".join(filter(None, (view.name, view.canonical.description))))
    data_items = ElementTree.SubElement(device, "DataItems")
    for item in items.items_of(view):
        ElementTree.SubElement(data_items, "DataItem", item.attributes)


def document_of(devices: Iterable[DeviceView]) -> Node:
    """Return what a `path` is held against: the elements of MTConnectDevices, their names without a prefix."""
    listed = tuple(
        Node(
            "Device",
            {"id": items.component_id(view.id), "name": view.id, "uuid": uuid_of(view.id)},
            (Node("DataItems", {}, tuple(Node("DataItem", item.attributes) for item in items.items_of(view))),),
        )
        for view in devices
    )
    return Node("", {}, (Node("MTConnectDevices", {}, (Node("Devices", {}, listed),)),))


def uuid_of(device_id: str) -> str:
    """Return a device's name that no other has, anywhere."""
    return f"urn:vipo:device:{device_id}"


def write_current(agent: Agent, sequences: Sequences, situation: Situation, wanted: Collection[str]) -> bytes:
    """Return the document MTConnectStreams of how devices are.

    Of the items only those are told whose ids are `wanted`, and of a device of which none is, nothing.
    """
    root, streams = _streams(agent, sequences)
    numbers = {(o.device, o.property): (o.sequence, o.at_ms) for o in situation.latest}
    for view in situation.devices:
        unknown = (sequences.first, int((view.last_seen_at or agent.at).timestamp() * 1000))
        told = [item for item in items.items_of(view) if item.id in wanted]
        stream = _Stream(streams, view.id) if told else None
        for item in told:
            assert stream is not None
            sequence, at_ms = numbers.get((view.id, item.source), unknown)
            stream.add(item, *_state(view, item, placed=situation.placed), at_ms, sequence)
    return _text(root)


def _state(view: DeviceView, item: DataItem, *, placed: bool) -> tuple[str, str | None]:
    """Return what an item is called in a stream, and its text."""
    if item.category == "CONDITION":
        return items.say_condition(item, view.readings.get(item.source), online=view.online)
    if not item.source and not placed:
        return items.element_name(item), items.UNAVAILABLE
    return items.element_name(item), _text_of(view, item)


def _text_of(view: DeviceView, item: DataItem) -> str:
    if item.source == ONLINE:
        return items.say_availability(online=view.online)
    if item.source == DONE:
        return items.say_execution(online=view.online, done=view.done, failed=bool(view.readings.get("error")))
    if not view.online:
        return items.UNAVAILABLE
    return items.say_value(item, view.readings.get(item.source)) if item.source else items.say_position(view.pose)


def write_samples(
    agent: Agent,
    sequences: Sequences,
    devices: Sequence[DeviceView],
    observations: Iterable[Observation],
    wanted: Collection[str],
) -> bytes:
    """Return the document MTConnectStreams of what devices have said, in the order of its numbers."""
    root, streams = _streams(agent, sequences)
    chosen = {view.id: [item for item in items.items_of(view) if item.id in wanted] for view in devices}
    known = {device: _Stream(streams, device) for device, told in chosen.items() if told}
    own = {(device, item.source): item for device, told in chosen.items() for item in told if item.source}
    for seen in observations:
        item = own.get((seen.device, seen.property))
        if item is not None:
            known[seen.device].add(item, *_observed(item, json.loads(seen.value)), seen.at_ms, seen.sequence)
    return _text(root)


def _observed(item: DataItem, value: Scalar) -> tuple[str, str | None]:
    if item.category == "CONDITION":
        return items.say_condition(item, value, online=True)
    if item.source == ONLINE:
        return items.element_name(item), items.say_availability(online=bool(value))
    if item.source == DONE:
        return items.element_name(item), items.say_execution(online=True, done=bool(value))
    return items.element_name(item), items.say_value(item, value)


def _streams(agent: Agent, sequences: Sequences) -> tuple[Element, Element]:
    root, header = _document("MTConnectStreams", agent)
    header.set("firstSequence", str(sequences.first))
    header.set("lastSequence", str(sequences.last))
    header.set("nextSequence", str(sequences.next))
    return root, ElementTree.SubElement(root, "Streams")


class _Stream:
    """A device's part of a document; what it holds is put in where the schema wants it."""

    def __init__(self, streams: Element, device_id: str) -> None:
        self._stream = ElementTree.SubElement(streams, "DeviceStream", {"name": device_id, "uuid": uuid_of(device_id)})
        self._device_id = device_id
        self._parts: dict[str, Element] = {}

    def _part(self, name: str) -> Element:
        """Return `Samples`, `Events` or `Condition`, in this order."""
        if name not in self._parts:
            component = self._component()
            order = tuple(_PARTS.values())
            before = sum(1 for other in order[: order.index(name)] if other in self._parts)
            self._parts[name] = Element(name)
            component.insert(before, self._parts[name])
        return self._parts[name]

    def _component(self) -> Element:
        component = self._stream.find("ComponentStream")
        if component is not None:
            return component
        told = {"componentId": items.component_id(self._device_id), "name": self._device_id, "component": "Device"}
        return ElementTree.SubElement(self._stream, "ComponentStream", told)

    def add(self, item: DataItem, name: str, text: str | None, at_ms: int, sequence: int) -> None:
        """Add an observation, called `name`."""
        told = ElementTree.SubElement(self._part(_PARTS[item.category]), name, _facts(item, at_ms, sequence))
        told.text = text


_PARTS: dict[items.Category, str] = {"SAMPLE": "Samples", "EVENT": "Events", "CONDITION": "Condition"}


def _facts(item: DataItem, at_ms: int, sequence: int) -> dict[str, str]:
    at = _moment(datetime.fromtimestamp(at_ms / 1000, UTC))
    named = {"name": item.name} if item.name else {}
    kind = {"type": item.type} if item.category == "CONDITION" else {}
    return {"dataItemId": item.id, **named, **kind, "timestamp": at, "sequence": str(sequence)}


def write_error(agent: Agent, code: ErrorCode, sentence: str) -> bytes:
    """Return the document MTConnectError."""
    root, _ = _document("MTConnectError", agent)
    errors = ElementTree.SubElement(root, "Errors")
    ElementTree.SubElement(errors, "Error", {"errorCode": code}).text = items.sayable(sentence)
    return _text(root)

"""MTConnect 1.2 documents of a site: its devices, how they are, what they said, and what was asked wrongly."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Literal
from xml.etree import ElementTree

from registry import mtconnect_items as items
from registry.mtconnect_items import DataItem
from registry.samples import DONE, ONLINE
from registry.views import DeviceView

VERSION = "1.2"
BUFFER_SIZE = 131_072
ErrorCode = Literal["NO_DEVICE", "OUT_OF_RANGE", "INVALID_REQUEST", "UNSUPPORTED"]
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
    told = {"id": items.component_id(view.id), "name": view.id, "uuid": _uuid(view.id)}
    device = ElementTree.SubElement(listed, "Device", told)
    about = ElementTree.SubElement(device, "Description", {"station": agent.site})
    about.text = items.sayable(". ".join(filter(None, (view.name, view.canonical.description))))
    data_items = ElementTree.SubElement(device, "DataItems")
    for item in items.items_of(view):
        said = {"id": item.id, "category": item.category, "type": item.type}
        named = {"name": item.name} if item.name else {}
        units = {"units": item.measure.units} if item.measure else {}
        ElementTree.SubElement(data_items, "DataItem", {**named, **said, **units})


def _uuid(device_id: str) -> str:
    return f"urn:vipo:device:{device_id}"


def write_current(
    agent: Agent, sequences: Sequences, devices: Sequence[DeviceView], latest: Iterable[Observation]
) -> bytes:
    """Return the document MTConnectStreams of how devices are; `latest` gives the numbers of their readings."""
    root, streams = _streams(agent, sequences)
    numbers = {(o.device, o.property): (o.sequence, o.at_ms) for o in latest}
    for view in devices:
        seen_ms = int(view.last_seen_at.timestamp() * 1000) if view.last_seen_at else int(agent.at.timestamp() * 1000)
        stream = _Stream(streams, view.id)
        for name, item, text in _states(view):
            sequence, at_ms = numbers.get((view.id, name), (sequences.first, seen_ms))
            stream.add(item, text, at_ms, sequence)
        stream.add_condition(view, seen_ms, sequences.first)
    return _text(root)


def _states(view: DeviceView) -> Iterable[tuple[str, DataItem, str]]:
    yield ONLINE, items.availability_of(view.id), items.say_availability(online=view.online)
    failed = bool(view.readings.get("error"))
    text = items.say_execution(online=view.online, done=view.done, failed=failed)
    yield DONE, items.execution_of(view.id), text
    if view.kind == "robot":
        yield "", items.position_of(view.id), items.say_position(view.pose) if view.online else items.UNAVAILABLE
    for spec in view.canonical.properties:
        item = items.item_of(view.id, spec)
        yield spec.name, item, items.say_value(item, view.readings.get(spec.name)) if view.online else items.UNAVAILABLE


def write_samples(
    agent: Agent, sequences: Sequences, devices: Sequence[DeviceView], observations: Iterable[Observation]
) -> bytes:
    """Return the document MTConnectStreams of what devices have said, in the order of its numbers."""
    root, streams = _streams(agent, sequences)
    known = {view.id: _Stream(streams, view.id) for view in devices}
    own = {(view.id, spec.name): items.item_of(view.id, spec) for view in devices for spec in view.canonical.properties}
    for seen in observations:
        item, text = _observed(seen, own)
        if item is not None and seen.device in known:
            known[seen.device].add(item, text, seen.at_ms, seen.sequence)
    return _text(root)


def _observed(seen: Observation, own: dict[tuple[str, str], DataItem]) -> tuple[DataItem | None, str]:
    value = json.loads(seen.value)
    if seen.property == ONLINE:
        return items.availability_of(seen.device), items.say_availability(online=bool(value))
    if seen.property == DONE:
        return items.execution_of(seen.device), items.say_execution(online=True, done=bool(value))
    item = own.get((seen.device, seen.property))
    return item, items.say_value(item, value) if item else ""


def _streams(agent: Agent, sequences: Sequences) -> tuple[Element, Element]:
    root, header = _document("MTConnectStreams", agent)
    header.set("firstSequence", str(sequences.first))
    header.set("lastSequence", str(sequences.last))
    header.set("nextSequence", str(sequences.next))
    return root, ElementTree.SubElement(root, "Streams")


class _Stream:
    """A device's part of a document; what it holds is put in where the schema wants it."""

    def __init__(self, streams: Element, device_id: str) -> None:
        self._stream = ElementTree.SubElement(streams, "DeviceStream", {"name": device_id, "uuid": _uuid(device_id)})
        self._device_id = device_id
        self._parts: dict[str, Element] = {}

    def _part(self, name: str) -> Element:
        """Return `Samples`, `Events` or `Condition`, in this order."""
        component = self._stream.find("ComponentStream")
        if component is None:
            told = {"componentId": items.component_id(self._device_id), "name": self._device_id, "component": "Device"}
            component = ElementTree.SubElement(self._stream, "ComponentStream", told)
        if name not in self._parts:
            order = ("Samples", "Events", "Condition")
            before = sum(1 for other in order[: order.index(name)] if other in self._parts)
            self._parts[name] = Element(name)
            component.insert(before, self._parts[name])
        return self._parts[name]

    def add(self, item: DataItem, text: str, at_ms: int, sequence: int) -> None:
        """Add an observation."""
        part = self._part("Samples" if item.category == "SAMPLE" else "Events")
        ElementTree.SubElement(part, items.element_name(item), _facts(item, at_ms, sequence)).text = text

    def add_condition(self, view: DeviceView, at_ms: int, sequence: int) -> None:
        """Add whether the device reports an error or a warning."""
        item = items.condition_of(view.id)
        error, warning = view.readings.get("error"), view.readings.get("warning")
        name = "Fault" if error else "Warning" if warning else "Normal"
        said = {**_facts(item, at_ms, sequence), "type": item.type}
        told = ElementTree.SubElement(self._part("Condition"), name if view.online else "Unavailable", said)
        told.text = items.sayable(str(error or warning)) if view.online and (error or warning) else None


def _facts(item: DataItem, at_ms: int, sequence: int) -> dict[str, str]:
    at = _moment(datetime.fromtimestamp(at_ms / 1000, UTC))
    named = {"name": item.name} if item.name else {}
    return {"dataItemId": item.id, **named, "timestamp": at, "sequence": str(sequence)}


def write_error(agent: Agent, code: ErrorCode, sentence: str) -> bytes:
    """Return the document MTConnectError."""
    root, _ = _document("MTConnectError", agent)
    errors = ElementTree.SubElement(root, "Errors")
    ElementTree.SubElement(errors, "Error", {"errorCode": code}).text = items.sayable(sentence)
    return _text(root)

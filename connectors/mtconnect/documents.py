"""MTConnect documents, read with suspicion: UTF-8, no document type and so no entities, and bounded in every way."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from typing import Any

from lxml import etree

MOST_BYTES = 8_000_000
MOST_ELEMENTS = 250_000
MOST_MACHINES = 100
MOST_ITEMS = 2_000
MOST_TEXT = 256
CATEGORIES = ("SAMPLE", "EVENT", "CONDITION")
_ROOT = re.compile(r"\{urn:mtconnect\.org:MTConnect(?:Devices|Streams|Error):(\d{1,3}\.\d{1,3})\}(\w+)")
_UNCLEAN = re.compile(r"[\x00-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069\ufffe\uffff]+")


class BadDocument(Exception):
    """What an agent sent is no MTConnect document; the sentence says why."""


@dataclass(frozen=True, slots=True)
class Header:
    """Which life of which agent speaks, where its observations begin and go on, how many it keeps; 0 where not said."""

    instance: int
    first: int = 0
    last: int = 0
    next: int = 0
    size: int = 0


@dataclass(frozen=True, slots=True)
class Item:
    """One thing that a machine tells; `part` is the component that it belongs to."""

    id: str
    category: str
    type: str
    subtype: str = ""
    name: str = ""
    units: str = ""
    part: str = ""
    representation: str = "VALUE"


@dataclass(frozen=True, slots=True)
class Machine:
    """A device of an agent."""

    uuid: str
    name: str
    about: str
    items: tuple[Item, ...]


@dataclass(frozen=True, slots=True)
class Observation:
    """What a machine said of an item; of a condition `name` is the level, and `code` keeps several apart."""

    machine: str
    item: str
    name: str
    text: str
    code: str = ""


@dataclass(frozen=True, slots=True)
class Devices:
    """MTConnectDevices."""

    header: Header
    machines: tuple[Machine, ...]


@dataclass(frozen=True, slots=True)
class Streams:
    """MTConnectStreams, its observations in their order."""

    header: Header
    observations: tuple[Observation, ...]


@dataclass(frozen=True, slots=True)
class Refusal:
    """MTConnectError."""

    header: Header
    codes: tuple[str, ...]
    sentence: str


Document = Devices | Streams | Refusal


def read_document(data: bytes) -> Document:
    """Read a document of any version. Raises BadDocument."""
    root = _parse(data)
    found = _ROOT.fullmatch(root.tag)
    header = next(iter(root.findall("{*}Header")), None)
    if found is None or header is None:
        raise BadDocument(f"The document is none of MTConnect's: it begins with {str(root.tag)[:80]}.")
    match found[2]:
        case "MTConnectDevices":
            return Devices(_header(header), tuple(_machines(root)))
        case "MTConnectStreams":
            return Streams(_header(header), tuple(_observations(root)))
        case "MTConnectError":
            errors = [error for error in root.iter() if error.get("errorCode")]
            sentence = "; ".join(_clean("".join(error.itertext())) for error in errors)
            return Refusal(_header(header), tuple(error.get("errorCode") for error in errors), sentence[:MOST_TEXT])
    raise BadDocument(f"The document {found[2][:40]} is not known.")


def _parse(data: bytes) -> Any:
    if len(data) > MOST_BYTES or data.count(b"<") > 2 * MOST_ELEMENTS:
        raise BadDocument(
            f"The document has {len(data)} bytes; {MOST_BYTES} and {MOST_ELEMENTS} elements are the most."
        )
    # As it is always read as UTF-8, a document type can hide behind no other encoding.
    if b"<!DOCTYPE" in data or b"<!ENTITY" in data:
        raise BadDocument("The document has a document type, which may hold entities; it is not read.")
    parser = etree.XMLParser(
        encoding="utf-8",
        resolve_entities=False,
        no_network=True,
        load_dtd=False,
        huge_tree=False,
        remove_comments=True,
        remove_pis=True,
    )
    try:
        return etree.fromstring(data, parser)
    except etree.XMLSyntaxError as error:
        raise BadDocument(f"The document is not XML: {error.msg}"[:MOST_TEXT]) from error


def _header(element: Any) -> Header:
    names = ("instanceId", "firstSequence", "lastSequence", "nextSequence", "bufferSize")
    return Header(*(_whole(element.get(name) or "0") for name in names))


def _whole(text: str) -> int:
    if not text.isascii() or not text.isdigit() or len(text) > 20:
        raise BadDocument(f"The header holds {text[:30]!r} where a whole number belongs.")
    return int(text)


def _machines(root: Any) -> Iterator[Machine]:
    devices = root.findall("{*}Devices/{*}Device")
    if len(devices) > MOST_MACHINES:
        raise BadDocument(f"The agent has {len(devices)} machines; {MOST_MACHINES} are the most.")
    for device in devices:
        uuid, name = (_clean(device.get(key) or "") for key in ("uuid", "name"))
        if not uuid and not name:
            raise BadDocument("A machine has neither uuid nor name.")
        items = tuple(_item(item, device) for item in islice(device.iter("{*}DataItem"), MOST_ITEMS))
        yield Machine(uuid or name, name or uuid, _about(device), tuple(item for item in items if item.id))


def _about(device: Any) -> str:
    about = device.find("{*}Description")
    if about is None:
        return ""
    words = [about.get("manufacturer"), about.get("model"), "".join(about.itertext())]
    return " ".join(filter(None, (_clean(word or "") for word in words)))[:MOST_TEXT]


def _item(element: Any, device: Any) -> Item:
    listed = element.getparent()
    owner = listed.getparent() if listed is not device else device
    part = "" if owner is device else _clean(owner.get("name") or etree.QName(owner).localname)
    texts = {key: _clean(element.get(key) or "") for key in ("id", "category", "type", "name", "units")}
    kind = element.get("representation") or "VALUE"
    return Item(**texts, subtype=_clean(element.get("subType") or ""), part=part, representation=kind)


def _observations(root: Any) -> Iterator[Observation]:
    for device in root.findall("{*}Streams/{*}DeviceStream"):
        machine = _clean(device.get("uuid") or device.get("name") or "")
        for part in device.iterfind("{*}ComponentStream/*"):
            for said in part:
                code = said.get("conditionId") or said.get("nativeCode") or ""
                text = "" if len(said) else _clean(said.text or "")
                yield Observation(
                    machine, said.get("dataItemId") or "", etree.QName(said).localname, text, _clean(code)
                )


def _clean(text: str) -> str:
    """Return a text on one line, without control characters, and not too long."""
    return _UNCLEAN.sub(" ", text[: 4 * MOST_TEXT]).strip()[:MOST_TEXT]

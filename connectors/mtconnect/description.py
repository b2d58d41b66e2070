"""A machine of an agent as a VIPO device: which of its items become which properties, in which units; pure."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from connectors.mtconnect.documents import BadDocument, Item, Machine
from vipo_device.descriptions.plausibility import find_faults
from vipo_device.descriptions.reader import write_description
from vipo_device.protocol.description import MOST_PROPERTIES, Description, Pose, PropertySpec, Size
from vipo_device.protocol.messages import MAX_BYTES, fit_device_id

EXECUTION, ERROR, WARNING = "execution", "error", "warning"
OF_ALL = (
    PropertySpec(EXECUTION, "text", title="Execution"),
    PropertySpec(ERROR, "text", title="Faults"),
    PropertySpec(WARNING, "text", title="Warnings"),
)
SAID_OTHERWISE = frozenset({"AVAILABILITY", "EXECUTION", "EMERGENCY_STOP", "ASSET_CHANGED", "ASSET_REMOVED"})
NUMBERS = frozenset({"LINE", "LINE_NUMBER", "PART_COUNT", "TOOL_NUMBER"})
"""Events that are numbers, though they have no unit."""
_UNFIT_NAME = re.compile(r"[^A-Za-z0-9_]+")


@dataclass(frozen=True, slots=True)
class Measure:
    """A unit of QUDT (empty: none), and the factor to it; `axes` is 3 for a number in each direction."""

    unit: str
    factor: float = 1.0
    axes: int = 1


MEASURES: Mapping[str, Measure] = {
    "AMPERE": Measure("A"),
    "CELSIUS": Measure("DEG_C"),
    "COUNT": Measure(""),
    "CUBIC_METER": Measure("M3"),
    "CUBIC_MILLIMETER": Measure("MilliL", 0.001),
    "DECIBEL": Measure("DEC_B"),
    "DEGREE": Measure("DEG"),
    "DEGREE_3D": Measure("DEG", axes=3),
    "DEGREE/SECOND": Measure("DEG-PER-SEC"),
    "GRAM": Measure("GM"),
    "HERTZ": Measure("HZ"),
    "HOUR": Measure("HR"),
    "JOULE": Measure("J"),
    "KILOGRAM": Measure("KiloGM"),
    "LITER": Measure("L"),
    "METER": Measure("M"),
    "MILLIGRAM": Measure("MilliGM"),
    "MILLILITER": Measure("MilliL"),
    "MILLIMETER": Measure("M", 0.001),
    "MILLIMETER_3D": Measure("M", 0.001, 3),
    "MILLIMETER/SECOND": Measure("M-PER-SEC", 0.001),
    "MILLIMETER/SECOND^2": Measure("M-PER-SEC2", 0.001),
    "MINUTE": Measure("MIN"),
    "NEWTON": Measure("N"),
    "NEWTON_METER": Measure("N-M"),
    "OHM": Measure("OHM"),
    "PASCAL": Measure("PA"),
    "PERCENT": Measure("PERCENT"),
    "REVOLUTION/MINUTE": Measure("REV-PER-MIN"),
    "REVOLUTION/SECOND": Measure("REV-PER-MIN", 60.0),
    "SECOND": Measure("SEC"),
    "VOLT": Measure("V"),
    "WATT": Measure("W"),
    "WATT_SECOND": Measure("J"),
}
AXES = ("x", "y", "z")


@dataclass(frozen=True, slots=True)
class Stand:
    """Where a machine stands on the site's map and how large it is, which no agent tells."""

    pose: Pose
    size: Size


@dataclass(frozen=True, slots=True)
class Reading:
    """A property that is a value of an item: which number of it, and what to multiply with; a text has no measure."""

    item: str
    property: str
    measure: Measure | None
    axis: int = 0


@dataclass(frozen=True, slots=True)
class DescribedMachine:
    """A machine as it describes itself, and what of its items that is made of; `left_out` counts those without room."""

    description: Description
    turtle: bytes
    readings: tuple[Reading, ...]
    executions: frozenset[str]
    availabilities: frozenset[str]
    stops: frozenset[str]
    conditions: frozenset[str]
    left_out: int


def device_id(uuid: str) -> str:
    """Return the id of a machine's device, before a site puts its own name before it.

    A hash keeps those apart that would look the same without it.
    """
    return fit_device_id(uuid, uuid)


def describe_machine(machine: Machine, site: str, stand: Stand, device: str) -> DescribedMachine:
    """Return how a machine shows itself, as this device: numbers first, as many as a description holds.

    Raises BadDocument.
    """
    found = list(_readings(machine.items))
    shown = found[: MOST_PROPERTIES - len(OF_ALL)]
    while True:
        description = _describe(machine, site, stand, device, shown)
        turtle = write_description(description).encode()
        if len(turtle) <= MAX_BYTES - 256 or not shown:
            break
        shown = shown[: len(shown) * 9 // 10]
    if faults := find_faults(description):
        raise BadDocument(f"{machine.name[:60]} cannot be described: {faults[0].text}")
    return DescribedMachine(
        description,
        turtle,
        tuple(reading for reading, _ in shown),
        _of_type(machine, "EXECUTION"),
        _availabilities(machine),
        _of_type(machine, "EMERGENCY_STOP"),
        frozenset(item.id for item in machine.items if item.category == "CONDITION"),
        len(found) - len(shown),
    )


def _of_type(machine: Machine, kind: str) -> frozenset[str]:
    return frozenset(item.id for item in machine.items if item.type == kind)


def _availabilities(machine: Machine) -> frozenset[str]:
    """Return what tells whether the machine is there: its own items, before those of its components."""
    own = frozenset(item.id for item in machine.items if item.type == "AVAILABILITY" and not item.part)
    return own or _of_type(machine, "AVAILABILITY")


def _describe(
    machine: Machine, site: str, stand: Stand, device: str, shown: Iterable[tuple[Reading, PropertySpec]]
) -> Description:
    return Description(
        id=device,
        name=machine.name[:100],
        kind="machine",
        device_class="mtconnect",
        pose=stand.pose,
        size=stand.size,
        description=f"{machine.about}. Read over MTConnect" if machine.about else "Read over MTConnect",
        site=site,
        properties=(*OF_ALL, *(spec for _, spec in shown)),
    )


def _readings(items: Iterable[Item]) -> Iterator[tuple[Reading, PropertySpec]]:
    """Give the properties of a machine's items: samples, then events; lists, tables and waveforms are left out."""
    plain = [i for i in items if i.representation in {"VALUE", "DISCRETE"} and i.type not in SAID_OTHERWISE]
    taken = {spec.name for spec in OF_ALL}
    for category in ("SAMPLE", "EVENT"):
        for item in plain:
            if item.category == category:
                yield from _of_item(item, taken)


def _of_item(item: Item, taken: set[str]) -> Iterator[tuple[Reading, PropertySpec]]:
    title = _title(item)
    if item.category == "EVENT" and not item.units and item.type not in NUMBERS:
        name = _free_name(item, "", taken)
        yield Reading(item.id, name, None), PropertySpec(name, "text", title=title)
        return
    measure = measure_of(item.units)
    if item.units and item.units not in MEASURES:
        title = f"{title[:60]} ({item.units[:30]})"
    for axis in range(measure.axes):
        suffix = f"_{AXES[axis]}" if measure.axes > 1 else ""
        name = _free_name(item, suffix, taken)
        spec = PropertySpec(name, "number", measure.unit, title=f"{title} {suffix[1:]}".strip())
        yield Reading(item.id, name, measure, axis), spec


def _free_name(item: Item, suffix: str, taken: set[str]) -> str:
    """Return a property's name that no other has: the item's own, or with its id, which no other item has."""
    for wished in (item.name or item.id, f"{item.name}_{item.id}"):
        name = _fit_name(wished)[: 64 - len(suffix)] + suffix
        if name not in taken:
            break
    else:
        name = f"i_{hashlib.sha256(item.id.encode()).hexdigest()[:16]}{suffix}"
    taken.add(name)
    return name


def _fit_name(text: str) -> str:
    fit = _UNFIT_NAME.sub("_", text)
    return fit if fit[:1].isalpha() or fit[:1] == "_" else f"i_{fit}"


def _title(item: Item) -> str:
    """Return an item's title: its component, its type and subtype in words."""
    kind = item.type.rpartition(":")[2].replace("_", " ").lower()
    words = (item.part[:30], kind, item.subtype.rpartition(":")[2].replace("_", " ").lower())
    text = " ".join(filter(None, words))
    return (text[:1].upper() + text[1:])[:80]


def measure_of(units: str) -> Measure:
    """Return what to make of a unit; one that is not known goes over as a number without a unit."""
    return MEASURES.get(units) or Measure("", axes=3 if units.endswith("_3D") else 1)

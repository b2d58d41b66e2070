"""What of a device MTConnect shows as data items, and how values are said there; pure."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from math import degrees, isfinite
from typing import Literal

from registry.devices.samples import DONE, ONLINE
from registry.devices.views import DeviceView
from vipo_device.protocol.description import Pose, PropertySpec, Scalar

Category = Literal["SAMPLE", "EVENT", "CONDITION"]
UNAVAILABLE = "UNAVAILABLE"
LEVELS: Mapping[str, str] = {"error": "Fault", "warning": "Warning"}
"""The readings that are conditions, and what a condition is called while there is such a reading."""
_UNSAYABLE = re.compile("[^\\t\\n\\r\\x20-\\ud7ff\\ue000-\\ufffd\\U00010000-\\U0010ffff]")


@dataclass(frozen=True, slots=True)
class Measure:
    """How a reading in a QUDT unit is said in MTConnect: its type, MTConnect's unit, what to multiply with and add."""

    type: str
    units: str
    factor: float = 1.0
    offset: float = 0.0


MEASURES: Mapping[str, Measure] = {
    "DEG_C": Measure("TEMPERATURE", "CELSIUS"),
    "DEG_F": Measure("TEMPERATURE", "CELSIUS", 5 / 9, -160 / 9),
    "K": Measure("TEMPERATURE", "CELSIUS", offset=-273.15),
    "PERCENT": Measure("LOAD", "PERCENT"),
    "M": Measure("DISPLACEMENT", "MILLIMETER", 1000.0),
    "CentiM": Measure("DISPLACEMENT", "MILLIMETER", 10.0),
    "MilliM": Measure("DISPLACEMENT", "MILLIMETER"),
    "M-PER-SEC": Measure("VELOCITY", "MILLIMETER/SECOND", 1000.0),
    "DEG": Measure("ANGLE", "DEGREE"),
    "RAD": Measure("ANGLE", "DEGREE", degrees(1.0)),
    "SEC": Measure("ACCUMULATED_TIME", "SECOND"),
    "MIN": Measure("ACCUMULATED_TIME", "SECOND", 60.0),
    "HR": Measure("ACCUMULATED_TIME", "SECOND", 3600.0),
    "PA": Measure("PRESSURE", "PASCAL"),
    "BAR": Measure("PRESSURE", "PASCAL", 100_000.0),
    "V": Measure("VOLTAGE", "VOLT"),
    "A": Measure("AMPERAGE", "AMPERE"),
    "W": Measure("WATTAGE", "WATT"),
    "HZ": Measure("FREQUENCY", "HERTZ"),
    "REV-PER-MIN": Measure("ROTARY_VELOCITY", "REVOLUTION/MINUTE"),
    "N-M": Measure("TORQUE", "NEWTON_METER"),
}


@dataclass(frozen=True, slots=True)
class DataItem:
    """One thing that a device tells; `measure` is None where it is no number with a unit that MTConnect knows.

    `source` is the reading behind it; the place of a robot, which is not kept, has none.
    """

    id: str
    category: Category
    type: str
    name: str = ""
    measure: Measure | None = None
    source: str = ""

    @property
    def attributes(self) -> dict[str, str]:
        """How the item is written in MTConnectDevices."""
        named = {"name": self.name} if self.name else {}
        units = {"units": self.measure.units} if self.measure else {}
        return {**named, "id": self.id, "category": self.category, "type": self.type, **units}


def component_id(device_id: str) -> str:
    """Return a device's id as XML wants it; no two ids of a document are the same."""
    return f"d_{device_id}"


def availability_of(device_id: str) -> DataItem:
    """Return the item that says whether the device is there."""
    return DataItem(f"a_{device_id}", "EVENT", "AVAILABILITY", source=ONLINE)


def execution_of(device_id: str) -> DataItem:
    """Return the item that says whether the device is at work."""
    return DataItem(f"e_{device_id}", "EVENT", "EXECUTION", source=DONE)


def conditions_of(device_id: str) -> tuple[DataItem, ...]:
    """Return the items that say whether the device reports an error, and whether it reports a warning."""
    return tuple(DataItem(f"c_{name}_{device_id}", "CONDITION", "SYSTEM", name, source=name) for name in LEVELS)


def position_of(device_id: str) -> DataItem:
    """Return the item that says where a robot is, on the site's map."""
    return DataItem(f"p_{device_id}", "SAMPLE", "PATH_POSITION", measure=Measure("PATH_POSITION", "MILLIMETER_3D"))


def item_of(device_id: str, spec: PropertySpec) -> DataItem:
    """Return a property's item: a sample when it is a number in a unit that MTConnect knows, else a message."""
    key = f"x{len(spec.name)}_{spec.name}_{device_id}"
    measure = MEASURES.get(spec.unit) if spec.type == "number" else None
    if measure is None:
        return DataItem(key, "EVENT", "MESSAGE", spec.name, source=spec.name)
    return DataItem(key, "SAMPLE", measure.type, spec.name, measure, spec.name)


def items_of(view: DeviceView) -> tuple[DataItem, ...]:
    """Return all that a device tells."""
    own = (item_of(view.id, spec) for spec in view.canonical.properties if spec.name not in LEVELS)
    place = (position_of(view.id),) if view.kind == "robot" else ()
    return (availability_of(view.id), execution_of(view.id), *conditions_of(view.id), *place, *own)


def element_name(item: DataItem) -> str:
    """Return what an item's observations are called: `PathPosition` for `PATH_POSITION`."""
    return "".join(word.capitalize() for word in item.type.split("_"))


def say_value(item: DataItem, value: Scalar) -> str:
    """Return a reading's text."""
    if value is None:
        return UNAVAILABLE
    if item.measure is None:
        return str(value).lower() if isinstance(value, bool) else sayable(str(value))
    if isinstance(value, bool) or not isinstance(value, int | float):
        return UNAVAILABLE
    measured = float(value) * item.measure.factor + item.measure.offset
    return repr(round(measured, 6)) if isfinite(measured) else UNAVAILABLE


def say_position(pose: Pose) -> str:
    """Return a place as three numbers of millimetres."""
    return " ".join(repr(round(metres * 1000.0, 3)) for metres in (pose.x, pose.y, pose.z))


def say_condition(item: DataItem, value: Scalar, *, online: bool) -> tuple[str, str | None]:
    """Return what a condition is called, and its text: a reading that is empty is none."""
    if not online:
        return "Unavailable", None
    return (LEVELS[item.source], sayable(str(value))) if value else ("Normal", None)


def say_availability(*, online: bool) -> str:
    """Return whether a device is there."""
    return "AVAILABLE" if online else UNAVAILABLE


def say_execution(*, online: bool, done: bool, failed: bool = False) -> str:
    """Return whether a device is at work."""
    if not online:
        return UNAVAILABLE
    if failed:
        return "STOPPED"
    return "READY" if done else "ACTIVE"


def sayable(text: str) -> str:
    """Return a text without the characters that no XML document may hold."""
    return _UNSAYABLE.sub("\ufffd", text)

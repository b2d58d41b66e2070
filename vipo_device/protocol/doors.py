"""Which devices are doors: those that can be told to open, whatever their class is called; pure.

A door, a gate, a barrier or a shutter differ in nothing that matters here. What counts is a method that opens and needs
no arguments; one that closes and a reading that tells how it stands are used where there are any.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from vipo_device.protocol.description import Description, PropertySpec, Scalar

OPENING = frozenset({"open", "raise", "öffnen", "oeffnen"})
CLOSING = frozenset({"close", "shut", "lower", "schließen", "schliessen"})
OPEN = frozenset({"open", "opened", "raised", "up", "offen", "geöffnet", "auf"})
"""What a reading says of a door that robots can drive through; anything else means that they cannot."""
CLOSED = frozenset({"closed", "shut", "lowered", "down", "geschlossen", "zu"})
STANDS = frozenset({"open", "opened", "state", "status", "position", "door", "gate", "offen", "zustand"})


@dataclass(frozen=True, slots=True)
class DoorMethods:
    """How a device is opened and closed, by the names of its description; empty: it has no such method or reading."""

    opens: str
    closes: str = ""
    reading: str = ""

    def is_open(self, value: Scalar) -> bool | None:
        """Tell whether its reading says that it is open; None: it says nothing."""
        if isinstance(value, bool):
            return value
        return value.casefold() in OPEN if isinstance(value, str) and value else None


def door_methods(device: Description) -> DoorMethods | None:
    """Return how a device is opened and closed; None: it is no door."""
    opens = _method(device, OPENING, CLOSING)
    if not opens:
        return None
    return DoorMethods(
        opens, _method(device, CLOSING, OPENING), next(filter(None, map(_reading, device.properties)), "")
    )


def said_of_door(spec: PropertySpec, *, is_open: bool) -> Scalar:
    """Return what a door's reading says when it is open, or when it is not, in the words of its description."""
    if spec.type == "boolean":
        return is_open
    words = [option for option in spec.options if (option.casefold() in OPEN) is is_open]
    shut = [option for option in words if option.casefold() in CLOSED]
    return next(iter((*shut, *words)), "open" if is_open else "closed")


def _method(device: Description, wanted: frozenset[str], other: frozenset[str]) -> str:
    """Return the first method that says one thing, not also the other, and can be told so without arguments."""
    for method in device.methods:
        words = _words(method.name)
        if words & wanted and not words & other and not any(each.required for each in method.parameters):
            return method.name
    return ""


def _reading(spec: PropertySpec) -> str:
    """Return the name of a property that tells whether a door is open, or an empty text."""
    words = _words(spec.name)
    if spec.type == "boolean":
        return spec.name if words & OPEN else ""
    if spec.type != "text":
        return ""
    is_told = {option.casefold() for option in spec.options} & OPEN if spec.options else words & STANDS
    return spec.name if is_told else ""


def _words(name: str) -> frozenset[str]:
    """Return the words of a name such as `openDoor` or `door_open`, in small letters."""
    parted = re.sub(r"(?<=[a-zäöüß0-9])(?=[A-ZÄÖÜ])", " ", name)
    return frozenset(re.split(r"[\W_]+", parted.casefold()))

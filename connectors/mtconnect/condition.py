"""How a machine is, by what its agent has said so far: values, conditions, whether it works; pure."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable

from connectors.mtconnect.description import ERROR, EXECUTION, WARNING, DescribedMachine, Reading
from connectors.mtconnect.documents import Observation
from vipo_device.protocol.description import DeviceState, Scalar
from vipo_device.protocol.messages import MAX_BYTES, MAX_TEXT

UNAVAILABLE = "UNAVAILABLE"
AT_WORK = frozenset(
    {"ACTIVE", "WAIT", "INTERRUPTED", "FEED_HOLD", "OPTIONAL_STOP", "PROGRAM_STOPPED", "PROGRAM_OPTIONAL_STOP"}
)
"""Words of EXECUTION within a program that is not at its end; also one that stands still in it goes on."""
LEVELS = {"Fault": ERROR, "Warning": WARNING}
MOST_OF_ITEM = 16
LENGTHS = (MAX_TEXT, 100, 40, 10)
_NUMBER = re.compile(r"[+-]?(\d{1,30}(\.\d{0,30})?|\.\d{1,30})([Ee][+-]?\d{1,3})?")


class MachineCondition:
    """What is known of one machine. A complete picture replaces what was known."""

    def __init__(self, described: DescribedMachine) -> None:
        self._described = described
        self._items = {r.item for r in described.readings}
        self._items |= described.executions | described.availabilities | described.stops
        self._values: dict[str, str] = {}
        self._conditions: dict[str, dict[str, tuple[str, str]]] = {}
        self._looked: tuple[bool, dict[str, Scalar]] | None = None

    def forget(self) -> None:
        """Know nothing any more."""
        self._values.clear()
        self._conditions.clear()
        self._looked = None

    def take(self, observations: Iterable[Observation]) -> None:
        """Take in what the agent said of this machine, the oldest first; what its probe does not name is ignored."""
        self._looked = None
        for observation in observations:
            if observation.item in self._described.conditions:
                self._take_condition(observation)
            elif observation.item in self._items:
                self._values[observation.item] = observation.text

    def _take_condition(self, said: Observation) -> None:
        """Several may hold of one item, kept apart by their codes; Normal without a code ends them all."""
        active = self._conditions.setdefault(said.item, {})
        level = LEVELS.get(said.name)
        if level is not None and (said.code in active or len(active) < MOST_OF_ITEM):
            active[said.code] = (level, said.text or said.code or f"{said.name} of {said.item}")
        elif level is None and said.code and said.name == "Normal":
            active.pop(said.code, None)
        elif level is None:
            active.clear()

    @property
    def is_available(self) -> bool:
        """False when the agent says that it does not reach the machine."""
        return UNAVAILABLE not in [self._values.get(item) for item in self._described.availabilities]

    def look(self, boot: int, seq: int) -> DeviceState:
        """Return the device's state."""
        if self._looked is None:
            doing = self._said(self._described.executions)
            self._looked = AT_WORK.isdisjoint(doing), _fitting(self._properties(doing))
        done, properties = self._looked
        return DeviceState(boot, seq, done, properties=properties)

    def _said(self, items: Iterable[str]) -> list[str]:
        return [text for item in sorted(items) if (text := self._values.get(item, UNAVAILABLE)) != UNAVAILABLE]

    def _properties(self, doing: list[str]) -> dict[str, Scalar]:
        held = [entry for active in self._conditions.values() for entry in active.values()]
        stops = ["Emergency stop"] if "TRIGGERED" in self._said(self._described.stops) else []
        return {
            EXECUTION: ", ".join(doing),
            ERROR: "; ".join([*stops, *(text for level, text in held if level == ERROR)]),
            WARNING: "; ".join(text for level, text in held if level == WARNING),
            **{reading.property: self._value(reading) for reading in self._described.readings},
        }

    def _value(self, reading: Reading) -> Scalar:
        text = self._values.get(reading.item, UNAVAILABLE)
        if text == UNAVAILABLE:
            return None
        if reading.measure is None:
            return text
        numbers = text.split()
        if len(numbers) != reading.measure.axes or not _NUMBER.fullmatch(numbers[reading.axis]):
            return None
        value = float(numbers[reading.axis]) * reading.measure.factor
        return round(value, 9) if abs(value) <= 1e300 else None


def _fitting(properties: dict[str, Scalar]) -> dict[str, Scalar]:
    """Return properties whose texts are short enough for a message."""
    found = properties
    for length in LENGTHS:
        found = {name: v[:length] if isinstance(v, str) else v for name, v in properties.items()}
        if len(json.dumps(found)) <= MAX_BYTES - 512:
            break
    return found

"""What a machine's readings show while it works and rests, by the laws of its kind and the ranges it describes."""

from __future__ import annotations

from collections.abc import Mapping
from math import exp

from simulation.actors.actor import Chance
from simulation.behaviour import Behaviour, ReadingLaw
from vipo_device.protocol.arguments import is_number
from vipo_device.protocol.description import Description, PropertySpec, Scalar
from vipo_device.protocol.units import convert, same_dimension

DEADBAND = 0.5
AT_REST = 0.05
MOST_COUNTED = 2**31
KEPT = frozenset({"stock", "freeSlots"})
"""Readings that follow from what a machine holds, so that no argument sets them."""


def within(spec: PropertySpec | None, value: float) -> float:
    """Return the value as near as the described range lets it be."""
    if spec is None:
        return value
    low = value if spec.minimum is None else max(value, spec.minimum)
    return low if spec.maximum is None else min(low, spec.maximum)


def converted(value: float, unit: str, shown_in: str) -> float:
    """Return a value in the unit in which a reading shows it; where that measures something else, as it is."""
    return convert(value, unit, shown_in) if same_dimension(unit, shown_in) else value


def told_in_units_of_readings(
    description: Description, method: str, arguments: Mapping[str, object]
) -> dict[str, object]:
    """Return a call's arguments, each in the unit in which the reading of its name shows it."""
    spec = description.method(method)
    units = {} if spec is None else {parameter.name: parameter.unit for parameter in spec.parameters}
    told = dict(arguments)
    for reading in description.properties:
        value = arguments.get(reading.name)
        if is_number(value):
            told[reading.name] = converted(value, units.get(reading.name, ""), reading.unit)
    return told


class Approach:
    """A reading that follows first order: value' = (target - value) / time constant."""

    def __init__(self, spec: PropertySpec, law: ReadingLaw, known: Scalar) -> None:
        self.spec, self._law = spec, law
        self._resting = converted(law.resting, law.unit, spec.unit)
        self._working = converted(law.working, law.unit, spec.unit)
        self._value = float(known) if is_number(known) else self._resting

    @property
    def resting(self) -> bool:
        """True when time changes nothing while the machine does not work."""
        return abs(self._value - self._resting) < AT_REST

    @property
    def shown(self) -> float:
        """Return the value as the reading shows it."""
        return round(within(self.spec, self._value), 1)

    def advance(self, dt_s: float, shown: Scalar, *, works: bool, wanted: float | None) -> float | None:
        """Let time pass; return what the reading shows now if that is worth saying. `wanted` is a set point."""
        if not works and self._value == self._resting:
            return None
        target = self._resting if not works else self._working if wanted is None else wanted
        constant_s = self._law.rising_s if target > self._value else self._law.falling_s
        self._value = target + (self._value - target) * exp(-dt_s / constant_s)
        if not works and self.resting:
            self._value = self._resting
        if not isinstance(shown, int | float):
            return None
        is_news = abs(self._value - shown) >= DEADBAND or self._value in {self._resting, target}
        return self.shown if is_news else None


class MachineReadings:
    """The readings of one machine that its work moves."""

    def __init__(self, description: Description, behaviour: Behaviour, known: Mapping[str, Scalar]) -> None:
        self._description = description
        self._laws = {p.name: law for p in description.properties if (law := _law_of(p, behaviour)) is not None}
        self._approaches = [
            Approach(spec, law, known.get(spec.name))
            for spec in description.properties
            if (law := self._laws.get(spec.name)) is not None and law.law == "approach"
        ]
        self._known = known
        self._worked = 0

    @property
    def resting(self) -> bool:
        """True when time changes nothing while the machine does not work."""
        return all(approach.resting for approach in self._approaches)

    def at_start(self) -> dict[str, Scalar]:
        """Return what the readings show before anybody listens."""
        resting = {name: value for name, value in self.switched(works=False).items() if name not in self._known}
        return {**resting, **{approach.spec.name: approach.shown for approach in self._approaches}}

    def advance(self, dt_s: float, shown: Mapping[str, Scalar], job: Mapping[str, object] | None) -> dict[str, Scalar]:
        """Let time pass; `job` are the arguments of the work under way. Returns what changed."""
        changed: dict[str, Scalar] = {}
        for approach in self._approaches:
            name = approach.spec.name
            wanted = (job or {}).get(name)
            value = approach.advance(
                dt_s, shown.get(name), works=job is not None, wanted=float(wanted) if is_number(wanted) else None
            )
            if value is not None:
                changed[name] = value
        return changed

    def progress(self, percent: int) -> dict[str, Scalar]:
        """Return what shows how far a job is, in percent."""
        return dict.fromkeys(self._names("progress"), percent)

    def switched(self, *, works: bool) -> dict[str, Scalar]:
        """Return what changes at once when work begins or ends."""
        changed: dict[str, Scalar] = {}
        for name in self._names("while_working"):
            law, spec = self._laws[name], self._description.property(name)
            value = law.working if works else law.resting
            changed[name] = within(spec, converted(value, law.unit, "" if spec is None else spec.unit))
        return changed

    def after(self, arguments: Mapping[str, object], true: Mapping[str, Scalar]) -> dict[str, Scalar]:
        """Return what a job that ended well leaves: counts go on from what is true; arguments set their namesakes."""
        changed: dict[str, Scalar] = {}
        for name in self._names("counts"):
            before = true.get(name)
            if is_number(before):
                changed[name] = min(before + 1, within(self._description.property(name), MOST_COUNTED))
        for spec in self._description.properties:
            value = arguments.get(spec.name)
            if spec.name not in self._laws and spec.name not in KEPT and _suits(spec, value):
                changed[spec.name] = value  # type: ignore[assignment]  # `_suits` has looked at the type
        return changed

    def drawn(self, method: str, chance: Chance | None) -> dict[str, Scalar]:
        """Return what chance decides at the end of a job; without chance the other comes as often, evenly."""
        laws = {n: self._laws[n] for n in self._names("drawn") if method in self._laws[n].after}
        if laws:
            self._worked += 1
        return {
            name: law.other if _is_other(law.odds, self._worked, chance) else law.usual for name, law in laws.items()
        }

    def _names(self, law: str) -> list[str]:
        return [name for name, known in self._laws.items() if known.law == law]


def _law_of(spec: PropertySpec, behaviour: Behaviour) -> ReadingLaw | None:
    """Return the law of a reading: by its name, else as a temperature by its unit; none whose type does not suit."""
    law = behaviour.readings.get(spec.name)
    if law is None and same_dimension(spec.unit, "DEG_C"):
        law = behaviour.readings.get("temperature")
    if law is None:
        return None
    return law if (spec.type == "number") != (law.law == "drawn") else None


def _is_other(odds: float, worked: int, chance: Chance | None) -> bool:
    if chance is not None:
        return chance() < odds
    return int(worked * odds + 1e-9) > int((worked - 1) * odds + 1e-9)


def _suits(spec: PropertySpec, value: object) -> bool:
    if spec.type == "number":
        return is_number(value) and within(spec, value) == value
    if spec.type == "boolean":
        return isinstance(value, bool)
    return isinstance(value, str) and (not spec.options or value in spec.options)

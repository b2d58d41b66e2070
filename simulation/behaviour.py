"""How a simulated device behaves: what its description says, and for all else what the kinds that fit it say."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

from vipo_device.protocol.description import Description

Law = Literal["progress", "approach", "while_working", "counts", "drawn"]


@dataclass(frozen=True, slots=True)
class ReadingLaw:
    """How one reading moves; `unit` is that of `resting` and `working`.

    `approach` goes to `working` while a job lasts and back to `resting`, with time constants in seconds;
    `while_working` jumps; `progress` counts a job from 0 to 100; `counts` counts the jobs that ended well; `drawn`
    is `usual` after a job, and `other` with the given odds.
    """

    law: Law
    unit: str = ""
    resting: float = 0.0
    working: float = 0.0
    rising_s: float = 60.0
    falling_s: float = 60.0
    after: tuple[str, ...] = ()
    usual: str = ""
    other: str = ""
    odds: float = 0.0


@dataclass(frozen=True, slots=True)
class Behaviour:
    """What a device does where its description does not say it.

    A method without a time takes `job_s` seconds; chance makes it up to `spread` (a part of 1) longer or shorter.
    A machine holds `slots` objects, a source begins with `stock` of them, and `hands_over` are the methods that are no
    work. `uses` says what a method uses up if it is there, `needs` without what it is refused, `fails` its odds of
    failing. A robot drives with `speed_m_s`; its battery lasts so many hours and is full after `charging_h`.
    """

    job_s: float = 2.0
    spread: float = 0.0
    slots: int = 8
    stock: int = 24
    speed_m_s: float = 0.5
    driving_h: float = 4.0
    standing_h: float = 24.0
    charging_h: float = 0.5
    hands_over: tuple[str, ...] = ("dispense", "accept")
    readings: Mapping[str, ReadingLaw] = field(default_factory=dict)
    uses: Mapping[str, Mapping[str, int]] = field(default_factory=dict)
    needs: Mapping[str, Mapping[str, int]] = field(default_factory=dict)
    fails: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Condition:
    """Which descriptions a kind is for: all that is said has to fit; of `classes` and `ids`, one."""

    kind: str = ""
    methods: tuple[str, ...] = ()
    properties: tuple[str, ...] = ()
    gives: tuple[str, ...] = ()
    takes: tuple[str, ...] = ()
    classes: tuple[str, ...] = ()
    ids: tuple[str, ...] = ()

    def fits(self, description: Description) -> bool:
        """Tell whether the kind is for this device."""
        return (
            self.kind in {"", description.kind}
            and all(description.method(name) for name in self.methods)
            and all(description.property(name) for name in self.properties)
            and set(self.gives) <= set(description.gives)
            and set(self.takes) <= set(description.takes)
            and (not self.classes or description.device_class in self.classes)
            and (not self.ids or description.id in self.ids)
        )


@dataclass(frozen=True, slots=True)
class Kind:
    """Defaults for the devices that a condition fits; `says` are fields of `Behaviour`."""

    name: str
    when: Condition
    says: Mapping[str, object]


def behaviour_of(description: Description, kinds: Sequence[Kind]) -> Behaviour:
    """Return how a device behaves: each kind that fits replaces, entry by entry, what those before it say."""
    said: dict[str, object] = {}
    for kind in kinds:
        if kind.when.fits(description):
            for name, value in kind.says.items():
                before = said.get(name)
                said[name] = {**before, **value} if isinstance(before, dict) and isinstance(value, dict) else value
    return Behaviour(**said)  # type: ignore[arg-type]  # the file's reader has looked at the types

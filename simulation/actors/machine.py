"""A simulated machine: it takes its time, holds objects, warms up and cools down."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import exp

from simulation.actors.actor import Actor, Emit, InitialState
from vipo_device.kit.arguments import counted_object, duration_s
from vipo_device.protocol.description import Description, PropertySpec, Scalar
from vipo_device.protocol.doors import door_methods, said_of_door
from vipo_device.protocol.messages import AckMessage

AMBIENT_C = 22.0
SLOTS = 8
FIRST_STOCK = {"shelf": 24, "cans": 8}
SLOTS_OF_CLASS = {"rollers": 9}
SCRATCHED_EVERY = 5
DEADBAND_C = 0.5


@dataclass(frozen=True, slots=True)
class Warmth:
    """The temperature that a class of machine works at, and the time constants of warming and cooling."""

    target_c: float
    warming_s: float
    cooling_s: float


WARMTH = {"oven": Warmth(80.0, 60.0, 120.0)}
MILD = Warmth(34.0, 120.0, 120.0)


@dataclass(slots=True)
class Job:
    """What a machine is doing."""

    command: str
    method: str
    lasts_s: float
    spent_s: float = 0.0


class Machine(Actor):
    """One job at a time; objects that robots bring can be fetched again; a sink or source has its own rules."""

    def __init__(self, description: Description, emit: Emit, initial: InitialState) -> None:
        super().__init__(description, emit, initial)
        self.stock = _stock_at(initial, description, self.slots) if initial.holds is None else dict(initial.holds)
        self._job: Job | None = None
        self._door = door_methods(description)
        self._pieces = initial.seed
        self._warmth = WARMTH.get(description.device_class, MILD)
        known = initial.readings.get("temperature")
        self._celsius = float(known) if isinstance(known, int | float) else AMBIENT_C
        self._start_readings()

    @property
    def busy(self) -> bool:
        """True while a job is under way."""
        return self._job is not None

    @property
    def resting(self) -> bool:
        """True when time changes nothing."""
        return self._job is None and abs(self._celsius - AMBIENT_C) < 0.05 and not self._waiting_faults

    @property
    def slots(self) -> int:
        """How many objects fit in."""
        declared = self.description.property("freeSlots")
        if declared is not None and declared.maximum:
            return int(declared.maximum)
        return self.description.capacity or SLOTS_OF_CLASS.get(self.description.device_class, SLOTS)

    def advance(self, t_s: float, dt_s: float) -> None:
        """Let time pass, up to `t_s`."""
        self.notice_faults(t_s)
        if self._job is not None and not self.frozen:
            self._work(t_s, dt_s, self._job)
        self._exchange_heat(t_s, dt_s)

    def refusal_to_give(self, name: str, count: int) -> str:
        """Return why a robot cannot fetch objects here now, or an empty text."""
        if self._job is not None and self._job.method != "dispense":
            return f"{self.description.name} is busy with {self._job.method}."
        held = self.stock.get(name, 0)
        if self._is_undeclared and held < count:
            return ""
        if held < count:
            return f"{self.description.name} is empty: it has {held} {name}, not {count}."
        return ""

    def refusal_to_take(self, name: str, count: int) -> str:
        """Return why a robot cannot leave objects here now, or an empty text."""
        if self._job is not None and self._job.method != "accept":
            return f"{self.description.name} is busy with {self._job.method}."
        if not self._is_undeclared and name not in self.description.takes:
            takes = ", ".join(self.description.takes) or "nothing"
            return f"{self.description.name} does not take {name}; it takes {takes}."
        if sum(self.stock.values()) + count > self.slots:
            return f"{self.description.name} is full: {sum(self.stock.values())} of {self.slots} places are taken."
        return ""

    def change_stock(self, t_s: float, name: str, change: int) -> None:
        """Put objects in or take them out; whether that may be is asked before."""
        self.stock[name] = max(0, self.stock.get(name, 0) + change)
        self._read_stock(t_s)

    def set_stock(self, t_s: float, stock: Mapping[str, int]) -> None:
        """Say what the machine holds, as after a delivery."""
        self.stock = dict(stock)
        self._read_stock(t_s)

    def wanted_stock(self) -> dict[str, int] | None:
        """Return what people would bring about here: a filled source, an emptied sink; None when all is well."""
        gives, takes = self.description.gives, self.description.takes
        if gives and not takes and not any(self.stock.values()):
            return first_stock(self.description)
        is_full = sum(self.stock.values()) >= self.slots
        return {} if is_full and self.description.device_class in SLOTS_OF_CLASS else None

    @property
    def _is_undeclared(self) -> bool:
        return not self.description.gives and not self.description.takes

    def _take_on(self, t_s: float, method: str, arguments: Mapping[str, object], command: str) -> str:
        if self._job is not None:
            return f"{self.description.name} is busy with {self._job.method}."
        if method in {"dispense", "accept"} and (why := self._refusal_of_goods(method, arguments)):
            return why
        spec = self.description.method(method)
        assert spec is not None
        self._say(t_s, AckMessage(command, "ACCEPTED"))
        self._say(t_s, AckMessage(command, "RUNNING"))
        self._job = Job(command, method, duration_s(spec, arguments))
        self._read_door(t_s, method, is_done=False)
        self.read(t_s, "jobStatus", 0)
        self._read_pressure(t_s)
        return ""

    def _refusal_of_goods(self, method: str, arguments: Mapping[str, object]) -> str:
        goods = counted_object(arguments)
        if isinstance(goods, str):
            return goods
        return self.refusal_to_give(*goods) if method == "dispense" else self.refusal_to_take(*goods)

    def _cancel(self, t_s: float, command: str) -> None:
        job = self._job
        if job is not None and command in {"", job.command}:
            self._job = None
            self._read_pressure(t_s)
            self._say(t_s, AckMessage(job.command, "CANCELED", f"{job.method} was cancelled."))

    def _work(self, t_s: float, dt_s: float, job: Job) -> None:
        job.spent_s += dt_s
        if job.spent_s < job.lasts_s - 1e-9:
            self.read(t_s, "jobStatus", int(100 * job.spent_s / job.lasts_s))
            return
        self._job = None
        self.read(t_s, "jobStatus", 100)
        self._read_pressure(t_s)
        if self._say_done(t_s, job.command, self._finish(t_s, job)):
            self._read_door(t_s, job.method, is_done=True)

    def _finish(self, t_s: float, job: Job) -> dict[str, Scalar]:
        """Do what a job does to objects and readings; return what is worth reporting."""
        if self.description.device_class == "booth" and job.method == "paint" and self.stock.get("can"):
            self.change_stock(t_s, "can", -1)
        if self.description.device_class == "oven" and job.method == "curePaint":
            self._pieces += 1
            quality = "scratched" if self._pieces % SCRATCHED_EVERY == 0 else "ok"
            self.read(t_s, "quality", quality)
            return {"quality": quality}
        return {}

    def _exchange_heat(self, t_s: float, dt_s: float) -> None:
        """First-order warming and cooling: T' = (target - T) / time constant."""
        works = self._job is not None and self._job.method not in {"dispense", "accept"}
        if not works and self._celsius == AMBIENT_C:
            return
        target = self._warmth.target_c if works else AMBIENT_C
        constant_s = self._warmth.warming_s if target > self._celsius else self._warmth.cooling_s
        self._celsius = target + (self._celsius - target) * exp(-dt_s / constant_s)
        if not works and self._celsius - AMBIENT_C < 0.05:
            self._celsius = AMBIENT_C
        shown = self.readings.get("temperature")
        if isinstance(shown, int | float) and (
            abs(self._celsius - shown) >= DEADBAND_C or self._celsius in {AMBIENT_C, target}
        ):
            self.read(t_s, "temperature", self._celsius_shown())

    def _celsius_shown(self) -> float:
        return round(_within(self.description.property("temperature"), self._celsius), 1)

    def _read_pressure(self, t_s: float) -> None:
        bar = 2.5 if self._job is not None and self._job.method not in {"dispense", "accept"} else 0.0
        self.read(t_s, "pressure", _within(self.description.property("pressure"), bar))

    def _read_door(self, t_s: float, method: str, *, is_done: bool) -> None:
        """A door is open once it has opened, and is not from the moment on in which it begins to close."""
        spec = self.description.property(self._door.reading) if self._door is not None else None
        if self._door is None or spec is None:
            return
        if method == self._door.opens and is_done:
            self.read(t_s, spec.name, said_of_door(spec, is_open=True))
        elif method == self._door.closes and not is_done:
            self.read(t_s, spec.name, said_of_door(spec, is_open=False))

    def _read_stock(self, t_s: float) -> None:
        total = sum(self.stock.values())
        self.read(t_s, "stock", total)
        self.read(t_s, "freeSlots", max(0, self.slots - total))

    def _start_readings(self) -> None:
        """Set the readings that follow from the machine's state, before anyone listens."""
        total = sum(self.stock.values())
        values = {"stock": total, "freeSlots": max(0, self.slots - total), "temperature": self._celsius_shown()}
        self.readings.update({name: value for name, value in values.items() if name in self.readings})


def first_stock(description: Description) -> dict[str, int]:
    """Return what a machine holds at the start when nobody says: a source is full, all else is empty."""
    if description.takes:
        return {}
    declared = description.property("stock")
    most = int(declared.maximum) if declared is not None and declared.maximum else 24
    return dict.fromkeys(description.gives, FIRST_STOCK.get(description.device_class, most))


def _stock_at(initial: InitialState, description: Description, slots: int) -> dict[str, int]:
    """Return what a machine holds at the beginning, from what it shows if it shows it."""
    stock, free = initial.readings.get("stock"), initial.readings.get("freeSlots")
    if isinstance(stock, int | float) and len(description.gives) == 1:
        return {description.gives[0]: int(stock)}
    if isinstance(free, int | float) and len(description.takes) == 1:
        return {description.takes[0]: max(0, slots - int(free))}
    return first_stock(description)


def _within(spec: PropertySpec | None, value: float) -> float:
    if spec is None:
        return value
    low = value if spec.minimum is None else max(value, spec.minimum)
    return low if spec.maximum is None else min(low, spec.maximum)

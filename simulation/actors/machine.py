"""A simulated machine: it takes its time, holds objects, warms up and cools down."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from simulation.actors.actor import Actor, Emit, InitialState
from simulation.actors.readings import MachineReadings, told_in_units_of_readings
from simulation.behaviour import Behaviour
from vipo_device.kit.arguments import counted_object
from vipo_device.protocol.description import Description, Scalar
from vipo_device.protocol.doors import door_methods, said_of_door
from vipo_device.protocol.messages import AckMessage


@dataclass(slots=True)
class Job:
    """What a machine is doing; `told` are the arguments, in the units of the readings of their names."""

    command: str
    method: str
    lasts_s: float
    told: Mapping[str, object] = field(default_factory=dict)
    spent_s: float = 0.0


class Machine(Actor):
    """One job at a time; objects that robots bring can be fetched again; a sink or source has its own rules."""

    def __init__(self, description: Description, emit: Emit, initial: InitialState) -> None:
        super().__init__(description, emit, initial)
        self.stock = _stock_at(initial, description, self.slots) if initial.holds is None else dict(initial.holds)
        self._job: Job | None = None
        self._door = door_methods(description)
        self._readings = MachineReadings(description, self.behaviour, initial.readings)
        self._start_readings()

    @property
    def busy(self) -> bool:
        """True while a job is under way."""
        return self._job is not None

    @property
    def resting(self) -> bool:
        """True when time changes nothing."""
        return self._job is None and self._readings.resting and not self.awaits_time

    @property
    def slots(self) -> int:
        """How many objects fit in."""
        return _declared_slots(self.description) or self.behaviour.slots

    def advance(self, t_s: float, dt_s: float) -> None:
        """Let time pass, up to `t_s`."""
        self.notice_faults(t_s)
        if self._job is not None and not self.frozen:
            self._work(t_s, dt_s, self._job)
        work = self._work_under_way
        changed = self._readings.advance(dt_s, self.readings, None if work is None else work.told)
        self._read_all(t_s, changed)

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
            return first_stock(self.description, self.behaviour)
        is_full = sum(self.stock.values()) >= self.slots
        return {} if is_full and takes and not gives else None

    @property
    def _work_under_way(self) -> Job | None:
        """The job under way, unless it only hands something over."""
        job = self._job
        return None if job is None or job.method in self.behaviour.hands_over else job

    @property
    def _is_undeclared(self) -> bool:
        return not self.description.gives and not self.description.takes

    def _take_on(self, t_s: float, method: str, arguments: Mapping[str, object], command: str) -> str:
        if self._job is not None:
            return f"{self.description.name} is busy with {self._job.method}."
        if method in {"dispense", "accept"} and (why := self._refusal_of_goods(method, arguments)):
            return why
        if why := self._lack(method):
            return why
        self._say(t_s, AckMessage(command, "ACCEPTED"))
        self._say(t_s, AckMessage(command, "RUNNING"))
        lasts_s = self._lasts_s(method, self.description.method(method), arguments)
        told = told_in_units_of_readings(self.description, method, arguments)
        self._job = Job(command, method, lasts_s, told)
        self._read_door(t_s, method, is_done=False)
        self._read_all(t_s, self._readings.progress(0))
        self._read_switched(t_s)
        return ""

    def _lack(self, method: str) -> str:
        """Return what the method needs and is not here, or an empty text."""
        for name, count in self.behaviour.needs.get(method, {}).items():
            held = self.stock.get(name, 0)
            if held < count:
                return f"{self.description.name} cannot {method}: it has {held} {name} and needs {count}."
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
            self._read_switched(t_s)
            self._say(t_s, AckMessage(job.command, "CANCELED", f"{job.method} was cancelled."))

    def _work(self, t_s: float, dt_s: float, job: Job) -> None:
        job.spent_s += dt_s
        if job.spent_s < job.lasts_s - 1e-9:
            self._read_all(t_s, self._readings.progress(int(100 * job.spent_s / job.lasts_s)))
            return
        self._job = None
        if self._breaks_down(job.method):
            self._read_switched(t_s)
            self._say(t_s, AckMessage(job.command, "FAILED", f"{self.description.name} broke down at {job.method}."))
            return
        self._read_all(t_s, self._readings.progress(100))
        self._read_switched(t_s)
        if self._say_done(t_s, job.command, self._finish(t_s, job)):
            self._read_door(t_s, job.method, is_done=True)

    def _breaks_down(self, method: str) -> bool:
        odds = self.behaviour.fails.get(method, 0.0)
        return odds > 0 and self._chance is not None and self._chance() < odds

    def _finish(self, t_s: float, job: Job) -> dict[str, Scalar]:
        """Do what a job does to objects and readings; return what is worth reporting."""
        for name, count in self.behaviour.uses.get(job.method, {}).items():
            if self.stock.get(name):
                self.change_stock(t_s, name, -count)
        if job.method not in self.behaviour.hands_over:
            self._read_all(t_s, self._readings.after(job.told, {**self.readings, **self._true_readings}))
        drawn = self._readings.drawn(job.method, self._chance)
        self._read_all(t_s, drawn)
        return drawn

    def _read_all(self, t_s: float, changed: Mapping[str, Scalar]) -> None:
        for name, value in changed.items():
            self.read(t_s, name, value)

    def _read_switched(self, t_s: float) -> None:
        self._read_all(t_s, self._readings.switched(works=self._work_under_way is not None))

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
        values = {"stock": total, "freeSlots": max(0, self.slots - total), **self._readings.at_start()}
        self.readings.update({name: value for name, value in values.items() if name in self.readings})


def first_stock(description: Description, behaviour: Behaviour) -> dict[str, int]:
    """Return what a machine holds at the start when nobody says: a source is full, all else is empty."""
    if description.takes:
        return {}
    declared = description.property("stock")
    most = int(declared.maximum) if declared is not None and declared.maximum else behaviour.stock
    return dict.fromkeys(description.gives, most)


def shown_stock(
    description: Description, readings: Mapping[str, Scalar], slots: int | None = None
) -> dict[str, int] | None:
    """Return what a machine holds as far as its readings show it; None where they do not."""
    stock, free = readings.get("stock"), readings.get("freeSlots")
    if isinstance(stock, int | float) and len(description.gives) == 1:
        return {description.gives[0]: max(0, int(stock))}
    places = slots or _declared_slots(description)
    if isinstance(free, int | float) and len(description.takes) == 1 and places:
        return {description.takes[0]: max(0, places - int(free))}
    return None


def _declared_slots(description: Description) -> int:
    declared = description.property("freeSlots")
    return int(declared.maximum) if declared is not None and declared.maximum else description.capacity


def _stock_at(initial: InitialState, description: Description, slots: int) -> dict[str, int]:
    """Return what a machine holds at the beginning, from what it shows if it shows it."""
    shown = shown_stock(description, initial.readings, slots)
    return first_stock(description, initial.behaviour) if shown is None else shown

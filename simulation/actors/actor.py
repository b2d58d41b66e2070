"""What every simulated device has in common: answers, readings, pause and cancel, and faults on purpose."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field

from simulation.actors.troubles import Troubles
from simulation.behaviour import Behaviour
from simulation.world import Ack, Fault, FaultBegan, PropertyChanged, WorldEvent
from vipo_device.kit.answers import REMEMBERED, AnswerLedger
from vipo_device.kit.arguments import duration_s
from vipo_device.protocol.arguments import refusal_of_arguments
from vipo_device.protocol.description import Description, MethodSpec, PropertySpec, Scalar
from vipo_device.protocol.messages import CONTROLS, AckMessage

Emit = Callable[[WorldEvent], None]
Chance = Callable[[], float]
"""Gives the next number from 0 up to 1; the same seed gives the same numbers."""


def starting_value(spec: PropertySpec) -> Scalar:
    """Return what a reading shows before anything has happened."""
    if spec.type == "number":
        return spec.minimum if spec.minimum is not None and spec.minimum > 0 else 0
    if spec.type == "boolean":
        return False
    return spec.options[0] if spec.options else ""


@dataclass(frozen=True, slots=True)
class InitialState:
    """How a device is when the world begins; `holds` is a machine's stock or a robot's load, None as usual.

    Without `chance` all takes its middle time, and what happens by odds happens evenly; faults have their own, so that
    a fault more changes nothing else. `paces` say of a method how many times as long as its model it takes.
    """

    readings: Mapping[str, Scalar] = field(default_factory=dict)
    holds: Mapping[str, int] | None = None
    faults: tuple[Fault, ...] = ()
    remembered: tuple[AckMessage, ...] = ()
    behaviour: Behaviour = field(default_factory=Behaviour)
    paces: Mapping[str, float] = field(default_factory=dict)
    chance: Chance | None = None
    fault_chance: Chance | None = None


class Actor(ABC):
    """A simulated device. Frozen while paused (by a command), held (by the site's stop) or stopped (by a fault)."""

    def __init__(self, description: Description, emit: Emit, initial: InitialState) -> None:
        self.description = description
        known = initial.readings
        self.readings = {p.name: known.get(p.name, starting_value(p)) for p in description.properties}
        self.behaviour = initial.behaviour
        self.paces = initial.paces
        self._chance = initial.chance
        self.ledger = AnswerLedger(initial.remembered)
        self.held = False
        self._pauses: list[str] = []
        self._emit = emit
        self.troubles = Troubles(initial.faults)
        self._fault_chance = initial.fault_chance
        self._drawn: dict[str, None] = {}
        self._late: list[tuple[float, AckMessage]] = []
        self._true_readings: dict[str, Scalar] = {}
        self._untold: dict[str, None] = {}

    @property
    @abstractmethod
    def busy(self) -> bool:
        """True while a command is under way."""

    @abstractmethod
    def _take_on(self, t_s: float, method: str, arguments: Mapping[str, object], command: str) -> str:
        """Begin or queue a command whose arguments fit; return why not, or an empty text."""

    @abstractmethod
    def _cancel(self, t_s: float, command: str) -> None:
        """End a command that is under way, or all of them when the id is empty."""

    @property
    def paused(self) -> bool:
        """True while a command is under way that was paused, or everything was; a pause ends with its command."""
        return any(not command or self.ledger.is_under_way(command) for command in self._pauses)

    @property
    def frozen(self) -> bool:
        """True while the device stands still whatever its commands are."""
        return self.paused or self.held or self.troubles.has("stop", "dead")

    @property
    def is_silent(self) -> bool:
        """True while nothing that the device says is heard."""
        return self.troubles.has("offline", "dead")

    @property
    def awaits_time(self) -> bool:
        """True when time alone brings something about: a fault begins or ends, or a late answer is due."""
        return bool(self._late) or self.troubles.wait_for_time

    def command(self, t_s: float, method: str, arguments: Mapping[str, object], command: str) -> None:
        """Take a command in; what comes of it is emitted."""
        self.notice_faults(t_s)
        known = self.ledger.find(command)
        if known is None and method not in CONTROLS and self.troubles.hang_on_chance and self._is_first(command):
            chance = None if self._fault_chance is None else self._fault_chance()
            self._befall(t_s, self.troubles.draw(t_s, chance))
        if self.is_silent or self.troubles.has("deaf"):
            return
        if known is not None:
            self._utter(t_s, known)
        elif method in CONTROLS:
            self._control(t_s, method, arguments, command)
        elif why := self._refusal(t_s, method, arguments, command):
            self._say(t_s, AckMessage(command, "REJECTED", why))

    def notice_faults(self, t_s: float) -> None:
        """Let the faults begin and end whose time has come, and say the late answers that are due."""
        begun, over = self.troubles.pass_time(t_s)
        self._befall(t_s, begun)
        for fault in over:
            self._recover(t_s, fault)
        while self._late and self._late[0][0] <= t_s + 1e-9:
            _, ack = self._late.pop(0)
            if not self.is_silent:
                self._emit_ack(t_s, ack)

    def reach(self, t_s: float, step: str, count: int) -> None:
        """Let the faults begin that wait for this step of the program."""
        self._befall(t_s, self.troubles.reach(t_s, step, count))

    def _is_first(self, command: str) -> bool:
        """Tell whether a command comes for the first time, and remember it: one that is not heard leaves no answer."""
        if command in self._drawn:
            return False
        self._drawn[command] = None
        if len(self._drawn) > REMEMBERED:
            del self._drawn[next(iter(self._drawn))]
        return True

    def _befall(self, t_s: float, faults: Iterable[Fault]) -> None:
        for fault in faults:
            self._emit(FaultBegan(t_s, fault))
            if fault.kind == "wrong_value" and fault.name in self.readings:
                self._true_readings.setdefault(fault.name, self.readings[fault.name])
                self._show(t_s, fault.name, fault.value)

    def _recover(self, t_s: float, fault: Fault) -> None:
        """Say after a fault what was not said in it."""
        if fault.kind == "wrong_value":
            self._show_again(t_s, fault.name)
        if not self.is_silent:
            untold, self._untold = list(self._untold), {}
            for name in untold:
                self._emit(PropertyChanged(t_s, self.description.id, name, self.readings[name]))

    def _show_again(self, t_s: float, name: str) -> None:
        """Show a property after a wrong value of it is over: what another fault says of it, or what is true."""
        other = self.troubles.find("wrong_value", name)
        if other is not None:
            self._show(t_s, name, other.value)
        elif name in self._true_readings:
            self._show(t_s, name, self._true_readings.pop(name))

    def read(self, t_s: float, name: str, value: Scalar) -> None:
        """Set a reading that the device offers; a change is emitted."""
        if name in self._true_readings:
            self._true_readings[name] = value
        elif name in self.readings:
            self._show(t_s, name, value)

    def _show(self, t_s: float, name: str, value: Scalar) -> None:
        if self.readings[name] == value:
            return
        self.readings[name] = value
        if self.is_silent:
            self._untold[name] = None
        else:
            self._emit(PropertyChanged(t_s, self.description.id, name, value))

    def _lasts_s(self, name: str, method: MethodSpec | None, arguments: Mapping[str, object]) -> float:
        """Return how long a job takes: what its arguments say, all else with the spread of its kind; times its pace."""
        pace = self.paces.get(name, 1.0)
        said_s = None if method is None else duration_s(method, arguments)
        if said_s is not None:
            return pace * said_s
        usual_s, spread = pace * self.behaviour.job_s, self.behaviour.spread
        return usual_s if self._chance is None else usual_s * (1 + spread * (2 * self._chance() - 1))

    def _refusal(self, t_s: float, method: str, arguments: Mapping[str, object], command: str) -> str:
        spec = self.description.method(method)
        if spec is None:
            known = ", ".join(m.name for m in self.description.methods) or "nothing"
            return f"{self.description.name} cannot {method}; it can: {known}."
        if why := refusal_of_arguments(spec, arguments):
            return why
        return self._take_on(t_s, method, arguments, command)

    def _control(self, t_s: float, method: str, arguments: Mapping[str, object], command: str) -> None:
        named = arguments.get("command")
        target = named if isinstance(named, str) else ""
        if method == "cancel":
            self._cancel_named(t_s, named)
        elif method == "pause":
            self._pauses = [*self._pauses, target][-REMEMBERED:]
        else:
            self._pauses = [command for command in self._pauses if target not in {"", command}]
        self._say(t_s, AckMessage(command, "DONE"))

    def _cancel_named(self, t_s: float, target: object) -> None:
        if target is None or target == "":
            self._cancel(t_s, "")
        elif isinstance(target, str) and self.ledger.is_under_way(target):
            self._cancel(t_s, target)
        elif isinstance(target, str) and self.ledger.find(target) is None:
            # The command that was cancelled may still be on its way here: it must not be carried out when it comes.
            self.ledger.note(AckMessage(target, "CANCELED", "It was cancelled before it arrived."))

    def _say(self, t_s: float, ack: AckMessage) -> None:
        self.ledger.note(ack)
        if self.is_silent or (ack.is_final and self.troubles.spend("lose_ack") is not None):
            return
        self._utter(t_s, ack)

    def _utter(self, t_s: float, ack: AckMessage) -> None:
        """Let an answer out: now, late, or twice."""
        late = self.troubles.find("late")
        if late is not None:
            self._late = sorted([*self._late, (t_s + late.after_s, ack)], key=lambda item: item[0])
            return
        self._emit_ack(t_s, ack)
        if ack.is_final and self.troubles.spend("doubled") is not None:
            self._emit_ack(t_s, ack)

    def _emit_ack(self, t_s: float, ack: AckMessage) -> None:
        self._emit(Ack(t_s, self.description.id, ack.command, ack.status, ack.why, ack.result))

    def _say_done(self, t_s: float, command: str, result: Mapping[str, Scalar] | None = None) -> bool:
        """Say that a command succeeded, unless a fault makes it fail; True if it succeeded."""
        fault = self.troubles.spend("fail_next")
        if fault is not None:
            why = fault.error or f"{self.description.name} broke down (a fault on purpose)."
            self._say(t_s, AckMessage(command, "FAILED", why))
            return False
        self._say(t_s, AckMessage(command, "DONE", result=result or {}))
        return True

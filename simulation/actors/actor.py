"""What every simulated device has in common: answers, readings, pause and cancel, and faults on purpose."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from simulation.behaviour import Behaviour
from simulation.world import Ack, Fault, PropertyChanged, WorldEvent
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

    Without `chance` all takes its middle time, and what happens by odds happens evenly.
    """

    readings: Mapping[str, Scalar] = field(default_factory=dict)
    holds: Mapping[str, int] | None = None
    faults: tuple[Fault, ...] = ()
    remembered: tuple[AckMessage, ...] = ()
    behaviour: Behaviour = field(default_factory=Behaviour)
    chance: Chance | None = None


class Actor(ABC):
    """A simulated device. Frozen while paused (by a command), held (by the site's stop) or stopped (by a fault)."""

    def __init__(self, description: Description, emit: Emit, initial: InitialState) -> None:
        self.description = description
        known = initial.readings
        self.readings = {p.name: known.get(p.name, starting_value(p)) for p in description.properties}
        self.behaviour = initial.behaviour
        self._chance = initial.chance
        self.ledger = AnswerLedger(initial.remembered)
        self.held = False
        self._pauses: list[str] = []
        self._emit = emit
        self._waiting_faults = sorted(initial.faults, key=lambda f: f.at_s)
        self._faults: set[str] = set()

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
        return self.paused or self.held or "stop" in self._faults

    def command(self, t_s: float, method: str, arguments: Mapping[str, object], command: str) -> None:
        """Take a command in; what comes of it is emitted."""
        self.notice_faults(t_s)
        if "offline" in self._faults:
            return
        if known := self.ledger.find(command):
            self._emit_ack(t_s, known)
        elif method in CONTROLS:
            self._control(t_s, method, arguments, command)
        elif why := self._refusal(t_s, method, arguments, command):
            self._say(t_s, AckMessage(command, "REJECTED", why))

    def notice_faults(self, t_s: float) -> None:
        """Let the faults begin whose time has come."""
        while self._waiting_faults and self._waiting_faults[0].at_s <= t_s:
            self._faults.add(self._waiting_faults.pop(0).kind)

    def read(self, t_s: float, name: str, value: Scalar) -> None:
        """Set a reading that the device offers; a change is emitted."""
        if name in self.readings and self.readings[name] != value:
            self.readings[name] = value
            if "offline" not in self._faults:
                self._emit(PropertyChanged(t_s, self.description.id, name, value))

    def _lasts_s(self, method: MethodSpec | None, arguments: Mapping[str, object]) -> float:
        """Return how long a job takes: what its arguments say to the second, all else with the spread of its kind."""
        said_s = None if method is None else duration_s(method, arguments)
        if said_s is not None:
            return said_s
        usual_s, spread = self.behaviour.job_s, self.behaviour.spread
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
        if "offline" in self._faults:
            return
        if ack.is_final and "lose_ack" in self._faults:
            self._faults.discard("lose_ack")
            return
        self._emit_ack(t_s, ack)

    def _emit_ack(self, t_s: float, ack: AckMessage) -> None:
        self._emit(Ack(t_s, self.description.id, ack.command, ack.status, ack.why, ack.result))

    def _say_done(self, t_s: float, command: str, result: Mapping[str, Scalar] | None = None) -> bool:
        """Say that a command succeeded, unless a fault makes it fail; True if it succeeded."""
        if "fail_next" in self._faults:
            self._faults.discard("fail_next")
            self._say(t_s, AckMessage(command, "FAILED", f"{self.description.name} broke down (a fault on purpose)."))
            return False
        self._say(t_s, AckMessage(command, "DONE", result=result or {}))
        return True

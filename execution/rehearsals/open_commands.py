"""Commands of a rehearsal that have no final answer: sent again as gateways do, where a fault may lose a message."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass

from execution.floor_protocol import again_after_s
from execution.traffic.messages import CONTROLS, SendCommand
from simulation.world import Ack, Fault, World

LOSING = frozenset({"offline", "dead", "deaf", "lose_ack"})
"""Faults by which a device misses a command, or nobody hears its answer."""


@dataclass(slots=True)
class _Open:
    command: SendCommand
    due_s: float
    tries: int = 0
    is_answered: bool = False


class OpenCommands:
    """Sends commands in order, and again until they are over; without faults that lose messages each goes out once.

    So it does to `idless` devices, by id, which would carry a command out anew each time that they hear it.
    """

    def __init__(self, world: World, faults: Iterable[Fault], idless: Collection[str] = ()) -> None:
        self.world = world
        self._idless = idless
        self._may_lose = any(fault.kind in LOSING for fault in faults)
        self._open: dict[str, _Open] = {}

    def send(self, command: SendCommand) -> None:
        """Send a command now, or when the device has answered the one before."""
        if not self._may_lose or command.device in self._idless:
            self._tell(command)
            return
        self._open[command.id] = _Open(command, self.world.time_s)
        self.send_due()

    def answered(self, ack: Ack) -> None:
        """Take in an answer: what is accepted is asked for again more seldom, what is over never."""
        kept = self._open.get(ack.command)
        if kept is None:
            return
        if ack.is_final:
            del self._open[ack.command]
            return
        kept.is_answered = True
        kept.due_s = self.world.time_s + again_after_s(kept.tries, is_answered=True)

    def send_due(self) -> None:
        """Send what is due; a device gets no command before it has answered those that come before."""
        waiting: set[str] = set()
        for kept in self._open.values():
            command = kept.command
            is_control = command.method in CONTROLS
            if kept.due_s <= self.world.time_s + 1e-9 and (is_control or command.device not in waiting):
                kept.tries += 1
                kept.due_s = self.world.time_s + again_after_s(kept.tries, is_answered=kept.is_answered)
                self._tell(command)
            if not kept.is_answered and not is_control:
                waiting.add(command.device)

    def _tell(self, command: SendCommand) -> None:
        self.world.command(command.device, command.method, command.arguments, command.id)

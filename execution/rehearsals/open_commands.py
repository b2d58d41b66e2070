"""Commands of a rehearsal that have no final answer: sent again as gateways do, where a fault may lose a message."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from execution.floor_protocol import ASKED_AFTER_S, FIRST_RETRY_S, LAST_RETRY_S
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
    """Sends commands in order, and again until they are over; without faults that lose messages each goes out once."""

    def __init__(self, world: World, faults: Iterable[Fault]) -> None:
        self.world = world
        self._may_lose = any(fault.kind in LOSING for fault in faults)
        self._open: dict[str, _Open] = {}

    def send(self, command: SendCommand) -> None:
        """Send a command now, or when the device has answered the one before."""
        if not self._may_lose:
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
        kept.due_s = self.world.time_s + ASKED_AFTER_S[min(kept.tries, len(ASKED_AFTER_S)) - 1]

    def send_due(self) -> None:
        """Send what is due; a device gets no command before it has answered those that come before."""
        waiting: set[str] = set()
        for kept in self._open.values():
            command = kept.command
            is_control = command.method in CONTROLS
            if kept.due_s <= self.world.time_s + 1e-9 and (is_control or command.device not in waiting):
                kept.tries += 1
                wait_s = ASKED_AFTER_S[-1] if kept.is_answered else FIRST_RETRY_S * 2 ** (kept.tries - 1)
                kept.due_s = self.world.time_s + min(LAST_RETRY_S, wait_s)
                self._tell(command)
            if not kept.is_answered and not is_control:
                waiting.add(command.device)

    def _tell(self, command: SendCommand) -> None:
        self.world.command(command.device, command.method, command.arguments, command.id)

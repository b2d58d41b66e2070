"""What a device remembers of its commands, so that a repeated one is answered again and not carried out again."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from simulation.world import AckStatus
from vipo_device.protocol.description import Scalar

REMEMBERED = 16


@dataclass(frozen=True, slots=True)
class Answer:
    """The last word about a command."""

    status: AckStatus
    why: str = ""
    result: Mapping[str, Scalar] = field(default_factory=dict)


class Ledger:
    """Commands that are under way, and the last 16 that are over."""

    def __init__(self, remembered: Mapping[str, Answer] | None = None) -> None:
        self._over: dict[str, Answer] = dict(remembered or {})
        self._under_way: dict[str, Answer] = {}

    def answer(self, command: str) -> Answer | None:
        """Return the last word about a command, or None when it is new."""
        return self._under_way.get(command) or self._over.get(command)

    def is_under_way(self, command: str) -> bool:
        """Tell whether the command has begun and has no final answer yet."""
        return command in self._under_way

    def note(self, command: str, answer: Answer) -> None:
        """Keep what was said; a final answer closes the command and pushes the oldest one out."""
        if answer.status in {"ACCEPTED", "RUNNING"}:
            self._under_way[command] = answer
            return
        self._under_way.pop(command, None)
        self._over[command] = answer
        while len(self._over) > REMEMBERED:
            del self._over[next(iter(self._over))]

    def under_way(self) -> tuple[str, ...]:
        """Return the commands that have no final answer yet."""
        return tuple(self._under_way)

    def over(self) -> dict[str, Answer]:
        """Return the remembered final answers, oldest first."""
        return dict(self._over)

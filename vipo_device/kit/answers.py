"""A device's answers to its commands: a command that comes again is answered again, and not carried out again."""

from __future__ import annotations

from collections.abc import Iterable

from vipo_device.protocol.messages import AckMessage

REMEMBERED = 16


class AnswerLedger:
    """The last answer to each open command, and to the last 16 that are over."""

    def __init__(self, over: Iterable[AckMessage] = (), under_way: Iterable[AckMessage] = ()) -> None:
        self._over = {ack.command: ack for ack in over}
        self._under_way = {ack.command: ack for ack in under_way}

    def find(self, command: str) -> AckMessage | None:
        """Return the last answer to a command, None when it is new."""
        return self._under_way.get(command) or self._over.get(command)

    def is_under_way(self, command: str) -> bool:
        """Tell whether the command has begun and has no final answer yet."""
        return command in self._under_way

    def is_over(self, command: str) -> bool:
        """Tell whether the command has its final answer, as far as that is remembered."""
        return command in self._over and command not in self._under_way

    def note(self, ack: AckMessage) -> None:
        """Keep an answer; a final one closes its command and pushes the oldest final one out."""
        if not ack.is_final:
            self._under_way[ack.command] = ack
            return
        self._under_way.pop(ack.command, None)
        self._over[ack.command] = ack
        while len(self._over) > REMEMBERED:
            del self._over[next(iter(self._over))]

    def over(self) -> tuple[AckMessage, ...]:
        """Return the final answers that are remembered, the oldest first."""
        return tuple(self._over.values())

    def under_way(self) -> tuple[AckMessage, ...]:
        """Return the last answers to the commands that are not over."""
        return tuple(self._under_way.values())

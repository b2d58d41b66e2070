"""What a device remembers of the commands that it has answered."""

from __future__ import annotations

from math import isfinite

from vipo_device.protocol.messages import AckMessage

REMEMBERED = 16
OPEN = frozenset({"ACCEPTED", "RUNNING"})


def is_number(value: object) -> bool:
    """Tell whether a value is a finite number and not a truth value."""
    return isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value)


class Answers:
    """The last word about each open command, and about the last 16 that are over."""

    def __init__(self, over: tuple[AckMessage, ...] = (), under_way: tuple[AckMessage, ...] = ()) -> None:
        self._over = {ack.command: ack for ack in over}
        self._under_way = {ack.command: ack for ack in under_way}

    def find(self, command: str) -> AckMessage | None:
        """Return the last word about a command, None when nothing was said."""
        return self._under_way.get(command) or self._over.get(command)

    def note(self, ack: AckMessage) -> None:
        """Keep what is said; a final answer closes the command and pushes the oldest one out."""
        if ack.status in OPEN:
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
        """Return the last words about what is not over."""
        return tuple(self._under_way.values())

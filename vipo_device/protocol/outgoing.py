"""A message on its way to the broker, and until when it may go."""

from __future__ import annotations

from math import inf
from typing import NamedTuple

from vipo_device.protocol.clock import steady_s


class Limits(NamedTuple):
    """From when on a message must not go out, and not be delivered, any more; both by `steady_s`."""

    until_s: float = inf
    ends_s: float = inf

    @property
    def is_late(self) -> bool:
        """Tell whether it must not go out now."""
        return steady_s() >= self.until_s

    @property
    def rest_s(self) -> float:
        """For how long it may be delivered from now on."""
        return self.ends_s - steady_s()


NONE = Limits()


def limits_of(expiry_s: float | None, wait_s: float | None) -> Limits:
    """Return the limits of a message that is delivered within `expiry_s` from now, and goes out within `wait_s`."""
    if expiry_s is None and wait_s is None:
        return NONE
    now_s = steady_s()
    ends_s = inf if expiry_s is None else now_s + expiry_s
    return Limits(ends_s if wait_s is None else min(ends_s, now_s + wait_s), ends_s)


class Outgoing(NamedTuple):
    """A message."""

    topic: str
    payload: bytes
    qos: int
    retain: bool
    limits: Limits

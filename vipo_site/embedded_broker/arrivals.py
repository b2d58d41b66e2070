"""How often somebody may come in to the embedded broker: each time costs questions to the database, and others wait."""

from __future__ import annotations

from collections import OrderedDict

from execution.gateway.queue import TokenBucket

COMES_PER_S, COMES_AT_ONCE = 1.0, 30.0
MOST_KNOWN = 5_000
SERVER = "server"
Name = tuple[str, str]


class Arrivals:
    """Whoever came in, or was refused, too often of late waits; the registry is not asked about them meanwhile.

    Only those that had the right key count against a user name, so that no stranger keeps a device out; those that had
    a wrong one count against the name and their own address. VIPO's own connections are not bounded.
    """

    def __init__(self) -> None:
        self._buckets: OrderedDict[Name, TokenBucket] = OrderedDict()

    def may_come(self, username: str, address: str, now: float) -> bool:
        """Tell whether somebody may try to come in; `now` in seconds of a clock that only goes forward."""
        known = [self._buckets[name] for name in ((username, ""), (username, address)) if name in self._buckets]
        return username == SERVER or all(bucket.has_one(now) for bucket in known)

    def note_admitted(self, username: str, now: float) -> None:
        """Count somebody who came in."""
        self._bucket((username, ""), now).take(now)

    def note_refused(self, username: str, address: str, now: float) -> None:
        """Count somebody who was refused."""
        self._bucket((username, address), now).take(now)

    def _bucket(self, name: Name, now: float) -> TokenBucket:
        bucket = self._buckets.pop(name, None) or TokenBucket(COMES_PER_S, COMES_AT_ONCE, COMES_AT_ONCE, now)
        self._buckets[name] = bucket
        if len(self._buckets) > MOST_KNOWN:
            self._buckets.popitem(last=False)
        return bucket

"""What devices say until it is handled: in order, held back when it is too much, counted when it is dropped."""

from __future__ import annotations

import json
import threading
from collections import Counter, OrderedDict, deque
from collections.abc import Hashable
from dataclasses import dataclass, field
from time import monotonic

from vipo_device.protocol.messages import MAX_BYTES
from vipo_device.protocol.mqtt_client import Message

INBOX_LIMIT = 20_000
ROOM_FOR_KEPT = 2_000
"""So many places are for what the broker keeps until it is acknowledged (QoS 1): it has 1,000 of a gateway under way,
and once more as many after a new connection. What finds no place is not sent again before the next one."""
MESSAGES_PER_S = 50.0
BURST = 200.0
ENROLMENTS_PER_S = 1.0
ENROLMENTS_AT_ONCE = 20.0
KNOWN_DEVICES = 5_000
COMPLAINT_EVERY_S = 60.0
COMPLAINTS_AT_ONCE = 6.0


@dataclass(slots=True)
class TokenBucket:
    """Allows `rate` messages a second on average and `burst` at once; time is an argument."""

    rate: float = MESSAGES_PER_S
    burst: float = BURST
    tokens: float = BURST
    filled_at: float = 0.0

    def take(self, now: float) -> bool:
        """Take one token if there is one; `now` in seconds of a clock that only goes forward."""
        if not self.has_one(now):
            return False
        self.tokens -= 1
        return True

    def has_one(self, now: float) -> bool:
        """Tell whether there is a token, without taking it."""
        self.tokens = min(self.burst, self.tokens + (now - self.filled_at) * self.rate)
        self.filled_at = now
        return self.tokens >= 1


def new_bucket(name: str) -> TokenBucket:
    """Return a device's bucket, or that of a site's enrolments (`join:…`): whoever asks there may be a stranger."""
    rate, burst = (ENROLMENTS_PER_S, ENROLMENTS_AT_ONCE) if name.startswith("join:") else (MESSAGES_PER_S, BURST)
    return TokenBucket(rate, burst, burst, monotonic())


@dataclass(slots=True)
class Entry:
    """A message that waits to be handled."""

    message: Message
    device: str
    kind: str
    outdated: bool = False
    stand_in: bool = False
    """The device's stand-in says it."""
    _told: tuple[int, int, bool] | None = field(default=None, init=False, repr=False)
    _is_read: bool = field(default=False, init=False, repr=False)

    def outdates(self, older: Entry) -> bool:
        """Tell whether of two states that wait this one says all that the older one did.

        A turn of the done flag is news by itself: by it devices that know nothing else answer commands.
        """
        told, before = self._read(), older._read()
        if told is None or before is None:
            return told is before
        return told[2] is before[2] and told[:2] >= before[:2]

    def _read(self) -> tuple[int, int, bool] | None:
        """Return a state's (boot, seq, done), read but once; None for what will be refused."""
        if not self._is_read:
            self._told, self._is_read = _order_and_flag(self.message.payload), True
        return self._told


def _order_and_flag(payload: bytes) -> tuple[int, int, bool] | None:
    """Read what orders a state, and its done flag, in a few microseconds; all else is checked when it is taken in."""
    try:
        body = json.loads(payload) if len(payload) <= MAX_BYTES else None
    except (ValueError, RecursionError):
        return None
    if not isinstance(body, dict):
        return None
    boot, seq, done = body.get("boot"), body.get("seq"), body.get("done")
    return (boot, seq, done) if isinstance(boot, int) and isinstance(seq, int) and isinstance(done, bool) else None


class Inbox:
    """Messages in the order of their arrival; of a device's waiting states in a row that tell the same `done`, only
    the newest is to be taken in.

    Each turn of the flag is kept. A device that alternates gains nothing by it: what is outdated has its place here,
    too, and how much of it comes in a second is up to the device's bucket. What nobody keeps elsewhere (QoS 0) leaves
    the last `room_for_kept` places free.
    """

    def __init__(self, limit: int = INBOX_LIMIT, room_for_kept: int = ROOM_FOR_KEPT) -> None:
        self._entries: deque[Entry] = deque()
        self._states: dict[tuple[str, bool], Entry] = {}
        self._limit, self._room_for_kept = limit, room_for_kept
        self._changed = threading.Condition()

    def __len__(self) -> int:
        return len(self._entries)

    def put(self, entry: Entry) -> bool:
        """Add a message; False when there is no room for it."""
        room = self._limit if entry.message.qos > 0 else self._limit - self._room_for_kept
        with self._changed:
            if len(self._entries) >= room:
                return False
            if entry.kind == "state":
                older = self._states.get((entry.device, entry.stand_in))
                if older is not None and entry.outdates(older):
                    older.outdated = True
                self._states[entry.device, entry.stand_in] = entry
            self._entries.append(entry)
            self._changed.notify()
            return True

    def get_all(self, timeout_s: float, most: int) -> list[Entry]:
        """Return the messages that wait, at most so many, oldest first; none when none came in time."""
        with self._changed:
            if not self._entries:
                self._changed.wait(timeout_s)
            return [self._take_first() for _ in range(min(most, len(self._entries)))]

    def _take_first(self) -> Entry:
        entry = self._entries.popleft()
        if self._states.get((entry.device, entry.stand_in)) is entry:
            del self._states[entry.device, entry.stand_in]
        return entry


@dataclass(slots=True)
class Complaints:
    """How often each device's messages were dropped or refused, and when which reason was last written down.

    Each other reason has a line of its own, so that who mends one thing hears of the next: six at once, and one a
    minute in the long run.
    """

    counts: Counter[str] = field(default_factory=Counter)
    waiting: Counter[str] = field(default_factory=Counter)
    _written_at: OrderedDict[tuple[str, int], float] = field(default_factory=OrderedDict)
    _lines: OrderedDict[str, TokenBucket] = field(default_factory=OrderedDict)
    _dropped: Counter[str] = field(default_factory=Counter)
    _guard: threading.Lock = field(default_factory=threading.Lock)

    def take_dropped(self) -> Counter[str]:
        """Return how many messages of each device were not taken since this was asked last."""
        with self._guard:
            taken, self._dropped = self._dropped, Counter()
        return taken

    def add(self, device: str, reason: str, now: float) -> str | None:
        """Count one more; return a line for the device's history where one is due."""
        others = self.count(device, reason, now)
        return None if others is None else with_others(reason, others)

    def count(self, device: str, reason: str, now: float, kind: Hashable = None) -> int | None:
        """Count one more; where a line is due, return how many others it stands for. The same is due once a minute.

        Reasons that differ in figures alone are the same if they have the same `kind`.
        """
        with self._guard:
            self.counts[reason.split(":", 1)[0]] += 1
            self._dropped[device] += 1
            self.waiting[device] = self.waiting.pop(device, 0) + 1
            if len(self.waiting) > KNOWN_DEVICES:  # whoever asks to be enrolled may name any device
                del self.waiting[next(iter(self.waiting))]
            said = (device, hash(kind or reason))
            if now - self._written_at.get(said, -COMPLAINT_EVERY_S) < COMPLAINT_EVERY_S:
                return None
            if not self._lines_of(device, now).take(now):
                return None
            self._written_at[said] = now
            self._written_at.move_to_end(said)
            if len(self._written_at) > KNOWN_DEVICES:
                self._written_at.popitem(last=False)
            return self.waiting.pop(device) - 1

    def _lines_of(self, device: str, now: float) -> TokenBucket:
        """Return what keeps a device from filling its history."""
        most = COMPLAINTS_AT_ONCE
        lines = self._lines.pop(device, None) or TokenBucket(1 / COMPLAINT_EVERY_S, most, most, now)
        self._lines[device] = lines
        if len(self._lines) > KNOWN_DEVICES:
            self._lines.popitem(last=False)
        return lines


def with_others(reason: str, others: int) -> str:
    """Return the line for a complaint that stands for others, too."""
    return reason if not others else f"{reason} ({others} more since the last note)"

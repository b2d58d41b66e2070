"""One connection in a room: who it is, what it may do, what waits to be sent to it, and how much it may send."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from editor.rooms import yjs_protocol

KIB, MIB = 1024, 1024 * 1024
FRAMES_PER_S, BURST_FRAMES = 60.0, 600.0
BYTES_PER_S, BURST_BYTES = float(MIB), 12.0 * MIB
MOST_HELD_FRAMES, MOST_HELD_BYTES = 1000, 4 * MIB
AWARENESS_PER_S, BURST_AWARENESS = 90.0, 3000.0
"""Clients also repeat whatever others show, 30 times a second, and after a pause all that waited for them."""
PARTS_PER_S, BURST_PARTS = 20_000.0, 500_000.0
"""Of changes, values and deletions: each is read and kept in about ten microseconds, on the event loop."""
WORK_PER_S, BURST_WORK_S = 0.1, 0.5
"""So long in each second the event loop works for one person, and so long at once; then their messages wait."""
MOST_WAITING_BYTES = 24 * MIB
HELD_OFF_S, MOST_HELD_OFF_S, FORGIVEN_AFTER_S = 10.0, 300.0, 900.0
MOST_UNREAD_BYTES = 24 * MIB
"""Of what it asked for itself."""
MOST_BEHIND_BYTES = 3 * MIB
"""Of what all are told."""
LEAST_BYTES = 2 * KIB
"""As so many a smaller frame is counted: a thousand of them are work, too."""
PROBE_EVERY_BYTES = 256 * KIB
MOST_SILENT_BEATS = 6


class Close(Exception):
    """The connection is to be closed with a code (44xx: for good, 4503: come again), and why."""

    MALFORMED, SIGNED_OUT, NOT_ALLOWED, NOT_FOUND, TOO_LARGE, ABUSE = 4400, 4401, 4403, 4404, 4413, 4429
    COME_AGAIN = 4503

    def __init__(self, code: int, reason: str) -> None:
        super().__init__(reason)
        self.code = code
        self.reason = reason


POINTS = {Close.ABUSE: 300, Close.MALFORMED: 1, Close.TOO_LARGE: 1}
"""What a close for what somebody sent counts: for abuse as much as for coming back 300 times with another fault."""


def held_off_for_s(points: int) -> float:
    """Return for how long nobody is let in who was closed for so many points in a row."""
    times = points // POINTS[Close.ABUSE]
    return min(HELD_OFF_S * (1 << min(times - 1, 10)), MOST_HELD_OFF_S) if times else 0.0


@dataclass(frozen=True, slots=True)
class Person:
    """Who sits at the other end, from the session."""

    id: int
    name: str
    initials: str

    def shown(self) -> dict[str, Any]:
        """Return what others are shown of the person."""
        return {"id": self.id, "name": self.name, "initials": self.initials, "color": colour_of(self.id)}


_COLOURS = (
    *("#2a6fdb", "#c2410c", "#7c3aed", "#047857", "#be185d"),
    *("#0e7490", "#a16207", "#4d7c0f", "#9333ea", "#b91c1c"),
)


def colour_of(person: int) -> str:
    """Return the colour that stands for a person, the same everywhere."""
    return _COLOURS[person % len(_COLOURS)]


@dataclass(slots=True)
class Budget:
    """A token bucket."""

    per_s: float
    burst: float
    left: float = field(init=False)
    at: float | None = None

    def __post_init__(self) -> None:
        self.left = self.burst

    def spend(self, amount: float, now_s: float) -> bool:
        """Take from the bucket; tell whether there was enough."""
        if self.at is not None:
            self.left = min(self.burst, self.left + max(0.0, now_s - self.at) * self.per_s)
        self.at = now_s if self.at is None else max(now_s, self.at)
        self.left -= amount
        return self.left >= 0

    def wait_s(self, now_s: float) -> float:
        """Return for how long nothing will be in the bucket."""
        return 0.0 if self.at is None else max(0.0, -self.left / self.per_s - max(0.0, now_s - self.at))

    def is_full(self, now_s: float) -> bool:
        """Tell whether nothing is missing in the bucket."""
        return self.at is None or self.left + (now_s - self.at) * self.per_s >= self.burst


class Allowance:
    """What a person may cost over all connections, and for how long nobody is let in under their name after abuse."""

    def __init__(self) -> None:
        self._parts = Budget(PARTS_PER_S, BURST_PARTS)
        self._work = Budget(WORK_PER_S, BURST_WORK_S)
        self._waiting_bytes = 0
        self.connections = 0
        """How many are open."""
        self.cutting = asyncio.Lock()
        """Held while an update of the person is cut: of each person one at a time."""
        self._points = 0
        self._closed_at = 0.0

    def spend_parts(self, parts: int, now_s: float) -> None:
        """Count of how many parts the updates are that are read. Raises Close."""
        if not self._parts.spend(parts, now_s):
            raise Close(Close.ABUSE, "You send more changes than a program has. Close other copies of the page.")

    def spend_work(self, work_s: float, now_s: float) -> None:
        """Count for how long this process has been at work for the person."""
        self._work.spend(work_s, now_s)

    def rest_s(self, now_s: float) -> float:
        """Return for how long nothing more is done for the person, so that others have their turns."""
        return self._work.wait_s(now_s)

    def let_wait(self, size: int) -> None:
        """Take in that a message of so many bytes waits; with a negative size, no more. Raises Close."""
        if size > 0 and self._waiting_bytes + size > MOST_WAITING_BYTES:
            raise Close(Close.ABUSE, "You send faster than it can be read. Close other copies of the page.")
        self._waiting_bytes += size

    def note_close(self, code: int, now_s: float) -> int:
        """Take in that a connection was closed for what it had sent; return of how many points that is."""
        points = POINTS.get(code, 0)
        if points:
            self._points = self._points + points if now_s - self._closed_at < FORGIVEN_AFTER_S else points
            self._closed_at = now_s
        return points

    def held_off_s(self, now_s: float) -> float:
        """Return for how long no new connection is let in: the longer, the more often in a row."""
        return max(0.0, self._closed_at + held_off_for_s(self._points) - now_s)

    def is_like_new(self, now_s: float) -> bool:
        """Tell whether there is nothing to remember of the person."""
        is_forgiven = not self._points or now_s - self._closed_at >= FORGIVEN_AFTER_S
        is_rested = self._parts.is_full(now_s) and self._work.is_full(now_s)
        return not self.connections and is_forgiven and is_rested


class Member:
    """A connection; frames for it are queued here and sent by its socket."""

    def __init__(
        self, person: Person, *, can_write: bool, wake: Callable[[], None], is_sure: Callable[[], bool] = lambda: True
    ) -> None:
        """`wake` is called when there is something to send; `is_sure` tells whether `can_write` is of now."""
        self.person = person
        self.is_sure = is_sure
        self.can_write = can_write
        self.synced = False
        self.clients: set[int] = set()
        self.shown: int | None = None
        """The revision of the compiled form that it has, 0 for none; None while it does not look at it."""
        self.frames = 0
        """How many messages with content the connection has sent."""
        self.saved = 0
        """How many of them, from the first on, are in the database."""
        self.refused = 0
        """How many of them would have changed something, and were not taken."""
        self.shows_saved = False
        """Whether the connection wants to be told."""
        self.unsaved: deque[tuple[int, int]] = deque()
        """Numbers of messages with the room's place up to which they are saved."""
        self.not_acted_on = 0
        """How many messages of it have come and are not acted on: who is asked meanwhile sends their content again."""
        self.behind: bytes | None = None
        """Up to where it was told of the document, while it has not read that and is told nothing more."""
        self.outbox: deque[bytes] = deque()
        self.closing: Close | None = None
        self.allowance = Allowance()
        """The person's, once the connection is let in."""
        self._wake = wake
        self._held: list[bytes] = []
        self._held_bytes = 0
        self._unread = 0
        self._since_probe = 0
        self._probes: deque[int] = deque()
        self._frames = Budget(FRAMES_PER_S, BURST_FRAMES)
        self._awareness = Budget(AWARENESS_PER_S, BURST_AWARENESS)
        self._bytes = Budget(BYTES_PER_S, BURST_BYTES)
        self._silent_beats = 0
        self.sent_since_beat = False

    def post(self, frame: bytes) -> None:
        """Queue a frame; a client that does not read is sent away, and will ask for what it lacks."""
        if self.closing is not None:
            return
        self.outbox.append(frame)
        self.sent_since_beat = True
        size = max(len(frame), LEAST_BYTES)
        self._unread += size
        self._since_probe += size
        if self._unread > MOST_UNREAD_BYTES:
            self.close(Close(Close.COME_AGAIN, "The connection did not keep up with the changes. It begins anew."))
            return
        self._wake()

    def close(self, close: Close) -> None:
        """Have the connection closed; what was queued for it is dropped."""
        if self.closing is None:
            self.closing = close
            self.outbox.clear()
            self._wake()

    def ask_for_state(self, state: bytes) -> None:
        """Send a step 1. Its answer also tells that everything before it has been read."""
        self._probes.append(self._since_probe)
        self._since_probe = 0
        self.post(yjs_protocol.encode_step_1(state))

    @property
    def is_full(self) -> bool:
        """Whether it is to be told nothing more until it has read."""
        return self._unread > MOST_BEHIND_BYTES

    @property
    def has_caught_up(self) -> bool:
        """Whether it was behind and has now read all."""
        return self.behind is not None and not self._probes

    def beat(self) -> None:
        """Send something if nothing was sent; let one that was behind and has not answered for a minute come again."""
        if self.behind is None and not self.sent_since_beat:
            self.post(yjs_protocol.encode_awareness(()))
        self.sent_since_beat = False
        self._silent_beats += self.behind is not None
        if self._silent_beats >= MOST_SILENT_BEATS:
            self.close(Close(Close.COME_AGAIN, "The connection did not keep up with the changes. It begins anew."))

    @property
    def probe_is_due(self) -> bool:
        """Whether so much has been sent that the client should be asked to answer."""
        return self._since_probe > PROBE_EVERY_BYTES and len(self._probes) < 32

    def note_answer(self) -> None:
        """Count what the oldest question's answer says has been read."""
        self._silent_beats = 0
        if self._probes:
            self._unread = max(0, self._unread - self._probes.popleft())

    def spend_bytes(self, size: int, now_s: float) -> None:
        """Count received bytes. Raises Close."""
        if not self._bytes.spend(size + 64, now_s):
            raise Close(Close.ABUSE, "This connection sends more than 1 MiB a second. Close other copies of the page.")

    def spend_frame(self, now_s: float, cost: float = 1) -> None:
        """Count a frame that asks for work, of so many frames' cost. Raises Close."""
        if not self._frames.spend(cost, now_s):
            raise Close(Close.ABUSE, "This connection sends more than 60 messages a second.")

    def spend_awareness(self, now_s: float) -> None:
        """Count a frame about who is here, of itself or repeated. Raises Close."""
        if not self._awareness.spend(1, now_s):
            raise Close(Close.ABUSE, "This connection tells more than 90 times a second who is here.")

    def note_stored(self, place: int) -> bool:
        """Take in the place up to which the room's changes are in the database; tell whether that saves messages."""
        before = self.saved
        while self.unsaved and self.unsaved[0][1] <= place:
            self.saved = self.unsaved.popleft()[0]
        return self.saved > before

    def hold(self, update: bytes) -> None:
        """Keep an update that came before the client's step 2. Raises Close."""
        self._held.append(update)
        self._held_bytes += len(update)
        if len(self._held) > MOST_HELD_FRAMES or self._held_bytes > MOST_HELD_BYTES:
            raise Close(Close.MALFORMED, "The client sends changes and never says what it has (sync step 2).")

    def take_held(self) -> list[bytes]:
        """Hand over the updates that were held back."""
        held, self._held, self._held_bytes = self._held, [], 0
        return held

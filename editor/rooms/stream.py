"""What the processes that hold the same room tell each other, in one order for all.

Two implementations with one interface, chosen by `settings.VIPO_STREAM_URL`: in the process, and Redis Streams.
"""

from __future__ import annotations

import asyncio
import time
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import takewhile
from typing import Any, Literal, Protocol

from redis.asyncio import Redis
from redis.asyncio.retry import Retry
from redis.backoff import ExponentialBackoff
from redis.exceptions import ConnectionError as RedisConnectionError
from redis.exceptions import RedisError, ResponseError
from redis.exceptions import TimeoutError as RedisTimeout

Kind = Literal["update", "awareness", "saved", "state", "lacking", "full", "compiled", "keep"]
BEGINNING = "0"
FORMAT = 2
"""Of the notes. Processes of another version are not heard; what they save is found in the rows."""
KEPT_ENTRIES = 10_000
KEPT_SECONDS = 3600
KEPT_BYTES = 4 * 1024 * 1024
"""Of one room, and a little more: who is further behind is told of a gap, and the rows have the rest."""
_READ_AT_ONCE = 500
_MARKS = 16
_WEIGHED_ROOMS = 5_000


class StreamLost(ConnectionError):
    """The other processes cannot be reached, so nothing may be changed here."""


@dataclass(frozen=True, slots=True)
class Note:
    """What a process has to say about a room."""

    kind: Kind
    data: bytes


@dataclass(frozen=True, slots=True)
class Entry:
    """A note in the stream: where it stands and which process wrote it."""

    id: str
    origin: str
    note: Note


@dataclass(frozen=True, slots=True)
class Batch:
    """Entries in order; `gap` tells that some before them are gone, so the document must be fetched anew."""

    entries: tuple[Entry, ...]
    gap: bool = False


class RoomStream(Protocol):
    """The interface of both implementations. Every method may raise StreamLost."""

    async def append(self, room: str, origin: str, notes: Sequence[Note]) -> None:
        """Add notes at the end, in this order."""

    async def known(self, room: str, entry: str) -> str:
        """Return the id itself if the stream goes that far, else BEGINNING: it may have been emptied since."""

    async def read(self, room: str, after: str, wait_s: float) -> Batch:
        """Return what stands after an id, waiting for it if there is nothing; empty when the time is up."""

    async def forget(self, room: str, up_to: str) -> None:
        """Keep nothing before this entry: all of it is in the rows, and nobody reads there any more."""

    async def close(self) -> None:
        """Give back connections."""


@dataclass(slots=True)
class _Kept:
    """A room's last entries within one process."""

    entries: deque[Entry]
    grown: asyncio.Event
    last: tuple[int, int] = (0, 0)
    dropped: tuple[int, int] = (0, 0)
    bytes: int = 0

    def drop_first(self) -> None:
        """Forget the oldest entry."""
        gone = self.entries.popleft()
        self.bytes -= len(gone.note.data)
        self.dropped = _order(gone.id)


class MemoryStream:
    """Within one process and one event loop; a room of which nothing was said for an hour is forgotten, as in Redis."""

    def __init__(self, kept: int = KEPT_ENTRIES, kept_s: float = KEPT_SECONDS, kept_bytes: int = KEPT_BYTES) -> None:
        self._most = kept
        self._most_bytes = kept_bytes
        self._kept_ms = int(kept_s * 1000)
        self._rooms: dict[str, _Kept] = {}

    async def append(self, room: str, origin: str, notes: Sequence[Note]) -> None:
        """See RoomStream."""
        now_ms = time.time_ns() // 1_000_000
        kept = self._room(room)
        for note in notes:
            milliseconds, number = kept.last
            kept.last = (now_ms, 0) if now_ms > milliseconds else (milliseconds, number + 1)
            kept.entries.append(Entry("{}-{}".format(*kept.last), origin, note))
            kept.bytes += len(note.data)
        while len(kept.entries) > self._most or (kept.bytes > self._most_bytes and len(kept.entries) > len(notes)):
            kept.drop_first()
        kept.grown.set()
        kept.grown = asyncio.Event()
        for name in [name for name, each in self._rooms.items() if each.last[0] < now_ms - self._kept_ms]:
            del self._rooms[name]

    def _room(self, room: str) -> _Kept:
        return self._rooms.setdefault(room, _Kept(deque(), asyncio.Event(), (time.time_ns() // 1_000_000, 0)))

    async def known(self, room: str, entry: str) -> str:
        """See RoomStream."""
        return entry if room in self._rooms and entry and self._rooms[room].last >= _order(entry) else BEGINNING

    async def read(self, room: str, after: str, wait_s: float) -> Batch:
        """See RoomStream."""
        kept, place = self._room(room), _order(after)
        if not kept.entries or _order(kept.entries[-1].id) <= place:
            try:
                await asyncio.wait_for(kept.grown.wait(), wait_s)
            except TimeoutError:
                return Batch(())
        newer = tuple(takewhile(lambda entry: _order(entry.id) > place, reversed(kept.entries)))
        return Batch(newer[::-1], gap=after != BEGINNING and kept.dropped > place)

    async def forget(self, room: str, up_to: str) -> None:
        """See RoomStream."""
        kept, place = self._room(room), _order(up_to)
        while kept.entries and _order(kept.entries[0].id) < place:
            kept.drop_first()

    async def close(self) -> None:
        """Nothing to give back."""


class _Weight:
    """How many bytes of a room's entries have been read here, and some of the entries with the bytes before them."""

    def __init__(self) -> None:
        self._bytes = 0
        self._last = (0, 0)
        self._marks: deque[tuple[str, int]] = deque()

    def take(self, entries: Sequence[Entry], kept: int) -> str:
        """Count entries, each once; return the one before which nothing has to be kept, or nothing."""
        for entry in entries:
            if _order(entry.id) > self._last:
                self._last = _order(entry.id)
                if not self._marks or self._bytes - self._marks[-1][1] >= kept // _MARKS:
                    self._marks.append((entry.id, self._bytes))
                self._bytes += len(entry.note.data)
        found = ""
        while len(self._marks) > 1 and self._bytes - self._marks[1][1] >= kept:
            self._marks.popleft()
            found = self._marks[0][0]
        return found


class RedisStream:
    """Between processes: one Redis Stream for each room; each process that reads it keeps it short."""

    def __init__(self, url: str, kept: int = KEPT_ENTRIES, kept_bytes: int = KEPT_BYTES) -> None:
        self._redis: Any = Redis.from_url(
            url,
            socket_connect_timeout=3,
            socket_timeout=10,
            health_check_interval=10,
            retry=Retry(ExponentialBackoff(cap=0.5, base=0.05), 2),
            retry_on_error=[RedisConnectionError, RedisTimeout],
        )
        self._kept = kept
        self._kept_bytes = kept_bytes
        self._at_once = min(_READ_AT_ONCE, kept)
        self._doubtful: set[str] = set()
        self._weights: dict[str, _Weight] = {}

    async def append(self, room: str, origin: str, notes: Sequence[Note]) -> None:
        """See RoomStream."""
        try:
            async with self._redis.pipeline(transaction=True) as pipe:
                for note in notes:
                    fields = {"o": origin, "k": note.kind, "d": note.data}
                    pipe.xadd(_key(room), fields, maxlen=self._kept, approximate=True)
                pipe.expire(_key(room), KEPT_SECONDS)
                await pipe.execute()
        except (RedisError, OSError) as error:
            raise StreamLost(f"Redis does not answer: {error}") from error

    async def known(self, room: str, entry: str) -> str:
        """See RoomStream."""
        try:
            last = await self._redis.xinfo_stream(_key(room))
        except ResponseError:
            return BEGINNING  # there is no such stream
        except (RedisError, OSError) as error:
            raise StreamLost(f"Redis does not answer: {error}") from error
        goes_far = bool(entry) and _order(_text(last["last-generated-id"])) >= _order(entry)
        return entry if goes_far else BEGINNING

    async def read(self, room: str, after: str, wait_s: float) -> Batch:
        """See RoomStream."""
        try:
            found = await self._redis.xread({_key(room): after}, count=self._at_once, block=max(1, int(wait_s * 1000)))
            entries = tuple(_entry(key, fields) for key, fields in (found[0][1] if found else ()))
            gap = self._may_have_missed(room, after, entries) and await self._is_trimmed_past(room, after)
            if up_to := self._weigh(room, entries):
                await self._trim(room, up_to)
        except (RedisError, OSError) as error:
            self._doubtful.add(room)
            raise StreamLost(f"Redis does not answer: {error}") from error
        self._doubtful.discard(room)
        return Batch(entries, gap)

    def _may_have_missed(self, room: str, after: str, entries: Sequence[Entry]) -> bool:
        """Tell whether so much was read at once that more may have been dropped before it."""
        much = len(entries) == self._at_once or sum(len(each.note.data) for each in entries) >= self._kept_bytes
        return after != BEGINNING and (much or room in self._doubtful)

    def _weigh(self, room: str, entries: Sequence[Entry]) -> str:
        weight = self._weights.pop(room, None) or _Weight()
        self._weights[room] = weight  # at the end: those read longest ago are forgotten
        while len(self._weights) > _WEIGHED_ROOMS:
            del self._weights[next(iter(self._weights))]
        return weight.take(entries, self._kept_bytes)

    async def forget(self, room: str, up_to: str) -> None:
        """See RoomStream."""
        try:
            await self._trim(room, up_to)
        except (RedisError, OSError) as error:
            raise StreamLost(f"Redis does not answer: {error}") from error

    async def _trim(self, room: str, up_to: str) -> None:
        await self._redis.xtrim(_key(room), minid=up_to, approximate=False)

    async def _is_trimmed_past(self, room: str, after: str) -> bool:
        """Tell whether the entry after which we read is gone, and others after it perhaps too."""
        oldest = await self._redis.xrange(_key(room), count=1)
        return not oldest or _order(_text(oldest[0][0])) > _order(after)

    async def close(self) -> None:
        """Give back connections."""
        await self._redis.aclose()


def is_after(entry: str, other: str) -> bool:
    """Tell whether an entry stands behind another; ids of both implementations."""
    return _order(entry) > _order(other)


def _key(room: str) -> str:
    return f"vipo:room:{FORMAT}:{room}"


def _text(value: bytes | str) -> str:
    return value.decode() if isinstance(value, bytes) else value


def _order(entry_id: str) -> tuple[int, int]:
    milliseconds, _, number = entry_id.partition("-")
    return int(milliseconds), int(number or 0)


def _entry(key: bytes, fields: dict[bytes, bytes]) -> Entry:
    kind: Any = fields[b"k"].decode()
    return Entry(_text(key), fields[b"o"].decode(), Note(kind, fields[b"d"]))


def make_stream(url: str) -> RoomStream:
    """Return the implementation for a URL: `memory://` or `redis://…`."""
    return MemoryStream() if url.startswith("memory:") else RedisStream(url)

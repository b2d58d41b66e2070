"""Which changes of a room are known to be in the database, and which are not yet. Pure.

Each change that comes into a room takes the next place, whether it was made here or heard of another process. Processes
number their own changes, and tell which of them are stored. What a connection sent counts as saved when every change up
to its last one is stored, the others' too: it may build upon them. What another process told and has not stored for a
while is written here, since it may have died.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from editor.documents.store import Change
from editor.documents.yjs_encoding import Reader, encode_integer, encode_sized
from editor.rooms.stream import Entry, Note

ADOPTED_AFTER_S = 1.0
"""So long a change of another process may wait to be stored before it is written here."""
UNKNOWN_FOR_S = 1.0
"""So long nobody may have told of a row before it is read from the database."""
_DATABASE = ""
"""In the place of an origin: what has yet to be compared with the database."""


@dataclass(frozen=True, slots=True)
class Waiting:
    """A change that may not be in the database: the `number`th of the process `origin`, in the room since `since_s`."""

    place: int
    origin: str
    number: int
    change: Change
    since_s: float


class Ledger:
    """What has come into the room of one process, which is `mine` in the stream."""

    def __init__(self, mine: str) -> None:
        self._mine = mine
        self.place = 0
        """How many changes have come in."""
        self._waiting: dict[int, Waiting] = {}
        self._heard: dict[str, int] = {}
        self._stored: dict[str, int] = {}
        self._entries: deque[tuple[str, str, int]] = deque()
        self.stored_to = ""
        """The entry of the stream up to which every change is stored."""
        self.rows_to = 0
        """The row up to which it is known who wrote each."""
        self._rows: set[int] = set()
        self._unknown_since: float | None = None

    def know_rows(self, rows: range) -> None:
        """Take in that rows of these numbers hold changes that are or will be heard."""
        self._rows.update(row for row in rows if row > self.rows_to)
        while self.rows_to + 1 in self._rows:
            self.rows_to += 1
        self._rows = {row for row in self._rows if row > self.rows_to}

    def see_row(self, number: int, now_s: float) -> None:
        """Take in that there are rows up to a number; of those that nobody tells of, their process has died since."""
        if number <= self.rows_to:
            self._unknown_since = None
        elif self._unknown_since is None:
            self._unknown_since = now_s
        elif now_s - self._unknown_since > UNKNOWN_FOR_S:
            self._unknown_since = None
            self.doubt("", now_s)

    def add(self, change: Change, now_s: float) -> Waiting:
        """Take in a change that was made here."""
        return self._add(self._mine, self._heard.get(self._mine, 0) + 1, change, now_s)

    def hear(self, entry: str, origin: str, number: int, change: Change, now_s: float) -> None:
        """Take in the entry of a change; of this process's own, only where it stands."""
        self._entries.append((entry, origin, number))
        if origin != self._mine and number > max(self._heard.get(origin, 0), self._stored.get(origin, 0)):
            self._add(origin, number, change, now_s)
        self._advance()

    def misses(self, origin: str, number: int) -> bool:
        """Tell whether changes of a process are missing before its change of a number."""
        heard = self._heard.get(origin)
        return origin != self._mine and heard is not None and number > heard + 1

    def pass_over(self, entry: str, origin: str, number: int) -> None:
        """Take in that a change was told which nothing can be made of yet: alone it is never written here."""
        self._heard[origin] = number
        self._entries.append((entry, _DATABASE, self.last_doubt))

    def hear_all(self, entries: Iterable[Entry], now_s: float) -> None:
        """Take in entries of which the document already has what they change."""
        for entry in entries:
            match entry.note.kind:
                case "update":
                    number, change = decode_change(entry.note.data)
                    self.hear(entry.id, entry.origin, number, change, now_s)
                case "saved":
                    numbers, rows = decode_stored(entry.note.data)
                    self.know_rows(rows)
                    for origin, number in numbers.items():
                        self.note_stored(origin, number)
                case "lacking" | "full":
                    self.doubt(entry.id, now_s)

    def doubt(self, entry: str, now_s: float) -> None:
        """Take in that the document may hold what is not in the database; it is to be compared."""
        number = self._heard.get(_DATABASE, 0) + 1
        self._add(_DATABASE, number, Change(None, b""), now_s)
        if entry:
            self._entries.append((entry, _DATABASE, number))

    def _add(self, origin: str, number: int, change: Change, now_s: float) -> Waiting:
        self.place += 1
        self._heard[origin] = number
        waiting = Waiting(self.place, origin, number, change, now_s)
        self._waiting[self.place] = waiting
        return waiting

    def note_stored(self, origin: str, number: int) -> None:
        """Take in that a process's changes up to a number are stored."""
        if number > self._stored.get(origin, 0):
            self._stored[origin] = number
            gone = [place for place, each in self._waiting.items() if each.origin == origin and each.number <= number]
            for place in gone:
                del self._waiting[place]
            self._advance()

    def pass_entry(self, entry: str) -> None:
        """Take in an entry that is no change."""
        if not self._entries:
            self.stored_to = entry

    def _advance(self) -> None:
        while self._entries and self._entries[0][2] <= self._stored.get(self._entries[0][1], 0):
            self.stored_to = self._entries.popleft()[0]

    @property
    def stored_place(self) -> int:
        """The place up to which every change is stored."""
        return next(iter(self._waiting), self.place + 1) - 1

    def is_stored_later(self, place: int) -> bool:
        """Tell whether of the changes up to a place some wait to be stored by their processes, or by this one."""
        return any(each.place <= place and each.origin != _DATABASE for each in self._waiting.values())

    def own(self) -> list[Waiting]:
        """Return the changes that this process has yet to store."""
        return [each for each in self._waiting.values() if each.origin == self._mine]

    def adoptable(self, now_s: float) -> list[Waiting]:
        """Return what other processes have told and should have stored by now."""
        before = now_s - ADOPTED_AFTER_S
        return [each for each in self._waiting.values() if each.since_s <= before and self._is_others(each.origin)]

    def _is_others(self, origin: str) -> bool:
        return origin not in (self._mine, _DATABASE)

    @property
    def doubts(self) -> int:
        """How many doubts are not settled."""
        return self._heard.get(_DATABASE, 0) - self._stored.get(_DATABASE, 0)

    def settle(self, doubts_until: int) -> None:
        """Take in that the document as it was after so many doubts is in the database."""
        self.note_stored(_DATABASE, doubts_until)

    @property
    def last_doubt(self) -> int:
        """The number of the last doubt."""
        return self._heard.get(_DATABASE, 0)


def encode_change(number: int, change: Change) -> Note:
    """Return the note that tells the other processes of a change."""
    author = encode_integer(0 if change.author is None else change.author + 1)
    return Note("update", encode_integer(number) + author + change.update)


def decode_change(data: bytes) -> tuple[int, Change]:
    """Return the number of a told change, and the change. Raises BadFrame."""
    reader = Reader(data)
    number, author = reader.integer(), reader.integer()
    return number, Change(author - 1 if author else None, reader.rest())


def updates_of(entries: Iterable[Entry]) -> list[bytes]:
    """Return what entries of a stream hold of the document. Raises BadFrame."""
    return [
        decode_change(entry.note.data)[1].update if entry.note.kind == "update" else entry.note.data
        for entry in entries
        if entry.note.kind in {"update", "lacking", "full"}
    ]


def last_numbers(stored: Sequence[Waiting]) -> dict[str, int]:
    """Return for each process the number of the last of these changes."""
    return {each.origin: each.number for each in stored}


def encode_stored(numbers: dict[str, int], rows: range) -> Note:
    """Return the note that tells up to which numbers processes' changes are stored, and in which rows the last ones."""
    parts = b"".join(encode_sized(origin.encode()) + encode_integer(number) for origin, number in numbers.items())
    return Note("saved", encode_integer(rows.start) + encode_integer(len(rows)) + encode_integer(len(numbers)) + parts)


def decode_stored(data: bytes) -> tuple[dict[str, int], range]:
    """Return the numbers and the rows of such a note. Raises BadFrame."""
    reader = Reader(data)
    first, rows, count = reader.integer(), reader.integer(), reader.integer()
    return {reader.sized(100).decode(): reader.integer() for _ in range(count)}, range(first, first + rows)

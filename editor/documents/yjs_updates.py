"""Whether a client's Yjs update can be given to pycrdt, read with bounds before it is. Pure.

What reads updates there goes down with the process when values are nested without end or clocks run over, takes
minutes for a hundred thousand authors in one update, and keeps roots that no document has. This reads the first version
of Yjs' encoding once from its beginning to its end, keeps nothing, and refuses what no client of a program would send.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass

from editor.documents.knowledge import Knowledge, Ranges, joined_ranges
from editor.documents.yjs_encoding import BadFrame, Reader

ROOTS = ("meta", "steps", "functions", "roles", "parameters", "zones")
"""The parts that a program has."""
ROOTS_AS_BYTES = frozenset(root.encode() for root in ROOTS)
MOST_CLIENTS, MOST_CLIENTS_OF_ALL = 200, 5_000
"""Whose changes one edit may bring, and whose all that somebody has; their deletions may be of everybody's."""
MOST_CLIENTS_EVER = 20_000
"""Who have ever changed a document: each page that was opened and drawn in is one."""
MOST_PARTS = 500_000
"""Changes, values and deletions in one update: read in about two seconds. A full program of 5,000 steps has 200,000."""
MOST_VALUES = 20_000
"""In one change, which is applied in one go."""
MOST_CLOCK = 2**31 - 1
DEEPEST = 100
"""How deep a value may be nested, as in every JSON body."""
MOST_NESTED = 16
"""How deep shared maps, arrays and texts may stand in each other; a program's stand in four."""
KIND, SKIPPED, _GONE = 0x1F, 10, 0
_HAS_ORIGIN, _HAS_RIGHT_ORIGIN, _HAS_KEY = 0x80, 0x40, 0x20
_SHARED_TYPES = frozenset({0, 1, 2})
"""Array, map and text."""
_FIXED_BYTES = {127: 0, 126: 0, 124: 4, 123: 8, 122: 8, 121: 0, 120: 0}
_INTEGER, _STRING, _OBJECT, _ARRAY, _BYTES = 125, 119, 118, 117, 116

Place = tuple[int, int]
"""A change by its client and clock."""


@dataclass(frozen=True, slots=True)
class ReadChange:
    """A change of a client, of its clocks from `first` until before `end`: where its bytes begin and end.

    `beside` are the changes that it stands beside or in.
    """

    client: int
    first: int
    end: int
    at: int
    until: int
    beside: tuple[Place, ...]
    is_skipped: bool


class UpdateReader(Reader):
    """Reads an update, and counts of how many parts it is."""

    parts = 0
    beside: tuple[Place, ...] = ()
    """What the change that was read last stands beside or in."""

    @property
    def at(self) -> int:
        """How many bytes have been read."""
        return self._at

    def count(self, most: int = MOST_PARTS) -> int:
        """Read how many of something follow."""
        number = self.integer()
        self.parts += number
        if number > min(self.left, most) or self.parts > MOST_PARTS:
            raise BadFrame("It says that it has more parts than it has, or than are taken at once.")
        return number


def check_update(
    update: bytes,
    roots: Collection[bytes],
    most_clients: int = MOST_CLIENTS,
    spend: Callable[[int], None] | None = None,
    note: Callable[[ReadChange], None] | None = None,
) -> Knowledge:
    """Return how far an update goes: the clock until which it has each client's changes, and what it deletes.

    `spend` is told of how many parts it is, `note` of each change. Raises BadFrame unless it is well-formed, of these
    roots and within the bounds, and what `spend` raises.
    """
    reader = UpdateReader(update)
    depths: dict[Place, int] = {}
    ends: dict[int, int] = {}
    begins: dict[int, int] = {}
    needs: dict[int, int] = {}
    for _ in range(reader.count(most_clients)):
        number, client, clock = reader.count(), reader.integer(), reader.integer()
        if client in begins:
            raise BadFrame("It names a client twice.")
        begins[client] = clock
        for _ in range(number):
            is_skipped, first, begin = reader.peek() & KIND == SKIPPED, clock, reader.at
            clock = _checked(clock + _read_change(reader, (client, clock), depths, roots))
            if is_skipped:
                begins[client] = clock
            for other, other_clock in reader.beside:
                needs[other] = max(needs.get(other, 0), other_clock + 1)
            if note is not None:
                note(ReadChange(client, first, clock, begin, reader.at, reader.beside, is_skipped))
        ends[client] = clock
    deletions = _read_deletions(reader)
    reader.end()
    if spend is not None:
        spend(reader.parts)
    beyond = {client: end for client, end in needs.items() if end > ends.get(client, 0)}
    return Knowledge(ends, deletions, begins, beyond)


def _read_deletions(reader: UpdateReader) -> dict[int, Ranges]:
    deletions: dict[int, Ranges] = {}
    for _ in range(reader.count()):  # a client that comes back sends all deletions there ever were, of everybody
        client = reader.integer()
        pairs = [(reader.integer(), reader.integer()) for _ in range(reader.count())]
        deletions[client] = joined_ranges((first, _checked(first + length)) for first, length in pairs)
    return deletions


def _checked(clock: int) -> int:
    if clock > MOST_CLOCK:
        raise BadFrame("A clock in it runs over.")
    return clock


def _read_change(reader: UpdateReader, place: Place, depths: dict[Place, int], roots: Collection[bytes]) -> int:
    """Read one change and return how many clocks it takes."""
    info = reader.byte()
    kind = info & KIND
    if kind in (_GONE, SKIPPED):
        reader.beside = ()
        return reader.integer()
    depth = _read_parent(reader, info, depths, roots)
    if kind not in _CONTENTS:
        raise BadFrame(f"There is no content of type {kind} in a program.")
    length = _CONTENTS[kind](reader)
    if depth:
        depths[place] = depth
    return length


def _read_parent(reader: UpdateReader, info: int, depths: Mapping[Place, int], roots: Collection[bytes]) -> int:
    """Read where a change stands; return how many changes of this update it stands in."""
    beside = [(reader.integer(), reader.integer()) for side in (_HAS_ORIGIN, _HAS_RIGHT_ORIGIN) if info & side]
    reader.beside = tuple(beside)
    if beside:
        return max(depths.get(place, 0) for place in beside)
    depth = 0
    if reader.integer() == 1:
        if reader.sized(MOST_CLOCK) not in roots:
            raise BadFrame("It writes to a part that no program has.")
    else:
        parent = reader.integer(), reader.integer()
        reader.beside = (parent,)
        depth = depths.get(parent, 0) + 1
    if info & _HAS_KEY:
        reader.sized(MOST_CLOCK)
    if depth > MOST_NESTED:
        raise BadFrame("Parts of it stand too deep in each other.")
    return depth


def _read_type(reader: UpdateReader) -> int:
    if reader.integer() not in _SHARED_TYPES:
        raise BadFrame("It has a shared type that no program has.")
    return 1


def _read_sized(reader: UpdateReader) -> int:
    reader.sized(MOST_CLOCK)
    return 1


def _read_string(reader: UpdateReader) -> int:
    try:
        text = reader.sized(MOST_CLOCK).decode()
    except UnicodeDecodeError as error:
        raise BadFrame("A text in it is not UTF-8.") from error
    return len(text) + sum(character > "\uffff" for character in text)


def _read_texts(reader: UpdateReader) -> int:
    number = reader.count()
    for _ in range(number):
        reader.sized(MOST_CLOCK)
    return number


def _read_values(reader: UpdateReader) -> int:
    number, before = reader.count(), reader.parts
    for _ in range(number):
        _read_value(reader)
    if number + reader.parts - before > MOST_VALUES:
        raise BadFrame(f"One change of it has more than {MOST_VALUES} values.")
    return number


def _read_value(reader: UpdateReader) -> None:
    """Read a value of lib0, without recursion: the stack holds how many are left in each that is open."""
    open_ones = [[1, False]]
    while open_ones:
        innermost = open_ones[-1]
        if not innermost[0]:
            open_ones.pop()
            continue
        innermost[0] -= 1
        if innermost[1]:
            reader.sized(MOST_CLOCK)
        tag = reader.byte()
        if tag in (_OBJECT, _ARRAY):
            open_ones.append([reader.count(), tag == _OBJECT])
            if len(open_ones) > DEEPEST:
                raise BadFrame(f"A value in it is nested more than {DEEPEST} times.")
        elif tag in (_STRING, _BYTES):
            reader.sized(MOST_CLOCK)
        elif tag == _INTEGER:
            reader.signed()
        elif tag in _FIXED_BYTES:
            reader.skip(_FIXED_BYTES[tag])
        else:
            raise BadFrame(f"There is no value of type {tag}.")


_CONTENTS: Mapping[int, Callable[[UpdateReader], int]] = {
    1: UpdateReader.integer,
    2: _read_texts,
    3: _read_sized,
    4: _read_string,
    5: _read_sized,
    6: lambda reader: _read_sized(reader) * _read_sized(reader),
    7: _read_type,
    8: _read_values,
}
"""What reads each kind of content, and returns how many clocks it takes; documents within documents are not taken."""


def clients_of(update: bytes) -> Collection[int]:
    """Return the Yjs clients whose changes an update brings."""
    return read_update(update).clocks.keys()


def read_update(update: bytes) -> Knowledge:
    """Return how far a checked update goes; nothing of one that was written when other bounds held."""
    try:
        return check_update(update, ROOTS_AS_BYTES, MOST_CLIENTS_OF_ALL)
    except BadFrame:
        return Knowledge({}, {})

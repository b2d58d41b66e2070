"""How far somebody knows a shared document: the clocks of its clients, and what of them is deleted. Pure.

A state vector alone does not tell of deletions, which advance no clock. Yjs calls the two together a snapshot.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from editor.documents.yjs_encoding import BadFrame, Reader, decode_state_vector, is_within

MOST_BYTES = 512 * 1024
Ranges = tuple[tuple[int, int], ...]
"""Clocks from each first one until before each second one, in order, none touching the next."""


@dataclass(frozen=True, slots=True)
class Knowledge:
    """What somebody knows, or an update tells: the clock of each client, and the deleted clocks of each client."""

    clocks: Mapping[int, int]
    deletions: Mapping[int, Ranges]
    begins: Mapping[int, int] = field(default_factory=dict)
    """Of an update: the clock from which on it has all of each client up to `clocks`."""
    needs: Mapping[int, int] = field(default_factory=dict)
    """Of an update: on whose changes beyond `clocks` it builds, and the clock until which these must be known."""

    def covers(self, other: Knowledge) -> bool:
        """Tell whether everything that the other knows is known here, too."""
        return is_within(other.clocks.items(), dict(self.clocks)) and all(
            _is_covered(ranges, self.deletions.get(client, ())) for client, ranges in other.deletions.items()
        )

    def ends(self) -> dict[int, int]:
        """Return for each client the clock until which something is known of it, deletions included."""
        ends = dict(self.clocks)
        for client, ranges in self.deletions.items():
            if ranges:
                ends[client] = max(ranges[-1][1], ends.get(client, 0))
        return ends


def _is_covered(lesser: Ranges, greater: Ranges) -> bool:
    at = 0
    for first, end in lesser:
        while at < len(greater) and greater[at][1] < end:
            at += 1
        if at == len(greater) or greater[at][0] > first:
            return False
    return True


def read_deletions(reader: Reader) -> dict[int, Ranges]:
    """Read which clocks of each client are deleted. Raises BadFrame."""
    deletions: dict[int, Ranges] = {}
    for _ in range(_count(reader)):
        client = reader.integer()
        found = []
        for _ in range(_count(reader)):
            first = reader.integer()
            found.append((first, first + reader.integer()))
        deletions[client] = joined_ranges([*deletions.get(client, ()), *found])
    return deletions


def _count(reader: Reader) -> int:
    count = reader.integer()
    if count > reader.left:
        raise BadFrame("It says that it has more parts than it has.")
    return count


def joined_ranges(ranges: Iterable[tuple[int, int]]) -> Ranges:
    """Return ranges in order, those that touch or overlap as one, empty ones left out."""
    joined: list[tuple[int, int]] = []
    for first, end in sorted(ranges):
        if joined and first <= joined[-1][1]:
            joined[-1] = (joined[-1][0], max(end, joined[-1][1]))
        elif end > first:
            joined.append((first, end))
    return tuple(joined)


def decode_snapshot(data: bytes) -> Knowledge:
    """Decode what `Y.encodeSnapshot` writes: the deletions, then the state vector. Raises BadFrame."""
    if len(data) > MOST_BYTES:
        raise BadFrame(f"It has {len(data)} bytes; {MOST_BYTES} are taken.")
    reader = Reader(data)
    deletions = read_deletions(reader)
    return Knowledge(decode_state_vector(reader.rest()), deletions)

"""A large update cut into small ones, each of which builds only on those before it. Pure.

A large update is applied in one go, and while pycrdt does so nobody else is served. Cut, it is applied piece by piece.
Each change keeps its bytes; what is new is their order and the numbers around them.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

from editor.documents.knowledge import Knowledge, Ranges
from editor.documents.yjs_encoding import BadFrame, encode_integer
from editor.documents.yjs_updates import ReadChange, check_update

SLICE_CHANGES, SLICE_BYTES = 250, 16 * 1024
"""So many changes, or deletions, or bytes go into one piece; a change that is larger is one by itself."""


@dataclass(frozen=True, slots=True)
class Slice:
    """A piece of an update, and the clock until which it brings each client's changes."""

    update: bytes
    clocks: Mapping[int, int]


@dataclass(frozen=True, slots=True)
class CutUpdate:
    """An update in pieces: how far it goes, of how many parts it is, the pieces in their order, and what that took."""

    said: Knowledge
    parts: int
    slices: tuple[Slice, ...]
    took_s: float


@dataclass(frozen=True, slots=True)
class Cutting:
    """An update that is to be checked and cut; who only compares what it deletes has use for all of its deletions."""

    update: bytes
    roots: frozenset[bytes]
    most_clients: int
    with_deletions: bool

    def cut(self) -> CutUpdate:
        """Return the pieces; of the deletions of each client only the last, unless all are wanted. Raises BadFrame."""
        found = cut_update(self.update, self.roots, self.most_clients)
        if self.with_deletions:
            return replace(found, slices=())
        last = {client: ranges[-1:] for client, ranges in found.said.deletions.items()}
        return replace(found, said=replace(found.said, deletions=last))


def cut_update(update: bytes, roots: Collection[bytes], most_clients: int) -> CutUpdate:
    """Check an update as `check_update` does, and cut it. Raises BadFrame."""
    began_s = time.process_time()
    changes: list[ReadChange] = []
    parts = 0

    def count(number: int) -> None:
        nonlocal parts
        parts = number

    said = check_update(update, roots, most_clients, count, changes.append)
    slices = [*_cut_changes(update, _ordered(changes)), *_cut_deletions(said.deletions)]
    return CutUpdate(said, parts, tuple(slices), time.process_time() - began_s)


def _ordered(changes: Iterable[ReadChange]) -> Iterator[ReadChange]:
    """Yield the changes so that each comes after those of the same update that it stands beside or in."""
    waiting: dict[int, deque[ReadChange]] = {}
    for change in changes:
        waiting.setdefault(change.client, deque()).append(change)
    begins = {client: each[0].first for client, each in waiting.items()}
    done = dict(begins)
    for client in list(waiting):
        path = {client: None}
        while waiting[client]:
            queue = waiting[next(reversed(path))]
            before = _first_lacking(queue[0], waiting, begins, done)
            if before is None:
                change = queue.popleft()
                done[change.client] = change.end
                yield change
                if len(path) > 1:
                    path.popitem()
            elif before in path:
                raise BadFrame("Changes in it build on each other in a circle.")
            else:
                path[before] = None


def _first_lacking(
    change: ReadChange, waiting: Mapping[int, deque[ReadChange]], begins: Mapping[int, int], done: Mapping[int, int]
) -> int | None:
    """Return a client of whose changes some must come before this one; what the update does not have is passed over."""
    for client, clock in change.beside:
        if (
            waiting.get(client)
            and begins[client] <= clock
            and clock >= done[client]
            and clock < waiting[client][-1].end
        ):
            return client
    return None


def _cut_changes(update: bytes, changes: Iterable[ReadChange]) -> Iterator[Slice]:
    runs: dict[int, list[ReadChange]] = {}
    count = size = 0
    for change in changes:
        length = change.until - change.at
        if runs and (change.is_skipped or count == SLICE_CHANGES or size + length > SLICE_BYTES):
            yield _slice(update, runs)
            runs, count, size = {}, 0, 0
        if not change.is_skipped:
            runs.setdefault(change.client, []).append(change)
            count, size = count + 1, size + length
    if runs:
        yield _slice(update, runs)


def _slice(update: bytes, runs: Mapping[int, list[ReadChange]]) -> Slice:
    parts = [encode_integer(len(runs))]
    for client, run in runs.items():
        parts += [encode_integer(len(run)), encode_integer(client), encode_integer(run[0].first)]
        parts += [update[change.at : change.until] for change in run]
    return Slice(b"".join((*parts, b"\x00")), {client: run[-1].end for client, run in runs.items()})


def _cut_deletions(deletions: Mapping[int, Ranges]) -> Iterator[Slice]:
    for client, ranges in deletions.items():
        for at in range(0, len(ranges), SLICE_CHANGES):
            piece = ranges[at : at + SLICE_CHANGES]
            pairs = b"".join(encode_integer(first) + encode_integer(end - first) for first, end in piece)
            yield Slice(b"\x00\x01" + encode_integer(client) + encode_integer(len(piece)) + pairs, {})

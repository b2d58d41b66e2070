"""How a room is opened: the document from the rows and the stream, without holding up the other rooms."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable

from editor.compiling.compilers import Compilers
from editor.documents.shared_document import SharedDocument
from editor.documents.store import Stored, load_document
from editor.documents.tasks import Opened, Opening
from editor.errors import DocumentHole
from editor.rooms.ledger import updates_of
from editor.rooms.room import Room
from editor.rooms.runner import LARGE_BYTES, OpenRoom, Shared
from editor.rooms.stream import Entry
from editor.rooms.stream_tail import read_tail
from editor.rooms.threads import in_database

HEARD_AT_ONCE, SLICES_AT_ONCE = 200, 5


async def open_room(program_id: str, origin: str, shared: Shared, on_end: Callable[[OpenRoom], None]) -> OpenRoom:
    """Load a program's document: the snapshot, the rows after it, what the stream has beyond them; in today's format.

    `origin` names this process and this opening. Raises NoSuchProgram, StreamLost, BadUpdate, DocumentHole.
    """
    stored = await in_database(load_document)(program_id)
    shared.compilers.prepare(program_id)
    tail, after = await read_tail(shared.stream, program_id, stored.stored_to)
    document, tail, is_changed = await _open_document(stored, tail, shared.compilers)
    room = Room(program_id, stored.site, origin, document)
    room.ledger.know_rows(range(1, stored.seq + 1))
    for at in range(0, len(tail), HEARD_AT_ONCE):
        room.ledger.hear_all(tail[at : at + HEARD_AT_ONCE], time.monotonic())
        await asyncio.sleep(0)  # others are served meanwhile
    if is_changed:
        room.ledger.doubt("", time.monotonic())
    room.ledger.stored_to = room.ledger.stored_to or stored.stored_to
    opened = OpenRoom(room, shared, after, stored, on_end)
    opened.start()
    return opened


async def _open_document(
    stored: Stored, tail: list[Entry], compilers: Compilers
) -> tuple[SharedDocument, list[Entry], bool]:
    """Return the document, the entries that are in it, and whether it is another than these and the rows say.

    A large one is put together in a process beside, if there is one: that computes for a second and holds pycrdt's
    lock, which stops the event loop also from a thread. Raises DocumentHole, BadUpdate, BadFrame.
    """
    updates = await asyncio.to_thread(updates_of, tail)
    if sum(map(len, (*stored.updates, *updates))) > LARGE_BYTES:
        opened = await compilers.do(Opening((*stored.updates, *updates), (*stored.appended, *updates)))
        if opened is not None and not opened.has_hole:
            return await _built(opened), tail, opened.migrated
    return await asyncio.to_thread(_open_here, stored, tail)


async def _built(opened: Opened) -> SharedDocument:
    """Build it piece by piece, so that others are served meanwhile."""
    document = SharedDocument()
    for number, piece in enumerate(opened.slices):
        document.apply_slice(piece)
        if number % SLICES_AT_ONCE == SLICES_AT_ONCE - 1:
            await asyncio.sleep(0)
    document.know(opened.update, opened.hashes)
    return document


def _open_here(stored: Stored, tail: list[Entry]) -> tuple[SharedDocument, list[Entry], bool]:
    """Put it together on a thread. What is left of a stream that was emptied may be of no use: others tell the rest."""
    try:
        document, is_changed = stored.open(updates_of(tail)), False
    except DocumentHole:
        document, tail, is_changed = stored.open(), [], True
    is_changed |= document.migrate()
    document.digest()  # so that the steps' hashes are there when the room tells the others, on the event loop
    return document, tail, is_changed

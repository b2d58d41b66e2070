"""What the web processes have told each other of a program and may not have stored, for who looks at the rows alone."""

from __future__ import annotations

from asgiref.sync import async_to_sync
from django.conf import settings

from editor.documents.store import Change, load_document
from editor.rooms.ledger import decode_change
from editor.rooms.stream import Entry, RoomStream, make_stream
from editor.rooms.stream import StreamLost as StreamLost


def read_unstored(*, program_id: str) -> tuple[Change, ...]:
    """Return the changes in the program's stream that may not be in its rows.

    Within one process (`memory://`) there are none for another one. Raises StreamLost, NoSuchProgram.
    """
    if settings.VIPO_STREAM_URL.startswith("memory:"):
        return ()
    stored_to = load_document(program_id).stored_to
    return tuple(_change(entry) for entry in async_to_sync(_read)(program_id, stored_to) if _is_change(entry))


def _is_change(entry: Entry) -> bool:
    return entry.note.kind in {"update", "lacking", "full"}


def _change(entry: Entry) -> Change:
    return decode_change(entry.note.data)[1] if entry.note.kind == "update" else Change(None, entry.note.data)


async def _read(program_id: str, stored_to: str) -> list[Entry]:
    stream: RoomStream = make_stream(settings.VIPO_STREAM_URL)
    try:
        return (await read_tail(stream, program_id, stored_to))[0]
    finally:
        await stream.close()


async def read_tail(stream: RoomStream, program_id: str, stored_to: str) -> tuple[list[Entry], str]:
    """Return what the stream has that may not be in the rows, and after which entry it is to be read."""
    tail: list[Entry] = []
    after = await stream.known(program_id, stored_to)
    while entries := (await stream.read(program_id, after, 0.001)).entries:
        tail += entries
        after = entries[-1].id
    return tail, after

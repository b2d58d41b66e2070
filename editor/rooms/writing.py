"""A program's content as one piece, for programs: read with a tag, written by who knows the tag.

What people change in the program's room meanwhile stays: what is written becomes the difference to what was read, as a
change of the shared document, which the rooms of all processes hear of.
"""

from __future__ import annotations

import asyncio
import hashlib
import uuid
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any
from uuid import UUID

from asgiref.sync import async_to_sync
from django.conf import settings
from django.db import transaction
from django.utils import timezone

from editor.documents.shared_document import SharedDocument, digest_of, migrate_document
from editor.documents.store import Change, append_changes, get_document, load_document
from editor.errors import BadRequest, EditorError
from editor.language import compile_document
from editor.models import Program
from editor.programs.checking import build_surroundings
from editor.programs.programs import get_compiled, get_program
from editor.programs.scripts import draw_script
from editor.rooms.hub import hubs_elsewhere
from editor.rooms.room import MOST_DOCUMENT_BYTES, MOST_STEPS, TOO_LARGE
from editor.rooms.stream import Note, RoomStream, StreamLost, make_stream

SPREAD_LIMIT_S = 5.0


class ContentChanged(EditorError):
    """The content is not any more what the writer read."""

    code = "changed"
    status = 412


class TagNeeded(EditorError):
    """Somebody writes without saying what they read."""

    code = "if_match_needed"
    status = 428


class BadScript(EditorError):
    """The script leaves the language; `diagnostics` says where."""

    code = "bad_script"
    status = 422


class RoomsAway(EditorError):
    """Those who have the program open cannot be told of a change."""

    code = "rooms_away"
    status = 503


@dataclass(frozen=True, slots=True)
class Content:
    """What a program holds, and a tag that is another once any of it changes."""

    document: Mapping[str, Any]
    script: str
    tag: str


def read_content(*, program_id: UUID | str) -> Content:
    """Return what a program holds now. Raises NoSuchProgram."""
    document = get_document(program_id=program_id)
    script = compile_document(document, build_surroundings(site=get_program(program_id=program_id).site)).script
    tag = hashlib.sha256(f"{digest_of(document)} {script}".encode()).hexdigest()[:32]
    return Content(document, script, f'"{tag}"')


def write_document(*, program_id: UUID | str, document: Mapping[str, Any], tag: str, author: int) -> Content:
    """Make a document a program's content. Raises ContentChanged, TagNeeded, BadRequest, RoomsAway, NoSuchProgram."""
    read = _read_by_tag(program_id, tag)
    return _write(program_id, read, migrate_document(document), author)


def write_script(*, program_id: UUID | str, text: str, tag: str, author: int) -> Content:
    """Make a script a program's content: steps that are still there keep their places and what no script says.

    Raises BadScript, ScriptTooLong, ContentChanged, TagNeeded, BadRequest, RoomsAway, NoSuchProgram.
    """
    read = _read_by_tag(program_id, tag)
    drawn = draw_script(program_id=program_id, text=text, base=read.document)
    if drawn.document is None:
        first = drawn.diagnostics[0]
        raise BadScript(str(first["message"]), {"diagnostics": list(drawn.diagnostics)})
    return _write(program_id, read, drawn.document, author)


def _read_by_tag(program_id: UUID | str, tag: str) -> Content:
    if not tag:
        raise TagNeeded("Say in the header If-Match what you have read: the ETag of the document or the script.")
    read = read_content(program_id=program_id)
    if tag != read.tag:
        raise ContentChanged("The program has changed since. Read it again, and write your change of that.")
    return read


def _write(program_id: UUID | str, read: Content, wanted: Mapping[str, Any], author: int) -> Content:
    with transaction.atomic():
        Program.objects.select_for_update().filter(pk=program_id).first()
        stored = SharedDocument(load_document(str(program_id)).updates)
        before = stored.state()
        stored.migrate()
        if digest_of(stored.to_json()) != digest_of(read.document):
            raise ContentChanged("The program has just changed. Read it again, and write your change of that.")
        stored.change_to(wanted)
        if stored.step_count() > MOST_STEPS or len(stored.encode()) > MOST_DOCUMENT_BYTES:
            raise BadRequest(TOO_LARGE)
        update = stored.encode(before)
        append_changes(str(program_id), [Change(author, update)], timezone.now())
        _spread(str(program_id), update)
    get_compiled(program_id=program_id)
    return read_content(program_id=program_id)


def _spread(program: str, update: bytes) -> None:
    """Tell the rooms of all processes; what they cannot be told is not kept either. Raises RoomsAway."""
    note = Note("update", update)
    try:
        told = [asyncio.run_coroutine_threadsafe(hub.stream.append(program, uuid.uuid4().hex, [note]), loop)
                for loop, hub in hubs_elsewhere()]  # fmt: skip
        for each in told:
            each.result(SPREAD_LIMIT_S)
        if not told and not settings.VIPO_STREAM_URL.startswith("memory:"):
            async_to_sync(_append_alone)(program, note)
    except (StreamLost, TimeoutError) as error:
        raise RoomsAway("Nothing was changed: those who have the program open cannot be told. Try again.") from error


async def _append_alone(program: str, note: Note) -> None:
    stream: RoomStream = make_stream(settings.VIPO_STREAM_URL)
    try:
        await stream.append(program, uuid.uuid4().hex, [note])
    finally:
        await stream.close()

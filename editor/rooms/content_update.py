"""A program's content as one piece: read with a tag and written by who knows the tag, or seen on a screen and stored.

What people change in the program's room meanwhile stays: what is written becomes the difference to what was read, as a
change of the shared document, which the rooms of all processes hear of.
"""

from __future__ import annotations

import hashlib
import time
import uuid
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any
from uuid import UUID

from django.db import transaction
from django.utils import timezone

from editor.documents import work
from editor.documents.knowledge import decode_snapshot
from editor.documents.shared_document import digest_of, migrate_document
from editor.documents.store import Change, append_changes, get_document, last_row, load_document
from editor.documents.tasks import Covering
from editor.documents.yjs_encoding import BadFrame
from editor.errors import BadRequest, EditorError, NotStored
from editor.models import Program
from editor.programs.checking import build_surroundings
from editor.programs.compilations import print_program
from editor.programs.programs import get_compiled, get_program
from editor.programs.scripts import draw_script
from editor.rooms.hub import tell_rooms
from editor.rooms.ledger import encode_change, encode_stored
from editor.rooms.receiver import MOST_DOCUMENT_BYTES, MOST_STEPS, PROGRAM_FULL
from editor.rooms.stream import Note, StreamLost

STORED_WITHIN_S = 4.0
LOOK_AGAIN_S = 0.05
_NOT_STORED = (
    "Not everything that you see is saved yet, so nothing was done. Look at the sign beside the program's name, "
    "and try again when it says that all is saved."
)


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
    script = print_program(document, build_surroundings(site=get_program(program_id=program_id).site))
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
    def change(document: Mapping[str, Any]) -> Mapping[str, Any]:
        if digest_of(document) != digest_of(read.document):
            raise ContentChanged("The program has just changed. Read it again, and write your change of that.")
        return wanted

    change_content(program_id=program_id, change=change, author=author)
    return read_content(program_id=program_id)


def change_content(
    *, program_id: UUID | str, change: Callable[[Mapping[str, Any]], Mapping[str, Any]], author: int
) -> None:
    """Make a program's content what `change` makes of it, as one edit of the author, and check the program.

    Only what it makes another is written, so what others change meanwhile stays. Raises BadRequest, RoomsAway,
    DocumentHole, NoSuchProgram, and what `change` does.
    """
    with transaction.atomic():
        Program.objects.select_for_update().filter(pk=program_id).first()
        stored = load_document(str(program_id)).open()
        before = stored.state()
        stored.migrate()
        stored.change_to(change(stored.to_json()))
        if stored.step_count() > MOST_STEPS or len(stored.encode()) > MOST_DOCUMENT_BYTES:
            raise BadRequest(PROGRAM_FULL)
        written, origin = Change(author, stored.encode(before)), uuid.uuid4().hex
        rows = append_changes(str(program_id), [written], timezone.now())
        try:
            tell_rooms(str(program_id), origin, encode_change(1, written))
        except StreamLost as error:
            raise RoomsAway(
                "Nothing was changed: those who have the program open cannot be told. Try again."
            ) from error
    with suppress(StreamLost):  # who does not hear that it is stored stores it once more
        tell_rooms(str(program_id), origin, encode_stored({origin: 1}, rows))
    get_compiled(program_id=program_id)


def ensure_stored(*, program_id: UUID | str, seen: bytes) -> None:
    """Wait until the database holds what somebody has seen of a program, so that what is made of it now holds that.

    `seen` is a Yjs snapshot (`Y.encodeSnapshot`). Every process is asked to write what it still holds. Returns after
    STORED_WITHIN_S at the latest. Raises NotStored, BadRequest, NoSuchProgram, DocumentHole.
    """
    try:
        wanted = decode_snapshot(seen)
    except BadFrame as error:
        raise BadRequest(f"What was seen is no snapshot of a Yjs document: {error}") from error
    ends = time.monotonic() + STORED_WITHIN_S
    with suppress(StreamLost):
        tell_rooms(str(program_id), uuid.uuid4().hex, Note("keep", b""))
    rows = -1
    while True:
        now = last_row(str(program_id))
        if now != rows:  # a large program is put together only when there is something new
            stored = load_document(str(program_id))
            if work.do(Covering(stored.updates, stored.appended, wanted), stored.size):
                return
            rows = now
        if time.monotonic() > ends:
            load_document(str(program_id)).open()
            raise NotStored(_NOT_STORED)
        time.sleep(LOOK_AGAIN_S)

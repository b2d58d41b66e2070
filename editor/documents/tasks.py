"""Work on documents that is done in a child process, so that the web process's event loop goes on. Pure."""

from __future__ import annotations

import json
from dataclasses import dataclass

from editor.documents.knowledge import Knowledge
from editor.documents.shared_document import ROOTS_AS_BYTES, BadUpdate, Entry, SharedDocument, clients_of
from editor.documents.slices import Cutting, CutUpdate, Slice, cut_update
from editor.documents.yjs_encoding import BadFrame
from editor.documents.yjs_updates import MOST_CLIENTS_EVER


@dataclass(frozen=True, slots=True)
class Opening:
    """A document that is to be put together from updates; of the `appended` ones none may build on what is missing."""

    updates: tuple[bytes, ...]
    appended: tuple[bytes, ...]

    def done(self) -> Opened:
        """Put it together. Raises BadUpdate."""
        document = SharedDocument(self.updates)
        has_hole = document.has_hole(self.appended)
        migrated = document.migrate()
        update = document.encode()
        return Opened(update, _slices_of(update), document.hashes(), migrated, has_hole)


def _slices_of(update: bytes) -> tuple[Slice, ...]:
    """Return a document's update in pieces, or as it is where it is too much to be cut."""
    try:
        return cut_update(update, ROOTS_AS_BYTES, MOST_CLIENTS_EVER).slices
    except BadFrame:
        return (Slice(update, {}),)


@dataclass(frozen=True, slots=True)
class Opened:
    """A document put together: one update, its pieces, its entries' hashes, whether it was brought to today's format.

    With a hole it is of no use.
    """

    update: bytes
    slices: tuple[Slice, ...]
    hashes: dict[Entry, int]
    migrated: bool
    has_hole: bool


@dataclass(frozen=True, slots=True)
class Reading:
    """A document that is to be read from updates; of the `appended` ones none may build on what is missing."""

    updates: tuple[bytes, ...]
    appended: tuple[bytes, ...]

    def done(self) -> PlainDocument:
        """Read it, in today's format."""
        try:
            document = SharedDocument(self.updates)
        except BadUpdate:
            return PlainDocument("", is_readable=False)
        if document.has_hole(self.appended):
            return PlainDocument("", has_hole=True)
        document.migrate()
        return PlainDocument(json.dumps(document.to_json()))


@dataclass(frozen=True, slots=True)
class PlainDocument:
    """A document in its plain form, as JSON; there is none with a hole, or of what cannot be read."""

    text: str
    has_hole: bool = False
    is_readable: bool = True


@dataclass(frozen=True, slots=True)
class Covering:
    """What somebody has seen of a document that is stored as updates; is all of it there?"""

    updates: tuple[bytes, ...]
    appended: tuple[bytes, ...]
    seen: Knowledge

    def done(self) -> bool:
        """Look. What builds on what is missing is not there, nor what cannot be read."""
        try:
            document = SharedDocument(self.updates)
        except BadUpdate:
            return False
        return not document.has_hole(self.appended) and document.knowledge().covers(self.seen)


@dataclass(frozen=True, slots=True)
class Comparing:
    """A document that is to be compared with what is stored of it, which is updates, the `appended` ones among them."""

    here: bytes
    stored: tuple[bytes, ...]
    appended: tuple[bytes, ...]

    def done(self) -> Differences:
        """Compare them; what is stored may build on what only the other one has. Raises BadUpdate."""
        kept, document = SharedDocument(self.stored), SharedDocument([self.here])
        missing = b""
        if kept.has_hole(self.appended):
            missing = document.encode(kept.state())
            kept = SharedDocument([*self.stored, missing])
            if kept.has_hole(self.appended):
                return Differences(b"", b"", has_hole=True)
        known_there, known_here = kept.knowledge(), document.knowledge()
        return Differences(
            missing or (b"" if known_there.covers(known_here) else document.encode(kept.state())),
            b"" if known_here.covers(known_there) else kept.encode(document.state()),
            has_hole=False,
        )


@dataclass(frozen=True, slots=True)
class Differences:
    """What the stored document lacks, and what the other one does; either may be empty. With a hole nothing is told."""

    lacking_there: bytes
    lacking_here: bytes
    has_hole: bool


@dataclass(frozen=True, slots=True)
class Folding:
    """What is stored of a document, as updates, which are to become one."""

    stored: tuple[bytes, ...]
    appended: tuple[bytes, ...]

    def done(self) -> Folded:
        """Fold them, and open what was made, as whoever reads it will. Raises BadUpdate."""
        document = SharedDocument(self.stored)
        update = document.encode()
        copy = SharedDocument([update])
        is_same = copy.digest() == document.digest() and copy.knowledge() == document.knowledge()
        clients = tuple(tuple(clients_of(each)) for each in self.appended)
        return Folded(update, is_same, document.has_hole(self.appended), clients)


@dataclass(frozen=True, slots=True)
class Folded:
    """Updates as one; whether it holds the same, and whether something is missing on which they build.

    `clients` are the Yjs clients of each appended one.
    """

    update: bytes
    is_same: bool
    has_hole: bool
    clients: tuple[tuple[int, ...], ...]


@dataclass(frozen=True, slots=True)
class Refusal:
    """Why an update is none of a program."""

    reason: str


@dataclass(frozen=True, slots=True)
class CuttingTask:
    """An update that is to be cut."""

    cutting: Cutting

    def done(self) -> CutUpdate | Refusal:
        """Cut it."""
        try:
            return self.cutting.cut()
        except BadFrame as error:
            return Refusal(str(error))

"""A room: one shared document and the connections that edit it, in strict order. No I/O: the runner does it."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable
from contextlib import suppress

from editor.documents import yjs_encoding
from editor.documents.shared_document import SharedDocument, UpdateHole, read_update
from editor.rooms import yjs_protocol
from editor.rooms.awareness import AwarenessBoard
from editor.rooms.broadcast import Broadcast, broadcast_form
from editor.rooms.compiled_form import CompiledForm
from editor.rooms.ledger import Ledger, decode_change, decode_stored, encode_stored
from editor.rooms.member import Close, Member
from editor.rooms.receiver import Receiver
from editor.rooms.stream import Entry, Note

MOST_READERS, MOST_WRITERS = 300, 50
"""Apart, so that whoever may only look never keeps out who may draw."""
MOST_OF_PERSON = 10


class Room:
    """One per document and process. What is to go to the database, to the others and to the connections waits in it.

    `wake` is called when something waits.
    """

    def __init__(self, program: str, site: str, origin: str, document: SharedDocument) -> None:
        """`site` is the slug of the program's site, `origin` the process."""
        self.program = program
        self.site = site
        self.origin = origin
        self.document = document
        self.members: list[Member] = []
        self.board = AwarenessBoard()
        self.ledger = Ledger(origin)
        self.to_publish: deque[Note] = deque()
        self.touched = False
        """Whether the document is to be checked by this process."""
        self.form = CompiledForm()
        self.must_keep = False
        """Whether somebody waits until everything is in the database."""
        self.broadcast = Broadcast(self.members, lambda: self.document.state())
        self.wake: Callable[[], None] = _nobody
        self.receiver = Receiver(self)

    def join(self, member: Member) -> None:
        """Let a connection in: it is asked for what it has, and shown who is here. Raises Close."""
        if sum(each.person.id == member.person.id for each in self.members) >= MOST_OF_PERSON:
            raise Close(
                Close.ABUSE, f"You have this program open {MOST_OF_PERSON} times. Close other copies of the page."
            )
        most = MOST_WRITERS if member.can_write else MOST_READERS
        if sum(each.can_write == member.can_write for each in self.members) >= most:
            raise Close(Close.COME_AGAIN, f"{most} people are in this program already. Try again later.")
        self.members.append(member)
        member.ask_for_state(self.document.state())
        if everybody := self.board.everybody():
            member.post(yjs_protocol.encode_awareness(everybody))

    def leave(self, member: Member) -> None:
        """Let a connection go."""
        if member in self.members:
            self.members.remove(member)
            self.board.drop(member)
            self.wake()

    def spread_later(self, change: bytes, sender: Member | None = None) -> None:
        """Take in a change that is to be sent to all but its sender."""
        self.broadcast.add(change, sender)
        self.wake()

    def spread(self) -> None:
        """Send what has changed since the last call."""
        self.broadcast.send()

    def hear(self, entry: Entry, now_s: float = 0.0) -> None:
        """Take what a process has to say; of this one's own, only what holds for all from its entry on."""
        is_own, note = entry.origin == self.origin, entry.note
        match note.kind:
            case "update":
                self._hear_change(entry, now_s)
            case "compiled":
                self._hear_form(entry)
            case "lacking" | "full" if not is_own:
                self._hear_missing(entry, now_s)
            case _ if not is_own:
                self._hear_other(entry)
        if note.kind != "update":
            self.ledger.pass_entry(entry.id)

    def _hear_change(self, entry: Entry, now_s: float) -> None:
        self.form.hear_update(entry)
        number, change = decode_change(entry.note.data)
        if entry.origin == self.origin:
            self.ledger.hear(entry.id, entry.origin, number, change, now_s)
            return
        is_missed = self.ledger.misses(entry.origin, number)
        try:
            changes = self.document.apply_whole(change.update, read_update(change.update))
        except UpdateHole:
            self._miss(now_s)
            self.ledger.pass_over(entry.id, entry.origin, number)
            return
        if is_missed:
            self._miss(now_s)
        self.ledger.hear(entry.id, entry.origin, number, change, now_s)
        for each in changes:
            self.spread_later(each)

    def _miss(self, now_s: float) -> None:
        """Ask for what is missing, and look for it in the rows: the stream was emptied."""
        self.ledger.doubt("", now_s)
        self.say_state()

    def _hear_missing(self, entry: Entry, now_s: float) -> None:
        """Take what another process found missing here; whether the database has it is not known."""
        changes = [entry.note.data] if entry.note.kind == "full" else self.document.apply(entry.note.data)
        if entry.note.kind == "full":
            self._rebuild([entry.note.data])
        for change in changes:
            self.spread_later(change)
        if changes:
            self.ledger.doubt(entry.id, now_s)

    def _hear_form(self, entry: Entry) -> None:
        """Take in a check; check here when one's own edits are not in it, or one's own check did not hold."""
        holds = self.form.hear(entry)
        if holds:
            broadcast_form(self.form, self.members, self.broadcast)
        is_wanted = entry.origin == self.origin or any(member.shown is not None for member in self.members)
        if self.origin in self.form.not_shown() or (not holds and is_wanted):
            self.touched = True
        self.wake()

    def _hear_other(self, entry: Entry) -> None:
        note = entry.note
        match note.kind:
            case "awareness":
                with suppress(yjs_encoding.BadFrame):  # who is here, as a process of another version tells it
                    self.board.hear(entry.origin, yjs_protocol.decode_awareness(note.data).entries)
                self.wake()
            case "saved":
                self.note_stored(*decode_stored(note.data))
            case "keep":
                self.must_keep = True
                self.wake()
            case "state":
                self._compare(note.data)

    def say_state(self) -> None:
        """Tell the other processes what is here, so that they can compare."""
        self.to_publish.append(self._state_note())
        if here := self.board.here():
            self.to_publish.append(Note("awareness", yjs_protocol.encode_entries(here)))
        self.wake()

    def _state_note(self) -> Note:
        return Note("state", self.document.digest().encode() + self.document.state())

    def _compare(self, data: bytes) -> None:
        """Give the other process what it lacks; say what is here if something is lacking here."""
        digest, state = data[:64].decode(), data[64:]
        theirs, ours = yjs_encoding.decode_state_vector(state), yjs_encoding.decode_state_vector(self.document.state())
        they_lack, we_lack = (
            not yjs_encoding.is_within(ours.items(), theirs),
            not yjs_encoding.is_within(theirs.items(), ours),
        )
        if they_lack:
            self.to_publish.append(Note("lacking", self.document.encode(state)))
        if we_lack:
            self.to_publish.append(self._state_note())
        if not they_lack and not we_lack and digest != self.document.digest():
            self.to_publish.append(Note("full", self.document.encode()))
        self.wake()

    def _rebuild(self, updates: list[bytes]) -> None:
        """Build the document anew from all that is known, which mends whatever came in a wrong order."""
        self.document = SharedDocument([self.document.encode(), *updates])
        self.touched = True

    def take_over(self, updates: list[bytes], now_s: float = 0.0) -> None:
        """Take in what the database holds, in any order: after a gap. Raises BadUpdate."""
        self.form.forget()
        self._rebuild(updates)
        for update in updates:
            self.spread_later(update)
        self.ledger.doubt("", now_s)

    def note_stored(self, numbers: dict[str, int], rows: range) -> None:
        """Take in up to which numbers processes' changes are in the database, the last in these rows; tell people."""
        self.ledger.know_rows(rows)
        for origin, number in numbers.items():
            self.ledger.note_stored(origin, number)
        self.tell_saved(self.members)

    def say_stored(self, numbers: dict[str, int], rows: range) -> None:
        """Take in what this process has stored in these rows, and tell the others and the connections."""
        self.to_publish.append(encode_stored(numbers, rows))
        self.note_stored(numbers, rows)
        self.wake()

    def settle(self, doubts: int) -> None:
        """Take in that what was in doubt is in the database; tell the connections."""
        self.ledger.settle(doubts)
        self.tell_saved(self.members)

    def tell_saved(self, members: Iterable[Member]) -> None:
        """Tell connections how many of their frames are in the database."""
        stored = self.ledger.stored_place
        for member in members:
            if member.note_stored(stored) and member.shows_saved:
                member.post(yjs_protocol.encode_saved(member.saved, member.refused))

    def spread_awareness(self) -> int:
        """Send what has changed on the board since the last call; return how many bytes went out."""
        sent = 0
        here, elsewhere = self.board.take_changes()
        if here:
            self.to_publish.append(Note("awareness", yjs_protocol.encode_entries(here)))
            self.wake()
        if here or elsewhere:
            for member in self.members:
                entries = [e for e in (*here, *elsewhere) if e.client not in member.clients]
                if entries:
                    frame = yjs_protocol.encode_awareness(entries)
                    self.broadcast.tell(member, frame)
                    sent += len(frame)
        return sent

    def beat(self) -> None:
        """Send something to those to whom nothing was sent: y-websocket gives up after 30 s of silence."""
        for member in self.members:
            member.beat()

    def close_all(self, close: Close) -> None:
        """Send everybody away."""
        for member in list(self.members):
            member.close(close)


def _nobody() -> None:
    """Nobody waits yet."""

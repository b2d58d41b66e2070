"""A room: one shared document and the connections that edit it, in strict order. No I/O: the runner does it."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

from editor.documents import yjs_encoding
from editor.documents.shared_document import EMPTY_UPDATE, ROOTS, BadUpdate, SharedDocument
from editor.documents.store import Change
from editor.documents.yjs_updates import check_update
from editor.rooms import yjs_protocol
from editor.rooms.awareness import AwarenessBoard
from editor.rooms.compiled_form import CompiledForm
from editor.rooms.member import MIB, Close, Member
from editor.rooms.stream import Entry, Note

MOST_READERS, MOST_WRITERS = 50, 50
"""Apart, so that whoever may only look never keeps out who may draw."""
MOST_OF_PERSON = 10
MOST_DOCUMENT_BYTES = 8 * MIB
MOST_STEPS = 5000
_ROOTS = frozenset(root.encode() for root in ROOTS)
INTERRUPTED = "The program could not be reached just now. What was typed stays in the browser and follows."
TOO_LARGE = "The program is full: it may have 8 MiB and 5,000 steps. Remove steps, or make a second program of a part."


class Room:
    """One per document and process. What is to go to the database and to the other processes waits in queues.

    `wake` is called when a queue has something in it.
    """

    def __init__(self, program: str, site: str, origin: str, document: SharedDocument) -> None:
        """`site` is the slug of the program's site, `origin` the process."""
        self.program = program
        self.site = site
        self.origin = origin
        self.document = document
        self.members: list[Member] = []
        self.board = AwarenessBoard()
        self.to_save: deque[Change] = deque()
        self.to_publish: deque[Note] = deque()
        self.touched = False
        """Whether the document is to be checked by this process."""
        self.form = CompiledForm(origin)
        self.saved_seq = 0
        self._bytes = len(document.encode())
        self.wake: Callable[[], None] = _nobody

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

    def receive(self, member: Member, frame: bytes, now_s: float) -> None:
        """Act on a client's frame. Raises Close."""
        member.spend_bytes(len(frame), now_s)
        try:
            message = yjs_protocol.decode_frame(frame)
        except yjs_encoding.FrameTooLarge as error:
            raise Close(Close.TOO_LARGE, str(error)) from error
        except yjs_encoding.BadFrame as error:
            raise Close(Close.MALFORMED, str(error)) from error
        if isinstance(message, yjs_protocol.Awareness):
            self._receive_awareness(member, message, now_s)
            return
        member.spend_frame(now_s)
        if isinstance(message, yjs_protocol.QueryCompiled):
            self._show_form(member, message.revision, now_s)
            return
        try:
            self._receive_sync(member, message)
        except (BadUpdate, yjs_encoding.BadFrame) as error:
            raise Close(Close.MALFORMED, f"The change is not one of a Yjs document: {error}") from error

    def _show_form(self, member: Member, revision: int, now_s: float) -> None:
        """Show the compiled form from now on: what is asked for again and again is counted as if it had been sent."""
        member.shown = revision
        if self.form.now is None:
            self.touched = True
            self.wake()
        elif self.form.now["revision"] != revision:
            frame = self._whole_form()
            member.spend_bytes(len(frame), now_s)
            self._post_form(member, frame)

    def _whole_form(self) -> bytes:
        return yjs_protocol.encode_compiled(self.form.now)

    def _post_form(self, member: Member, frame: bytes) -> None:
        if self.form.now is not None:
            member.shown = self.form.now["revision"]
            member.post(frame)

    def _spread_form(self) -> None:
        """Send who looks at the compiled form what is another in it."""
        change, whole = self.form.change or {}, b""
        frame = yjs_protocol.encode_compiled(change) if "base" in change else b""
        for member in self.members:
            if member.shown is not None and member.shown == change.get("base"):
                self._post_form(member, frame)
            elif member.shown is not None:
                whole = whole or self._whole_form()
                self._post_form(member, whole)

    def _receive_awareness(self, member: Member, message: yjs_protocol.Awareness, now_s: float) -> None:
        if self.board.speaks_for_itself(member, message.entries):
            member.spend_frame(now_s)
            self.board.take(member, message.entries)
            self.wake()

    def _receive_sync(self, member: Member, message: yjs_protocol.Message) -> None:
        match message:
            case yjs_protocol.SyncStep1(state=state):
                member.post(yjs_protocol.encode_step_2(self.document.encode(state)))
            case yjs_protocol.SyncStep2(update=update):
                self._receive_step_2(member, update)
            case yjs_protocol.Update(update=update) if member.can_write:
                if member.synced:
                    self._change(member, update)
                else:
                    member.hold(update)
            case yjs_protocol.QueryAwareness():
                member.post(yjs_protocol.encode_awareness(self.board.everybody()))
        if member.probe_is_due:
            member.ask_for_state(self.document.state())

    def _receive_step_2(self, member: Member, update: bytes) -> None:
        member.note_answer()
        first, member.synced = not member.synced, True
        held = member.take_held()
        if not member.can_write:
            return
        for change in (update, *held):
            self._change(member, change)
        if first and not self.to_save:
            member.post(yjs_protocol.encode_saved(self.saved_seq, self.document.state()))

    def _change(self, member: Member, update: bytes) -> None:
        """Apply a client's change, save it, publish it."""
        if update == EMPTY_UPDATE:
            return
        if not member.is_sure():
            raise Close(Close.COME_AGAIN, INTERRUPTED)
        check_update(update, _ROOTS)
        if self._leaves_a_hole(update):
            member.ask_for_state(self.document.state())
            return
        self._check_size(update)
        steps = self.document.step_count()
        for change in self.document.apply(update):
            self.to_save.append(Change(member.person.id, change))
            self.to_publish.append(Note("update", change))
            self._spread(change, besides=member)
            self.touched = True
        if steps < self.document.step_count() > MOST_STEPS:
            raise Close(Close.TOO_LARGE, TOO_LARGE)

    def _leaves_a_hole(self, update: bytes) -> bool:
        """Tell whether a change begins after what is known of its client: Yjs would wait for the rest, pycrdt not."""
        first = yjs_encoding.first_of_update(update)
        if first is None:
            return False
        client, clock = first
        return clock > yjs_encoding.decode_state_vector(self.document.state()).get(client, 0)

    def _check_size(self, update: bytes) -> None:
        self._bytes += len(update)
        if self._bytes > MOST_DOCUMENT_BYTES:
            self._bytes = len(self.document.encode()) + len(update)
        if self._bytes > MOST_DOCUMENT_BYTES:
            self._bytes -= len(update)
            raise Close(Close.TOO_LARGE, TOO_LARGE)

    def _spread(self, change: bytes, besides: Member | None = None) -> None:
        frame = yjs_protocol.encode_update(change)
        for member in self.members:
            if member is not besides:
                member.post(frame)
        self.wake()

    def hear(self, entry: Entry) -> None:
        """Take what a process has to say; of this one's own, only what holds for all from its entry on."""
        is_own, note = entry.origin == self.origin, entry.note
        if note.kind == "update":
            self.form.hear_update(entry)
        if note.kind == "compiled":
            self._hear_form(entry)
        elif not is_own:
            self._hear_other(entry)

    def _hear_form(self, entry: Entry) -> None:
        """Take in a check; check here when one's own edits are not in it, or one's own check did not hold."""
        holds = self.form.hear(entry)
        if holds:
            self._spread_form()
        is_wanted = entry.origin == self.origin or any(member.shown is not None for member in self.members)
        if self.origin in self.form.not_shown() or (not holds and is_wanted):
            self.touched = True
        self.wake()

    def _hear_other(self, entry: Entry) -> None:
        note = entry.note
        match note.kind:
            case "update":
                for change in self.document.apply(note.data):
                    self._spread(change)
            case "full":
                self._take_full(note.data)
            case "awareness":
                self.board.hear(entry.origin, yjs_protocol.decode_awareness(note.data).entries)
                self.wake()
            case "saved":
                self.announce_saved(*decode_saved(note.data))
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
            self.to_publish.append(Note("update", self.document.encode(state)))
        if we_lack:
            self.to_publish.append(self._state_note())
        if not they_lack and not we_lack and digest != self.document.digest():
            self.to_publish.append(Note("full", self.document.encode()))
        self.wake()

    def _take_full(self, update: bytes) -> None:
        """Build the document anew from all that is known, which mends whatever came in a wrong order."""
        before = self.document.encode()
        self.document = SharedDocument([before, update])
        self._spread(update)
        self.touched = True

    def take_over(self, updates: list[bytes]) -> None:
        """Take in what the database or a peer holds, in any order: after a gap. Raises BadUpdate."""
        self.form.forget()
        self._take_full(SharedDocument(updates).encode())

    def announce_saved(self, seq: int, state: bytes) -> None:
        """Tell everybody what is in the database."""
        self.saved_seq = max(seq, self.saved_seq)
        frame = yjs_protocol.encode_saved(self.saved_seq, state)
        for member in self.members:
            member.post(frame)

    def spread_awareness(self) -> None:
        """Send what has changed on the board since the last call."""
        here, elsewhere = self.board.take_changes()
        if here:
            self.to_publish.append(Note("awareness", yjs_protocol.encode_entries(here)))
            self.wake()
        if here or elsewhere:
            for member in self.members:
                entries = [e for e in (*here, *elsewhere) if e.client not in member.clients]
                if entries:
                    member.post(yjs_protocol.encode_awareness(entries))

    def beat(self) -> None:
        """Send something to those to whom nothing was sent: y-websocket gives up after 30 s of silence."""
        for member in self.members:
            if not member.sent_since_beat:
                member.post(yjs_protocol.encode_awareness(()))
            member.sent_since_beat = False

    def close_all(self, close: Close) -> None:
        """Send everybody away."""
        for member in list(self.members):
            member.close(close)


def _nobody() -> None:
    """Nobody waits yet."""


def encode_saved_note(seq: int, state: bytes) -> Note:
    """Return the note that tells the other processes what has been saved."""
    return Note("saved", yjs_encoding.encode_integer(seq) + state)


def decode_saved(data: bytes) -> tuple[int, bytes]:
    """Return the number and the state vector of a note."""
    reader = yjs_encoding.Reader(data)
    seq = reader.integer()
    return seq, reader.rest()

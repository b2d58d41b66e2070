"""What a connection sends to a room: counted, checked, and applied step by step. No I/O: the inbox does it."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Generator, Iterable
from contextlib import suppress
from typing import Protocol

from editor.documents import yjs_encoding
from editor.documents.knowledge import Knowledge
from editor.documents.shared_document import EMPTY_UPDATE, ROOTS_AS_BYTES, BadUpdate, SharedDocument, UpdateHole
from editor.documents.slices import Cutting, CutUpdate
from editor.documents.store import Change
from editor.documents.yjs_updates import MOST_CLIENTS, MOST_CLIENTS_EVER, MOST_CLIENTS_OF_ALL, check_update
from editor.rooms import yjs_protocol
from editor.rooms.awareness import AwarenessBoard
from editor.rooms.broadcast import Broadcast, post_form
from editor.rooms.compiled_form import CompiledForm
from editor.rooms.ledger import Ledger, encode_change
from editor.rooms.member import KIB, MIB, Close, Member
from editor.rooms.refusals import INTERRUPTED, TOO_MANY_PAGES
from editor.rooms.stream import Note

MOST_DOCUMENT_BYTES = 8 * MIB
MOST_STEPS = 5000
PROGRAM_FULL = (
    f"The program is full: it may have {MOST_DOCUMENT_BYTES // MIB} MiB and {MOST_STEPS:,} steps. "
    "Remove steps, or make a second program of a part."
)
COST_OF_A_HOLE = 50
"""A message that builds on what is not known may have a client send all that it has."""
SHARE_OF_CUTTING = 0.25
"""So much of the time that another process took to cut an update counts as this one's."""
LIGHT_BYTES = 4 * KIB
"""A larger update is cut elsewhere and applied piece by piece."""
WORK_PER_BYTE_S = 1e-8
"""So long a byte of an answer is work, beside putting the answer together."""

Acting = Generator[Cutting | None, CutUpdate | None, None]
"""The steps of acting on a frame; where an update is yielded, it is to be sent in pieces."""


class Changed(Protocol):
    """What of a room a message may change."""

    document: SharedDocument
    board: AwarenessBoard
    ledger: Ledger
    form: CompiledForm
    broadcast: Broadcast
    to_publish: deque[Note]
    touched: bool
    wake: Callable[[], None]

    def spread_later(self, change: bytes, sender: Member | None = None) -> None:
        """Take in a change that is to be sent to all but its sender."""

    def tell_saved(self, members: Iterable[Member]) -> None:
        """Tell connections how many of their frames are in the database."""


class Receiver:
    """What receives the messages of a room's connections."""

    def __init__(self, room: Changed) -> None:
        """Begin with the document that the room has."""
        self._room = room
        self._bytes = len(room.document.encode())
        self._steps = room.document.step_count()

    def receive(self, member: Member, frame: bytes, now_s: float) -> None:
        """Count a client's frame and act on it in one go. Raises Close."""
        self.count(member, frame, now_s)
        acting, cut = self.act(member, frame, now_s), None
        with suppress(StopIteration):
            while True:
                wanted = acting.send(cut)
                cut = None if wanted is None else wanted.cut()

    def count(self, member: Member, frame: bytes, now_s: float) -> None:
        """Count a client's frame before anything is done for it. Raises Close."""
        member.spend_bytes(len(frame), now_s)
        if frame[:1] == bytes((yjs_protocol.AWARENESS,)):
            member.spend_awareness(now_s)
        else:
            member.spend_frame(now_s)

    def act(self, member: Member, frame: bytes, now_s: float) -> Acting:
        """Act on a frame, step by step; what is large is asked to be cut by somebody else. Raises Close."""
        try:
            message = yjs_protocol.decode_frame(frame)
        except yjs_encoding.FrameTooLarge as error:
            raise Close(Close.TOO_LARGE, str(error)) from error
        except yjs_encoding.BadFrame as error:
            raise Close(Close.MALFORMED, str(error)) from error
        match message:
            case yjs_protocol.Awareness():
                self._receive_awareness(member, message, now_s)
            case yjs_protocol.QueryCompiled(revision=revision):
                self._show_form(member, revision, now_s)
            case yjs_protocol.QuerySaved():
                member.shows_saved = True
                member.post(yjs_protocol.encode_saved(member.saved, member.refused))
            case _:
                try:
                    yield from self._receive_sync(member, message, now_s)
                except (BadUpdate, yjs_encoding.BadFrame) as error:
                    raise Close(Close.MALFORMED, f"The change is not one of a Yjs document: {error}") from error

    def _show_form(self, member: Member, revision: int, now_s: float) -> None:
        """Show the compiled form from now on: what is asked for again and again is counted as if it had been sent."""
        member.shown = revision
        if self._room.form.now is None:
            self._room.touched = True
            self._room.wake()
        elif self._room.form.now["revision"] != revision:
            member.spend_bytes(post_form(self._room.form, member, self._room.broadcast), now_s)

    def _receive_awareness(self, member: Member, message: yjs_protocol.Awareness, now_s: float) -> None:
        if not message.entries or self._room.board.speaks_for_itself(member, message.entries):
            member.spend_frame(now_s)
            self._room.board.take(member, message.entries)
            self._room.wake()

    def _receive_sync(self, member: Member, message: yjs_protocol.Message, now_s: float) -> Acting:
        match message:
            case yjs_protocol.SyncStep1(state=state):
                answer = yjs_protocol.encode_step_2(self._room.document.encode(state))
                member.allowance.spend_work(len(answer) * WORK_PER_BYTE_S, now_s)
                member.post(answer)
            case yjs_protocol.SyncStep2(update=update):
                yield from self._receive_step_2(member, update, now_s)
            case yjs_protocol.Update(update=update):
                yield from self._receive_update(member, update, now_s)
            case yjs_protocol.QueryAwareness():
                member.post(yjs_protocol.encode_awareness(self._room.board.everybody()))
        if member.probe_is_due and member.not_acted_on <= 1:  # this one
            member.ask_for_state(self._room.document.state())

    def _receive_update(self, member: Member, update: bytes, now_s: float) -> Acting:
        member.frames += 1
        if not member.can_write:
            yield from self._refuse(member, update, MOST_CLIENTS, now_s)
        elif member.synced:
            yield from self._change(member, [update], MOST_CLIENTS, now_s)
        else:
            if len(update) <= LIGHT_BYTES:  # what is larger is read when it is applied
                self._check(member, update, MOST_CLIENTS, now_s)
            member.hold(update)

    def _receive_step_2(self, member: Member, update: bytes, now_s: float) -> Acting:
        member.frames += 1
        member.note_answer()
        if member.has_caught_up:
            self._catch_up(member)
        member.synced = True
        held = member.take_held()
        if member.can_write:
            yield from self._change(member, [update], MOST_CLIENTS_OF_ALL, now_s)
            yield from self._change(member, held, MOST_CLIENTS, now_s)
        else:
            yield from self._refuse(member, update, MOST_CLIENTS_OF_ALL, now_s)

    def _catch_up(self, member: Member) -> None:
        """Tell a connection that was behind what it was not told meanwhile."""
        state, member.behind = member.behind, None
        self._room.broadcast.tell(member, yjs_protocol.encode_update(self._room.document.encode(state)))
        self._room.broadcast.tell(member, yjs_protocol.encode_awareness(self._room.board.everybody()))
        if (
            member.shown is not None
            and self._room.form.now is not None
            and self._room.form.now["revision"] != member.shown
        ):
            post_form(self._room.form, member, self._room.broadcast)

    def _check(self, member: Member, update: bytes, most_clients: int, now_s: float) -> Knowledge:
        """Read an update before the document does, at the cost of who sent it. Raises BadFrame, Close."""
        return check_update(
            update, ROOTS_AS_BYTES, most_clients, lambda parts: member.allowance.spend_parts(parts, now_s)
        )

    def _refuse(self, member: Member, update: bytes, most_clients: int, now_s: float) -> Acting:
        """Take no change of who may only look; say so, if it would have changed something."""
        if update == EMPTY_UPDATE:
            return
        if len(update) > LIGHT_BYTES:
            cut = yield Cutting(update, ROOTS_AS_BYTES, most_clients, with_deletions=True)
            assert cut is not None
            self._spend_cut(member, cut, now_s)
            said = cut.said
        else:
            said = self._check(member, update, most_clients, now_s)
        if not self._room.document.knowledge().covers(said):
            member.refused += 1
            if member.shows_saved:
                member.post(yjs_protocol.encode_saved(member.saved, member.refused))

    def _change(self, member: Member, updates: list[bytes], most_clients: int, now_s: float) -> Acting:
        """Apply a client's changes, all or, from the first one that leaves a hole, none until it has said all."""
        for number, update in enumerate(updates):
            if update == EMPTY_UPDATE:
                continue
            self._check_right(member)
            try:
                if len(update) > LIGHT_BYTES:
                    yield from self._apply_slowly(member, update, most_clients, now_s)
                else:
                    said = self._check(member, update, most_clients, now_s)
                    self._check_size(update, said)
                    self._spread_all(member, self._room.document.apply_whole(update, said), now_s)
            except UpdateHole:
                for later in updates[number:]:
                    member.hold(later)
                member.spend_frame(now_s, COST_OF_A_HOLE)
                member.synced = False
                member.ask_for_state(self._room.document.state())
                return
            if number + 1 < len(updates):
                yield None
        member.unsaved.append((member.frames, self._room.ledger.place))
        self._room.tell_saved([member])

    def _check_right(self, member: Member) -> None:
        """Raise Close where somebody may have lost the right to change something since their frame came."""
        if not (member.is_sure() and member.can_write):
            raise Close(Close.COME_AGAIN, INTERRUPTED)

    def _apply_slowly(self, member: Member, update: bytes, most_clients: int, now_s: float) -> Acting:
        cut = yield Cutting(update, ROOTS_AS_BYTES, most_clients, with_deletions=False)
        assert cut is not None
        self._spend_cut(member, cut, now_s)
        self._check_size(update, cut.said)
        self._room.document.check_whole(cut.said)
        for piece in cut.slices:
            self._check_right(member)
            self._spread_all(member, self._room.document.apply_slice(piece), now_s)
            yield None

    def _spend_cut(self, member: Member, cut: CutUpdate, now_s: float) -> None:
        """Count what it took to cut an update. Raises Close."""
        member.allowance.spend_work(cut.took_s * SHARE_OF_CUTTING, now_s)
        member.allowance.spend_parts(cut.parts, now_s)

    def _spread_all(self, member: Member, changes: list[bytes], now_s: float) -> None:
        """Tell all of a client's changes, which the document has. Raises Close when it has too many steps then."""
        steps, self._steps = self._steps, self._room.document.step_count()
        for change in changes:
            waiting = self._room.ledger.add(Change(member.person.id, change), now_s)
            self._room.to_publish.append(encode_change(waiting.number, waiting.change))
            self._room.spread_later(change, member)
            self._room.touched = True
        if steps < self._steps > MOST_STEPS:
            raise Close(Close.TOO_LARGE, PROGRAM_FULL)

    def _check_size(self, update: bytes, said: Knowledge) -> None:
        clocks = self._room.document.clocks()
        if len(clocks) >= MOST_CLIENTS_EVER and not said.clocks.keys() <= clocks.keys():
            raise Close(Close.TOO_LARGE, TOO_MANY_PAGES)
        self._bytes += len(update)
        if self._bytes > MOST_DOCUMENT_BYTES:
            self._bytes = self._room.document.measure() + len(update)
        if self._bytes > MOST_DOCUMENT_BYTES:
            self._bytes -= len(update)
            raise Close(Close.TOO_LARGE, PROGRAM_FULL)

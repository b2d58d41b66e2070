"""What goes out to a room's connections: gathered into few frames, and bounded for who does not keep up. No I/O.

Nobody can be asked how much of what was sent has been read, so now and then a connection is asked for what it has; its
answer tells. To one that owes too many answers nothing more is sent until it has read all; what it missed, which is the
difference to the document as it was then, follows in one piece.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from editor.documents.shared_document import merge
from editor.rooms import yjs_protocol
from editor.rooms.compiled_form import CompiledForm
from editor.rooms.member import Member


class Broadcast:
    """The way out of one room. `state` returns the document's state vector."""

    def __init__(self, members: Sequence[Member], state: Callable[[], bytes]) -> None:
        self._members = members
        self._state = state
        self._fresh: list[tuple[Member | None, bytes]] = []

    def add(self, change: bytes, sender: Member | None) -> None:
        """Take in a change that is to go out to all but its sender."""
        self._fresh.append((sender, change))

    def send(self) -> None:
        """Send what has been taken in, to each connection as one frame, its own changes apart."""
        fresh, self._fresh = self._fresh, []
        senders = {sender for sender, _ in fresh}
        everything = yjs_protocol.encode_update(merge(change for _, change in fresh)) if fresh else b""
        for member in self._members if fresh else ():
            if member not in senders:
                self.tell(member, everything)
            elif others := [change for sender, change in fresh if sender is not member]:
                self.tell(member, yjs_protocol.encode_update(merge(others)))

    def tell(self, member: Member, frame: bytes) -> None:
        """Send somebody what all are told, unless it is behind."""
        if member.behind is not None:
            return
        member.post(frame)
        if member.is_full:
            self.send()  # so that what the document holds now has gone out
        if member.is_full and member.behind is None:
            member.behind = self._state()
            member.ask_for_state(member.behind)
        elif member.probe_is_due and not member.not_acted_on:
            member.ask_for_state(self._state())


def post_form(form: CompiledForm, member: Member, out: Broadcast) -> int:
    """Send a connection all of the form; return how many bytes that is."""
    frame = yjs_protocol.encode_compiled(form.now)
    _post(form, member, frame, out)
    return len(frame)


def broadcast_form(form: CompiledForm, members: Iterable[Member], out: Broadcast) -> None:
    """Send who looks at the form what is another in it, or all of it to who had another one before."""
    change, whole = form.change or {}, b""
    frame = yjs_protocol.encode_compiled(change) if "base" in change else b""
    for member in members:
        if member.shown is not None and member.shown == change.get("base"):
            _post(form, member, frame, out)
        elif member.shown is not None:
            whole = whole or yjs_protocol.encode_compiled(form.now)
            _post(form, member, whole, out)


def _post(form: CompiledForm, member: Member, frame: bytes, out: Broadcast) -> None:
    if form.now is not None and member.behind is None:
        member.shown = form.now["revision"]
        out.tell(member, frame)

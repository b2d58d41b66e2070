"""The compiled form as frames, for the connections that look at it."""

from __future__ import annotations

from collections.abc import Iterable

from editor.rooms import yjs_protocol
from editor.rooms.compiled_form import CompiledForm
from editor.rooms.member import Member
from editor.rooms.spreading import Spreading


def post_form(form: CompiledForm, member: Member, out: Spreading) -> int:
    """Send a connection all of the form; return how many bytes that is."""
    frame = yjs_protocol.encode_compiled(form.now)
    _post(form, member, frame, out)
    return len(frame)


def spread_form(form: CompiledForm, members: Iterable[Member], out: Spreading) -> None:
    """Send who looks at the form what is another in it, or all of it to who had another one before."""
    change, whole = form.change or {}, b""
    frame = yjs_protocol.encode_compiled(change) if "base" in change else b""
    for member in members:
        if member.shown is not None and member.shown == change.get("base"):
            _post(form, member, frame, out)
        elif member.shown is not None:
            whole = whole or yjs_protocol.encode_compiled(form.now)
            _post(form, member, whole, out)


def _post(form: CompiledForm, member: Member, frame: bytes, out: Spreading) -> None:
    if form.now is not None and member.behind is None:
        member.shown = form.now["revision"]
        out.tell(member, frame)

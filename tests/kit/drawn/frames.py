"""Frames of the program socket as a client reads them: without the limits of what the server takes."""

from __future__ import annotations

from pycrdt import Decoder

from editor.rooms import yjs_protocol


def read_frame(frame: bytes) -> yjs_protocol.Message:
    """Return what a frame of the server says about the document, or of who is here; of others ValueError is raised."""
    decoder = Decoder(frame)
    kind = decoder.read_var_uint()
    sync_kind = decoder.read_var_uint() if kind == yjs_protocol.SYNC else None
    content = decoder.read_message() or b""
    match kind, sync_kind:
        case yjs_protocol.SYNC, yjs_protocol.STEP_1:
            return yjs_protocol.SyncStep1(content)
        case yjs_protocol.SYNC, yjs_protocol.STEP_2:
            return yjs_protocol.SyncStep2(content)
        case yjs_protocol.SYNC, yjs_protocol.UPDATE:
            return yjs_protocol.Update(content)
        case yjs_protocol.AWARENESS, _:
            return yjs_protocol.decode_awareness(content)
    raise ValueError(f"No client reads a frame of type {kind}.")


def read_update(frame: bytes) -> bytes:
    """Return the update that a frame of the server brings; ValueError where it brings none."""
    message = read_frame(frame)
    if isinstance(message, yjs_protocol.SyncStep2 | yjs_protocol.Update):
        return message.update
    raise ValueError("The frame brings no update.")

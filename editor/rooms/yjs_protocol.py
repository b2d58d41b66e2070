"""The messages of the y-websocket protocol, decoded with bounds. Pure; a client's bytes are read here first.

A frame holds one message: 0 sync (0 step 1: a state vector, 1 step 2: an update, 2 an update), 1 awareness,
2 refusal (server only), 3 awareness query, 100 saved (a client asks; the server answers and goes on with two numbers:
of the messages of sync step 2 and of updates that this connection has sent, so many are in the database from the first
one on, and so many were not taken, since who only looks may change nothing),
101 compiled (a client asks by the revision that it has, 0 for none; the server answers and goes on with JSON).
"""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from editor.documents.yjs_encoding import (
    BadFrame,
    FrameTooLarge,
    Reader,
    decode_state_vector,
    encode_integer,
    encode_sized,
)

SYNC, AWARENESS, REFUSAL, QUERY_AWARENESS, SAVED, COMPILED = 0, 1, 2, 3, 100, 101
STEP_1, STEP_2, UPDATE = 0, 1, 2

MOST_FRAME_BYTES = 10 * 1024 * 1024
MOST_UPDATE_BYTES = MOST_FRAME_BYTES
"""Of one change; who comes back may send a whole document in one frame."""
MOST_STATE_VECTOR_BYTES, MOST_STATE_VECTOR_CLIENTS = 512 * 1024, 25_000
"""A document has 20,000 at most; somebody may have some more who were never told."""
MOST_AWARENESS_FRAME_BYTES = 2 * 1024 * 1024
MOST_AWARENESS_BYTES = 4096
MOST_AWARENESS_CLIENTS = 64


@dataclass(frozen=True, slots=True)
class SyncStep1:
    """A peer's state vector: it asks for what it lacks."""

    state: bytes


@dataclass(frozen=True, slots=True)
class SyncStep2:
    """The answer to a step 1: an update with everything that was lacking."""

    update: bytes


@dataclass(frozen=True, slots=True)
class Update:
    """A change, as it happens."""

    update: bytes


@dataclass(frozen=True, slots=True)
class AwarenessEntry:
    """What one client shows of itself; None when it has left. `clock` counts up."""

    client: int
    clock: int
    state: dict[str, Any] | None


@dataclass(frozen=True, slots=True)
class Awareness:
    """What clients show of themselves."""

    entries: tuple[AwarenessEntry, ...]


@dataclass(frozen=True, slots=True)
class QueryAwareness:
    """A peer asks for what everybody shows."""


@dataclass(frozen=True, slots=True)
class QueryCompiled:
    """A client wants to see the compiled form, now and after each edit; it has this revision of it, 0 for none."""

    revision: int


@dataclass(frozen=True, slots=True)
class QuerySaved:
    """A client wants to be told what of its messages is saved, now and after each change of that."""


Message = QuerySaved | SyncStep1 | SyncStep2 | Update | Awareness | QueryAwareness | QueryCompiled


def decode_frame(data: bytes) -> Message:
    """Decode a client's frame. Raises BadFrame, and FrameTooLarge for what is merely too large."""
    if len(data) > MOST_FRAME_BYTES:
        raise FrameTooLarge("The message", len(data), MOST_FRAME_BYTES)
    reader = Reader(data)
    kind = reader.integer()
    if kind == SYNC:
        message = _decode_sync(reader)
    elif kind == AWARENESS:
        message = decode_awareness(reader.sized(MOST_AWARENESS_FRAME_BYTES, "What is said of who is here"))
    elif kind == QUERY_AWARENESS:
        message = QueryAwareness()
    elif kind == SAVED:
        message = QuerySaved()
    elif kind == COMPILED:
        message = QueryCompiled(reader.integer())
    else:
        raise BadFrame(f"There is no message of type {kind}.")
    reader.end()
    return message


def _decode_sync(reader: Reader) -> Message:
    kind = reader.integer()
    if kind == STEP_1:
        state = reader.sized(MOST_STATE_VECTOR_BYTES, "The state vector")
        decode_state_vector(state, MOST_STATE_VECTOR_CLIENTS)
        return SyncStep1(state)
    if kind == STEP_2:
        return SyncStep2(reader.sized(MOST_FRAME_BYTES, "The answer to sync step 1"))
    if kind == UPDATE:
        return Update(reader.sized(MOST_UPDATE_BYTES, "The update"))
    raise BadFrame(f"There is no sync message of type {kind}.")


def decode_awareness(data: bytes) -> Awareness:
    """Decode an awareness update. Raises BadFrame."""
    reader = Reader(data)
    count = reader.integer()
    if count > MOST_AWARENESS_CLIENTS * 16:
        raise BadFrame("The message speaks for too many clients.")
    entries = tuple(_decode_entry(reader) for _ in range(count))
    reader.end()
    return Awareness(entries)


def _decode_entry(reader: Reader) -> AwarenessEntry:
    client, clock, raw = (
        reader.integer(),
        reader.integer(),
        reader.sized(MOST_AWARENESS_BYTES * 16, "What a client shows"),
    )
    try:
        state = json.loads(raw.decode(), parse_constant=_refuse_constant, parse_float=_finite)
    except BadFrame:
        raise
    except (ValueError, RecursionError) as error:
        raise BadFrame("What the client shows of itself is not JSON.") from error
    if state is not None and not isinstance(state, dict):
        raise BadFrame("What the client shows of itself is not a JSON object.")
    return AwarenessEntry(client, clock, state)


def _refuse_constant(name: str) -> None:
    raise BadFrame(f"{name} is not JSON.")


def _finite(digits: str) -> float:
    """Return the number; one that is too large for a browser would be told to others as a word that is not JSON."""
    number = float(digits)
    if not math.isfinite(number):
        raise BadFrame(f"{digits[:40]} is larger than a number may be.")
    return number


def encode_step_1(state: bytes) -> bytes:
    """Encode a frame that asks for what a state vector lacks."""
    return bytes((SYNC, STEP_1)) + encode_sized(state)


def encode_step_2(update: bytes) -> bytes:
    """Encode a frame that answers a step 1."""
    return bytes((SYNC, STEP_2)) + encode_sized(update)


def encode_update(update: bytes) -> bytes:
    """Encode a frame with a change."""
    return bytes((SYNC, UPDATE)) + encode_sized(update)


def encode_entries(entries: Sequence[AwarenessEntry]) -> bytes:
    """Encode an awareness update, without the frame around it."""
    return encode_integer(len(entries)) + b"".join(
        encode_integer(e.client) + encode_integer(e.clock) + encode_sized(_json(e.state)) for e in entries
    )


def encode_awareness(entries: Sequence[AwarenessEntry]) -> bytes:
    """Encode a frame with what clients show of themselves."""
    return bytes((AWARENESS,)) + encode_sized(encode_entries(entries))


def encode_saved(saved: int, refused: int) -> bytes:
    """Encode a frame that says how many of a connection's messages are in the database, and how many were not taken."""
    return encode_integer(SAVED) + encode_integer(saved) + encode_integer(refused)


def encode_compiled(form: object) -> bytes:
    """Encode a frame with a compiled form, or what is another in it than in the one before."""
    return encode_integer(COMPILED) + encode_sized(json.dumps(form, ensure_ascii=False, separators=(",", ":")).encode())


def encode_refusal(reason: str) -> bytes:
    """Encode a frame that says why the connection will be closed (y-protocols: permission denied)."""
    return bytes((REFUSAL, 0)) + encode_sized(reason.encode())


def _json(value: object) -> bytes:
    return json.dumps(value, separators=(",", ":"), allow_nan=False).encode()

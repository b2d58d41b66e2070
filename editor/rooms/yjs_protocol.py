"""The y-websocket protocol, decoded with bounds. Pure; the client's bytes are read here and nowhere else.

A frame holds one message: 0 sync (0 step 1: a state vector, 1 step 2: an update, 2 an update), 1 awareness,
2 refusal (server only), 3 awareness query, 100 saved (server only: a number and the state vector that is saved).
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

SYNC, AWARENESS, REFUSAL, QUERY_AWARENESS, SAVED = 0, 1, 2, 3, 100
STEP_1, STEP_2, UPDATE = 0, 1, 2

MOST_FRAME_BYTES = 10 * 1024 * 1024
MOST_STATE_VECTOR_BYTES = 512 * 1024
MOST_AWARENESS_BYTES = 4096
MOST_AWARENESS_CLIENTS = 64
MOST_INTEGER_BYTES = 8
_MOST_INTEGER = 2**53 - 1


class BadFrame(ValueError):
    """The frame is not the protocol; the message says what is wrong with it."""


class FrameTooLarge(BadFrame):
    """The frame is well-formed so far, and larger than is taken."""


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


Message = SyncStep1 | SyncStep2 | Update | Awareness | QueryAwareness


class Reader:
    """Reads a frame from its beginning; every read is bounded, and linear in what it reads."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self._at = 0

    def integer(self) -> int:
        """Read a variable-length unsigned integer of at most 53 bits."""
        value = shift = 0
        for position in range(self._at, min(self._at + MOST_INTEGER_BYTES, len(self._data))):
            byte = self._data[position]
            value |= (byte & 0x7F) << shift
            shift += 7
            if byte < 0x80:
                self._at = position + 1
                return self._checked(value)
        if self._at + MOST_INTEGER_BYTES <= len(self._data):
            raise BadFrame("A number in the message is longer than 53 bits.")
        raise BadFrame("The message ends within a number.")

    def _checked(self, value: int) -> int:
        if value > _MOST_INTEGER:
            raise BadFrame("A number in the message is longer than 53 bits.")
        return value

    def sized(self, limit: int) -> bytes:
        """Read a length and that many bytes."""
        length = self.integer()
        if self._at + length > len(self._data):
            raise BadFrame("The message ends before it should.")
        if length > limit:
            raise FrameTooLarge(f"A part of the message has {length} bytes; {limit} are taken.")
        self._at += length
        return self._data[self._at - length : self._at]

    def rest(self) -> bytes:
        """Read all that is left."""
        at, self._at = self._at, len(self._data)
        return self._data[at:]

    def end(self) -> None:
        """Make sure that nothing follows."""
        if self._at != len(self._data):
            raise BadFrame("Something follows the end of the message.")


def decode_frame(data: bytes) -> Message:
    """Decode a client's frame. Raises BadFrame, and FrameTooLarge for what is merely too large."""
    if len(data) > MOST_FRAME_BYTES:
        raise FrameTooLarge(f"The message has {len(data)} bytes; {MOST_FRAME_BYTES} are taken.")
    reader = Reader(data)
    kind = reader.integer()
    if kind == SYNC:
        message = _decode_sync(reader)
    elif kind == AWARENESS:
        message = decode_awareness(reader.sized(MOST_FRAME_BYTES))
    elif kind == QUERY_AWARENESS:
        message = QueryAwareness()
    else:
        raise BadFrame(f"There is no message of type {kind}.")
    reader.end()
    return message


def _decode_sync(reader: Reader) -> Message:
    kind = reader.integer()
    if kind == STEP_1:
        state = reader.sized(MOST_STATE_VECTOR_BYTES)
        decode_state_vector(state)
        return SyncStep1(state)
    if kind == STEP_2:
        return SyncStep2(reader.sized(MOST_FRAME_BYTES))
    if kind == UPDATE:
        return Update(reader.sized(MOST_FRAME_BYTES))
    raise BadFrame(f"There is no sync message of type {kind}.")


def decode_state_vector(data: bytes) -> dict[int, int]:
    """Decode a state vector: {client: clock}. Raises BadFrame."""
    reader = Reader(data)
    count = reader.integer()
    if count > len(data):
        raise BadFrame("The state vector is shorter than it says.")
    clocks = {}
    for _ in range(count):
        client = reader.integer()
        clocks[client] = reader.integer()
    reader.end()
    return clocks


def first_of_update(update: bytes) -> tuple[int, int] | None:
    """Return (client, clock) where an update of a single client begins; None when it has none or several."""
    reader = Reader(update)
    if reader.integer() != 1:
        return None
    reader.integer()
    return reader.integer(), reader.integer()


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
    client, clock, raw = reader.integer(), reader.integer(), reader.sized(MOST_AWARENESS_BYTES * 16)
    try:
        state = json.loads(raw.decode(), parse_constant=_refuse_constant)
    except (ValueError, RecursionError) as error:
        raise BadFrame("What the client shows of itself is not JSON.") from error
    if state is not None and not isinstance(state, dict):
        raise BadFrame("What the client shows of itself is not a JSON object.")
    return AwarenessEntry(client, clock, state)


def _refuse_constant(name: str) -> None:
    raise BadFrame(f"{name} is not JSON.")


def encode_integer(value: int) -> bytes:
    """Encode a variable-length unsigned integer."""
    out = bytearray()
    while value >= 0x80:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)
    return bytes(out)


def _sized(data: bytes) -> bytes:
    return encode_integer(len(data)) + data


def encode_state_vector(clocks: dict[int, int]) -> bytes:
    """Encode a state vector."""
    pairs = b"".join(encode_integer(client) + encode_integer(clock) for client, clock in clocks.items())
    return encode_integer(len(clocks)) + pairs


def encode_step_1(state: bytes) -> bytes:
    """Encode a frame that asks for what a state vector lacks."""
    return bytes((SYNC, STEP_1)) + _sized(state)


def encode_step_2(update: bytes) -> bytes:
    """Encode a frame that answers a step 1."""
    return bytes((SYNC, STEP_2)) + _sized(update)


def encode_update(update: bytes) -> bytes:
    """Encode a frame with a change."""
    return bytes((SYNC, UPDATE)) + _sized(update)


def encode_entries(entries: Sequence[AwarenessEntry]) -> bytes:
    """Encode an awareness update, without the frame around it."""
    return encode_integer(len(entries)) + b"".join(
        encode_integer(e.client) + encode_integer(e.clock) + _sized(_json(e.state)) for e in entries
    )


def encode_awareness(entries: Sequence[AwarenessEntry]) -> bytes:
    """Encode a frame with what clients show of themselves."""
    return bytes((AWARENESS,)) + _sized(encode_entries(entries))


def encode_saved(seq: int, state: bytes) -> bytes:
    """Encode a frame that says: everything up to this number, which is this state vector, is in the database."""
    return encode_integer(SAVED) + encode_integer(seq) + _sized(state)


def encode_refusal(reason: str) -> bytes:
    """Encode a frame that says why the connection will be closed (y-protocols: permission denied)."""
    return bytes((REFUSAL, 0)) + _sized(reason.encode())


def is_within(lesser: Iterable[tuple[int, int]], greater: dict[int, int]) -> bool:
    """Tell whether a state vector's clocks are all known to another one."""
    return all(greater.get(client, 0) >= clock for client, clock in lesser)


def _json(value: object) -> bytes:
    return json.dumps(value, separators=(",", ":")).encode()

"""How Yjs writes numbers, state vectors and updates as bytes, read with bounds. Pure.

A state vector says how far somebody knows a document: for each client the clock, the number of its changes.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

MOST_INTEGER_BYTES = 8
_MOST_INTEGER = 2**53 - 1


class BadFrame(ValueError):
    """The frame is not the protocol; the message says what is wrong with it."""


class FrameTooLarge(BadFrame):
    """The frame is well-formed so far, and a part of it has more bytes, or clients, than are taken."""

    def __init__(self, part: str, has: int, most: int, unit: str = "bytes") -> None:
        super().__init__(f"{part} has {has} {unit}; {most} is the most. Send less at once.")


class Reader:
    """Reads a frame from its beginning; every read is bounded, and linear in what it reads."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self._at = 0

    def integer(self) -> int:
        """Read a variable-length unsigned integer of at most 53 bits."""
        if self._at < len(self._data) and self._data[self._at] < 0x80:  # most are of one byte
            self._at += 1
            return self._data[self._at - 1]
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

    @property
    def left(self) -> int:
        """How many bytes are left."""
        return len(self._data) - self._at

    def byte(self) -> int:
        """Read one byte."""
        if self._at == len(self._data):
            raise BadFrame("The message ends before it should.")
        self._at += 1
        return self._data[self._at - 1]

    def peek(self) -> int:
        """Return the next byte, 0 at the end, and stay before it."""
        return self._data[self._at] if self._at < len(self._data) else 0

    def skip(self, length: int) -> int:
        """Pass over so many bytes; return where they begin."""
        if length > self.left:
            raise BadFrame("The message ends before it should.")
        self._at += length
        return self._at - length

    def signed(self) -> None:
        """Pass over a variable-length signed integer, of which each byte but the last has its highest bit set."""
        for _ in range(MOST_INTEGER_BYTES):
            if self.byte() < 0x80:
                return
        raise BadFrame("A number in the message is longer than 53 bits.")

    def sized(self, limit: int, part: str = "A part of the message") -> bytes:
        """Read a length and that many bytes; `part` is what they are called if they are more than `limit`."""
        length = self.integer()
        if self._at + length > len(self._data):
            raise BadFrame("The message ends before it should.")
        if length > limit:
            raise FrameTooLarge(part, length, limit)
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


def decode_state_vector(data: bytes, most_clients: int | None = None) -> dict[int, int]:
    """Decode a state vector: {client: clock}. Raises BadFrame, FrameTooLarge for one of more clients."""
    reader = Reader(data)
    count = reader.integer()
    if most_clients is not None and count > most_clients:
        raise FrameTooLarge("The state vector", count, most_clients, "clients")
    if count > len(data):
        raise BadFrame("The state vector is shorter than it says.")
    clocks = {}
    for _ in range(count):
        client = reader.integer()
        clocks[client] = reader.integer()
    reader.end()
    return clocks


def encode_state_vector(clocks: dict[int, int]) -> bytes:
    """Encode a state vector."""
    pairs = b"".join(encode_integer(client) + encode_integer(clock) for client, clock in clocks.items())
    return encode_integer(len(clocks)) + pairs


def is_within(lesser: Iterable[tuple[int, int]], greater: Mapping[int, int]) -> bool:
    """Tell whether a state vector's clocks are all known to another one."""
    return all(greater.get(client, 0) >= clock for client, clock in lesser)


def encode_integer(value: int) -> bytes:
    """Encode a variable-length unsigned integer."""
    out = bytearray()
    while value >= 0x80:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)
    return bytes(out)


def encode_sized(data: bytes) -> bytes:
    """Encode bytes behind their length."""
    return encode_integer(len(data)) + data

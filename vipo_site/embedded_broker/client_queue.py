"""What waits for one client of the embedded broker: a queue with limits, and the messages that it has not acknowledged.

The limits are those of Mosquitto in deploy/mosquitto/mosquitto.conf, smaller for a device, and in bytes as well: a
process that also serves the screens must not grow by what somebody does not read.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass

LAST_NUMBER = 65535
OVERHEAD_BYTES = 200
_PUBLISH, _AGAIN, _RETAINED = 0x30, 0x08, 0x01


@dataclass(frozen=True, slots=True)
class Room:
    """How much may wait for one client: messages, bytes, and messages that were sent and not acknowledged."""

    messages: int
    size: int
    flying: int


DEVICE_ROOM = Room(1_000, 2**20, 20)
READER_ROOM = Room(5_000, 2**21, 20)
"""For a program that looks on: it asks for all values of a site at once."""
SERVER_ROOM = Room(100_000, 2**26, 1_000)


@dataclass(slots=True)
class Letter:
    """A message on its way to one client; `number` is 0 until it is sent with QoS 1."""

    topic: bytes
    payload: bytes
    qos: int
    retained: bool = False
    number: int = 0
    again: bool = False

    @property
    def size(self) -> int:
        """Bytes that it takes, roughly."""
        return len(self.topic) + len(self.payload) + OVERHEAD_BYTES

    def packet(self) -> bytes:
        """Return it as a PUBLISH of MQTT 3.1.1."""
        head = _PUBLISH | self.qos << 1 | (_AGAIN if self.again else 0) | (_RETAINED if self.retained else 0)
        number = self.number.to_bytes(2, "big") if self.qos else b""
        body = len(self.topic).to_bytes(2, "big") + self.topic + number + self.payload
        return bytes((head,)) + length_bytes(len(body)) + body


class Outbox:
    """The messages for one client, in their order; it outlives a connection when the client's session does."""

    def __init__(self, room: Room) -> None:
        self.news = asyncio.Event()
        self._room = room
        self._waiting: deque[Letter] = deque()
        self._flying: dict[int, Letter] = {}
        self._once_more: set[int] = set()
        self._size = 0
        self._last = 0

    def __len__(self) -> int:
        return len(self._waiting) + len(self._flying)

    def put(self, letter: Letter) -> bool:
        """Queue a message; False when there is no room for it."""
        if len(self) >= self._room.messages or self._size + letter.size > self._room.size:
            return False
        self._size += letter.size
        self._waiting.append(letter)
        self.news.set()
        return True

    def begin(self) -> None:
        """Begin a connection: what was not acknowledged in the one before goes out first, once more."""
        for letter in self._flying.values():
            letter.again = True
        self._waiting.extendleft(reversed(self._flying.values()))
        self._once_more |= self._flying.keys()
        self._flying = {}
        self.news.set()

    def packets(self) -> Iterator[bytes]:
        """Yield what may be sent now."""
        while self._waiting and (self._waiting[0].qos == 0 or len(self._flying) < self._room.flying):
            letter = self._waiting.popleft()
            if letter.qos:
                letter.number = letter.number or self._next_number()
                self._once_more.discard(letter.number)
                self._flying[letter.number] = letter
            else:
                self._size -= letter.size
            yield letter.packet()

    def acknowledge(self, number: int) -> None:
        """Forget a message that the client has."""
        letter = self._flying.pop(number, None)
        if letter is not None:
            self._size -= letter.size
            self.news.set()

    def _next_number(self) -> int:
        """Return a packet id that no message has, not even one that will be sent once more."""
        while True:
            self._last = self._last % LAST_NUMBER + 1
            if self._last not in self._flying and self._last not in self._once_more:
                return self._last


def length_bytes(length: int) -> bytes:
    """Return a packet's length as MQTT writes it: seven bits in each byte, the lowest first."""
    written = bytearray()
    while True:
        length, low = length >> 7, length & 0x7F
        written.append(low | 0x80 if length else low)
        if not length:
            return bytes(written)

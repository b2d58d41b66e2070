"""MQTT 3.1.1 by hand, for clients that behave badly."""

from __future__ import annotations

import socket
import time
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager

from vipo_site.embedded_broker.access_control import Line, PasswordAccess
from vipo_site.embedded_broker.server import EmbeddedBroker


def field(data: bytes | str) -> bytes:
    data = data.encode() if isinstance(data, str) else data
    return len(data).to_bytes(2, "big") + data


def length_of(length: int) -> bytes:
    written = b""
    while length > 127:
        written, length = written + bytes((length & 127 | 128,)), length >> 7
    return written + bytes((length,))


def packet(head: int, *parts: bytes) -> bytes:
    body = b"".join(parts)
    return bytes((head,)) + length_of(len(body)) + body


def connect(
    name: str,
    word: str,
    *,
    user: str = "",
    keepalive_s: int = 60,
    clean: bool = True,
    will: tuple[str, str] | None = None,
) -> bytes:
    flags = 0xC0 | (2 if clean else 0) | (0x0C if will else 0)
    last = field(will[0]) + field(will[1]) if will else b""
    return packet(
        0x10,
        field("MQTT"),
        bytes((4, flags)),
        keepalive_s.to_bytes(2, "big"),
        field(name),
        last,
        field(user or name),
        field(word),
    )


def publish(topic: str, payload: bytes, *, qos: int = 0, number: int = 1, retain: bool = False) -> bytes:
    mid = number.to_bytes(2, "big") if qos else b""
    return packet(0x30 | qos << 1 | retain, field(topic), mid, payload)


def subscribe(number: int, *filters: str, qos: int = 1) -> bytes:
    return packet(0x82, number.to_bytes(2, "big"), *(field(each) + bytes((qos,)) for each in filters))


class Raw:
    """A client's socket; `room` is how many bytes the system keeps for it that it has not read."""

    def __init__(self, broker: EmbeddedBroker, hello: bytes, room: int | None = None) -> None:
        self.socket = socket.socket()
        if room is not None:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, room)
        self.socket.settimeout(20)
        self.socket.connect(("127.0.0.1", broker.port))
        self.send(hello)

    def send(self, data: bytes) -> None:
        self.socket.sendall(data)

    def read(self) -> tuple[int, bytes]:
        """Return the first byte and the body of the next packet."""
        head, byte = self._exactly(2)
        length, shift = byte & 127, 7
        while byte & 128:
            (byte,) = self._exactly(1)
            length, shift = length | (byte & 127) << shift, shift + 7
        return head, self._exactly(length)

    def closed(self, within_s: float = 20) -> bool:
        """Tell whether the broker ends the connection in time; what it says until then is left aside."""
        self.socket.settimeout(within_s)
        deadline = time.monotonic() + within_s
        try:
            while time.monotonic() < deadline:
                if not self.socket.recv(65536):
                    return True
        except TimeoutError:
            return False
        except OSError:
            return True
        return False

    def _exactly(self, size: int) -> bytes:
        data = b""
        while len(data) < size:
            data += (piece := self.socket.recv(size - len(data)))
            assert piece, "the broker closed the connection"
        return data


@contextmanager
def raw(broker: EmbeddedBroker, hello: bytes, answer: bytes = b"\x00\x00", room: int | None = None) -> Iterator[Raw]:
    made = Raw(broker, hello, room)
    with made.socket:
        assert made.read() == (0x20, answer)
        yield made


class Notebook(PasswordAccess):
    """Lets in whoever knows the word, and keeps what is noted."""

    def __init__(self, word: str) -> None:
        super().__init__(lambda _username, password: password == word)
        self.dropped: Counter[str] = Counter()
        self.lines: list[tuple[str, str]] = []

    def wait(self) -> None:
        time.sleep(0.05)

    def record(self, dropped: Mapping[str, int], lines: Sequence[Line]) -> None:
        self.dropped.update(dropped)
        self.lines += [(device, line) for device, line, _ in lines]

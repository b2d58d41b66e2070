"""How soon a stop is heard by a hundred devices, each on a connection of its own."""

from __future__ import annotations

import json
import selectors
import socket
import struct
import threading
import time
from collections import defaultdict

from django.conf import settings

from bench.flow import packet, text
from execution.floor.stop_publisher import stop_topic

TOLD = 0x30
LIMIT_S = 30.0


class Ears:
    """Connections that hear the stop of a site at QoS 1, as devices do, and note by one clock when they did."""

    def __init__(self, site: str, count: int) -> None:
        self._count, self._rest = count, dict[socket.socket, bytes]()
        self._heard: defaultdict[int, dict[socket.socket, float]] = defaultdict(dict)
        self._changed = threading.Condition()
        self._selector = selectors.DefaultSelector()
        subscription = struct.pack("!H", 1) + text(stop_topic(site)) + b"\x01"
        for number in range(count):
            opened = socket.create_connection(("127.0.0.1", int(str(settings.VIPO_MQTT["port"]))), timeout=20)
            opened.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            who = text(f"ear-{number}") + text("server") + text(str(settings.VIPO_MQTT["password"]))
            opened.sendall(packet(0x10, text("MQTT") + b"\x04\xc2\x00\x00" + who) + packet(0x82, subscription))
            self._rest[opened] = b""
            self._selector.register(opened, selectors.EVENT_READ)
        self._open = True
        self._thread = threading.Thread(target=self._hear, daemon=True)
        self._thread.start()

    def wait(self, fence: int) -> list[float]:
        """Return when each of them heard what was said under a fence, in seconds of `perf_counter`."""
        with self._changed:
            if not self._changed.wait_for(lambda: len(self._heard[fence]) >= self._count, LIMIT_S):
                raise RuntimeError(f"{len(self._heard[fence])} of {self._count} devices have heard the stop.")
            return list(self._heard[fence].values())

    def close(self) -> None:
        self._open = False
        self._thread.join(5)
        for opened in self._rest:
            opened.close()

    def _hear(self) -> None:
        while self._open:
            for key, _ in self._selector.select(0.2):
                self._read(key.fileobj)  # type: ignore[arg-type]  # what was registered is a socket

    def _read(self, opened: socket.socket) -> None:
        """Take in what the broker says, and acknowledge what it wants to have acknowledged."""
        data = self._rest[opened] + opened.recv(65_536)
        at = time.perf_counter()
        while (found := _take_packet(data)) is not None:
            kind, body, data = found
            if kind & 0xF0 == TOLD:
                begins, is_once = 2 + struct.unpack_from("!H", body)[0], bool(kind & 0x06)
                opened.sendall(packet(0x40, body[begins : begins + 2]) if is_once else b"")
                self._note(json.loads(body[begins + 2 * is_once :])["fence"], opened, at)
        self._rest[opened] = data

    def _note(self, fence: int, ear: socket.socket, at: float) -> None:
        """Note the first time only: two processes say the same."""
        with self._changed:
            self._heard[fence].setdefault(ear, at)
            self._changed.notify_all()


def _take_packet(data: bytes) -> tuple[int, bytes, bytes] | None:
    """Return the first packet's kind and body, and what is behind it; None while it is not whole."""
    length, shift, begins = 0, 0, 1
    while begins < len(data):
        byte = data[begins]
        length, shift, begins = length | (byte & 0x7F) << shift, shift + 7, begins + 1
        if not byte & 0x80:
            whole = len(data) >= begins + length
            return (data[0], data[begins : begins + length], data[begins + length :]) if whole else None
    return None

"""A flow of state messages from many devices, written straight to a broker's socket so that the sender costs little."""

from __future__ import annotations

import json
import os
import socket
import struct
import threading
import time
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
USER = "server"
TICKS_PER_S = os.sysconf("SC_CLK_TCK")


def cpu_seconds(pid: int) -> float:
    """Return the processor time that a process has used in all its threads."""
    fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / TICKS_PER_S


def device_name(number: int) -> str:
    return f"device{number:04d}"


def state(number: int, seq: int) -> bytes:
    """Return a state as a robot says it on its way: everything differs from the last one."""
    body = {
        "boot": 1,
        "seq": seq,
        "done": seq % 7 == 0,
        "loc": [number % 40 + seq * 0.01, number / 40, 0.0, round(seq * 0.1 % 3, 3)],
        "props": {"battery": 90 - seq * 0.1, "temperature": 20 + seq * 0.25},
    }
    return json.dumps(body).encode()


@dataclass
class Flow:
    """`rounds` states of each of `devices` devices, `pace` a second in all, QoS 1; `first` is the first seq."""

    port: int
    password: str
    devices: int
    rounds: int
    pace: float
    first: int = 1

    @property
    def last(self) -> int:
        """The seq of the last state of each device."""
        return self.first + self.rounds - 1

    def send(self) -> float:
        """Send all, and return how many seconds it took."""
        with socket.create_connection(("127.0.0.1", self.port), timeout=60) as broker:
            broker.sendall(_connect_packet(self.password))
            if broker.recv(4) != b"\x20\x02\x00\x00":
                raise RuntimeError("The broker did not let the sender in.")
            threading.Thread(target=_drain, args=(broker,), daemon=True).start()
            began = time.perf_counter()
            self._send_rounds(broker, began)
            took = time.perf_counter() - began
            time.sleep(1)
        return took

    def _send_rounds(self, broker: socket.socket, began: float) -> None:
        chunk, sent = 50, 0
        for seq in range(self.first, self.last + 1):
            for start in range(0, self.devices, chunk):
                numbers = range(start, min(start + chunk, self.devices))
                packets = [
                    _publish_packet(f"vipo/v1/dev/{device_name(n)}/up/state", state(n, seq), (sent + i) % 65535 + 1)
                    for i, n in enumerate(numbers)
                ]
                broker.sendall(b"".join(packets))
                sent += len(packets)
                ahead = began + sent / self.pace - time.perf_counter()
                if ahead > 0:
                    time.sleep(ahead)


def _drain(broker: socket.socket) -> None:
    """Read acknowledgements away, so that the broker never waits for us."""
    try:
        while broker.recv(65536):
            pass
    except OSError:
        return


def text(value: str) -> bytes:
    data = value.encode()
    return struct.pack("!H", len(data)) + data


def packet(kind: int, body: bytes) -> bytes:
    length, head = len(body), bytearray([kind])
    while True:
        head.append(length % 128 | (0x80 if length > 127 else 0))
        length //= 128
        if not length:
            return bytes(head) + body


def _connect_packet(password: str) -> bytes:
    return packet(0x10, text("MQTT") + b"\x04\xc2\x00\x00" + text("bench-sender") + text(USER) + text(password))


def _publish_packet(topic: str, payload: bytes, number: int) -> bytes:
    return packet(0x32, text(topic) + struct.pack("!H", number) + payload)

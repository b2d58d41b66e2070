"""The firmware's MQTT client, on the real MicroPython: against Mosquitto, and against a broker that misbehaves."""

from __future__ import annotations

import json
import socket
import subprocess
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path

from tests.firmware.rig import FIRMWARE, HEAP, LIMIT_S
from tests.kit.mqtt import Ear
from tests.kit.servers import run_mosquitto
from tests.kit.waiting import wait_for

CONNECT, CONNACK, PUBLISH, PUBACK, PINGREQ, PINGRESP = 0x10, 0x20, 0x30, 0x40, 0xC0, 0xD0
WRAP = 65535


@dataclass(frozen=True)
class Packet:
    """What the client sent on its `connection`-th connection; `number` is a PUBLISH's packet id."""

    connection: int
    kind: int
    body: bytes

    @property
    def number(self) -> int:
        end = 2 + int.from_bytes(self.body[:2], "big")
        return int.from_bytes(self.body[end : end + 2], "big")

    @property
    def payload(self) -> bytes:
        return self.body[4 + int.from_bytes(self.body[:2], "big") :]

    @property
    def again(self) -> bool:
        return bool(self.kind & 0x08)


Answer = Callable[[Packet], bytes | None]


@dataclass
class RudeBroker:
    """Answers each packet as the test says: some bytes, nothing (b""), or None to hang up."""

    answer: Answer
    packets: list[Packet] = field(default_factory=list)
    connections: int = 0

    def serve(self, listener: socket.socket) -> None:
        with suppress(OSError):
            while True:
                connection, _ = listener.accept()
                self.connections += 1
                with connection, suppress(OSError, EOFError):
                    connection.settimeout(LIMIT_S)
                    self._talk(connection)

    def _talk(self, connection: socket.socket) -> None:
        while True:
            kind = self._exactly(connection, 1)[0]
            length = self._exactly(connection, 1)[0]
            assert length < 128
            packet = Packet(self.connections, kind, self._exactly(connection, length))
            self.packets.append(packet)
            answer = self.answer(packet)
            if answer is None:
                return
            connection.sendall(answer)

    def _exactly(self, connection: socket.socket, length: int) -> bytes:
        data = b""
        while len(data) < length:
            piece = connection.recv(length - len(data))
            if not piece:
                raise EOFError
            data += piece
        return data

    def published(self, connection: int = 0) -> list[Packet]:
        return [p for p in self.packets if p.kind & 0xF0 == PUBLISH and connection in (0, p.connection)]


PROGRAM = """
import asyncio
from vipo.mqtt import Client
client = Client("127.0.0.1", {port}, "soak", "word", keepalive_s={keepalive})
client.first_back_off_s = 0.05
client.outbox.last_id = {first} - 1
client.on_down = lambda why: print("down:", why)
async def main():
    task = asyncio.create_task(client.run())
    for number in range({count}):
        client.publish("up", b"%d" % number)
        await asyncio.sleep(0.02)
{more}
    while client.pending():
        await asyncio.sleep(0.02)
    print("all acknowledged")
asyncio.run(main())
"""


@contextmanager
def client_at(
    micropython: str,
    folder: Path,
    answer: Answer,
    *,
    count: int = 1,
    first: int = 1,
    keepalive: float = 15,
    more: str = "",
) -> Iterator[tuple[RudeBroker, subprocess.Popen[str]]]:
    """Run a client that sends `count` messages to a broker that answers as it is told."""
    broker = RudeBroker(answer)
    with socket.create_server(("127.0.0.1", 0)) as listener:
        thread = threading.Thread(target=broker.serve, args=(listener,), daemon=True)
        thread.start()
        path = folder / "program.py"
        port = listener.getsockname()[1]
        path.write_text(PROGRAM.format(port=port, keepalive=keepalive, first=first, count=count, more=more))
        with subprocess.Popen(
            [micropython, *HEAP, str(path)],
            env={"MICROPYPATH": f"{FIRMWARE / 'lib'}:.frozen", "PATH": "/usr/bin:/bin"},
            stdout=subprocess.PIPE,
            text=True,
        ) as process:
            try:
                yield broker, process
            finally:
                process.kill()
        listener.shutdown(socket.SHUT_RDWR)
    thread.join(LIMIT_S)


def well(packet: Packet) -> bytes | None:
    """Answer as a good broker does."""
    kind = packet.kind & 0xF0
    if kind == CONNECT:
        return bytes((CONNACK, 2, 0, 0))
    if kind == PUBLISH:
        return bytes((PUBACK, 2)) + packet.number.to_bytes(2, "big")
    return bytes((PINGRESP, 0)) if kind == PINGREQ else b""


def ended(process: subprocess.Popen[str]) -> str:
    assert process.stdout is not None
    out, _ = process.communicate(timeout=LIMIT_S)
    assert process.returncode == 0, out
    return out


def test_packet_ids_go_round_and_leave_out_those_in_flight(micropython: str, tmp_path: Path) -> None:
    held: list[Packet] = []

    def hold_the_last(packet: Packet) -> bytes | None:
        if packet.kind & 0xF0 == PUBLISH and packet.number == WRAP and not held:
            held.append(packet)
            return b""
        answer = well(packet)
        if packet.kind & 0xF0 == PUBLISH and packet.payload == b"7":
            return (answer or b"") + bytes((PUBACK, 2)) + WRAP.to_bytes(2, "big")
        return answer

    # The ids go round a second time while the broker still owes an answer to 65535.
    more = (
        f"    client.outbox.last_id = {WRAP} - 2\n"
        "    for number in range(4, 8):\n"
        '        client.publish("up", b"%d" % number)\n'
        "        await asyncio.sleep(0.02)"
    )
    with client_at(micropython, tmp_path, hold_the_last, count=4, first=WRAP - 1, more=more) as (broker, process):
        assert ended(process) == "all acknowledged\n"
    assert [(p.number, p.payload) for p in broker.published()] == [
        *((WRAP - 1, b"0"), (WRAP, b"1"), (1, b"2"), (2, b"3")),
        *((WRAP - 1, b"4"), (1, b"5"), (2, b"6"), (3, b"7")),
    ]


def test_what_was_not_acknowledged_is_sent_again_in_order_and_marked(micropython: str, tmp_path: Path) -> None:
    def hang_up_at_the_third(packet: Packet) -> bytes | None:
        if packet.connection == 1 and packet.kind & 0xF0 == PUBLISH:
            return b"" if packet.payload != b"2" else None
        return well(packet)

    with client_at(micropython, tmp_path, hang_up_at_the_third, count=4) as (broker, process):
        assert ended(process).splitlines()[-1] == "all acknowledged"
    assert [(p.number, p.again) for p in broker.published(1)] == [(1, False), (2, False), (3, False)]
    second = [(p.payload, p.number, p.again) for p in broker.published(2)]
    assert second[:3] == [(b"0", 1, True), (b"1", 2, True), (b"2", 3, True)]
    assert second[3][0] == b"3"


def test_a_broker_that_falls_silent_is_left_and_looked_for_again(micropython: str, tmp_path: Path) -> None:
    def say_nothing_more(packet: Packet) -> bytes | None:
        return b"" if packet.connection == 1 and packet.kind & 0xF0 != CONNECT else well(packet)

    with client_at(micropython, tmp_path, say_nothing_more, keepalive=4) as (broker, process):
        assert ended(process) == "down: the broker fell silent\nall acknowledged\n"
    assert PINGREQ in {p.kind for p in broker.packets if p.connection == 1}


def test_a_broker_that_talks_nonsense_or_refuses_is_asked_again(micropython: str, tmp_path: Path) -> None:
    answers = [
        b"\x20\x02\x00\x05",
        b"HTTP/1.1 400 Bad Request\r\n\r\n",
        b"\x20\x02\x00\x00\x30\xff\xff\xff\xff\x7f",
        None,
    ]

    def misbehave(packet: Packet) -> bytes | None:
        return answers[packet.connection - 1] if packet.connection <= len(answers) else well(packet)

    with client_at(micropython, tmp_path, misbehave) as (broker, process):
        told = ended(process).splitlines()
    assert told[0] == "down: refused: the key"
    assert told[1] == "down: the broker did not answer as one"
    assert told[-1] == "all acknowledged"
    assert broker.connections == len(answers) + 1


def test_a_broker_that_lets_in_and_hangs_up_is_asked_ever_more_seldom(micropython: str, tmp_path: Path) -> None:
    came: list[float] = []

    def hang_up(packet: Packet) -> bytes | None:
        if packet.kind & 0xF0 == CONNECT:
            came.append(time.monotonic())
            return well(packet)
        return None if packet.connection < 6 else well(packet)

    with client_at(micropython, tmp_path, hang_up) as (_, process):
        assert ended(process).splitlines()[-1] == "all acknowledged"
    pauses_s = 0.05 * sum(2**n for n in range(5))
    assert came[5] - came[0] > 0.75 * pauses_s, "five pauses of the first one's length would be a sixth of it"


def test_a_large_message_comes_whole(micropython: str, tmp_path: Path) -> None:
    more = '    client.publish("up", bytes(range(65, 88)) * 400)\n    client.publish("up", b"after")'
    with (
        run_mosquitto(tmp_path, {"server": "secret", "soak": "word"}) as mosquitto,
        Ear(mosquitto.port, "secret", "vipo/v1/dev/soak/up/ack") as ear,
    ):
        path = tmp_path / "program.py"
        program = PROGRAM.format(port=mosquitto.device_port, keepalive=15, first=1, count=2, more=more)
        path.write_text(program.replace('"up"', '"vipo/v1/dev/soak/up/ack"'))
        environment = {"MICROPYPATH": f"{FIRMWARE / 'lib'}:.frozen", "PATH": "/usr/bin:/bin"}
        command = [micropython, "-X", "heapsize=80k", str(path)]
        done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=LIMIT_S)
        assert done.stdout == "all acknowledged\n", done.stdout + done.stderr
        wait_for("every message", lambda: len(ear.heard) >= 4)
    assert [h.payload for h in ear.heard] == [b"0", b"1", bytes(range(65, 88)) * 400, b"after"]


def test_seventy_thousand_messages_pass_the_end_of_the_packet_ids(micropython: str, tmp_path: Path) -> None:
    count = 70_000
    with (
        run_mosquitto(tmp_path, {"server": "secret", "soak": "soaked"}) as mosquitto,
        Ear(mosquitto.port, "secret", "vipo/v1/dev/soak/up/ack") as ear,
    ):
        done = subprocess.run(
            [micropython, *HEAP, str(Path(__file__).with_name("soak.py")), str(mosquitto.device_port), str(count), "1"],
            env={"MICROPYPATH": f"{FIRMWARE / 'lib'}:.frozen", "PATH": "/usr/bin:/bin"},
            capture_output=True,
            text=True,
            timeout=600,
        )
        assert done.returncode == 0, done.stdout + done.stderr
        wait_for("every message", lambda: len(ear.heard) >= count)
    assert [int(h.payload) for h in ear.heard] == list(range(count))
    told = json.loads(done.stdout)
    assert (told["connections"], told["last_id"]) == (1, count - WRAP)
    assert told["bytes_at_the_end"] < told["bytes_at_a_tenth"] + 4096
    assert told["largest_block_at_the_end"] > told["largest_block_at_a_tenth"] - 2048, (
        "the heap is ever more full of holes"
    )

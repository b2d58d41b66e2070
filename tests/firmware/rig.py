"""What the firmware's tests share: brokers it speaks to, and the firmware as a process that is listened to."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from tests.kit.files import ROOT
from tests.kit.mqtt import Ear, Heard
from tests.kit.servers import free_port, run_mosquitto
from tests.kit.waiting import PATIENCE_S, wait_for
from vipo_site.embedded_broker.server import EmbeddedBroker, start_broker

FIRMWARE = ROOT / "firmware"
SHADOW = Path(__file__).resolve().parent / "shadow"
DEVICE = "paintMixer02"
SPEED = 60  # a minute of mixing takes a second
ACCOUNTS = {"server": "secret", DEVICE: "mixer's word"}
LIMIT_S = PATIENCE_S
# A kilobyte of a computer's heap holds half of what one of the chip's holds: its words are twice as long.
HEAP_BYTES = 112 * 1024
HEAP = ("-X", f"heapsize={HEAP_BYTES}")
IMPORTS = "import gc, os, sys, time; gc.collect(); before = gc.mem_alloc(); "
MEASURE = IMPORTS + "import machine, network; gc.collect(); print(gc.mem_alloc() - before)"


class EmbeddedBus:
    """amqtt, on a port that it keeps over a restart."""

    def __init__(self) -> None:
        self.device_port = self.port = free_port()
        self.authority = ""
        self.accounts = dict(ACCOUNTS)
        self._broker: EmbeddedBroker | None = None

    def start(self) -> None:
        self._broker = start_broker(
            port=self.port, server_password=ACCOUNTS["server"], check_password=lambda u, p: self.accounts.get(u) == p
        )

    def kill(self) -> None:
        assert self._broker is not None
        self._broker.stop()

    stop = kill


@contextmanager
def running_bus(kind: str, folder: Path) -> Iterator[Any]:
    if kind == "amqtt":
        embedded = EmbeddedBus()
        embedded.start()
        yield embedded
        embedded.stop()
        return
    with run_mosquitto(folder, ACCOUNTS, tls=kind == "mosquitto with TLS") as mosquitto:
        yield mosquitto


@contextmanager
def listening(bus: Any) -> Iterator[Ear]:
    from vipo_device.protocol.sockets import tls_context

    with Ear(bus.port, ACCOUNTS["server"], tls=tls_context(bus.authority) if bus.authority else None) as ear:
        yield ear


@dataclass
class Running:
    """A running firmware and who listens to it."""

    ear: Ear
    bus: Any
    process: subprocess.Popen[bytes]
    log: Path
    interpreter: list[str] = field(default_factory=list)
    device: str = DEVICE

    @property
    def up(self) -> str:
        return f"vipo/v1/dev/{self.device}/up/"

    @property
    def down(self) -> str:
        return f"vipo/v1/dev/{self.device}/down/"

    def tell(self, method: str, command_id: str, **values: Any) -> None:
        self.ear.tell(self.device, method, command_id, **values)

    def answer(self, command: str, status: str) -> Heard:
        return self.ear.wait(
            lambda h: h.topic == self.up + "ack" and h.json["id"] == command and h.json["st"] == status, LIMIT_S
        )

    def answers(self, command: str) -> list[str]:
        return [h.json["st"] for h in self.ear.all("/ack") if h.json["id"] == command]

    def state(self, wanted: Callable[[Any], bool]) -> dict[str, Any]:
        found: dict[str, Any] = self.ear.wait(lambda h: h.topic == self.up + "state" and wanted(h.json), LIMIT_S).json
        return found

    def end(self) -> None:
        self.process.kill()
        self.process.wait()


def configuration(bus: Any, folder: Path, **more: Any) -> dict[str, Any]:
    return {
        "host": "localhost" if bus.authority else "127.0.0.1",
        "port": bus.device_port,
        "id": DEVICE,
        "password": ACCOUNTS[DEVICE],
        "speed": SPEED,
        "site": "hall",
        "ca": bus.authority,
        "boot_file": str(folder / "boot"),
        "key_file": str(folder / "key"),
        "ledger_file": str(folder / "ledger"),
        **more,
    }


def start_firmware(interpreter: list[str], folder: Path, bus: Any, **more: Any) -> subprocess.Popen[bytes]:
    """Start unix_main.py; its panel's lines go to panel.log."""
    path = folder / "configuration.json"
    path.write_text(json.dumps(configuration(bus, folder, log=str(folder / "panel.log"), **more)))
    return subprocess.Popen([*interpreter, str(FIRMWARE / "unix_main.py"), str(path)])


@dataclass(frozen=True)
class Chip:
    """A board that runs main.py: its folder is the flash, `record` what was done to its hardware."""

    folder: Path
    process: subprocess.Popen[bytes]

    @property
    def record(self) -> list[list[Any]]:
        """Return [microseconds, what, …] of all that was recorded so far."""
        path = self.folder / "record"
        return read_record(path.read_bytes()) if path.exists() else []

    @property
    def console(self) -> str:
        return (self.folder / "console").read_text()

    def wait(self, wanted: Callable[[list[list[Any]]], Any]) -> Any:
        return wait_for("what the board shall do", lambda: wanted(self.record), story=lambda: self.console)


def read_record(data: bytes) -> list[list[Any]]:
    """Read what shadow/machine.py writes; the last entry may not be whole yet."""
    entries: list[list[Any]] = []
    while b"\n" in data:
        at, what, *numbers, size = data[: (end := data.index(b"\n"))].decode().split()
        body, data = data[end + 1 : end + 1 + int(size)], data[end + 1 + int(size) :]
        if len(body) < int(size):
            break
        more = [list(body)] if what == "write" else json.loads(body or b"[]")
        entries.append([int(at), what, *(int(number) for number in numbers), *more])
    start = entries[0][0] if entries else 0
    return [[at - start, *rest] for at, *rest in entries]


@cache
def heap_of_a_board(micropython: str) -> tuple[str, str]:
    """Return the option for a heap of 112 kB, and what the stand-ins for `machine` and `network` take besides.

    On a board these two lie in the flash and take nothing of it.
    """
    environment = {"MICROPYPATH": f"{SHADOW}:.frozen", "VIPO_RECORD": os.devnull}
    done = subprocess.run([micropython, "-c", MEASURE], env=environment, capture_output=True, text=True, check=True)
    return "-X", f"heapsize={HEAP_BYTES + int(done.stdout)}"


@contextmanager
def running_chip(
    micropython: str, folder: Path, environment: Mapping[str, str], *, main: Path = FIRMWARE / "main.py"
) -> Iterator[Chip]:
    """Run main.py as the chip would, on the real MicroPython, with recorded hardware."""
    settings = {
        "MICROPYPATH": f"{SHADOW}:{FIRMWARE / 'lib'}:.frozen",
        "VIPO_RECORD": str(folder / "record"),
        "VIPO_I2C": "39",
        "VIPO_WIFI": "hall",
        **environment,
    }
    with (folder / "console").open("wb") as console:
        process = subprocess.Popen(
            [micropython, *heap_of_a_board(micropython), str(main)],
            cwd=folder,
            env={**os.environ, **settings},
            stdout=console,
            stderr=console,
        )
    try:
        yield Chip(folder, process)
    finally:
        process.kill()
        process.wait()


def interpreter_command(micropython: str | None) -> list[str]:
    """Return how to run a file: on MicroPython with the chip's heap, or on this Python."""
    return [micropython, *HEAP] if micropython else [sys.executable]


RED, GREEN, BLUE, OUTPUT = 25, 26, 27, 23


PINS = {"sda": 21, "scl": 22, "red": RED, "green": GREEN, "blue": BLUE, "output": OUTPUT, "button": 0}


def flash(folder: Path, settings: dict[str, Any]) -> None:
    (folder / "config.json").write_text(json.dumps({"wifi_name": "hall", "wifi_password": "warm paint", **settings}))


def levels(record: list[list[Any]], pin: int) -> list[int]:
    return [entry[3] for entry in record if entry[1:3] == ["pin", pin]]


UNREADABLE = {
    "too long, the id not first": b'{"v": {"time": 1}, "id": "h", "x": "' + b"x" * 6000 + b'"}',
    "too long, an id with an escape": b'{"id": "\\u0068", "x": "' + b"x" * 6000 + b'"}',
    "too long, an id without an end": b'{"id": "' + b"h" * 6000,
    "too long, an id that is a number": b'{"id": 7, "x": "' + b"x" * 6000 + b'"}',
    "too long, an id that is not ASCII": b'{"id": "h\xe4", "x": "' + b"x" * 6000 + b'"}',
    "far too long": b"x" * 16000,
    "not JSON": b'{"id": "h", "v": {"time": 1} nonsense',
    "cut off": b'{"id": "h", "v": {"time": 1}',
    "crossed brackets": b'{"id": "h", "v": {"time": 1}]',
    "deep lists": b"[" * 4000,
    "deep objects": b'{"id": "h", "v": ' + b'{"a": ' * 400 + b"1" + b"}" * 401,
    "empty": b"",
    "a NUL": b'{"id": "h", "v": {"time": 1}}\x00',
    "a NUL in a text": b'{"id": "h\x00", "v": {}}',
    "not UTF-8": b'{"id": "\xff\xfe", "v": {}}',
    "a list": b"[1, 2]",
    "a number": b"7",
    "null": b"null",
    "an id that is an object": b'{"id": {"a": 1}, "v": {}}',
    "an id that is too long": json.dumps({"id": "h" * 65, "v": {}}).encode(),
    "an id with half a surrogate pair": b'{"id": "\\ud800", "v": {}}',
    "an id with control characters": b'{"id": "a\\u0000b", "v": {}}',
    "keys that are no texts": b'{1: 2, "id": 3}',
    "many keys": json.dumps({f"k{n}": n for n in range(400)}).encode()[:4000],
}

"""The firmware as a process: the real MicroPython (and CPython) on the embedded broker and on Mosquitto."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from tests.bus import Ear, Heard
from tests.servers import free_port, run_mosquitto
from vipo_site.broker import EmbeddedBroker, start_broker
from vipo_site.firmware_process import find_micropython

ROOT = Path(__file__).resolve().parents[2]
DEVICE = "paintMixer02"
UP = f"vipo/v1/dev/{DEVICE}/up/"
DOWN = f"vipo/v1/dev/{DEVICE}/down/"
SPEED = 60  # a minute of mixing takes a second
ACCOUNTS = {"server": "secret", DEVICE: "mixer's word"}


class EmbeddedBus:
    """amqtt, on a port that it keeps over a restart."""

    def __init__(self) -> None:
        self.device_port = self.port = free_port()
        self.authority = ""
        self._broker: EmbeddedBroker | None = None

    def start(self) -> None:
        self._broker = start_broker(
            port=self.port, server_password=ACCOUNTS["server"], check_password=lambda u, p: ACCOUNTS.get(u) == p
        )

    def kill(self) -> None:
        assert self._broker is not None
        self._broker.stop()

    stop = kill


@dataclass
class Mixer:
    """A running firmware."""

    ear: Ear
    bus: Any
    process: subprocess.Popen[bytes]
    log: Path
    interpreter: str

    def tell(self, method: str, command_id: str, **values: Any) -> None:
        self.ear.say(DOWN + method, {"id": command_id, "v": values, "ttl_s": 30})

    def answer(self, command: str, status: str) -> Heard:
        return self.ear.wait(lambda h: h.topic == UP + "ack" and h.json["id"] == command and h.json["st"] == status)

    def answers(self, command: str) -> list[str]:
        return [h.json["st"] for h in self.ear.all("/ack") if h.json["id"] == command]

    def state(self, wanted: Any) -> dict[str, Any]:
        found: dict[str, Any] = self.ear.wait(lambda h: h.topic == UP + "state" and wanted(h.json)).json
        return found


@pytest.fixture(scope="session")
def micropython() -> str:
    path, why = find_micropython(ROOT / "var")
    if path is None:
        pytest.skip(why)
    return path


@pytest.fixture(params=["micropython", "cpython"])
def interpreter(request: pytest.FixtureRequest) -> str:
    return find_interpreter(request, request.param)


def find_interpreter(request: pytest.FixtureRequest, name: str) -> str:
    return str(request.getfixturevalue("micropython")) if name == "micropython" else sys.executable


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


PLACES = [
    ("micropython", "amqtt"),
    ("micropython", "mosquitto"),
    ("micropython", "mosquitto with TLS"),
    ("cpython", "amqtt"),
]


@pytest.fixture(params=PLACES, ids=[" on ".join(place) for place in PLACES])
def mixer(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Mixer]:
    name, kind = request.param
    interpreter = find_interpreter(request, name)
    with running_bus(kind, tmp_path) as bus, Ear(bus.port, ACCOUNTS["server"], tls=_trust(bus)) as ear:
        process = start_firmware(interpreter, tmp_path, bus)
        running = Mixer(ear, bus, process, tmp_path / "panel.log", interpreter)
        try:
            running.state(lambda _state: True)  # it hears commands before it tells its first state
            yield running
        finally:
            running.process.kill()
            running.process.wait()


def _trust(bus: Any) -> Any:
    from registry.mqtt import tls_context

    return tls_context(bus.authority) if bus.authority else None


def start_firmware(interpreter: str, folder: Path, bus: Any, **more: Any) -> subprocess.Popen[bytes]:
    configuration = {
        "host": "localhost" if bus.authority else "127.0.0.1",
        "port": bus.device_port,
        "id": DEVICE,
        "password": ACCOUNTS[DEVICE],
        "speed": SPEED,
        "site": "hall",
        "ca": bus.authority,
        "description": str(ROOT / "registry" / "demo" / "devices" / f"{DEVICE}.ttl"),
        "boot_file": str(folder / "boot"),
        "log": str(folder / "panel.log"),
        **more,
    }
    path = folder / "configuration.json"
    path.write_text(json.dumps(configuration))
    return subprocess.Popen([interpreter, str(ROOT / "firmware" / "unix_main.py"), str(path)])


def test_it_joins_mixes_and_answers(mixer: Mixer) -> None:
    description = mixer.ear.wait(lambda h: h.topic == UP + "desc")
    assert description.payload == (ROOT / "registry" / "demo" / "devices" / f"{DEVICE}.ttl").read_bytes()
    assert mixer.ear.wait(lambda h: h.topic == UP + "presence").json["s"] == "online"
    first = mixer.state(lambda s: True)
    assert (first["done"], first["cmd"], first["props"]) == (True, "", {"jobStatus": 0, "temperature": 22.0})

    mixer.tell("mixPaint", "c1", time=2)
    mixer.answer("c1", "RUNNING")
    busy = mixer.state(lambda s: 0 < s["props"]["jobStatus"] < 100)
    assert (busy["done"], busy["cmd"]) == (False, "c1")
    done = mixer.answer("c1", "DONE")
    assert mixer.answers("c1") == ["ACCEPTED", "RUNNING", "DONE"]
    assert 1.8 < done.at - mixer.answer("c1", "RUNNING").at < 4
    last = mixer.state(lambda s: s["props"]["jobStatus"] == 100)
    assert (last["done"], last["cmd"], last["boot"]) == (True, "", first["boot"])
    assert last["props"]["temperature"] > 22.0
    panel = mixer.log.read_text().splitlines()
    assert panel.index("LCD |Mixing Started  |2 min           |") < panel.index(
        "LCD |Mixing Complete |2 min           |"
    )


def test_a_repeated_command_is_answered_again_and_not_executed_again(mixer: Mixer) -> None:
    mixer.tell("mixPaint", "c1", time=1)
    mixer.answer("c1", "DONE")
    before = mixer.log.read_text().count("Mixing Started")
    for number in range(15):
        mixer.tell("mixPaint", f"bad{number}", time=99)
    mixer.answer("bad14", "REJECTED")
    mixer.ear.forget()
    mixer.tell("mixPaint", "c1", time=1)
    assert mixer.answer("c1", "DONE").json["result"]["temperature"] > 22
    assert mixer.answers("c1") == ["DONE"]
    assert mixer.log.read_text().count("Mixing Started") == before == 1


def test_what_cannot_be_done_is_rejected_with_the_reason(mixer: Mixer) -> None:
    mixer.tell("mixPaint", "c1", time=20)
    mixer.answer("c1", "RUNNING")
    wrong: list[tuple[str, str, dict[str, Any], str]] = [
        ("mixPaint", "r1", {"time": 1}, "busy with c1"),
        ("paint", "r2", {"time": 1}, "there is no method paint"),
        ("cancel", "r3", {"command": "other"}, "that command is not running"),
    ]
    for method, command, values, why in wrong:
        mixer.tell(method, command, **values)
        assert mixer.answer(command, "REJECTED").json["why"] == why
    mixer.tell("cancel", "r4", command="c1")
    mixer.answer("c1", "CANCELED")
    for values, why in (
        ({"time": 31}, "time must be from 1 to 30"),
        ({}, "time is missing"),
        ({"time": "5"}, "time must be a number"),
        ({"time": 1, "colour": "red"}, "there is no argument colour"),
    ):
        command = "w" + why[-6:]
        mixer.tell("mixPaint", command, **values)
        assert mixer.answer(command, "REJECTED").json["why"] == why
    mixer.ear.say(DOWN + "mixPaint", b'{"id": ')
    mixer.ear.say(DOWN + "mixPaint", b"[1, 2]")
    mixer.tell("mixPaint", "c2", time=1)
    mixer.answer("c2", "DONE")


def test_a_stop_holds_the_work_until_it_is_released(mixer: Mixer) -> None:
    mixer.tell("mixPaint", "c1", time=2)
    mixer.state(lambda s: s["props"]["jobStatus"] > 5)
    mixer.ear.say("vipo/v1/site/hall/stop", {"active": True, "by": "Ada", "at": None}, retain=True)
    mixer.tell("dispense", "c2", object="can", value=1)
    assert mixer.answer("c2", "REJECTED").json["why"] == "the site is stopped"
    held = mixer.ear.all("/state")[-1].json["props"]["jobStatus"]
    mixer.ear.forget()
    mixer.tell("pause", "p1", command="c1")
    mixer.answer("p1", "DONE")
    mixer.ear.say("vipo/v1/site/hall/stop", {"active": False, "by": "Ada", "at": None}, retain=True)
    mixer.tell("dispense", "c3", object="can", value=1)
    assert mixer.answer("c3", "REJECTED").json["why"] == "busy with c1"
    assert all(h.json["props"]["jobStatus"] <= held + 6 for h in mixer.ear.all("/state"))
    mixer.tell("resume", "p2", command="c1")
    mixer.answer("c1", "DONE")


def test_it_comes_back_after_the_broker_was_killed_and_says_what_was_missed(mixer: Mixer) -> None:
    boot = mixer.state(lambda s: True)["boot"]
    mixer.tell("mixPaint", "c1", time=2)
    mixer.answer("c1", "RUNNING")
    mixer.bus.kill()
    mixer.ear.forget()
    mixer.bus.start()
    assert mixer.ear.wait(lambda h: h.topic == UP + "presence" and h.json["s"] == "online").json["boot"] == boot
    mixer.answer("c1", "DONE")
    mixer.ear.wait(lambda h: h.topic == UP + "desc")


def test_a_new_server_is_told_everything_anew(mixer: Mixer) -> None:
    mixer.state(lambda s: True)
    mixer.ear.forget()
    mixer.ear.say("vipo/v1/srv/status", {"s": "online"}, retain=True)
    mixer.ear.wait(lambda h: h.topic == UP + "desc")
    mixer.ear.wait(lambda h: h.topic == UP + "presence")
    mixer.ear.wait(lambda h: h.topic == UP + "state")


def test_a_killed_device_is_declared_offline_with_its_boot_and_the_next_boot_is_higher(
    mixer: Mixer, tmp_path: Path
) -> None:
    boot = mixer.state(lambda s: True)["boot"]
    mixer.process.send_signal(signal.SIGKILL)
    mixer.process.wait()
    gone = mixer.ear.wait(lambda h: h.topic == UP + "presence" and h.json["s"] == "offline")
    assert gone.json["boot"] == boot
    mixer.ear.forget()
    mixer.process = start_firmware(mixer.interpreter, tmp_path, mixer.bus)
    assert mixer.ear.wait(lambda h: h.topic == UP + "presence" and h.json["s"] == "online").json["boot"] == boot + 1


def test_a_configuration_that_cannot_be_used_is_said_in_a_sentence(interpreter: str, tmp_path: Path) -> None:
    good = {"host": "h", "port": 1, "id": "x", "password": "p", "description": str(tmp_path / "none.ttl")}
    for content, sentence in (
        (None, "There is no configuration file {path}."),
        ("%", "{path} is not JSON."),
        (json.dumps({**good, "password": ""}), "{path} does not say 'password'."),
        (json.dumps(good), f"There is no description file {tmp_path}/none.ttl."),
    ):
        path = tmp_path / "c.json"
        path.unlink(missing_ok=True)
        if content is not None:
            path.write_text(content)
        done = subprocess.run(
            [interpreter, str(ROOT / "firmware" / "unix_main.py"), str(path)],
            capture_output=True,
            text=True,
            timeout=20,
        )
        assert (done.returncode, done.stdout.strip()) == (2, sentence.format(path=path))


def test_a_broker_with_a_strange_certificate_is_not_trusted(interpreter: str, tmp_path: Path) -> None:
    script = ROOT / "deploy" / "mosquitto" / "make-certificates.sh"
    subprocess.run([script, tmp_path / "strangers", "localhost"], check=True, capture_output=True)
    (tmp_path / "broker").mkdir()
    with run_mosquitto(tmp_path / "broker", ACCOUNTS, tls=True) as mosquitto:
        process = start_firmware(interpreter, tmp_path, mosquitto, ca=str(tmp_path / "strangers" / "ca.crt"))
        time.sleep(1.5)
        process.kill()
        process.wait()
        with Ear(mosquitto.port, ACCOUNTS["server"], tls=_trust(mosquitto)) as ear:
            time.sleep(0.3)
            assert ear.heard == []
    assert "No connection" in (tmp_path / "panel.log").read_text()

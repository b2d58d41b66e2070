"""The firmware as a process: the real MicroPython (and CPython) on the embedded broker and on Mosquitto."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from registry.demo.devices import DEVICES
from tests.firmware.conftest import find_interpreter
from tests.firmware.rig import (
    ACCOUNTS,
    DEVICE,
    LIMIT_S,
    Running,
    interpreter_command,
    listening,
    running_bus,
    start_firmware,
)
from tests.kit.files import ROOT
from tests.kit.mqtt import sends_at_once
from tests.kit.servers import run_mosquitto
from tests.kit.waiting import wait_for
from vipo_device.descriptions.reader import canonical_hash, read
from vipo_site.demo.firmware_process import firmware_command

UP = f"vipo/v1/dev/{DEVICE}/up/"
DOWN = f"vipo/v1/dev/{DEVICE}/down/"

PLACES = [
    ("micropython", "amqtt"),
    ("micropython", "mosquitto with TLS"),
    ("cpython", "amqtt"),
]


@pytest.fixture(params=PLACES, ids=[" on ".join(place) for place in PLACES])
def mixer(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Running]:
    name, kind = request.param
    interpreter = find_interpreter(request, name)
    with running_bus(kind, tmp_path) as bus, listening(bus) as ear:
        process = start_firmware(interpreter, tmp_path, bus)
        running = Running(ear, bus, process, tmp_path / "panel.log", interpreter)
        try:
            running.state(lambda _state: True)  # it hears commands before it tells its first state
            yield running
        finally:
            running.end()


def test_it_sends_each_message_at_once(mixer: Running) -> None:
    assert sends_at_once(mixer.process.pid, mixer.bus.device_port) == [True]


def test_it_joins_mixes_and_answers(mixer: Running) -> None:
    description = mixer.ear.wait(lambda h: h.topic == UP + "desc", LIMIT_S)
    told = read(description.payload, device_id=DEVICE).description
    assert (told.device_class, told.site, [m.name for m in told.methods]) == ("mixer", "hall", ["mixPaint", "dispense"])
    assert mixer.ear.wait(lambda h: h.topic == UP + "presence", LIMIT_S).json["s"] == "online"
    first = mixer.state(lambda s: True)
    assert (first["done"], first["cmd"], first["props"]) == (True, "", {"jobStatus": 0, "temperature": 22.0})

    told_at = time.monotonic()
    mixer.tell("mixPaint", "c1", time=2)
    mixer.answer("c1", "RUNNING")
    busy = mixer.state(lambda s: 0 < s["props"]["jobStatus"] < 100)
    assert (busy["done"], busy["cmd"]) == (False, "c1")
    done = mixer.answer("c1", "DONE")
    assert mixer.answers("c1") == ["ACCEPTED", "RUNNING", "DONE"]
    assert 1.8 < done.at - told_at < 60, "two seconds, and what a busy machine adds; at the speed of a hall 120"
    last = mixer.state(lambda s: s["props"]["jobStatus"] == 100)
    assert (last["done"], last["cmd"], last["boot"]) == (True, "", first["boot"])
    assert last["props"]["temperature"] > 22.0
    panel = mixer.log.read_text().splitlines()
    assert panel.index("LCD |Mixing Started  |2 min           |") < panel.index(
        "LCD |Mixing Complete |2 min           |"
    )


def test_a_repeated_command_is_answered_again_and_not_executed_again(mixer: Running) -> None:
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


def test_what_cannot_be_done_is_rejected_with_the_reason(mixer: Running) -> None:
    mixer.tell("mixPaint", "c1", time=30)
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


def test_what_a_stop_has_overtaken_is_neither_done_nor_answered(mixer: Running) -> None:
    def tell(command: str, fence: int) -> None:
        mixer.ear.say(DOWN + "dispense", {"id": command, "v": {"object": "can", "value": 1}, "fence": fence})

    now = 1_790_000_000_000
    mixer.ear.say("vipo/v1/site/hall/stop", {"active": True, "at": None, "fence": now}, retain=True)
    mixer.ear.say("vipo/v1/site/hall/stop", {"active": False, "at": None, "fence": now - 1}, retain=True)
    tell("late", now - 1)
    tell("ahead", now + 1)
    mixer.tell("dispense", "c1", object="can", value=1)
    assert mixer.answer("c1", "REJECTED").json["why"] == "the site is stopped"
    mixer.ear.say("vipo/v1/site/hall/stop", {"active": False, "at": None, "fence": now + 1}, retain=True)
    tell("late", now)
    tell("ahead", now + 1)
    mixer.answer("ahead", "ACCEPTED")
    assert mixer.answers("late") == []
    assert mixer.answers("ahead")[0] == "ACCEPTED"


def test_a_stop_holds_the_work_until_it_is_released(mixer: Running) -> None:
    mixer.tell("mixPaint", "c1", time=6)
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


def test_without_a_site_the_stop_of_each_holds_and_no_other_site_lifts_it(micropython: str, tmp_path: Path) -> None:
    with running_bus("amqtt", tmp_path) as bus, listening(bus) as ear:
        for site, active in (("a-hall", False), ("hall", True), ("other", False)):
            ear.say(f"vipo/v1/site/{site}/stop", {"active": active}, retain=True)
        command = interpreter_command(micropython)
        process = start_firmware(command, tmp_path, bus, site="+")
        mixer = Running(ear, bus, process, tmp_path / "panel.log", command)
        try:
            mixer.state(lambda _state: True)
            for site in ("other", "a-hall"):
                ear.say(f"vipo/v1/site/{site}/stop", {"active": False}, retain=True)
            mixer.tell("dispense", "c1", object="can", value=1)
            assert mixer.answer("c1", "REJECTED").json["why"] == "the site is stopped"
            ear.say("vipo/v1/site/hall/stop", {"active": False}, retain=True)
            mixer.tell("dispense", "c2", object="can", value=1)
            mixer.answer("c2", "DONE")
        finally:
            mixer.end()


def test_it_comes_back_after_the_broker_was_killed_and_says_what_was_missed(mixer: Running) -> None:
    boot = mixer.state(lambda s: True)["boot"]
    mixer.tell("mixPaint", "c1", time=6)
    mixer.answer("c1", "RUNNING")
    mixer.bus.kill()
    mixer.ear.forget()
    mixer.bus.start()
    assert (
        mixer.ear.wait(lambda h: h.topic == UP + "presence" and h.json["s"] == "online", LIMIT_S).json["boot"] == boot
    )
    mixer.answer("c1", "DONE")
    mixer.ear.wait(lambda h: h.topic == UP + "desc", LIMIT_S)


def test_a_new_server_is_told_everything_anew(mixer: Running) -> None:
    mixer.state(lambda s: True)
    mixer.ear.forget()
    mixer.ear.say("vipo/v1/srv/status", {"s": "online"}, retain=True)
    mixer.ear.wait(lambda h: h.topic == UP + "desc", LIMIT_S)
    mixer.ear.wait(lambda h: h.topic == UP + "presence", LIMIT_S)
    mixer.ear.wait(lambda h: h.topic == UP + "state")


def test_a_killed_device_is_declared_offline_with_its_boot_and_the_next_boot_is_higher(
    mixer: Running, tmp_path: Path
) -> None:
    boot = mixer.state(lambda s: True)["boot"]
    mixer.process.send_signal(signal.SIGKILL)
    mixer.process.wait()
    gone = mixer.ear.wait(lambda h: h.topic == UP + "presence" and h.json["s"] == "offline", LIMIT_S)
    assert gone.json["boot"] == boot
    mixer.ear.forget()
    mixer.process = start_firmware(mixer.interpreter, tmp_path, mixer.bus)
    assert (
        mixer.ear.wait(lambda h: h.topic == UP + "presence" and h.json["s"] == "online", LIMIT_S).json["boot"]
        == boot + 1
    )


def test_a_configuration_that_cannot_be_used_is_said_in_a_sentence(interpreter: list[str], tmp_path: Path) -> None:
    good = {"host": "h", "port": 1, "id": "x", "password": "p", "description": str(tmp_path / "none.ttl")}
    long = tmp_path / "long.ttl"
    long.write_text("#" * 16001)
    for content, sentence in (
        (None, "There is no configuration file {path}."),
        ("%", "{path} is not JSON."),
        (json.dumps({**good, "host": ""}), "{path} does not say 'host'."),
        (
            json.dumps({**good, "password": ""}),
            "{path} needs 'password', the device's own key, or 'join_key', the site's.",
        ),
        (
            json.dumps({**good, "join_key": "key", "site": "+"}),
            "{path} has an enrolment key, but does not say 'site', whose key it is.",
        ),
        (json.dumps(good), f"There is no description file {tmp_path}/none.ttl."),
        (
            json.dumps({**good, "description": str(long)}),
            f"The description file {long} is longer than 16000 bytes.",
        ),
    ):
        path = tmp_path / "c.json"
        path.unlink(missing_ok=True)
        if content is not None:
            path.write_text(content)
        done = subprocess.run(
            [*interpreter, str(ROOT / "firmware" / "unix_main.py"), str(path)],
            capture_output=True,
            text=True,
            timeout=LIMIT_S,
        )
        assert (done.returncode, done.stdout.strip()) == (2, sentence.format(path=path))


def test_a_broker_with_a_strange_certificate_is_not_trusted(interpreter: list[str], tmp_path: Path) -> None:
    script = ROOT / "deploy" / "mosquitto" / "make-certificates.sh"
    subprocess.run([script, tmp_path / "strangers", "localhost"], check=True, capture_output=True)
    (tmp_path / "broker").mkdir()
    with run_mosquitto(tmp_path / "broker", ACCOUNTS, tls=True) as mosquitto:
        process = start_firmware(interpreter, tmp_path, mosquitto, ca=str(tmp_path / "strangers" / "ca.crt"))
        log = tmp_path / "panel.log"
        wait_for("its attempt", lambda: log.exists() and "No connection" in log.read_text())
        process.kill()
        process.wait()
        with listening(mosquitto) as ear:
            ear.say("vipo/v1/dev/other/up/ack", {"after": "what was kept"})
            ear.wait(lambda h: h.topic == "vipo/v1/dev/other/up/ack")
            assert [h.topic for h in ear.heard] == ["vipo/v1/dev/other/up/ack"]
    if interpreter[0] != sys.executable:
        assert "LCD |No connection   |The certificate |" in log.read_text()


def test_the_demos_mixer_says_of_itself_what_the_site_knows_already(micropython: str, tmp_path: Path) -> None:
    (tmp_path / "micropython").symlink_to(Path(micropython).parent)
    command, notice = firmware_command(tmp_path, {"host": "127.0.0.1", "port": 1, "id": DEVICE, "password": "word"})
    assert (command[1:], notice) == ([str(ROOT / "firmware" / "unix_main.py"), command[2]], None)
    program = (
        "from vipo.identity import make_identity; from vipo.panel import Panel\n"
        f"import json; c = json.load(open({command[2]!r}))\n"
        "print(make_identity(c, Panel())[1].decode())"
    )
    env = {"MICROPYPATH": f"{ROOT / 'firmware' / 'lib'}:.frozen"}
    told = subprocess.run(
        [micropython, "-c", program], env=env, capture_output=True, timeout=LIMIT_S, check=True
    ).stdout
    known = (DEVICES / f"{DEVICE}.ttl").read_bytes()
    assert canonical_hash(read(told, device_id=DEVICE).description) == canonical_hash(read(known).description)

"""What a board must bear: messages through a real broker that no server would send. It works on, in 112 kB."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from tests.firmware.conftest import find_interpreter
from tests.firmware.rig import DEVICE, UNREADABLE, Running, listening, running_bus, start_firmware

REFUSED: dict[str, tuple[object, str]] = {
    "v1": ({"v": [1, 2]}, "v must be an object with at most 16 arguments"),
    "v2": ({"v": {f"a{n}": n for n in range(17)}}, "v must be an object with at most 16 arguments"),
    "v3": ({"v": {"t\x00": 1}}, "v must be an object with at most 16 arguments"),
    "v4": ({"v": {"time": 1}, "ttl_s": "long"}, "ttl_s must be a number"),
    "v5": ({"v": {"time": 1}, "ttl_s": -1}, "it came too late"),
    "v6": ({"v": {"time": "1" * 500}}, "time must be a number"),
    "v7": ({"v": {"time": [[[[1]]]]}}, "time must be a number"),
    "v8": ({"v": {"self": 1, "time": 1}}, "there is no argument self"),
    "v9": ({"v": {"__class__": 1}}, "there is no argument __class__"),
}


@pytest.fixture(params=["amqtt", "mosquitto"])
def mixer(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Running]:
    with running_mixer(request, tmp_path) as running:
        yield running


@pytest.fixture(params=["amqtt", "mosquitto"])
def slow_mixer(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Running]:
    """A mixer for which a second takes a second: it is still at its first command when the last one comes."""
    with running_mixer(request, tmp_path, speed=1) as running:
        yield running


@contextmanager
def running_mixer(request: pytest.FixtureRequest, tmp_path: Path, **more: Any) -> Iterator[Running]:
    with running_bus(request.param, tmp_path) as bus, listening(bus) as ear:
        ear.say(f"vipo/v1/dev/{DEVICE}/down/mixPaint", {"id": "kept", "v": {"time": 1}}, retain=True)
        process = start_firmware(find_interpreter(request, "micropython"), tmp_path, bus, **more)
        running = Running(ear, bus, process, tmp_path / "panel.log")
        try:
            running.state(lambda _state: True)
            yield running
        finally:
            running.end()


def test_hostile_messages_harm_nothing(mixer: Running) -> None:
    boot = mixer.state(lambda _state: True)["boot"]
    for name, payload in UNREADABLE.items():
        for method in ("mixPaint", "idle", "__init__", "cancel"):
            mixer.ear.say(mixer.down + method, payload)
        command = "after " + name
        mixer.tell("mixPaint", command, time=99)
        assert mixer.answer(command, "REJECTED").json["why"] == "time must be from 1 to 30"
    for command, (body, why) in REFUSED.items():
        assert isinstance(body, dict)
        mixer.ear.say(mixer.down + "mixPaint", {"id": command, **body})
        assert mixer.answer(command, "REJECTED").json["why"] == why
    for command, size in (("long", 4200), ("longest", 16000)):
        mixer.ear.say(
            mixer.down + "mixPaint", b' { "id" : "%s", "v": {"time": 1}, "x": "' % command.encode() + b"x" * size
        )
        told = mixer.answer(command, "REJECTED").json["why"]
        assert told == "the message is too long for this device"
    for method in ("idle", "switched", "properties", "_drift", "__init__", "a/b", "x" * 300):
        mixer.ear.say(mixer.down + method, {"id": "m" + method[:9], "v": {}})
        told = mixer.answer("m" + method[:9], "REJECTED").json["why"]
        assert told == f"there is no method {method}"[:256]
    mixer.tell("mixPaint", "last", time=1)
    mixer.answer("last", "DONE")
    state = mixer.state(lambda s: s["props"]["jobStatus"] == 100)
    assert (state["boot"], state["done"]) == (boot, True)
    assert mixer.answers("kept") == mixer.answers("h") == []
    assert "No connection" not in mixer.log.read_text()
    assert mixer.process.poll() is None


def test_a_command_under_way_is_never_forgotten(slow_mixer: Running) -> None:
    slow_mixer.tell("mixPaint", "c1", time=30)
    slow_mixer.answer("c1", "RUNNING")
    for number in range(300):  # more than a board of 112 kB has room for answers to
        slow_mixer.tell("mixPaint", f"other{number}", time=1)
    slow_mixer.answer("other299", "REJECTED")
    slow_mixer.ear.forget()
    slow_mixer.tell("mixPaint", "c1", time=30)
    slow_mixer.answer("c1", "RUNNING")
    slow_mixer.ear.say(slow_mixer.down + "mixPaint", b'{"id": "c1", "x": "' + b"x" * 6000)
    slow_mixer.tell("cancel", "x1", command="c1")
    slow_mixer.answer("c1", "CANCELED")
    assert slow_mixer.answers("c1") == ["RUNNING", "RUNNING", "CANCELED"]
    assert slow_mixer.log.read_text().count("Mixing Started") == 1

"""What a board must bear: messages through a real broker that no server would send. It works on, in 100 kB."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

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
    with running_bus(request.param, tmp_path) as bus, listening(bus) as ear:
        ear.say(f"vipo/v1/dev/{DEVICE}/down/mixPaint", {"id": "kept", "v": {"time": 1}}, retain=True)
        process = start_firmware(find_interpreter(request, "micropython"), tmp_path, bus)
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


def test_a_command_under_way_is_never_forgotten(mixer: Running) -> None:
    mixer.tell("mixPaint", "c1", time=30)
    mixer.answer("c1", "RUNNING")
    for number in range(40):
        mixer.tell("mixPaint", f"other{number}", time=1)
    mixer.answer("other39", "REJECTED")
    mixer.ear.forget()
    mixer.tell("mixPaint", "c1", time=30)
    mixer.answer("c1", "RUNNING")
    mixer.ear.say(mixer.down + "mixPaint", b'{"id": "c1", "x": "' + b"x" * 6000)
    mixer.tell("cancel", "x1", command="c1")
    mixer.answer("c1", "CANCELED")
    assert mixer.answers("c1") == ["RUNNING", "RUNNING", "CANCELED"]
    assert mixer.log.read_text().count("Mixing Started") == 1

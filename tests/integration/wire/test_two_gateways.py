"""Two gateway processes share the devices; one is killed, and nothing that was said is lost."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack
from datetime import UTC, datetime
from pathlib import Path

import pytest
from django.conf import LazySettings

from execution import services as execution
from registry import services
from tests.integration.wire.bus import SERVER_WORD, SITE, Bus
from tests.kit.files import MIXER_TEXT
from tests.kit.mqtt import Ear
from tests.kit.processes.forked import ForkedPython
from tests.kit.waiting import wait_for
from vipo_device.protocol.mqtt_client import MqttClient

pytestmark = [pytest.mark.servers, pytest.mark.parametrize("bus", ["mosquitto"], indirect=True)]
NAMES = tuple(f"mixer{number:02}" for number in range(1, 7))
KEY = "one-key-for-every-mixer-1"
ROUNDS = 4
STATES = 40


class Gateways:
    """`manage.py gateway`, several times, on the test's database and broker."""

    def __init__(self, bus: Bus, folder: Path) -> None:
        self._folder = folder
        self._environment = {
            **{name: value for name, value in os.environ.items() if not name.startswith(("VIPO_", "DJANGO_"))},
            "VIPO_STATE_DIR": str(folder),
            "VIPO_MQTT_PORT": str(bus.server_port),
            "VIPO_DEFAULT_SITE": SITE,
            "VIPO_LOG": "INFO",
        }
        (folder / "secrets").mkdir()
        (folder / "secrets" / "mqtt-server").write_text(SERVER_WORD)
        self.processes: dict[str, subprocess.Popen[bytes]] = {}

    def start(self, name: str) -> None:
        with (self._folder / f"{name}.log").open("ab") as log:
            self.processes[name] = ForkedPython(
                [sys.executable, "manage.py", "gateway"],
                env={**self._environment, "VIPO_GATEWAY": name},
                stdout=log,
                stderr=log,
            )

    def kill(self, name: str) -> None:
        process = self.processes.pop(name)
        process.kill()
        process.wait()

    def stop(self) -> None:
        for process in self.processes.values():
            process.terminate()
        for process in self.processes.values():
            process.wait(30)


class Mixer:
    """A device that answers each command and does it once."""

    def __init__(self, bus: Bus, name: str) -> None:
        self.name, self.seq, self.done = name, 0, list[str]()
        self.text = MIXER_TEXT.replace("paintMixer03", name)
        self.client: MqttClient = bus.client(name, KEY)
        self.client.subscribe(f"vipo/v1/dev/{name}/down/#", 1, self.hear)
        self.client.subscribe("vipo/v1/srv/status", 1, lambda _t, _p, retained: None if retained else self.introduce())
        self.client.start()
        assert self.client.wait_connected(20)
        self.introduce()

    def introduce(self) -> None:
        self.describe()
        self.client.publish(self.up("presence"), b'{"s": "online", "boot": 1}', retain=True)

    def describe(self) -> None:
        self.client.publish(self.up("desc"), self.text.encode(), retain=True)

    def up(self, kind: str) -> str:
        return f"vipo/v1/dev/{self.name}/up/{kind}"

    def hear(self, topic: str, payload: bytes, _retained: bool) -> None:
        command = json.loads(payload)["id"]
        if topic.endswith("/credential"):
            self.client.publish(self.up("ack"), json.dumps({"id": command, "st": "REJECTED"}).encode())
            return
        if command not in self.done:
            self.done.append(command)
        for status in ("ACCEPTED", "RUNNING", "DONE"):
            self.client.publish(self.up("ack"), json.dumps({"id": command, "st": status}).encode())

    def say_states(self) -> None:
        for _ in range(STATES):
            self.seq += 1
            body = {"boot": 1, "seq": self.seq, "done": True, "props": {"jobStatus": self.seq}}
            self.client.publish(self.up("state"), json.dumps(body).encode(), retain=True)


@pytest.fixture
def gateways(bus: Bus, tmp_path: Path, settings: LazySettings) -> Iterator[Gateways]:
    made = Gateways(bus, tmp_path)
    with Ear(bus.server_port, SERVER_WORD, "vipo/v1/srv/status") as ear:
        for name in ("one", "two"):
            made.start(name)
        wait_for("both gateways", lambda: len([h for h in ear.heard if not h.retained]) == 2, 90)
    yield made
    made.stop()


@pytest.fixture
def mixers(bus: Bus) -> Iterator[list[Mixer]]:
    at = datetime.now(UTC)
    for name in NAMES:
        services.enrol_device(site=SITE, device_id=name, payload=json.dumps({"key": KEY}).encode(), at=at)
    with ExitStack() as stack:
        made = []
        for name in NAMES:
            made.append(Mixer(bus, name))
            stack.callback(made[-1].client.stop)
        yield made


def test_the_death_of_one_gateway_loses_no_answer_and_no_description(
    bus: Bus, gateways: Gateways, mixers: list[Mixer]
) -> None:
    wait_for("every description", lambda: len(services.list_devices(site=SITE)) == len(NAMES))
    for name in NAMES:
        services.approve_device(site=SITE, device_id=name, by=None, at=datetime.now(UTC))
    wait_for("everybody", lambda: all(d.online for d in services.list_devices(site=SITE)))
    for number in range(ROUNDS):
        calls = [
            execution.call_method(site=SITE, device_id=name, method="mixPaint", arguments={"time": 1}, by="Ada")
            for name in NAMES
        ]
        for mixer in mixers:
            mixer.say_states()
        if number == ROUNDS // 2:
            gateways.kill("one")
        wait_for(
            f"the answers of round {number}",
            lambda made=calls: all(execution.get_call(site=SITE, call_id=c.id).status == "done" for c in made),
            60,
        )
    last = dict.fromkeys(NAMES, STATES * ROUNDS)
    wait_for(
        "the last states",
        lambda: {d.id: d.readings.get("jobStatus") for d in services.list_devices(site=SITE)} == last,
        30,
    )
    assert [len(mixer.done) for mixer in mixers] == [ROUNDS] * len(NAMES)
    gateways.start("one")
    assert bus.mosquitto is not None
    bus.mosquitto.kill()
    bus.mosquitto.start()
    mixers[0].text = mixers[0].text.replace(f'title "{NAMES[0]}"', 'title "Changed while away"')
    mixers[0].describe()
    wait_for(
        "the description said around the broker's death",
        lambda: services.get_device(site=SITE, device_id=NAMES[0]).name == "Changed while away",
        60,
    )

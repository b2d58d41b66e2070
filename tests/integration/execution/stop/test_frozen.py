"""A gateway that is frozen between its claim and the sending, and one that is frozen while the stop is pressed."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any
from uuid import uuid4

import pytest
from pytest_django import DjangoDbBlocker

from execution import services
from execution.floor import stop_publisher
from execution.models import Command
from registry.models import Device, Site
from tests.kit.databases import on_database
from tests.kit.files import ROOT
from tests.kit.mqtt import Ear, Heard
from tests.kit.processes.forked import ForkedPython
from tests.kit.served import served_without_broker
from tests.kit.servers import Mosquitto, Redis, run_mosquitto
from tests.kit.waiting import PATIENCE_S, wait_for
from vipo_device.protocol.clock import steady_s
from vipo_site.settings import postgres

pytestmark = pytest.mark.servers
WORD = "the server's word"
CLAIM_IS_OVER_S = 2.5


class Gateway:
    """`manage.py gateway` on the test's database and broker; it can be told where it is to be frozen."""

    def __init__(self, url: str, redis: Redis, broker: Mosquitto, folder: Path, name: str) -> None:
        self.freezing, self.log = folder / f"{name}-freezing", folder / f"{name}.log"
        self.freezing.mkdir()
        environment = served_without_broker(folder / name, url, redis.url) | {
            "VIPO_MQTT_PORT": str(broker.port),
            "VIPO_MQTT_TLS": "0",
            "VIPO_MQTT_PASSWORD": WORD,
            "VIPO_GATEWAY": name,
            "VIPO_FAULTS": str(self.freezing),
            "VIPO_LOG": "INFO",
        }
        with self.log.open("wb") as out:
            command = [sys.executable, "manage.py", "gateway"]
            self.process = ForkedPython(command, cwd=ROOT, env=environment, stdout=out, stderr=out)

    def freeze_at(self, point: str) -> None:
        (self.freezing / point).write_text("freeze")

    def is_frozen(self) -> bool:
        stat = Path(f"/proc/{self.process.pid}/stat").read_text()
        return stat.rpartition(")")[2].split()[0] == "T"

    def freeze(self) -> None:
        self.process.send_signal(signal.SIGSTOP)
        wait_for("the frozen gateway", self.is_frozen)

    def thaw(self) -> None:
        self.process.send_signal(signal.SIGCONT)

    def end(self) -> None:
        os.kill(self.process.pid, signal.SIGCONT)
        self.process.terminate()
        self.process.wait(30)


@dataclass
class Hall:
    """A site of which one test tells a device, beside the gateway that serves all of them."""

    slug: str
    device: str
    gateway: Gateway
    ear: Ear
    broker: Mosquitto

    @property
    def stop_topic(self) -> str:
        return f"vipo/v1/site/{self.slug}/stop"

    def add_command(self) -> str:
        now = datetime.now(UTC)
        row = Command.objects.create(
            id=uuid4(), site=Site.objects.get(slug=self.slug), position=Command.objects.count(), device=self.device,
            method="cure", send_after=now, created_at=now,
        )  # fmt: skip
        return str(row.id)

    def heard(self) -> list[Heard]:
        return self.ear.all(f"/{self.device}/down/cure")

    def told(self) -> set[str]:
        """Which commands; one that is not answered is told again, on a slow machine before anybody has looked."""
        return {heard.json["id"] for heard in self.heard()}

    def wait_told(self, command: str) -> Heard:
        topic = f"vipo/v1/dev/{self.device}/down/cure"
        return self.ear.wait(lambda heard: heard.topic == topic and heard.json["id"] == command)

    def wait_stop(self, wanted: Callable[[Any], bool]) -> dict[str, Any]:
        found: dict[str, Any] = self.ear.wait(lambda h: h.topic == self.stop_topic and wanted(h.json)).json
        return found

    def freeze_with_a_claim(self, point: str = "after_claim") -> str:
        self.gateway.freeze_at(point)
        command = self.add_command()
        wait_for("the gateway that has claimed", self.gateway.is_frozen)
        return command

    def outlast_the_claim(self) -> None:
        began_s = steady_s()
        wait_for("the end of the claim", lambda: steady_s() - began_s > CLAIM_IS_OVER_S)


@pytest.fixture(scope="module")
def served(
    module_database_url: str,
    shared_redis: Redis,
    tmp_path_factory: pytest.TempPathFactory,
    django_db_blocker: DjangoDbBlocker,
) -> Iterator[tuple[Gateway, Ear, Mosquitto]]:
    folder = tmp_path_factory.mktemp("frozen")
    with (
        django_db_blocker.unblock(),
        on_database(**postgres(module_database_url)),
        run_mosquitto(folder, {"server": WORD}) as broker,
        Ear(broker.port, WORD, "vipo/v1/#") as ear,
    ):
        gateway = Gateway(module_database_url, shared_redis, broker, folder, "one")
        ear.wait(lambda heard: heard.topic == "vipo/v1/srv/status")
        yield gateway, ear, broker
        gateway.end()


@pytest.fixture
def hall(served: tuple[Gateway, Ear, Mosquitto]) -> Iterator[Hall]:
    slug = f"hall{Site.objects.count()}"
    site = Site.objects.create(name=slug, slug=slug)
    Device.objects.create(id=f"{slug}.oven", site=site, lifecycle="approved", online=True)
    yield Hall(slug, f"{slug}.oven", *served)
    Command.objects.all().delete()


def test_a_frozen_gateway_sends_nothing_late_when_it_is_thawed(hall: Hall) -> None:
    command = hall.freeze_with_a_claim()
    hall.outlast_the_claim()
    Command.objects.filter(id=command).update(status="timed_out")
    hall.gateway.thaw()
    second = hall.add_command()
    hall.wait_told(second)
    assert hall.told() == {second}
    assert "claimed too long ago to be sent; 0 of them are free again" in hall.gateway.log.read_text()


def test_what_still_holds_is_sent_once_the_gateway_is_thawed(hall: Hall) -> None:
    command = hall.freeze_with_a_claim()
    hall.outlast_the_claim()
    hall.gateway.thaw()
    hall.wait_told(command)
    assert hall.told() == {command}
    wait_for("a try for each time that it is told", lambda: Command.objects.get().tries == len(hall.heard()))
    assert "claimed too long ago to be sent; 1 of them are free again" in hall.gateway.log.read_text()


def test_a_command_that_was_claimed_before_a_stop_bears_an_older_fence(hall: Hall) -> None:
    """The gateway is frozen after it has looked whether the claim still holds: here that may take any time."""
    services.press_stop(site=hall.slug, by="Ada")
    before = services.reset_stop(site=hall.slug, by="Ada").fence
    command = hall.freeze_with_a_claim("before_publish")
    pressed = services.press_stop(site=hall.slug, by="Ada")
    hall.gateway.thaw()
    assert hall.wait_told(command).json["fence"] == before
    assert hall.wait_stop(lambda said: said["fence"] == pressed.fence)["active"] is True
    assert pressed.fence > before


def test_a_command_keeps_the_fence_under_which_it_was_claimed_or_is_given_back(hall: Hall) -> None:
    """It is given back where the machine was so busy that the claim was over by the time that the stop was pressed."""
    services.press_stop(site=hall.slug, by="Ada")
    before = services.reset_stop(site=hall.slug, by="Ada").fence
    command = hall.freeze_with_a_claim()
    pressed = services.press_stop(site=hall.slug, by="Ada")
    hall.gateway.thaw()
    wait_for("the command, or its return", lambda: hall.told() or not Command.objects.get(id=command).tries)
    assert hall.wait_stop(lambda said: said["fence"] == pressed.fence)["active"] is True
    assert {heard.json["fence"] for heard in hall.heard()} <= {before}


def test_the_web_process_tells_the_devices_of_a_stop_while_the_only_gateway_is_frozen(
    hall: Hall, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(stop_publisher, "FRESH_S", PATIENCE_S)  # however long it takes here to press the stop
    hall.gateway.freeze()
    where = {"host": "127.0.0.1", "port": hall.broker.port, "username": "server", "password": WORD, "tls": False}
    services.open_publisher(mqtt=where)
    try:
        assert stop_publisher._client is not None
        assert stop_publisher._client.wait_connected(20)
        pressed = services.press_stop(site=hall.slug, by="Ada")
        assert hall.wait_stop(lambda said: said["active"])["fence"] == pressed.fence
        reset = services.reset_stop(site=hall.slug, by="Ada")
        hall.wait_stop(lambda said: said["fence"] == reset.fence)
    finally:
        services.close_publisher()
    hall.ear.forget()
    hall.gateway.thaw()
    hall.wait_told(hall.add_command())
    said = [heard for heard in hall.ear.all("/stop") if heard.topic == hall.stop_topic]
    assert {heard.json["fence"] for heard in said} <= {reset.fence}, "the same, or nothing"


def test_a_stop_that_somebody_says_late_is_put_right_by_the_gateway(hall: Hall) -> None:
    pressed = services.press_stop(site=hall.slug, by="Ada")
    hall.wait_stop(lambda said: said["fence"] == pressed.fence)
    hall.ear.say(hall.stop_topic, {"active": False, "at": None, "fence": pressed.fence - 1}, retain=True)
    wrong = hall.ear.wait(lambda h: h.topic == hall.stop_topic and h.json["fence"] == pressed.fence - 1)
    right = hall.ear.wait(lambda h: h.topic == hall.stop_topic and h.json["active"] and h.at > wrong.at)
    assert right.json["fence"] == pressed.fence


def test_a_database_that_was_put_back_does_not_let_devices_go_that_were_stopped(hall: Hall) -> None:
    ahead = services.press_stop(site=hall.slug, by="Ada").fence + 1_000_000
    services.reset_stop(site=hall.slug, by="Ada")
    hall.ear.say(hall.stop_topic, {"active": True, "at": None, "fence": ahead}, retain=True)
    hall.wait_stop(lambda said: said["active"] and said["fence"] > ahead)
    assert services.get_stop(site=hall.slug).active

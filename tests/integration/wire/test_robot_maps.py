"""A robot's map from the agent that runs on robots, over both brokers, into the database; parts outlive a gateway."""

from __future__ import annotations

import json
import random
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path

import pytest
from django.conf import LazySettings

from execution.gateway.gateway import Gateway
from registry import services
from registry.floorplan.plan import Grid
from registry.models import DeviceEvent, RobotMapPart
from tests.integration.wire.bus import SERVER_WORD, SITE, Bus
from tests.kit.mqtt import Ear
from tests.kit.waiting import wait_for
from tests.unit.robot_agent.agent import Agent, Config, Navigation, RobotGrid, write_grid

pytestmark = pytest.mark.servers
KEY = "the-key-of-every-robot-1"
CELLS = bytes(random.Random(5).choices((0, 100, 255), k=250_000))
GRID = RobotGrid(500, 500, 0.05, (-2.0, -3.0, 0.0), CELLS)


class StandsStill(Navigation):
    """A robot that has a map and stays where it is."""

    def start(self, agent: Agent) -> None:
        agent.moved((1.0, 2.0, 0.0))
        agent.mapped(GRID)

    def go(self, goal: object) -> None:
        raise AssertionError("nobody sends it anywhere")

    def halt(self) -> None: ...

    def stop(self) -> None: ...


@contextmanager
def running(run: object, *arguments: object) -> Iterator[None]:
    stopping = threading.Event()
    thread = threading.Thread(target=run, args=(*arguments, stopping))  # type: ignore[arg-type]
    thread.start()
    try:
        yield
    finally:
        stopping.set()
        thread.join(30)


def make_agent(bus: Bus, folder: Path, name: str) -> Agent:
    config = Config(name, SITE, 0.2, 0.5, 1, password=KEY, port=bus.device_port, state=str(folder / f"{name}.json"))
    return Agent(config, StandsStill())


def admit(name: str) -> None:
    at, hello = datetime.now(UTC), json.dumps({"key": KEY}).encode()
    services.enrol_device(site=SITE, device_id=name, payload=hello, at=at)


def approve(name: str) -> None:
    wait_for(f"the description of {name}", lambda: services.find_device(device_id=name))
    services.approve_device(site=SITE, device_id=name, by=None, at=datetime.now(UTC))


def known_map(name: str) -> Grid | None:
    try:
        return services.get_robot_map(site=SITE, device_id=name).grid
    except services.NoRobotMap:
        return None


def test_the_agents_map_arrives_whole_and_nobody_sends_one_for_another(
    bus: Bus, gateway: Gateway, tmp_path: Path
) -> None:
    admit("robot1")
    with running(make_agent(bus, tmp_path, "robot1").run):
        approve("robot1")
    with running(make_agent(bus, tmp_path, "robot1").run):
        wait_for("the map", lambda: known_map("robot1"), 60)
    assert known_map("robot1") == Grid(500, 500, 0.05, -2.0, -3.0, CELLS)
    admit("stranger")
    stranger = bus.client("stranger", KEY)
    stranger.start()
    assert stranger.wait_connected(20)
    (forged,) = write_grid(RobotGrid(2, 1, 0.05, (0.0, 0.0, 0.0), b"\0\0"), 2**50, 1)
    with Ear(bus.server_port, SERVER_WORD, "vipo/v1/dev/#") as ear:
        ear.wait(lambda heard: heard.topic == "vipo/v1/dev/robot1/up/state", 30)
        stranger.publish("vipo/v1/dev/robot1/up/map", forged)
        stranger.publish("vipo/v1/dev/stranger/up/map", forged)
        ear.wait(lambda heard: heard.topic == "vipo/v1/dev/stranger/up/map", 30)
        stranger.stop()
        assert "vipo/v1/dev/robot1/up/map" not in [heard.topic for heard in ear.heard]
    assert known_map("robot1") == Grid(500, 500, 0.05, -2.0, -3.0, CELLS)


@pytest.mark.parametrize("bus", ["mosquitto"], indirect=True)
def test_parts_that_come_to_several_gateways_make_one_map(bus: Bus, settings: LazySettings, tmp_path: Path) -> None:
    admit("robot1")
    said = list(write_grid(GRID._replace(cells=CELLS[::-1]), 2**40, 1))
    wanted = Grid(500, 500, 0.05, -2.0, -3.0, CELLS[::-1])
    robot = bus.client("robot1", KEY)
    with gateway_named("one", settings, bus):
        with running(make_agent(bus, tmp_path, "robot1").run):
            approve("robot1")
        robot.start()
        for message in said[:3]:
            robot.publish("vipo/v1/dev/robot1/up/map", message)
        wait_for("the first parts", lambda: RobotMapPart.objects.count() == 3)
        robot.publish("vipo/v1/dev/robot1/up/map", said[3].replace(b"[500,500]", b"[500,499]"))
        wait_for("the complaint", lambda: DeviceEvent.objects.filter(kind="problem", text__startswith="map: ").exists())
    assert known_map("robot1") != wanted
    with gateway_named("one", settings, bus), gateway_named("two", settings, bus):
        for message in said[3:]:
            robot.publish("vipo/v1/dev/robot1/up/map", message)
        wait_for("the map", lambda: known_map("robot1") == wanted, 60)
    robot.stop()
    assert RobotMapPart.objects.count() == 0


@contextmanager
def gateway_named(name: str, settings: LazySettings, bus: Bus) -> Iterator[None]:
    settings.VIPO_GATEWAY = name
    with Ear(bus.server_port, SERVER_WORD, "vipo/v1/srv/status") as ear:
        assert ear.client.wait_subscribed(20)
        with running(Gateway(settings).run_forever):
            ear.wait(lambda heard: not heard.retained, 20)
            yield

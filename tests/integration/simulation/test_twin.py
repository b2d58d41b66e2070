"""The twin on a real Mosquitto with the product's own rules: its devices speak as real ones do."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import pytest

from registry.floorplan.map_message import join_parts, read_grid_part
from registry.floorplan.plan import FREE, UNKNOWN
from simulation.site_facts import SiteUnread, demo_facts
from simulation.twin import Twin, TwinPlan
from simulation.world import Obstacle
from tests.kit.files import ROOT
from tests.kit.mqtt import Ear, Heard
from tests.kit.servers import Mosquitto, run_mosquitto
from tests.kit.waiting import PATIENCE_S, wait_for
from vipo_device.descriptions.reader import read_description
from vipo_device.protocol.description import Pose
from vipo_device.protocol.messages import parse_presence, parse_state
from vipo_device.protocol.mqtt_client import MqttClient, Will

FACTS = demo_facts()
IDS = frozenset(d.description.id for d in FACTS.devices)
ACCOUNTS = {"server": "secret"} | {name: f"word of {name}" for name in IDS}
VOICES = frozenset({"itemInventory01", "curingOven01", "robot01"})
STOP = "vipo/v1/site/painting-factory/stop"


@pytest.fixture(scope="module")
def bus(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Mosquitto]:
    with run_mosquitto(tmp_path_factory.mktemp("mosquitto"), ACCOUNTS) as mosquitto:
        yield mosquitto


@pytest.fixture
def ear(bus: Mosquitto) -> Iterator[Ear]:
    with Ear(bus.port, "secret") as ear:
        yield ear
        ear.say(STOP, b"", retain=True)
        for name in IDS:
            for kind in ("desc", "presence", "state"):
                ear.say(f"vipo/v1/dev/{name}/up/{kind}", b"", retain=True)


@contextmanager
def running_twin(bus: Mosquitto, memory: Path, **changes: object) -> Iterator[None]:
    def connect(device: str, will: Will) -> MqttClient:
        return MqttClient(
            host="127.0.0.1",
            port=bus.device_port,
            username=device,
            password=ACCOUNTS[device],
            client_id=device,
            will=will,
        )

    plan = TwinPlan(facts=FACTS, speaking=VOICES, memory_path=memory, speed=20, driver="kinematic")
    twin, stopping = Twin(replace(plan, **changes), connect), threading.Event()  # type: ignore[arg-type]
    thread = threading.Thread(target=twin.run, args=(stopping,))
    thread.start()
    try:
        yield
    finally:
        stopping.set()
        thread.join(PATIENCE_S)
        assert not thread.is_alive()


def up(device: str, kind: str) -> str:
    return f"vipo/v1/dev/{device}/up/{kind}"


def is_ack(heard: Heard, command: str, status: str) -> bool:
    return heard.topic.endswith("/ack") and heard.json["id"] == command and heard.json["st"] == status


def wait_done(ear: Ear, command: str) -> Heard:
    done = ear.wait(
        lambda h: h.topic.endswith("/ack") and h.json["id"] == command and h.json["st"] not in "ACCEPTED RUNNING"
    )
    assert done.json["st"] == "DONE", done.json
    return done


def test_devices_introduce_themselves_with_their_own_bytes(bus: Mosquitto, ear: Ear, tmp_path: Path) -> None:
    with running_twin(bus, tmp_path / "memory.json"):
        for name in VOICES:
            described = ear.wait(lambda h, name=name: h.topic == up(name, "desc"))
            assert described.payload == next(d.source for d in FACTS.devices if d.description.id == name)
            assert read_description(described.payload, device_id=name).id == name
            assert parse_presence(ear.wait(lambda h, name=name: h.topic == up(name, "presence")).payload).online
        state = parse_state(ear.wait(lambda h: h.topic == up("curingOven01", "state")).payload)
    assert state.done
    assert state.boot == 1
    assert state.pose == Pose(9.8, -11.4)
    assert state.properties == {"jobStatus": 0, "temperature": 22.0, "quality": "ok"}
    assert {h.topic.split("/")[3] for h in ear.heard} == VOICES


def test_a_robot_sends_the_map_of_what_its_laser_sees(bus: Mosquitto, ear: Ear, tmp_path: Path) -> None:
    with running_twin(bus, tmp_path / "memory.json"):
        sent = ear.wait(lambda h: h.topic == up("robot01", "map"))
    grid = join_parts([read_grid_part(sent.payload)])
    assert (grid.width, grid.height, sent.retained) == (FACTS.grid.width, FACTS.grid.height, False)
    robot = next(d.description.pose for d in FACTS.devices if d.description.id == "robot01")
    row, column = grid.cell_of(robot.x, robot.y) or (0, 0)
    assert grid.cells[row * grid.width + column] == FREE
    assert len(grid.cells) > grid.cells.count(UNKNOWN) > len(grid.cells) / 2


def test_goodbye_says_offline(bus: Mosquitto, ear: Ear, tmp_path: Path) -> None:
    with running_twin(bus, tmp_path / "memory.json"):
        ear.wait(lambda h: h.topic == up("robot01", "state"))
    ear.wait(lambda h: h.topic == up("robot01", "presence") and not parse_presence(h.payload).online)
    ear.wait(lambda h: h.topic == up("curingOven01", "presence") and not parse_presence(h.payload).online)


def test_robot_fetches_a_box_and_the_states_come_before_the_answer(bus: Mosquitto, ear: Ear, tmp_path: Path) -> None:
    with running_twin(bus, tmp_path / "memory.json"):
        ear.wait(lambda h: h.topic == up("robot01", "state"))
        way = [[15.78, -8.0], [2.3, -8.0], [2.3, -3.0]]
        ear.tell("robot01", "move", "go", path=way)
        ear.tell("robot01", "pick", "take", device="itemInventory01", object="box", value=1)
        wait_done(ear, "go")
        moving = [parse_state(h.payload).pose for h in ear.all("robot01/up/state")]
        wait_done(ear, "take")
    topics = [(h.topic, h.json) for h in ear.heard if not h.topic.endswith("desc")]
    answered = next(i for i, (t, body) in enumerate(topics) if body.get("id") == "take" and body["st"] == "DONE")
    loads = [body["props"]["load"] for t, body in topics[:answered] if t == up("robot01", "state")]
    assert loads[-1] == "box:1"
    stocks = [body["props"]["stock"] for t, body in topics if t == up("itemInventory01", "state")]
    assert stocks[-1] == 23
    assert len({(p.x, p.y) for p in moving if p}) > 5
    assert [body["st"] for _, body in topics if body.get("id") == "take"] == ["ACCEPTED", "RUNNING", "DONE"]


def test_a_repeated_command_is_answered_again_and_not_carried_out_again(
    bus: Mosquitto, ear: Ear, tmp_path: Path
) -> None:
    with running_twin(bus, tmp_path / "memory.json", speed=100):
        ear.wait(lambda h: h.topic == up("curingOven01", "state"))
        ear.tell("curingOven01", "curePaint", "cure", time=1)
        first = wait_done(ear, "cure")
        ear.forget()
        ear.tell("curingOven01", "curePaint", "cure", time=1)
        again = ear.wait(lambda h: h.topic.endswith("/ack"))
    assert again.json == first.json
    assert first.json["result"] == {"quality": "ok"}
    assert all(parse_state(h.payload).done for h in ear.all("curingOven01/up/state"))


def test_what_it_cannot_do_is_rejected_with_a_reason(bus: Mosquitto, ear: Ear, tmp_path: Path) -> None:
    with running_twin(bus, tmp_path / "memory.json"):
        ear.wait(lambda h: h.topic == up("robot01", "state"))
        ear.tell("robot01", "pick", "far", device="itemInventory01", object="box", value=1)
        refused = ear.wait(lambda h: is_ack(h, "far", "REJECTED"))
    assert refused.json["why"].startswith("TurtleBot 1 is not at Item Inventory: it is ")


def test_the_sites_stop_holds_everything_until_it_is_reset(bus: Mosquitto, ear: Ear, tmp_path: Path) -> None:
    with running_twin(bus, tmp_path / "memory.json", speed=5):
        ear.wait(lambda h: h.topic == up("robot01", "state"))
        ear.tell("robot01", "move", "go", path=[[15.78, -10.4], [15.78, -8.0], [2.3, -8.0]])
        ear.wait(lambda h: is_ack(h, "go", "RUNNING"))
        ear.say(STOP, {"active": True, "by": "Ann", "at": None}, retain=True)

        def stands_still() -> bool:
            ear.forget()
            time.sleep(0.7)
            return not ear.all("robot01/up/state")

        wait_for("a robot that stands still", stands_still)
        assert not ear.all("robot01/up/ack"), "it stands on its way"
        ear.say(STOP, {"active": False, "by": "", "at": None}, retain=True)
        wait_done(ear, "go")


@pytest.mark.parametrize("before", [{"s": "online", "at": "1"}, b""])
def test_a_new_server_is_told_who_is_here_also_the_first_of_all(
    bus: Mosquitto, ear: Ear, tmp_path: Path, before: dict[str, str] | bytes
) -> None:
    ear.say("vipo/v1/srv/status", before, retain=True)
    with running_twin(bus, tmp_path / "memory.json"):
        ear.wait(lambda h: h.topic == up("robot01", "state"))
        time.sleep(0.3)
        ear.forget()
        ear.say("vipo/v1/srv/status", {"s": "online", "at": "2"}, retain=True)
        for kind in ("desc", "presence", "state"):
            ear.wait(lambda h, kind=kind: h.topic == up("robot01", kind))


def test_the_world_goes_on_where_it_was_left_with_a_higher_boot_number(
    bus: Mosquitto, ear: Ear, tmp_path: Path
) -> None:
    memory = tmp_path / "memory.json"
    with running_twin(bus, memory):
        ear.wait(lambda h: h.topic == up("robot01", "state"))
        ear.tell("robot01", "move", "go", path=[[15.78, -10.4]])
        wait_done(ear, "go")
        ear.tell("curingOven01", "curePaint", "long", time=60)
        ear.wait(lambda h: is_ack(h, "long", "RUNNING"))
    ear.forget()
    with running_twin(bus, memory):
        state = parse_state(ear.wait(lambda h: h.topic == up("robot01", "state")).payload)
        ear.tell("curingOven01", "curePaint", "long", time=60)
        ear.wait(lambda h: is_ack(h, "long", "RUNNING"))
        ear.tell("robot01", "move", "go", path=[[15.78, -10.4]])
        wait_done(ear, "go")
    assert state.boot == 2
    assert state.pose is not None
    assert abs(state.pose.y - -10.4) < 0.03
    answers = [(h.json["id"], h.json["st"]) for h in ear.all("/ack")]
    assert answers == [("long", "ACCEPTED"), ("long", "RUNNING"), ("go", "DONE")]


def test_devices_that_are_taken_out_and_let_back_go_on_where_they_were(tmp_path: Path) -> None:
    now = {"facts": FACTS}
    plan = TwinPlan(FACTS, VOICES, tmp_path / "memory.json", driver="kinematic", refresh=lambda: now["facts"])
    twin = Twin(plan, lambda device, will: pytest.fail("Nobody connects here."))
    world = twin._world
    place = world.robots()["robot01"].pose
    world.command("robot01", "move", {"path": [[place.x + 0.5, place.y]]}, "c1")
    world.command("itemInventory01", "dispense", {"object": "box", "value": 1}, "c2")
    world.advance(30)
    moved = world.robots()["robot01"].pose
    assert moved.x > place.x + 0.4
    for out in ({"robot01", "itemInventory01"}, {"robot01"}, set()):
        left = tuple(d for d in FACTS.devices if d.description.id not in out)
        now["facts"] = replace(FACTS, devices=left)
        twin._refresh()
        assert set(twin._world.robots()).isdisjoint(out)
        twin._save()
    assert twin._world.robots()["robot01"].pose == moved
    remembered = twin._world.remembered()
    assert [[ack.command for ack in remembered[name]] for name in ("robot01", "itemInventory01")] == [["c1"], ["c2"]]


def test_a_memory_that_cannot_be_read_begins_anew_and_boots_still_rise(
    bus: Mosquitto, ear: Ear, tmp_path: Path
) -> None:
    memory = tmp_path / "memory.json"
    memory.write_text('{"format": 1, "boots": {"robot01": ')
    with running_twin(bus, memory):
        state = parse_state(ear.wait(lambda h: h.topic == up("robot01", "state")).payload)
    assert state.boot > 1_700_000_000
    assert json.loads(memory.read_text())["boots"]["robot01"] == state.boot


def test_a_broken_message_is_ignored_and_the_next_one_is_heard(bus: Mosquitto, ear: Ear, tmp_path: Path) -> None:
    with running_twin(bus, tmp_path / "memory.json"):
        ear.wait(lambda h: h.topic == up("curingOven01", "state"))
        for payload in (b"\xff", b"[]", b'{"v": {}}', b'{"id": "", "v": {}}', b'{"id": "x", "v": 3}'):
            ear.say("vipo/v1/dev/curingOven01/down/curePaint", payload)
        ear.tell("curingOven01", "curePaint", "none")
        refused = ear.wait(lambda h: h.topic.endswith("/ack"))
    assert refused.json["id"] == "none"
    assert refused.json["why"] == "curePaint needs a value for time."


def test_a_map_that_changed_is_taken_over_when_nobody_is_busy(
    bus: Mosquitto, ear: Ear, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("simulation.twin.REFRESH_EVERY_S", 0.2)
    moved = tuple(
        replace(d, description=replace(d.description, pose=Pose(10.0, -11.0)))
        if d.description.id == "curingOven01"
        else d
        for d in FACTS.devices
    )
    with running_twin(bus, tmp_path / "memory.json", refresh=lambda: replace(FACTS, devices=moved)):
        states = up("curingOven01", "state")
        ear.wait(lambda h: h.topic == states and parse_state(h.payload).pose == Pose(10.0, -11.0))


def test_a_robot_stops_before_what_people_put_down_and_says_so_also_while_the_database_is_away(
    bus: Mosquitto, ear: Ear, tmp_path: Path
) -> None:
    looks: list[int] = []

    def look() -> tuple[Obstacle, ...]:
        looks.append(1)
        if len(looks) > 1:
            raise SiteUnread("The database does not answer.")
        return (Obstacle(17.3, -8.6, 0.5),)

    with running_twin(bus, tmp_path / "memory.json", obstacles=look, speed=2):
        ear.wait(lambda h: h.topic == up("robot01", "state"))
        x, y = parse_state(ear.wait(lambda h: h.topic == up("robot01", "state")).payload).pose.x, -10.4
        ear.tell("robot01", "move", "go", path=[[x, y], [17.3, y], [17.3, -7.0]])
        failed = ear.wait(lambda h: is_ack(h, "go", "FAILED"))
    assert failed.json["why"] == (
        "TurtleBot 1 cannot go on: something that is not on the map is in its way at (17.3, -8.6)."
    )
    assert len(looks) > 2


def test_the_process_with_physics_leaves_in_time(bus: Mosquitto, ear: Ear, tmp_path: Path) -> None:
    environment = os.environ | {
        "VIPO_STATE_DIR": str(tmp_path),
        "VIPO_MQTT_PORT": str(bus.device_port),
        "VIPO_MODE": "embedded",
        "DJANGO_SETTINGS_MODULE": "vipo_site.settings",
    }
    manage = [sys.executable, str(ROOT / "manage.py")]
    subprocess.run([*manage, "migrate", "-v0", "--skip-checks"], check=True, env=environment)
    subprocess.run([*manage, "seed_demo", "-v0", "--skip-checks"], check=True, env=environment)
    passwords = {name: word for name, word in ACCOUNTS.items() if name != "server"}
    (tmp_path / "secrets" / "devices.json").write_text(json.dumps(passwords))
    with (tmp_path / "twin.log").open("wb") as log:
        command = [*manage, "twin", "--site", "painting-factory", "--speed", "4", "--except", "paintMixer02"]
        process = subprocess.Popen(command, env=environment, stderr=log)
    try:
        ear.wait(lambda h: h.topic == up("robot02", "state"))
        ear.tell("robot02", "move", "go", path=[[17.3, -10.4]])
        wait_done(ear, "go")
        process.send_signal(signal.SIGTERM)
        assert process.wait(PATIENCE_S) == 0
    finally:
        process.kill()
    offline = ear.wait(lambda h: h.topic == up("robot02", "presence") and not parse_presence(h.payload).online)
    assert offline.json["boot"] == 1
    assert {h.topic.split("/")[3] for h in ear.heard} == IDS - {"paintMixer02"}
    assert "Traceback" not in (tmp_path / "twin.log").read_text()

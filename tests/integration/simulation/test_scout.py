"""A simulated robot that maps a floor, on a real Mosquitto with the product's own rules."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from django.core.management import call_command
from django.core.management.base import CommandError

from registry.floorplan.map_message import GridPart, join_parts, read_grid_part
from registry.floorplan.map_server import write_pgm, write_yaml
from registry.floorplan.plan import FREE, Grid
from simulation.management.commands.scout import read_floor
from simulation.mapping.floor import TrueFloor
from simulation.mapping.scores import score
from simulation.mapping.survey import NoRoom, SurveyPlan
from simulation.scout import Scout, ScoutPlan
from simulation.twin_memory import TwinMemory, read_memory, write_memory
from tests.kit.floors.halls import bare_hall
from tests.kit.mqtt import Ear, Heard
from tests.kit.servers import Mosquitto, run_mosquitto
from tests.kit.waiting import PATIENCE_S, wait_for
from vipo_device.descriptions.reader import read_description
from vipo_device.protocol.description import Pose
from vipo_device.protocol.messages import parse_state
from vipo_device.protocol.mqtt_client import MqttClient, Will

SCOUT, SITE = "hall.scout", "hall"
ACCOUNTS = {"server": "secret", SCOUT: "word of the scout"}
FLOOR, START = bare_hall(5.0, 4.0), Pose(1.0, 1.0)


@pytest.fixture
def ear(tmp_path: Path) -> Iterator[Ear]:
    """Hears a scout that is running."""
    with run_mosquitto(tmp_path, ACCOUNTS) as bus, Ear(bus.port, "secret") as ear, running(bus, ear):
        yield ear


@contextmanager
def running(
    bus: Mosquitto, ear: Ear, memory: Path | None = None, *, boot: int = 7, speed: float = 20
) -> Iterator[None]:
    """Run a scout until it is stopped."""
    stopping = threading.Event()
    plan = ScoutPlan(SCOUT, "Scout", SITE, SurveyPlan(FLOOR, 1, start=START), speed, boot, memory)
    thread = threading.Thread(target=Scout(plan, connecting(bus)).run, args=(stopping,))
    thread.start()
    try:
        ear.wait(lambda h: h.topic.endswith("/state") and h.json["boot"] == boot)
        yield
    finally:
        stopping.set()
        thread.join(PATIENCE_S)
        assert not thread.is_alive()


def connecting(bus: Mosquitto):  # type: ignore[no-untyped-def]
    def connect(device: str, will: Will) -> MqttClient:
        key = ACCOUNTS[device]
        return MqttClient(
            host="127.0.0.1", port=bus.device_port, username=device, password=key, client_id=device, will=will
        )

    return connect


def answered(ear: Ear, command: str, status: str) -> Heard:
    return ear.wait(lambda h: h.topic.endswith("/ack") and h.json["id"] == command and h.json["st"] == status)


def maps(ear: Ear) -> list[Grid]:
    """The whole maps that were sent, oldest first."""
    parts: dict[int, list[GridPart]] = {}
    for heard in ear.all(f"{SCOUT}/up/map"):
        part = read_grid_part(heard.payload)
        parts.setdefault(part.number, []).append(part)
    return [join_parts(each) for _, each in sorted(parts.items())]


def known(grid: Grid) -> int:
    return grid.cells.count(FREE)


def test_it_says_what_it_is_maps_when_it_is_told_to_and_sends_the_map_before_it_says_done(ear: Ear) -> None:
    described = read_description(ear.wait(lambda h: h.topic.endswith("/desc")).payload, device_id=SCOUT)
    assert (described.kind, described.simulated) == ("robot", True)
    assert [method.name for method in described.methods] == ["move", "explore"]
    ear.tell(SCOUT, "explore", "go")
    answered(ear, "go", "RUNNING")
    ear.tell(SCOUT, "explore", "again")
    assert (
        answered(ear, "again", "REJECTED").json["why"]
        == "Scout explores already. Wait until it is done, or cancel that."
    )
    answered(ear, "go", "DONE")
    sent = [heard.topic.rsplit("/", 1)[1] for heard in ear.heard]
    assert "map" in sent[: len(sent) - 1 - sent[::-1].index("ack")]
    whole = maps(ear)[-1]
    found = score(whole, TrueFloor(FLOOR), START)
    assert found.f1 >= 0.95
    assert found.iou >= 0.97
    state = parse_state(ear.all(f"{SCOUT}/up/state")[-1].payload)
    assert state.done
    assert state.pose is not None
    assert (state.pose.x, state.pose.y) == pytest.approx((START.x, START.y), abs=0.3)


def test_after_a_cancel_it_goes_on_with_the_same_map(ear: Ear) -> None:
    ear.tell(SCOUT, "explore", "go")
    first = ear.wait(lambda h: h.topic.endswith("/map"))
    assert not first.retained
    ear.tell(SCOUT, "cancel", "end", command="go")
    answered(ear, "go", "CANCELED")
    before = maps(ear)[-1]
    ear.tell(SCOUT, "explore", "on")
    answered(ear, "on", "DONE")
    assert known(maps(ear)[-1]) > known(before) > 0


def test_it_drives_where_it_is_told_to_and_sends_no_map_of_that(ear: Ear) -> None:
    ear.tell(SCOUT, "explore", "go")
    answered(ear, "go", "DONE")
    before = len(maps(ear))
    ear.tell(SCOUT, "move", "drive", path=[[3.5, 1.0], [3.5, 3.0]])
    answered(ear, "drive", "DONE")
    state = parse_state(ear.all(f"{SCOUT}/up/state")[-1].payload)
    assert state.pose is not None
    assert (state.pose.x, state.pose.y) == pytest.approx((3.5, 3.0), abs=0.05)
    assert len(maps(ear)) == before


def test_the_sites_stop_holds_it_where_it_is(ear: Ear) -> None:
    ear.say(f"vipo/v1/site/{SITE}/stop", {"active": True, "at": "2026-01-01T12:00:00+00:00"}, retain=True)
    ear.tell(SCOUT, "explore", "go")
    answered(ear, "go", "RUNNING")
    assert not maps(ear)
    ear.say(f"vipo/v1/site/{SITE}/stop", {"active": False, "at": "2026-01-01T12:00:01+00:00"}, retain=True)
    answered(ear, "go", "DONE")
    assert maps(ear)


def test_killed_under_way_it_stands_where_it_stood_and_does_nothing_twice(tmp_path: Path) -> None:
    """What it kept at one moment is all that a killed process leaves behind."""
    kept, left = tmp_path / "twin" / "scout.json", tmp_path / "left.json"
    with run_mosquitto(tmp_path, ACCOUNTS) as bus, Ear(bus.port, "secret") as ear:
        with running(bus, ear, kept, speed=1):
            ear.tell(SCOUT, "move", "first", path=[[2.0, 1.0]])
            answered(ear, "first", "DONE")
            ear.tell(SCOUT, "move", "second", path=[[3.5, 1.0], [3.5, 3.0]])
            wait_for("it has set out", lambda: pose_in(kept).x > 2.5)
            left.write_bytes(kept.read_bytes())
        stood = pose_in(left)
        with running(bus, ear, left, boot=8):
            states = [parse_state(heard.payload) for heard in ear.all(f"{SCOUT}/up/state")]
            first = next(state.pose for state in states if state.boot == 8)
            assert first is not None
            assert (first.x, first.y) == pytest.approx((stood.x, stood.y), abs=0.05)
            for command, path in (("first", [[2.0, 1.0]]), ("second", [[3.5, 1.0], [3.5, 3.0]])):
                ear.tell(SCOUT, "move", command, path=path)
            answered(ear, "second", "DONE")
            said = [(h.json["id"], h.json["st"]) for h in ear.all(f"{SCOUT}/up/ack")]
            assert [said.count(("first", status)) for status in ("RUNNING", "DONE")] == [1, 2]
            assert [said.count(("second", status)) for status in ("RUNNING", "DONE")] == [2, 1]
        assert (pose_in(left).x, pose_in(left).y) == pytest.approx((3.5, 3.0), abs=0.06)


def test_where_the_floor_has_become_another_one_it_begins_at_its_start(tmp_path: Path) -> None:
    write_memory(tmp_path / "scout.json", TwinMemory(poses={SCOUT: Pose(90.0, 90.0)}))
    with run_mosquitto(tmp_path, ACCOUNTS) as bus, Ear(bus.port, "secret") as ear:
        with running(bus, ear, tmp_path / "scout.json"):
            pass
        pose = parse_state(ear.all(f"{SCOUT}/up/state")[-1].payload).pose
    assert pose is not None
    assert (pose.x, pose.y) == (START.x, START.y)


def pose_in(memory: Path) -> Pose:
    return read_memory(memory).poses.get(SCOUT, START)


def test_a_scout_that_does_not_fit_is_refused_before_it_connects() -> None:
    plan = ScoutPlan(SCOUT, "Scout", SITE, SurveyPlan(FLOOR, 1, start=Pose(0.1, 0.1)))
    with pytest.raises(NoRoom, match="does not fit"):
        Scout(plan, lambda *_: pytest.fail("it came in"))


@pytest.mark.parametrize(
    ("option", "value", "told"),
    [
        ("--speed", "50", r"--speed 50 is outside 0\.1 to 20; 1 is real time\."),
        ("--lidar", "nan", r"--lidar nan is out of bounds; choose 2 to 40 metres\."),
        ("--seed", "-1", r"--seed must be a whole number from 0 to 2147483647\."),
    ],
)
def test_the_command_refuses_what_no_robot_has(option: str, value: str, told: str) -> None:
    with pytest.raises(CommandError, match=told):
        call_command("scout", "--site", SITE, "--map", "hall.yaml", option, value)


def test_the_command_names_a_map_that_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(CommandError, match=r"hall\.yaml cannot be read: No such file or directory\."):
        read_floor(tmp_path / "hall.yaml")
    (tmp_path / "hall.yaml").write_bytes(write_yaml(FLOOR, "hall.pgm"))
    with pytest.raises(CommandError, match=r"hall\.pgm cannot be read"):
        read_floor(tmp_path / "hall.yaml")
    (tmp_path / "hall.pgm").write_bytes(write_pgm(FLOOR))
    assert read_floor(tmp_path / "hall.yaml") == FLOOR

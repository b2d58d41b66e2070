"""The robot's agent on real ROS (Debian's rosmaster, rospy and actionlib) and on a stand-in for rosbridge.

move_base and Nav2 are stand-ins: a robot that drives straight to its goal. The broker and the agent are real.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import pytest

from registry.floorplan.map_message import join_parts, read_grid_part
from registry.floorplan.plan import Grid
from tests.kit.files import ROOT
from tests.kit.mqtt import Ear, ServerSide
from tests.kit.servers import Mosquitto, answers, free_port, must_be_installed, run_mosquitto, wait_ready
from tests.kit.waiting import PATIENCE_S, wait_for
from tests.robot_agent.bridge_stand_in import BridgeStandIn
from tests.robot_agent.pretend_robot import HEIGHT, SPEED_M_S, WIDTH, map_cells
from vipo_device.descriptions.reader import read_description

AGENT = ROOT / "firmware" / "robot_agent"
HERE = Path(__file__).parent
DEBIAN_PYTHON = "/usr/bin/python3"
ACCOUNTS = {
    "server": "secret of the server",
    "tb1": "the word of tb1",
    "tb2": "the word of tb2",
    "tb3": "the word of tb3",
    "join:hall": "the key for enrolment",
}
STOP = "vipo/v1/site/hall/stop"
JOIN = {"join_key": ACCOUNTS["join:hall"]}
PACKAGES = "rospy, rosmaster, actionlib, move_base_msgs.msg, nav_msgs.msg, sensor_msgs.msg, paho.mqtt.client"


@pytest.fixture(scope="module")
def broker(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Mosquitto]:
    with run_mosquitto(tmp_path_factory.mktemp("broker"), ACCOUNTS) as mosquitto:
        yield mosquitto


@pytest.fixture(scope="module")
def ear(broker: Mosquitto) -> Iterator[Ear]:
    with Ear(broker.port, ACCOUNTS["server"], "vipo/v1/#") as ear:
        yield ear


@pytest.fixture(scope="module")
def ros1(broker: Mosquitto, ear: Ear, tmp_path_factory: pytest.TempPathFactory) -> Iterator[ServerSide]:
    """Run rosmaster, the stand-in for move_base, and the agent."""
    found = subprocess.run([DEBIAN_PYTHON, "-c", f"import {PACKAGES}"], capture_output=True, text=True)
    if found.returncode:
        must_be_installed("ROS 1", found.stderr.strip()[-200:])
    folder, port = tmp_path_factory.mktemp("ros1"), free_port()
    environment = {
        "PATH": "/usr/bin:/bin",
        "HOME": str(folder),
        "ROS_MASTER_URI": f"http://127.0.0.1:{port}",
        "ROS_IP": "127.0.0.1",
        "ROS_HOME": str(folder),
        "ROS_LOG_DIR": str(folder),
        "PYTHONPATH": str(AGENT),
    }
    with ExitStack() as stack:
        run = stack.enter_context
        master = run(running(["/usr/bin/rosmaster", "--core", "-p", str(port)], environment, folder / "master.log"))
        wait_ready(lambda: answers(port), (folder / "master.log").read_text, master)
        robot = [DEBIAN_PYTHON, str(HERE / "move_base_stand_in.py")]
        log = folder / "robot.log"
        process = run(running(robot, environment, log))
        wait_ready(lambda: "ready" in log.read_text(), log.read_text, process)
        config = write_config(folder, broker, "tb1", ros=1)
        yield run(joined(ear, "tb1", [DEBIAN_PYTHON, "-m", "vipo_agent", config], environment, folder / "agent.log"))


@pytest.fixture(scope="module")
def bridge() -> Iterator[BridgeStandIn]:
    stand_in = BridgeStandIn(free_port())
    yield stand_in
    stand_in.close()


@pytest.fixture(scope="module")
def ros2(
    broker: Mosquitto, ear: Ear, bridge: BridgeStandIn, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[ServerSide]:
    """Run the agent with roslibpy against the stand-in for rosbridge."""
    folder = tmp_path_factory.mktemp("ros2")
    config = write_config(folder, broker, "tb2", ros=2, bridge_port=bridge.port, speed_topic="/speed_limit")
    environment = {**os.environ, "PYTHONPATH": str(AGENT)}
    with joined(ear, "tb2", [sys.executable, "-m", "vipo_agent", config], environment, folder / "agent.log") as server:
        yield server


@pytest.fixture(params=["ros1", "ros2"])
def server(request: pytest.FixtureRequest) -> ServerSide:
    found: ServerSide = request.getfixturevalue(request.param)
    return found


def write_config(folder: Path, broker: Mosquitto, name: str, **more: Any) -> str:
    body = {
        "id": name,
        "name": 'TurtleBot "3"',
        "site": "hall",
        "password": ACCOUNTS[name],
        "port": broker.device_port,
        "radius_m": 0.18,
        "speed_m_s": 0.5,
        "home": [1.0, 2.0, 0.0],
        "capacity": 2,
        "handling_s": 0.3,
        "state": str(folder / "state.json"),
        **more,
    }
    path = folder / "config.json"
    path.write_text(json.dumps(body))
    return str(path)


@contextmanager
def running(command: list[str], environment: dict[str, str], log: Path) -> Iterator[subprocess.Popen[bytes]]:
    with log.open("ab") as out:
        process = subprocess.Popen(command, env=environment, stdout=out, stderr=out)
    try:
        yield process
    finally:
        process.terminate()
        process.wait(PATIENCE_S)


@contextmanager
def joined(ear: Ear, name: str, command: list[str], environment: dict[str, str], log: Path) -> Iterator[ServerSide]:
    server = ServerSide(ear, name)
    with running(command, environment, log) as process:
        try:
            server.wait_state(done=True, loc=[1.0, 2.0, 0.0, 0.0], battery=88)
        except AssertionError as error:
            raise AssertionError(f"{error}\n{log.read_text()}") from error
        yield server
        process.terminate()
        assert process.wait(PATIENCE_S) == 0
    server.wait_presence("offline")
    assert "Traceback" not in log.read_text()


def test_a_new_device_makes_a_key_of_its_own_and_enrols_with_it(
    broker: Mosquitto, ear: Ear, bridge: BridgeStandIn, tmp_path: Path
) -> None:
    config = write_config(tmp_path, broker, "tb2", id="new", ros=2, bridge_port=bridge.port, password="", **JOIN)
    environment = {**os.environ, "PYTHONPATH": str(AGENT)}
    command = [sys.executable, "-m", "vipo_agent", config]
    with running(command, environment, tmp_path / "agent.log"):
        enrolled = ear.wait(lambda h: h.topic == "vipo/v1/join/hall/new")
        assert len(enrolled.json["key"]) == 32
        kept = tmp_path / "state.json"
        assert json.loads(kept.read_text())["key"] == enrolled.json["key"]
        assert kept.stat().st_mode & 0o777 == 0o600
    assert "Traceback" not in (tmp_path / "agent.log").read_text()


def go(server: ServerSide, *commands: tuple[str, list[list[float]]], **more: Any) -> None:
    for command, path in commands:
        server.tell("move", command, path=path, **more)


def test_the_robot_describes_itself_and_sends_its_map(server: ServerSide) -> None:
    described = server.ear.wait(lambda h: h.topic == server.up("desc")).payload
    found = read_description(described, device_id=server.device)
    assert (found.name, found.kind, found.site, found.capacity) == ('TurtleBot "3"', "robot", "hall", 2)
    assert (found.radius_m, found.speed_m_s, found.pose.x, found.pose.y) == (0.18, 0.5, 1.0, 2.0)
    assert [m.name for m in found.methods] == ["move", "pick", "drop"]
    last = server.ear.wait(lambda h: h.topic == server.up("map") and h.json["part"] == h.json["parts"] - 1).json
    heard = [h for h in server.ear.all("/map") if h.topic == server.up("map") and h.json["map"] == last["map"]]
    assert all(len(h.payload) < 16_000 for h in heard)
    grid = join_parts([read_grid_part(h.payload) for h in heard])
    assert grid == Grid(WIDTH, HEIGHT, 0.05, -1.0, -2.0, bytes(cell & 0xFF for cell in map_cells()))


def test_pieces_of_way_are_driven_and_each_has_its_end(server: ServerSide) -> None:
    server.ear.forget()
    server.tell("move", "a", path=[[1.0, 2.0], [2.0, 2.0], [3.0, 2.0]], **{"from": [1.0, 2.0]})
    server.tell("move", "b", path=[[3.0, 3.0]], theta=1.0, **{"from": [3.0, 2.0]})
    assert server.wait_ack("a")["st"] == "DONE"
    assert server.wait_ack("b")["st"] == "DONE"
    assert server.acks("a") == server.acks("b") == ["ACCEPTED", "RUNNING", "DONE"]
    server.wait_state(done=True, loc=[3.0, 3.0, 0.0, 1.0])
    server.tell("move", "a", path=[[9.0, 9.0]])
    server.ear.wait(lambda h: server.acks("a").count("DONE") == 2)
    assert server.states()[-1]["loc"] == [3.0, 3.0, 0.0, 1.0]
    server.tell("move", "back", path=[[1.0, 2.0]], theta=0.0)
    assert server.wait_ack("back")["st"] == "DONE"


def test_a_goal_that_cannot_be_reached_fails_with_the_planners_reason(server: ServerSide) -> None:
    go(server, ("far", [[3.0, 2.0], [95.0, 2.0]]), ("farther", [[96.0, 2.0]]))
    failed = server.wait_ack("far")
    assert failed["st"] == "FAILED"
    reasons = {"tb1": "move_base: Failed to find a valid plan.", "tb2": "/navigate_to_pose: no valid path"}
    assert failed["why"] == reasons[server.device]
    assert server.wait_ack("farther")["st"] == "CANCELED"


def test_pause_resume_stop_and_cancel(server: ServerSide) -> None:
    server.ear.forget()
    server.tell("move", "long", path=[[80.0, 2.0]])
    server.wait_ack("long", "RUNNING")
    stands = [
        (lambda: server.tell("pause", "p", command="long"), lambda: server.tell("resume", "r", command="long")),
        (lambda: stop(server, True), lambda: stop(server, False)),
    ]
    for hold, release in stands:
        drives(server)
        hold()
        stands_still(server)
        release()
    drives(server)
    stop(server, True)
    server.tell("move", "new", path=[[1.0, 2.0]])
    assert server.wait_ack("new")["why"] == "The site is stopped."
    stop(server, False)
    server.tell("cancel", "c", command="long")
    assert server.wait_ack("long")["st"] == "CANCELED"
    assert server.wait_ack("c")["st"] == "DONE"
    stands_still(server)
    server.tell("move", "home", path=[[1.0, 2.0]], theta=0.0)
    assert server.wait_ack("home")["st"] == "DONE"


def stop(server: ServerSide, active: bool) -> None:
    server.ear.say(STOP, {"active": active, "by": "Ada", "at": None}, retain=True)


def drives(server: ServerSide) -> None:
    server.ear.forget()
    server.ear.wait(lambda h: len({s["loc"][0] for s in server.states()}) > 2)


def stands_still(server: ServerSide) -> None:
    """Wait until half a second passes in which no state tells of another place."""

    def is_still() -> bool:
        server.ear.forget()
        time.sleep(0.5)
        return not server.states()

    wait_for("a robot that stands still", is_still)


def test_goods_are_counted_and_the_load_is_shown(server: ServerSide) -> None:
    server.tell("pick", "take", object="box", value=2)
    assert server.wait_ack("take")["st"] == "DONE"
    server.wait_state(load="box:2", done=True)
    server.tell("pick", "more", object="box")
    assert server.wait_ack("more")["why"] == 'TurtleBot "3" carries 2 and has room for 2.'
    server.tell("drop", "put", object="box", value=2)
    assert server.wait_ack("put")["st"] == "DONE"


def test_hostile_commands_are_ignored_or_rejected(server: ServerSide) -> None:
    for said in (b"", b"\xff", b"{", b"[" * 10_000, b'{"id":1}', b'{"id":"x","v":[]}', b'{"id":"n","v":{"path":NaN}}'):
        server.ear.say(f"vipo/v1/dev/{server.device}/down/move", said)
    server.tell("fly", "f")
    assert server.wait_ack("f")["why"] == 'TurtleBot "3" cannot fly.'
    server.tell("move", "odd", path=[[1.0, "2"]])
    assert server.wait_ack("odd")["st"] == "REJECTED"


def test_nav2_is_told_to_drive_slower_and_move_base_refuses(
    ros1: ServerSide, ros2: ServerSide, bridge: BridgeStandIn
) -> None:
    ros1.tell("move", "slow", path=[[1.0, 2.0]], speed=0.2)
    assert ros1.wait_ack("slow")["why"] == 'TurtleBot "3" cannot be told to drive slower than 0.5 m/s.'
    bridge.robot.top_m_s = 0.0
    ros2.tell("move", "slow", path=[[1.2, 2.0]], speed=0.2)
    assert ros2.wait_ack("slow")["st"] == "DONE"
    assert bridge.robot.top_m_s == 0.2


def test_nav2_that_has_started_anew_is_told_again_to_drive_slower(ros2: ServerSide, bridge: BridgeStandIn) -> None:
    ros2.tell("move", "there", path=[[1.1, 2.0]], speed=0.2)
    assert ros2.wait_ack("there")["st"] == "DONE"
    bridge.robot.limit_m_s, bridge.robot.top_m_s = SPEED_M_S, 0.0
    ros2.tell("move", "back again", path=[[1.0, 2.0]], speed=0.2)
    assert ros2.wait_ack("back again")["st"] == "DONE"
    assert bridge.robot.top_m_s == 0.2


def test_an_agent_that_has_started_anew_lifts_the_limit_of_the_one_before(
    broker: Mosquitto, ear: Ear, tmp_path: Path
) -> None:
    bridge = BridgeStandIn(free_port())
    try:
        bridge.robot.limit_m_s = 0.2
        config = write_config(tmp_path, broker, "tb3", ros=2, bridge_port=bridge.port, speed_topic="/speed_limit")
        environment = {**os.environ, "PYTHONPATH": str(AGENT)}
        command = [sys.executable, "-m", "vipo_agent", config]
        with joined(ear, "tb3", command, environment, tmp_path / "agent.log") as server:
            assert "advertise" in [body["op"] for body in bridge.heard]
            server.tell("move", "there", path=[[1.1, 2.0]])
            assert server.wait_ack("there")["st"] == "DONE"
        assert bridge.robot.limit_m_s == SPEED_M_S
    finally:
        bridge.close()

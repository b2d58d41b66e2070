"""VDA 5050 vehicles as robots: vda-5050-lib's virtual vehicle, the connector and both brokers are real."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import ExitStack

import pytest

from tests.integration.connectors.modern_vehicle import VERSION, ModernVehicle
from tests.integration.connectors.vehicles import (
    Connector,
    VirtualVehicle,
    install_library,
    run_plain_broker,
)
from tests.kit.mqtt import Ear, ServerSide
from tests.kit.servers import run_mosquitto
from vipo_device.descriptions.reader import read_description

SERIALS = ("1", "2", "3", "4", "5", "6", "7", "modern")
ACCOUNTS = {"server": "secret of the server", "join:hall": "the key of the door"} | {
    f"Acme-{serial}": f"the word of Acme-{serial}" for serial in SERIALS
}
STOP = "vipo/v1/site/hall/stop"
CRAWL = 0.05
"""Of a vehicle's time in ours: what is to come while it drives three metres has two minutes for it."""
Join = Callable[..., tuple[VirtualVehicle, ServerSide]]


@pytest.fixture(scope="module")
def connector(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Connector]:
    install_library()
    folder = tmp_path_factory.mktemp("connector")
    with run_mosquitto(folder, ACCOUNTS) as vipo, run_plain_broker(folder) as port:
        connector = Connector(folder, vipo, port)
        connector.start()
        yield connector
        assert connector.stop() == 0
        assert "Traceback" not in connector.log.read_text()


@pytest.fixture
def join(connector: Connector) -> Iterator[Join]:
    """Give a function that switches a vehicle on and waits until it is a device."""
    with ExitStack() as stack:
        ear = stack.enter_context(Ear(connector.vipo.port, ACCOUNTS["server"]))

        def come(serial: str, **more: object) -> tuple[VirtualVehicle, ServerSide]:
            vehicle = VirtualVehicle(connector.vehicles_port, serial, **more)
            stack.callback(vehicle.kill)
            server = ServerSide(ear, f"Acme-{serial}")
            server.wait_presence("online")
            server.wait_state(done=True)
            return vehicle, server

        yield come
        ear.say(STOP, b"", retain=True)


def test_a_vehicle_appears_with_what_its_factsheet_says(join: Join) -> None:
    _, server = join("1", tells=False)
    described = server.ear.wait(lambda h: h.topic == server.up("desc"))
    found = read_description(described.payload, device_id="Acme-1")
    assert (found.name, found.kind, found.device_class, found.site) == ("Acme 1", "robot", "carrier", "hall")
    assert (found.size.x, found.size.y, found.size.z) == (0.8, 0.6, 1.2)
    assert (found.radius_m, found.speed_m_s, found.capacity) == (0.5, 2.0, 1)
    assert (found.pose.x, found.pose.y) == (1.0, 2.0)
    assert [m.name for m in found.methods] == ["move", "pick", "drop", "noop"]
    assert found.method("pick").parameter("object").options == ("EPAL",)  # type: ignore[union-attr]
    state = server.wait_state(done=True, battery=88)
    assert state["loc"] == [1.0, 2.0, 0.0, 0.0]
    assert (state["props"]["mode"], state["props"]["error"], state["cmd"]) == ("AUTOMATIC", "", "")


def test_a_new_device_makes_a_key_of_its_own_and_enrols_with_it(connector: Connector) -> None:
    with Ear(connector.vipo.port, ACCOUNTS["server"], "vipo/v1/join/#") as ear:
        vehicle = VirtualVehicle(connector.vehicles_port, "new")
        try:
            enrolled = ear.wait(lambda h: h.topic == "vipo/v1/join/hall/hall.Acme-new", 60)
        finally:
            vehicle.kill()
    kept = connector.folder / "secrets" / "vda5050-hall.json"
    assert json.loads(kept.read_text()) == {"hall.Acme-new": enrolled.json["key"]}
    assert len(enrolled.json["key"]) == 32
    assert kept.stat().st_mode & 0o777 == 0o600


def test_what_cannot_be_read_is_ignored_and_harms_nobody(connector: Connector, join: Join) -> None:
    _, server = join("1")
    hostile = [b"", b"\xff\xfe", b"{", b"[" * 100_000, b'{"a":1,"a":2}', b'{"headerId":NaN}', b"null", b"{}" * 200_000]
    with Ear(connector.vehicles_port, "") as other:
        for said in hostile:
            for subtopic in ("connection", "state", "factsheet", "visualization"):
                other.say(f"uagv/v2/Acme/1/{subtopic}", said)
                other.say(f"uagv/v2/Nobody/{len(said)}/{subtopic}", said)
        server.tell("move", "go", path=[[2.0, 2.0]])
        assert server.wait_ack("go")["st"] == "DONE"
    described = {h.topic.split("/")[3] for h in server.ear.all("/desc")}
    assert "Acme-1" in described
    assert [name for name in described if not name.startswith("Acme-")] == []


def test_pieces_of_way_are_driven_in_one_order_and_each_has_its_end(join: Join) -> None:
    vehicle, server = join("2", timeLapse=CRAWL)
    server.tell("move", "a", path=[[2.5, 2.0], [4.0, 2.0]], ahead=[[4.0, 3.0], [9.0, 3.0]], **{"from": [1.0, 2.0]})
    server.wait_ack("a", "ACCEPTED")
    server.tell("move", "b", path=[[4.0, 3.5]], theta=1.57, speed=0.4, **{"from": [4.0, 2.0]})
    assert server.wait_ack("b", "ACCEPTED", "RUNNING")["st"] == "ACCEPTED"
    assert server.acks("a") == ["ACCEPTED", "RUNNING"], "the second piece was to come while the first is driven"
    vehicle.tell("hurry", timeLapse=4)
    assert server.wait_ack("a")["st"] == "DONE"
    assert server.wait_ack("b")["st"] == "DONE"
    assert server.acks("b") == ["ACCEPTED", "RUNNING", "DONE"]
    assert server.wait_state(loc=[4.0, 3.5, 0.0, 1.57], done=True)["props"]["driving"] is False
    assert len({tuple(s["loc"][:2]) for s in server.states()}) > 5, "the pose is told while driving"
    server.tell("move", "far", path=[[9.0, 9.0]], **{"from": [8.0, 6.5]})
    assert server.wait_ack("far") == {
        "id": "far",
        "st": "REJECTED",
        "why": "The way begins 5.0 m from where Acme 2 will be.",
        "result": {},
    }
    server.tell("move", "a", path=[[3.0, 2.0]])
    server.ear.wait(lambda h: h.topic == server.up("ack") and server.acks("a").count("DONE") == 2)
    assert server.states()[-1]["done"]


def test_loads_are_picked_and_dropped_and_a_refusal_has_its_reason(join: Join) -> None:
    _, server = join("3", timeLapse=10)
    server.tell("move", "near", path=[[1.5, 2.0]], ahead=[[9.0, 2.0]])
    assert server.wait_ack("near")["st"] == "DONE"
    server.tell("pick", "take", object="EPAL", value=1, device="shelf01")
    assert server.wait_ack("take")["st"] == "DONE"
    assert server.wait_state(load="EPAL:1")
    server.tell("pick", "more", object="EPAL", value=1)
    failed = server.wait_ack("more")
    assert (failed["st"], failed["why"]) == ("FAILED", "orderActionError: load already picked")
    server.tell("pick", "tin", object="tin")
    assert server.wait_ack("tin")["why"] == "Acme 3 carries EPAL, not tin."
    server.tell("drop", "put", object="EPAL", value=1)
    assert server.wait_ack("put")["st"] == "DONE"
    server.wait_state(load="")
    server.tell("noop", "rest", duration=1)
    assert server.wait_ack("rest")["st"] == "DONE"
    server.tell("noop", "long", duration="an hour")
    assert server.wait_ack("long")["why"] == "noop: duration must be of the type FLOAT."


def test_pause_resume_stop_and_cancel(join: Join) -> None:
    _, server = join("4")
    server.tell("move", "go", path=[[300.0, 2.0]])
    server.wait_state(driving=True)
    server.tell("pause", "p", command="go")
    assert server.wait_ack("p")["st"] == "DONE"
    server.tell("resume", "r", command="go")
    assert server.wait_ack("r")["st"] == "DONE"
    server.ear.forget()
    server.wait_state(driving=True)
    server.ear.say(STOP, {"active": True, "by": "Ada", "at": None}, retain=True)
    server.wait_state(driving=False, done=False)
    server.tell("move", "new", path=[[1.0, 2.0]])
    assert server.wait_ack("new")["why"] == "The site is stopped."
    server.ear.forget()
    server.ear.say(STOP, {"active": False, "by": "", "at": None}, retain=True)
    server.wait_state(driving=True)
    server.tell("cancel", "c", command="go")
    assert server.wait_ack("go")["st"] == "CANCELED"
    assert server.wait_ack("c")["st"] == "DONE"
    stopped = server.wait_state(done=True)
    assert 1.0 < stopped["loc"][0] < 300.0
    server.tell("move", "back", path=[[stopped["loc"][0] - 1, 2.0]])
    assert server.wait_ack("back")["st"] == "DONE"


def test_a_vehicle_that_is_killed_has_failed_when_it_comes_back(connector: Connector, join: Join) -> None:
    vehicle, server = join("5")
    server.tell("move", "go", path=[[300.0, 2.0]])
    server.wait_ack("go", "RUNNING")
    vehicle.kill()
    server.wait_presence("offline")
    server.tell("move", "new", path=[[1.0, 2.0]])
    assert server.wait_ack("new")["why"] == "Acme 5 is not connected."
    assert server.acks("go") == ["ACCEPTED", "RUNNING"]
    server.ear.forget()
    again = VirtualVehicle(connector.vehicles_port, "5", x=4.0)
    try:
        failed = server.wait_ack("go")
        assert failed["st"] == "FAILED"
        assert failed["why"].startswith("The vehicle no longer has the order")
        server.wait_presence("online")
        server.tell("move", "on", path=[[5.0, 2.0]])
        assert server.wait_ack("on")["st"] == "DONE"
    finally:
        again.kill()


def test_a_vehicle_that_needs_a_person_is_not_sent_on(join: Join) -> None:
    vehicle, server = join("6")
    fault = {"errorType": "bumper", "errorLevel": "FATAL", "errorDescription": "hit a box", "errorReferences": []}
    server.tell("move", "go", path=[[300.0, 2.0]])
    server.wait_state(driving=True)
    vehicle.tell("complain", error=fault)
    assert server.wait_ack("go")["why"] == "bumper: hit a box"
    server.wait_state(error="bumper: hit a box", driving=False)
    server.tell("move", "new", path=[[1.0, 2.0]])
    assert server.wait_ack("new")["why"] == "Acme 6 needs a person: bumper: hit a box"
    vehicle.tell("recover", error=fault)
    server.wait_state(error="", done=True)
    vehicle.tell("mode", mode="MANUAL")
    server.wait_state(mode="MANUAL")
    server.tell("move", "hand", path=[[1.0, 2.0]])
    assert server.wait_ack("hand")["why"] == "Acme 6 is in the mode MANUAL; switch it to AUTOMATIC."


def test_a_connector_that_is_killed_goes_on_where_it_was(connector: Connector, join: Join) -> None:
    vehicle, server = join("7", timeLapse=CRAWL)
    server.tell("move", "a", path=[[5.0, 2.0]])
    server.wait_state(driving=True)
    server.tell("pause", "p", command="a")
    assert server.wait_ack("p")["st"] == "DONE"
    connector.kill()
    server.wait_presence("offline")
    before = server.states()[-1]
    server.ear.forget()
    connector.start()
    server.wait_presence("online")
    after = server.wait_state(done=False, cmd="a")
    assert after["boot"] > before["boot"]
    server.tell("move", "b", path=[[5.0, 4.0]], theta=0.5, **{"from": [5.0, 2.0]})
    server.tell("move", "a", path=[[5.0, 2.0]])
    assert server.wait_ack("a", "RUNNING")["st"] == "RUNNING", "what is known is answered again"
    server.tell("resume", "r", command="a")
    vehicle.tell("hurry", timeLapse=4)
    assert server.wait_ack("a")["st"] == "DONE"
    assert server.wait_ack("b")["st"] == "DONE"
    server.wait_state(loc=[5.0, 4.0, 0.0, 0.5], done=True)


@pytest.fixture
def modern(connector: Connector) -> Iterator[tuple[ModernVehicle, ServerSide]]:
    """Give a vehicle that speaks 2.1, once it is a device."""
    with Ear(connector.vipo.port, ACCOUNTS["server"]) as ear:
        vehicle, server = ModernVehicle(connector.vehicles_port, "modern"), ServerSide(ear, "Acme-modern")
        vehicle.start()
        try:
            server.wait_presence("online")
            server.wait_state(done=True)
            yield vehicle, server
        finally:
            vehicle.stop()


def test_a_vehicle_of_2_1_drives_carries_pauses_is_cancelled_and_refuses_with_a_hint(
    modern: tuple[ModernVehicle, ServerSide],
) -> None:
    vehicle, server = modern
    found = read_description(server.ear.wait(lambda h: h.topic == server.up("desc")).payload, device_id="Acme-modern")
    assert (found.device_class, found.capacity, [m.name for m in found.methods]) == (
        "carrier",
        1,
        ["move", "pick", "drop", "noop"],
    )
    server.tell("move", "a", path=[[3.0, 2.0], [5.0, 2.0]], ahead=[[5.0, 9.0]], **{"from": [1.0, 2.0]})
    server.wait_ack("a", "ACCEPTED")
    server.tell("move", "b", path=[[5.0, 4.0]], theta=1.57, speed=1.0, **{"from": [5.0, 2.0]})
    assert [server.wait_ack("a")["st"], server.wait_ack("b")["st"]] == ["DONE", "DONE"]
    server.wait_state(loc=[5.0, 4.0, 0.0, 1.57], done=True)
    server.tell("pick", "take", object="EPAL", value=1)
    assert server.wait_ack("take")["st"] == "DONE"
    server.wait_state(load="EPAL:1")
    server.tell("move", "far", path=[[99.0, 4.0]], speed=0.5)
    server.wait_state(driving=True)
    server.tell("pause", "p", command="far")
    assert server.wait_ack("p")["st"] == "DONE"
    server.tell("resume", "r", command="far")
    assert server.wait_ack("r")["st"] == "DONE"
    server.tell("cancel", "c", command="far")
    assert [server.wait_ack("far")["st"], server.wait_ack("c")["st"]] == ["CANCELED", "DONE"]
    server.tell("move", "wall", path=[[101.0, 2.0]])
    assert server.wait_ack("wall")["why"] == "noRouteError: there is a wall (drive round it)"
    kinds = [[action["actionType"] for action in message["actions"]] for message in vehicle.instant]
    assert [kind for (kind,) in kinds if kind != "factsheetRequest"] == ["startPause", "stopPause", "cancelOrder"]
    assert {said["version"] for said in (*vehicle.orders, *vehicle.instant)} == {VERSION}
    assert not any("instantActions" in message for message in vehicle.instant)
    assert {node["nodePosition"]["mapId"] for order in vehicle.orders for node in order["nodes"]} == {"hall"}

"""Machines of an MTConnect agent as devices: the connector and the broker are real, the agent speaks HTTP."""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path
from queue import Queue
from threading import Event, Thread

import pytest

from connectors.mtconnect import agent as asking
from connectors.mtconnect.agent import Agent, AgentAway, read_address
from connectors.mtconnect.connector import Connector, FollowerEnded, Setting
from connectors.mtconnect.description import Stand
from connectors.mtconnect.documents import BadDocument, Document
from connectors.mtconnect.follower import AgentEvent, Follower, MachinesListed, Observed
from registry import services as registry
from registry.models import Device
from tests.integration.connectors.agents import Handler, MachineConnector, Misbehaviour, ScriptedAgent
from tests.kit.mqtt import Ear, ServerSide
from tests.kit.servers import run_mosquitto
from vipo_device.descriptions.reader import read_description
from vipo_device.protocol.description import Pose, Size

LATHE = "M8010-1"
BOMB = b'<!DOCTYPE a [<!ENTITY b "bbbb"><!ENTITY c "&b;&b;&b;&b;">]><a>&c;</a>'
ACCOUNTS = {"server": "secret of the server", LATHE: f"the word of {LATHE}"}


@pytest.fixture
def agent() -> Iterator[ScriptedAgent]:
    agent = ScriptedAgent()
    agent.start()
    yield agent
    agent.stop()


def test_a_machine_lives_as_its_agent_says(tmp_path: Path) -> None:
    agent = ScriptedAgent("2.0", keeps=50)
    agent.start()
    agent.say("avail", "AVAILABLE")
    agent.say("exec", "READY")
    with run_mosquitto(tmp_path, ACCOUNTS) as vipo, Ear(vipo.port, ACCOUNTS["server"]) as ear:
        connector = MachineConnector(tmp_path, vipo, f"http://127.0.0.1:{agent.port}/", ("--place", "3,4,0"))
        connector.start()
        try:
            server = ServerSide(ear, LATHE)
            _appears(server)
            _tells(server, agent)
            _begins_anew(server, agent)
            _misses_something(server, agent)
            _comes_and_goes(server, agent)
            connector.kill()
            server.wait_presence("offline")
            ear.forget()
            connector.start()
            server.wait_presence("online")
            ear.forget()
            assert connector.stop() == 0
            server.wait_presence("offline")
        finally:
            connector.kill()
    log = connector.log.read_text()
    assert "Traceback" not in log
    assert "it has begun anew" in log
    assert "The agent does not keep what it said since number" in log


def _appears(server: ServerSide) -> None:
    described = server.ear.wait(lambda h: h.topic == server.up("desc"), 60)
    found = read_description(described.payload, device_id=LATHE)
    assert (found.name, found.pose.x, found.pose.y, found.methods) == ("Lathe", 3.0, 4.0, ())
    server.wait_presence("online")
    server.wait_state(execution="READY", done=True)
    server.tell("pause", "hold", command="x")
    refused = "This machine is only read over MTConnect; it cannot be told anything."
    assert server.wait_ack("hold") == {"id": "hold", "st": "REJECTED", "why": refused, "result": {}}


def _tells(server: ServerSide, agent: ScriptedAgent) -> None:
    agent.say("exec", "ACTIVE")
    agent.say("xpos", "250.5")
    agent.say("system", "Door open", level="Fault", code="17")
    said = server.wait_state(execution="ACTIVE", Xact=0.2505, error="Door open")
    assert not said["done"]
    agent.say("system", "", level="Normal", code="17")
    agent.say("exec", "READY")
    server.wait_state(execution="READY", error="", Xact=0.2505)


def _begins_anew(server: ServerSide, agent: ScriptedAgent) -> None:
    """What is known of the old life is forgotten."""
    server.ear.forget()
    agent.restart()
    agent.say("exec", "INTERRUPTED")
    assert server.wait_state(execution="INTERRUPTED", done=False)["props"]["Xact"] is None


def _misses_something(server: ServerSide, agent: ScriptedAgent) -> None:
    """Between two questions the buffer runs over; so the connector asks how all is."""
    agent.say_at_once(("xpos", "7"), *(("prog", f"O{n}") for n in range(60)))
    server.wait_state(program="O59", Xact=0.007)


def _comes_and_goes(server: ServerSide, agent: ScriptedAgent) -> None:
    server.ear.forget()
    agent.say("avail", "UNAVAILABLE")
    server.wait_presence("offline")
    agent.say("avail", "AVAILABLE")
    server.wait_presence("online")
    server.ear.forget()
    agent.stop()
    server.wait_presence("offline")
    server.ear.forget()
    agent.start()
    agent.say("xpos", "8")
    server.wait_presence("online")
    server.wait_state(Xact=0.008)
    server.ear.forget()
    agent.misbehave = lambda handler: handler.send(BOMB)
    server.wait_presence("offline")
    agent.misbehave = None
    server.wait_presence("online")
    server.wait_state(Xact=0.008)


@pytest.mark.django_db
def test_a_machine_of_a_second_site_comes_with_an_id_that_the_site_takes(tmp_path: Path, agent: ScriptedAgent) -> None:
    registry.create_site(name="Yard", slug="yard")
    registry.create_site(name="Hall", slug="hall")
    accounts = {"server": ACCOUNTS["server"], "join:hall": "the key of the door"}
    with run_mosquitto(tmp_path, accounts) as vipo, Ear(vipo.port, accounts["server"], "vipo/v1/join/#") as ear:
        connector = MachineConnector(tmp_path, vipo, f"http://127.0.0.1:{agent.port}/")
        connector.start({"join": accounts["join:hall"]})
        try:
            asked = ear.wait(lambda h: h.topic.startswith("vipo/v1/join/hall/"), 60)
        finally:
            connector.kill()
    device = asked.topic.rpartition("/")[2]
    registry.enrol_device(site="hall", device_id=device, payload=asked.payload, at=datetime.now(UTC))
    assert list(Device.objects.values_list("pk", "site__slug", "lifecycle")) == [(f"hall.{LATHE}", "hall", "pending")]
    assert json.loads((tmp_path / "secrets" / "mtconnect-hall.json").read_text()) == {device: asked.json["key"]}
    told = connector.log.read_text()
    assert "waits for an admin, or was refused: the site's What was done says why." in told


def test_what_is_missed_at_the_beginning_is_asked_again(agent: ScriptedAgent) -> None:
    """A probe without the picture that belongs to it is of no use: the next one counts."""
    agent.say("exec", "READY")
    agent.misbehave = lambda handler: handler.send(b"<a/>") if "current" in handler.path else handler.reply()
    heard: Queue[AgentEvent] = Queue()
    stopping = Event()
    thread = Thread(
        target=Follower(Agent(read_address(f"http://127.0.0.1:{agent.port}")), 0.05, heard.put).run, args=[stopping]
    )
    thread.start()
    try:
        assert isinstance(heard.get(timeout=60), MachinesListed)
        agent.misbehave = None
        while not isinstance(said := heard.get(timeout=60), Observed):
            pass
        assert ([o.text for o in said.observations], said.is_whole) == (["READY"], True)
        assert heard.get(timeout=60) == Observed((), is_whole=False)
    finally:
        stopping.set()
        thread.join(30)


class BrokenAgent(Agent):
    def ask(self, call: str, **query: int) -> Document:
        raise AssertionError("a fault of the connector")


def test_a_connector_that_does_not_follow_any_more_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(threading, "excepthook", lambda _: None)
    stand = Stand(Pose(0, 0), Size(1, 1, 1))
    setting = Setting("hall", stand, 0.1, lambda *_: pytest.fail("no machine is known"), str, 1)
    with pytest.raises(FollowerEnded):
        Connector(BrokenAgent(read_address("http://127.0.0.1:1")), setting).run(Event())


def drips(handler: Handler) -> None:
    handler.drip()


@pytest.mark.parametrize(
    ("misbehave", "told"),
    [
        (lambda h: h.send(b"", 302, Location="http://127.0.0.1:1/probe"), "redirects are not followed"),
        (lambda h: h.send(b"{}", Content_Type="application/json"), "answers with application/json"),
        (lambda h: h.send(b"\x1f\x8b", Content_Encoding="gzip"), "packs its answer"),
        (lambda h: h.send(b"<a/>", Content_Length="9"), "breaks off 5 bytes before its end"),
        (lambda h: h.send(b"<a/>", Content_Type="multipart/x-mixed-replace;boundary=x"), "not with XML"),
        (lambda h: h.send(b"<a " + b"b" * 9_000_000), "bytes"),
        (lambda h: h.wfile.write(b"nonsense\r\n" * 500), "BadStatusLine"),
        (lambda h: h.wfile.write(b"HTTP/1.1 200 OK\r\n" + b"A: b\r\n" * 200), "HTTPException"),
        (drips, ""),
    ],
)
def test_an_agent_that_misbehaves_costs_little(agent: ScriptedAgent, misbehave: Misbehaviour, told: str) -> None:
    agent.misbehave = misbehave
    limit_s = 1.0 if misbehave is drips else asking.LIMIT_S
    with pytest.raises((AgentAway, BadDocument)) as refused:
        Agent(read_address(f"http://127.0.0.1:{agent.port}"), limit_s=limit_s).ask("probe")
    assert told in str(refused.value)


def test_a_password_and_headers_go_along(agent: ScriptedAgent) -> None:
    heard: list[str | None] = []
    agent.misbehave = lambda h: heard.extend((h.headers["Authorization"], h.headers["Cookie"], h.path))
    address = read_address(f"http://ann:pw@127.0.0.1:{agent.port}/cell 1/", headers="Cookie: sessionid=x")
    with pytest.raises(AgentAway):
        Agent(address).ask("sample", **{"from": 3, "count": 5})
    assert heard == ["Basic YW5uOnB3", "sessionid=x", "/cell%201/sample?from=3&count=5"]
    assert asking.LIMIT_S == 20.0

"""What keeps the robot's agent from starting is said, and so is a broker that does not let it in."""

from __future__ import annotations

import json
import threading
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from paho.mqtt.packettypes import PacketTypes
from paho.mqtt.reasoncodes import ReasonCode

from tests.unit.robot_agent.agent import Agent, BadConfig, CannotStart, Config, Go, Link, Navigation, make_config

FACTS: dict[str, Any] = {
    "id": "tb1",
    "site": "hall",
    "radius_m": 0.2,
    "speed_m_s": 0.5,
    "ros": 2,
    "password": "a word",
    "port": 1,
}


class Parked(Navigation):
    """A robot that is never told anything."""

    def start(self, agent: Agent) -> None:
        raise AssertionError("an agent that cannot keep anything must not begin")

    def go(self, goal: Go) -> None:
        raise AssertionError

    def halt(self) -> None:
        raise AssertionError

    def stop(self) -> None:
        raise AssertionError


def config(**more: Any) -> Config:
    return make_config({**FACTS, **more})


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        ({"port": "8883"}, "port must be a whole number from 1 to 65535, without quotes."),
        ({"bridge_port": True}, "bridge_port must be a whole number from 1 to 65535, without quotes."),
        ({"ca": "/nowhere/ca.crt"}, "ca: there is no file /nowhere/ca.crt."),
        ({"map_topic": None}, "map_topic must be text."),
        ({"handling_s": "2"}, "handling_s must be a number of seconds from 0."),
        ({"speed_m_s": 10**400}, "speed_m_s must be a number above 0."),
    ],
)
def test_a_wrong_configuration_says_what_to_mend(wrong: dict[str, Any], sentence: str) -> None:
    with pytest.raises(BadConfig) as caught:
        config(**wrong)
    assert str(caught.value) == sentence


def test_the_folder_of_the_state_is_made_and_one_that_cannot_be_is_named(tmp_path: Path) -> None:
    state = tmp_path / "new" / "folder" / "tb1.json"
    Agent(config(state=str(state)), Parked())._save()
    assert json.loads(state.read_text())["load"] == {}
    (tmp_path / "file").write_text("")
    agent = Agent(config(state=str(tmp_path / "file" / "tb1.json")), Parked())
    with pytest.raises(CannotStart, match=r"^state: .*/file/tb1\.json cannot be written: "):
        agent.run(threading.Event())


def test_the_first_birth_of_the_server_has_the_robot_introduce_itself() -> None:
    link, came = Link(config(), 7), []
    link.came_in = lambda: came.append(True)
    status = SimpleNamespace(topic="vipo/v1/srv/status", payload=b'{"s":"online"}', retain=True)
    link._heard(None, None, status)
    assert came == []
    link._heard(None, None, SimpleNamespace(**{**vars(status), "retain": False}))
    assert came == [True]


def test_the_log_says_once_why_the_robot_is_not_let_in(caplog: pytest.LogCaptureFixture) -> None:
    link = Link(config(), 7)
    begin_s = link._away_s
    link.watch(begin_s + 5)
    assert caplog.messages == []
    link.watch(begin_s + 11)
    link.watch(begin_s + 12)
    link._connected(None, None, None, ReasonCode(PacketTypes.CONNACK, "Not authorized"), None)
    link.watch(begin_s + 13)
    assert caplog.messages == [
        "The broker at 127.0.0.1:1 is not reached; the robot goes on trying.",
        "The broker at 127.0.0.1:1 does not let tb1 in (Not authorized); the robot goes on trying.",
    ]

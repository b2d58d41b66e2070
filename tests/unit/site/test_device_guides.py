"""The examples in the guides for devices and in the protocol are what the product reads and writes."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path

from connectors.management.commands.vda5050 import Command
from registry.alerts.causes import CAUSES
from tests.kit.files import ROOT
from tests.unit.robot_agent.agent import make_config
from vipo_device.protocol import messages

DOCS = ROOT / "docs"
MESSAGE = re.compile(r"^(vipo/v1/\S+) {2,}(\{.*\})$", re.MULTILINE)
PARSERS = {"presence": messages.parse_presence, "state": messages.parse_state, "ack": messages.parse_ack}


def blocks(page: str, form: str) -> list[str]:
    return re.findall(rf"```{form}\n(.*?)```", (DOCS / page).read_text(), re.DOTALL)


def test_the_protocols_messages_are_read_as_they_stand() -> None:
    kinds = []
    for topic, payload in MESSAGE.findall("\n".join(blocks("protocol.md", "json"))):
        body = messages.parse_json(payload.replace("…", "0").encode())
        device = messages.read_up_topic(topic)
        if device is not None and device[1] in PARSERS:
            PARSERS[device[1]](payload.encode())
        elif "/down/" in topic:
            assert json.loads(messages.command_payload(body["id"], body["v"], body["ttl_s"])) == body
        kinds.append(device[1] if device else topic.split("/")[-2])
    assert set(kinds) >= {"presence", "ack", "down", "map", "srv"}


def test_the_protocols_states_and_answers_without_a_topic_are_read() -> None:
    lines = [line for block in blocks("protocol.md", "json") for line in block.splitlines() if line.startswith('{"')]
    states = [messages.parse_state(line.encode()) for line in lines if '"seq"' in line]
    answers = [messages.parse_ack(line.encode()) for line in lines if '"st"' in line]
    assert [state.seq for state in states] == [31]
    assert [answer.status for answer in answers] == ["REJECTED", "DONE"]


def test_the_robots_configuration_is_one_and_every_key_in_its_table_is_known(tmp_path: Path) -> None:
    (example,) = blocks("devices/ros.md", "json")
    authority = tmp_path / "ca.crt"  # on the robot it is where the example says
    authority.touch()
    config = make_config({**json.loads(example), "ca": str(authority)})
    assert config.id == "turtlebot01"
    table = (DOCS / "devices" / "ros.md").read_text().partition("## Configuration")[2].partition("## ")[0]
    named = {key for row in re.findall(r"^\| (`.*?) \|", table, re.MULTILINE) for key in re.findall(r"`(\w+)`", row)}
    assert named <= set(vars(config))


def test_the_connectors_command_line_is_one() -> None:
    (line,) = blocks("devices/vda5050.md", "sh")
    words = shlex.split(line)
    told = Command().create_parser(words[2], words[3]).parse_args(words[4:])
    assert words[1:4] == [".venv/bin/python", "manage.py", "vda5050"]
    assert (told.site, told.broker) == ("painting-factory", "mqtt://vipo@10.0.0.5:1883")
    table = re.findall(r"^\| `(--[a-z-]+)", (DOCS / "devices" / "vda5050.md").read_text(), re.MULTILINE)
    assert table == ["--broker", "--prefix", "--interface", "--origin", "--station-type"]
    assert set(table) <= set(Command().create_parser("", "")._option_string_actions)


def test_the_flashing_guide_names_files_that_there_are() -> None:
    (commands,) = blocks("devices/esp32.md", "")
    sources = re.findall(r"firmware/\S+", commands)
    assert sources == ["firmware/package.json", "firmware/main.py"]
    assert all((ROOT / name).is_file() for name in sources)


def test_the_apis_page_lists_every_alert_with_how_bad_it_is() -> None:
    section = (DOCS / "api.md").read_text().partition("\n## Alerts\n")[2].partition("\n## ")[0]
    rows = [row.split("|")[1:3] for row in section.splitlines() if row.startswith("| `")]
    told = {code: how for codes, how in rows for code in re.findall(r"`(\w+)`", codes)}
    assert set(told) == set(CAUSES)
    assert all(cause.severity in told[code] for code, cause in CAUSES.items())

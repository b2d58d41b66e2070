"""Every driver on the real MicroPython: its description is what it declares, and its methods do what they say."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import pytest

from registry.demo.devices import describe_devices
from tests.firmware.rig import FIRMWARE, HEAP, LIMIT_S
from vipo_device.descriptions.reader import read
from vipo_device.descriptions.shacl import check_rdf
from vipo_device.protocol.description import Description

DEMO = {"mixer": "paintMixer02", "oven": "curingOven01", "painter": "paintMachine01"}


def rehearse(micropython: str, *trials: tuple[str, dict[str, Any], list[Any]]) -> list[dict[str, Any]]:
    done = subprocess.run(
        [micropython, *HEAP, str(Path(__file__).with_name("rehearse_drivers.py"))],
        input="".join(json.dumps(trial) + "\n" for trial in trials),
        env={"MICROPYPATH": f"{FIRMWARE / 'lib'}:.frozen", "PATH": "/usr/bin:/bin"},
        capture_output=True,
        text=True,
        timeout=LIMIT_S,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return [json.loads(line) for line in done.stdout.splitlines()]


def described(told: dict[str, Any]) -> Description:
    return read(told["description"].encode(), device_id="machine01").description


@pytest.fixture(scope="module")
def every(micropython: str) -> dict[str, dict[str, Any]]:
    names = ("mixer", "oven", "painter", "dispenser", "inventory", "drop-off", "relay")
    return dict(zip(names, rehearse(micropython, *((name, {}, []) for name in names)), strict=True))


def test_every_description_is_understood_and_has_the_right_shape(every: dict[str, dict[str, Any]]) -> None:
    for name, told in every.items():
        description = described(told)
        assert [m.name for m in description.methods] == told["order"], name
        assert description.site == "hall"
        assert check_rdf(told["description"].encode()) == (), name


def test_the_demos_machines_could_be_boards(every: dict[str, dict[str, Any]]) -> None:
    known = {device.id: device for device in describe_devices()}
    for name, device in DEMO.items():
        board, wanted = described(every[name]), known[device]
        for field in ("device_class", "description", "gives", "takes"):
            assert getattr(board, field) == getattr(wanted, field), (name, field)
        assert [(m.name, m.title, m.message_type, m.parameters) for m in board.methods] == [
            (m.name, m.title, m.message_type, m.parameters) for m in wanted.methods
        ]
        assert set(board.properties) <= set(wanted.properties)


def test_the_displays_words_are_the_papers(micropython: str) -> None:
    told = rehearse(
        micropython,
        ("mixer", {}, [["mixPaint", {"time": 5}]]),
        ("oven", {}, [["curePaint", {"time": 10}]]),
        ("painter", {}, [["paint", {"time": 2}]]),
        ("relay", {}, [["run", {"time": 1}]]),
    )
    answers = [trial["answers"][0] for trial in told]
    assert [answer["shown"] for answer in answers] == [
        [["Mixing Started", "5 min"], ["Mixing Complete", "5 min"]],
        [["Curing Started", "10 min"], ["Curing Complete", "10 min"]],
        [["Paint Started", "2 min"], ["Paint Complete", "2 min"]],
        [["Switched on", "1 min"], ["Switched off", "1 min"]],
    ]
    assert all(answer["switched"] == [True, False] for answer in answers)
    assert all(answer["properties"]["jobStatus"] == 100 for answer in answers)
    assert answers[0]["result"]["temperature"] > 22
    assert answers[1]["result"]["temperature"] > answers[0]["result"]["temperature"]
    assert (answers[2]["properties"]["pressure"], answers[3]["properties"]["on"]) == (0.0, False)


def test_an_inventory_counts_what_it_hands_out_and_remembers_it(micropython: str, tmp_path: Path) -> None:
    options = {"object": "can", "slots": 3, "count_file": str(tmp_path / "count")}
    first, second = rehearse(
        micropython,
        ("inventory", options, [["dispense", {"object": "can", "value": n}] for n in (2, 2, 4)]),
        ("inventory", options, [["refill", {"value": 3}], ["dispense", {"object": "can", "value": 3}]]),
    )
    assert first["answers"][0]["result"] == {"stock": 1}
    assert first["answers"][1:] == [{"failed": "there are 1 can, not 2"}, {"refused": "value must be from 1 to 3"}]
    assert [answer["result"] for answer in second["answers"]] == [{"stock": 3}, {"stock": 0}]
    assert (tmp_path / "count").read_text() == "0"
    (tmp_path / "count").write_text("-7")
    (third,) = rehearse(micropython, ("inventory", options, [["dispense", {"object": "can", "value": 1}]]))
    assert third["answers"] == [{"failed": "there are 0 can, not 1"}]


def test_a_drop_off_takes_what_fits(micropython: str) -> None:
    calls: list[Any] = [
        ["accept", {"object": "box", "value": 2}],
        ["accept", {"object": "box", "value": 1}],
        ["empty", {}],
    ]
    (told,) = rehearse(micropython, ("drop-off", {"slots": 2}, calls))
    assert [a.get("result") or a for a in told["answers"]] == [
        {"freeSlots": 0},
        {"failed": "there is room for 0 box, not 1"},
        {"freeSlots": 2},
    ]


def test_a_dispenser_pushes_once_for_each_object(micropython: str) -> None:
    (told,) = rehearse(micropython, ("dispenser", {"object": "can"}, [["dispense", {"object": "can", "value": 2.0}]]))
    (answer,) = told["answers"]
    assert answer["switched"] == [True, False, True, False]
    assert answer["shortest_us"] > 500, "the output was switched off for no time: that is one long push"
    assert answer["properties"] == {"dispensed": 2}
    assert answer["shown"] == [["Dispensing", "1 of 2 can"], ["Dispensing", "2 of 2 can"], ["Dispensed", "2 x can"]]


@pytest.mark.parametrize(
    ("method", "arguments", "why"),
    [
        ("dispense", {"object": "box", "value": 1}, "object must be one of: can"),
        ("dispense", {"object": ["can"], "value": 1}, "object must be one of: can"),
        ("dispense", {"object": "can", "value": 1.5}, "value must be a whole number"),
        ("dispense", {"object": "can", "value": True}, "value must be a number"),
        ("dispense", {"object": "can", "value": None}, "value is missing"),
        ("mixPaint", {"time": 1e300}, "time must be from 1 to 30"),
        ("mixPaint", {"time": -5}, "time must be from 1 to 30"),
        ("mixPaint", {"time": {}}, "time must be a number"),
    ],
)
def test_arguments_that_do_not_fit_are_refused(micropython: str, method: str, arguments: Any, why: str) -> None:
    (told,) = rehearse(micropython, ("mixer", {}, [[method, arguments]]))
    assert told["answers"] == [{"refused": why}]

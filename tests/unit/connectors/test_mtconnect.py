"""What is read from MTConnect agents, what of it becomes a device, and what is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from django.core.management.base import CommandError

from connectors.management.commands.mtconnect import make_agent, read_stand
from connectors.mtconnect.agent import BadAddress, read_address
from connectors.mtconnect.condition import MachineCondition
from connectors.mtconnect.description import Stand, describe_machine, device_id
from connectors.mtconnect.documents import MOST_BYTES, BadDocument, Devices, Machine, Refusal, Streams, read_document
from connectors.mtconnect.starts import count_start
from tests.kit.work import within_processor_time
from tests.unit.connectors import mtconnect_words as words
from vipo_device.descriptions.reader import read_description
from vipo_device.protocol.description import Pose, Size
from vipo_device.protocol.messages import MAX_BYTES, parse_state, state_payload

STAND = Stand(Pose(1.0, 2.0), Size(2.0, 1.5, 2.0))
BOMB = b'<?xml version="1.0"?><!DOCTYPE a [<!ENTITY b "bbbb"><!ENTITY c "&b;&b;&b;&b;">]>'


def machine_of(*devices: str, version: str = "1.2") -> Machine:
    found = read_document(words.probe(*devices, version=version))
    assert isinstance(found, Devices)
    return found.machines[0]


@pytest.fixture
def lathe() -> MachineCondition:
    return MachineCondition(describe_machine(machine_of(), "hall", STAND, "M8010-1"))


def hear(condition: MachineCondition, *told: str, version: str = "1.2") -> dict[str, Any]:
    found = read_document(words.streams(*told, head=words.header(following=9), version=version))
    assert isinstance(found, Streams)
    condition.take(found.observations)
    state = condition.look(1, 1)
    assert parse_state(state_payload(state)) == state
    return {**state.properties, "done": state.done}


@pytest.mark.parametrize("version", ["1.2", "1.7", "2.0"])
def test_a_machine_describes_itself_by_its_probe(version: str) -> None:
    described = describe_machine(machine_of(version=version), "hall", STAND, "M8010-1")
    found = read_description(described.turtle, device_id="M8010-1")
    assert (found.name, found.kind, found.site, found.methods) == ("Lathe", "machine", "hall", ())
    assert (found.pose, found.size) == (STAND.pose, STAND.size)
    assert found.description == "Mazak Turning centre. Read over MTConnect"
    assert [(p.name, p.type, p.unit, p.title) for p in found.properties] == [
        ("execution", "text", "", "Execution"),
        ("error", "text", "", "Faults"),
        ("warning", "text", "", "Warnings"),
        ("Xact", "number", "M", "X position actual"),
        ("load", "number", "PERCENT", "X load"),
        ("load_zload", "number", "PERCENT", "Z load"),
        ("tip_x", "number", "M", "Path path position x"),
        ("tip_y", "number", "M", "Path path position y"),
        ("tip_z", "number", "M", "Path path position z"),
        ("program", "text", "", "Path program"),
        ("parts", "number", "", "Path part count"),
    ]


def test_millimetres_become_metres_and_execution_says_whether_it_is_done(lathe: MachineCondition) -> None:
    nothing = hear(lathe)
    assert (nothing["Xact"], nothing["execution"], nothing["error"], nothing["done"]) == (None, "", "", True)
    said = hear(
        lathe,
        words.told("xpos", "-1250.5", 1),
        words.told("place", "1 2e3 -3", 2),
        words.told("exec", "ACTIVE", 3),
        words.told("parts", "12", 4),
        words.told("prog", "O&lt;1&gt;", 5),
        words.told("nobody", "5", 6),
    )
    assert (said["Xact"], said["tip_x"], said["tip_y"], said["tip_z"]) == (-1.2505, 0.001, 2.0, -0.003)
    assert (said["execution"], said["done"], said["parts"], said["program"]) == ("ACTIVE", False, 12.0, "O<1>")
    assert hear(lathe, words.told("exec", "FEED_HOLD", 7))["done"] is False
    assert hear(lathe, words.told("exec", "PROGRAM_COMPLETED", 8), version="2.0")["done"] is True
    for short, metres in ((".5", 0.0005), ("5.", 0.005), ("-.5e3", -0.5)):
        assert hear(lathe, words.told("xpos", short, 9))["Xact"] == metres
    for odd in ("UNAVAILABLE", "NaN", "1e999", "0x10", "1 2", "", "."):
        assert hear(lathe, words.told("xpos", odd, 9))["Xact"] is None


def test_conditions_are_errors_and_warnings_until_they_are_normal(lathe: MachineCondition) -> None:
    def held(*told: str) -> tuple[str, str]:
        said = hear(lathe, *told)
        return said["error"], said["warning"]

    fault = words.told("system", "Door open", 1, level="Fault", code="17")
    other = words.told("system", "", 2, level="Fault", code="18")
    assert held(fault, other) == ("Door open; 18", "")
    assert held(words.told("xcond", "Axis hot", 3, level="Warning")) == ("Door open; 18", "Axis hot")
    assert held(words.told("system", "", 4, level="Normal", code="17")) == ("18", "Axis hot")
    assert held(words.told("system", "", 5, level="Normal")) == ("", "Axis hot")
    assert held(words.told("xcond", "", 6, level="Unavailable")) == ("", "")
    assert held(words.told("estop", "TRIGGERED", 7)) == ("Emergency stop", "")
    assert held(*(words.told("system", "x" * 300, n, level="Fault", code=f"{n}") for n in range(99)))[0] != ""
    lathe.forget()
    assert held() == ("", "")


def test_a_machine_that_its_agent_does_not_reach_is_not_there(lathe: MachineCondition) -> None:
    assert lathe.is_available
    hear(lathe, words.told("avail", "UNAVAILABLE", 1))
    assert not lathe.is_available
    hear(lathe, words.told("avail", "AVAILABLE", 2))
    assert lathe.is_available


def test_the_largest_machine_fits_into_a_description_and_a_state() -> None:
    items = "".join(
        f'<DataItem category="EVENT" id="i{n}" name="{"ä" * 200}{n}" type="{"MESSAGE" * 9}"/>' for n in range(3000)
    )
    described = describe_machine(
        machine_of(f'<Device uuid="{"é" * 300}" name="{"n" * 300}"><DataItems>{items}</DataItems></Device>'),
        "hall",
        STAND,
        device_id("é" * 300),
    )
    assert len(described.turtle) <= MAX_BYTES
    assert 20 < len(described.readings) <= 61
    assert len(described.readings) + described.left_out == 2000
    condition = MachineCondition(described)
    found = read_document(
        words.streams(
            *(words.told(r.item, "\u2603" * 300, n) for n, r in enumerate(described.readings)), head=words.header()
        )
    )
    assert isinstance(found, Streams)
    condition.take(found.observations)
    assert len(state_payload(condition.look(1, 1))) <= MAX_BYTES


def test_ids_are_kept_apart() -> None:
    assert device_id("M8010-1") == "M8010-1"
    assert len({device_id(text) for text in ("a b", "a/b", "a-b", "ä" * 99, "ä" * 98)}) == 5


@pytest.mark.parametrize(
    ("data", "told"),
    [
        (b"", "not XML"),
        (b"<html></html>", "none of MTConnect's"),
        (b"\xff\xfe<\x00a\x00", "not XML"),
        (BOMB + b"<a>&c;</a>", "document type"),
        *((BOMB.decode().encode(code), "not XML") for code in ("utf-16", "utf-16-le", "utf-32", "cp037")),
        (words.probe().decode().replace("UTF-8", "UTF-16").encode("utf-16"), "not XML"),
        (b'<!DOCTYPE a SYSTEM "file:///etc/passwd"><a/>', "document type"),
        (b"<a>" * 3000, "not XML"),
        (b"<a>&b;</a>", "not XML"),
        (b"<" * 600_000, "elements are the most"),
        (b"a" * (MOST_BYTES + 1), "are the most"),
        (words.document("Streams", "", head='<Header instanceId="1e9"/>'), "whole number"),
        (words.document("Devices", "<Devices/>", version="next"), "none of MTConnect's"),
        (words.document("Assets", ""), "none of MTConnect's"),
        (words.probe("<Device/>"), "neither uuid nor name"),
        (words.probe(*['<Device uuid="x"/>'] * 101), "101 machines"),
    ],
)
def test_what_is_no_document_is_refused_quickly(data: bytes, told: str) -> None:
    with pytest.raises(BadDocument) as refused, within_processor_time(2):
        read_document(data)
    assert told in str(refused.value)


def test_refusals_of_all_versions_are_read() -> None:
    old = words.document("Error", '<Error errorCode="OUT_OF_RANGE">Too old</Error>')
    new = words.document(
        "Error",
        '<Errors><OutOfRange errorCode="OUT_OF_RANGE"><ErrorMessage>Too old</ErrorMessage></OutOfRange></Errors>',
        version="2.6",
    )
    for data in (old, new):
        found = read_document(data)
        assert isinstance(found, Refusal)
        assert (found.codes, found.sentence) == (("OUT_OF_RANGE",), "Too old")


@pytest.mark.parametrize(
    ("url", "headers"),
    [
        ("", ""),
        ("ftp://a/", ""),
        ("http:///x", ""),
        ("http://a:x/", ""),
        ("http://a/?from=1", ""),
        ("http://a/", "no header"),
        ("http://a/", "Cookie: a\x0bb"),
    ],
)
def test_addresses_that_cannot_be_asked_are_refused(url: str, headers: str) -> None:
    with pytest.raises(BadAddress):
        read_address(url, headers=headers)


def test_an_address_has_a_path_a_password_and_headers() -> None:
    found = read_address("http://ann%40x:pw@cell:5000/a b", headers="Cookie: s=1\n\nX-Y: z")
    assert (found.host, found.port, found.path) == ("cell", 5000, "/a%20b/")
    assert found.headers == {"Authorization": "Basic YW5uQHg6cHc=", "Cookie": "s=1", "X-Y": "z"}


def test_the_command_line_is_read(tmp_path: Path) -> None:
    assert read_stand("1,-2,0.5", "3,2,1") == Stand(Pose(1, -2, 0, 0.5), Size(3, 2, 1))
    for place, size in [("1,2", "2,2,2"), ("0,0,nan", "2,2,2"), ("0,0,0", "0,1,1"), ("1e9,0,0", "1,1,1")]:
        with pytest.raises(CommandError):
            read_stand(place, size)
    with pytest.raises(CommandError, match="say http://host:5000/"):
        make_agent({"agent": "cell", "ca": "", "headers": ""})
    with pytest.raises(CommandError, match="No such file"):
        make_agent({"agent": "http://cell/", "ca": "", "headers": str(tmp_path / "none")})


def test_a_start_has_a_higher_number_than_those_before_also_when_the_clock_goes_back(tmp_path: Path) -> None:
    path = tmp_path / "mtconnect" / "hall.json"
    assert [count_start(path, now) for now in (5_000, 1_000, 1_000, 6_000)] == [5_000, 5_001, 5_002, 6_000]


@pytest.mark.parametrize("kept", ["", "[]", "{}", '{"boot": 1e999}', '{"boot": null}', "\ud800"])
def test_a_start_whose_last_number_cannot_be_read_takes_the_clocks(
    tmp_path: Path, kept: str, caplog: pytest.LogCaptureFixture
) -> None:
    path = tmp_path / "hall.json"
    path.write_bytes(kept.encode("utf-8", "surrogatepass"))
    assert (count_start(path, 7), count_start(path, 7), len(caplog.messages)) == (7, 8, 1)


def test_a_start_whose_number_cannot_be_kept_is_one_all_the_same(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    (tmp_path / "a file").touch()
    assert count_start(tmp_path / "a file" / "hall.json", 7) == 7
    assert len(caplog.messages) == 1

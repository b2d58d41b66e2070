from __future__ import annotations

import io
import json
import sys
from pathlib import Path

import pytest

from registry.demo.devices import DEVICES, describe_devices
from vipo_device.descriptions.forms import FORMS
from vipo_device.descriptions.reader import read
from vipo_site.cli.main import main

MIXER = DEVICES / "paintMixer02.ttl"
FIGURE_5 = Path(__file__).parents[3] / "fixtures" / "figure-5.txt"


def test_describe_says_what_a_file_holds(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["describe", str(MIXER), "--shacl"]) == 0
    assert capsys.readouterr().out == (
        f"{MIXER}: Turtle. It describes the machine paintMixer02, “Paint Mixer B” of class mixer.\n"
        "place: 14.78, -5.85, 0 m, 0 rad; size: 1.35 x 1.35 x 1.2 m\n"
        "property: jobStatus: number 0…100 PERCENT\n"
        "property: temperature: number 0…80 DEG_C\n"
        "method: mixPaint(time: number 1…30 MIN)\n"
        "method: dispense(object: object can, value: number 1…24)\n"
    )


@pytest.mark.parametrize("form", FORMS)
def test_describe_writes_every_form(form: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["describe", str(MIXER), "--to", form]) == 0
    again = tmp_path / "again"
    again.write_text(capsys.readouterr().out)
    reading = read(again.read_bytes())
    assert (reading.form, reading.description) == (form, next(d for d in describe_devices() if d.id == "paintMixer02"))
    assert main(["describe", str(again), "--json", "--to", "turtle"]) == 0
    body = json.loads(capsys.readouterr().out)
    assert (body["form"], body["notes"], body["faults"]) == (form, [], [])
    assert (body["description"]["id"], body["text"]) == ("paintMixer02", MIXER.read_text())


def test_describe_says_what_it_mended(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["describe", str(FIGURE_5)]) == 0
    assert "mended: Line 11: put a colon behind methods.\n" in capsys.readouterr().out
    assert main(["describe", str(FIGURE_5), "--to", "td"]) == 0
    told = capsys.readouterr()
    assert json.loads(told.out)["title"] == "Paint Mixer B"
    assert f"{FIGURE_5}: Line 11: put a colon behind methods.\n" in told.err


@pytest.mark.parametrize(
    ("text", "place", "says"),
    [
        ("@prefix a: <b> .\n<x> <y> foo bar .", ":2:9", "is not RDF (Turtle, N-Triples or JSON-LD)"),
        ('{"id": "m1",\n "size" 3}', ":2:9", "is not JSON"),
        ('{"id": 3}', ": /id", "needs text in quotes for id"),
        ('id: "m1"\nlocation: x\n', ":2:11", "needs a list of numbers for location"),
        ('{"@context": "https://www.w3.org/2022/wot/td/v1.1"}', "", "'security' is a required property. Such as"),
        ("<?xml version='1.0'?><rdf:RDF/>", "", "RDF/XML"),
        ("", "", "is empty"),
        ("<urn:a> a <urn:vipo:ns#Maschine> .", "", "no vipo:Machine or vipo:Robot. It needs exactly one"),
        ("<urn:a> a <urn:vipo:ns#Maschine> .", "", "It speaks of urn:vipo:ns#Maschine."),
        ("<urn:a> a <urn:vipo:ns#Machine> .", "", 'needs the device\'s id: dct:identifier "lamp01".'),
        ("<urn:a> <urn:b> ( 1, 2 ) .", ":1:20", "have blanks between them and no commas."),
        ("<urn:a> td:name 1 .", ":1:9", "Begin the text with '@prefix td: <…> .'"),
        ("<urn:a> <urn:b> 1\n<urn:c> 2 .", ":2:1", "missing dot, semicolon, quote"),
    ],
)
def test_a_broken_file_gives_code_1_and_sentences_with_places(
    text: str, place: str, says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "broken"
    path.write_text(text)
    assert main(["describe", str(path)]) == 1
    told = capsys.readouterr()
    assert told.out == ""
    lines = told.err.splitlines()
    assert any(line.startswith(f"{path}{place}: ") and says in line for line in lines)
    assert main(["describe", str(path), "--json"]) == 1
    faults = json.loads(capsys.readouterr().out)["faults"]
    assert [sorted(fault) for fault in faults] == [["args", "code", "column", "line", "path", "text"]] * len(lines)


def test_every_implausible_thing_has_a_line_of_its_own(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "odd.txt"
    path.write_text('id: "m1"\nlocation: [1, 2]\nsize: [0, 1, 1]\ncapacity: -1\n')
    assert main(["describe", str(path)]) == 1
    assert capsys.readouterr().err.splitlines() == [
        f"{path}: Its size must be three lengths between 0 and 100 metres: 0, 1, 1.",
        f"{path}: Its capacity must lie between 0 and 1000 objects.",
    ]


def test_the_shapes_say_all_that_is_wrong_with_rdf(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "odd.ttl"
    path.write_text(MIXER.read_text().replace("vipo:done true", "vipo:done true ; vipo:capacity 2.5 ; vipo:speed 99"))
    assert main(["describe", str(path), "--shacl"]) == 1
    lines = capsys.readouterr().err.splitlines()
    assert f"{path}: vipo:speed may be given once: 0.001 to 20 m/s, or 0. It is '99'." in lines
    assert any("needs a whole number for vipo:capacity" in line for line in lines)


@pytest.mark.parametrize("text", [MIXER.read_text(), "no description"])
def test_without_pyshacl_it_is_said_what_to_install(
    text: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pyshacl", None)  # as Python itself has it where a package is not there
    path = tmp_path / "device.ttl"
    path.write_text(text)
    assert main(["describe", str(path), "--shacl"]) == 2
    told = capsys.readouterr()
    assert told.out == ""
    assert told.err == (
        "Nothing can be held against the SHACL shapes: pyshacl is not installed. "
        "Install it with: pip install 'vipo[shacl]'\n"
    )


def test_without_pyshacl_everything_else_is_as_ever(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pyshacl", None)
    assert main(["describe", str(MIXER), "--to", "paper"]) == 0
    assert 'id: "paintMixer02"' in capsys.readouterr().out


def test_a_file_that_cannot_be_read_gives_code_2(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["describe", str(tmp_path / "nothing.ttl")]) == 2
    assert capsys.readouterr().err == f"{tmp_path / 'nothing.ttl'} cannot be read: No such file or directory.\n"
    assert main(["describe", str(tmp_path)]) == 2


def test_a_description_comes_on_standard_input_too(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(MIXER.read_bytes())))
    assert main(["describe", "-", "--to", "paper"]) == 0
    assert 'id: "paintMixer02"' in capsys.readouterr().out


def test_no_more_is_read_than_a_description_may_have(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["describe", "/dev/zero"]) == 2
    assert capsys.readouterr().err == "/dev/zero is larger than 20 MB. That is no description.\n"

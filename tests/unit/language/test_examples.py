"""The programs of `examples`: sound, printed and read back, rehearsed; and between them the whole language."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from editor.language import compile_document, parse_script, tree_to_document
from editor.language.document.outline import BRANCHES
from execution.rehearsals.program_file import read_site, rehearse_program
from execution.rehearsals.rehearsal import Conditions, rehearse
from scripts.example_sites import Example, hospital, warehouse, write
from simulation.world import Fault
from tests.kit.files import ROOT
from vipo_site.cli.main import main
from vipo_site.cli.program_file import read_program_file

SITE = "painting-factory"
TOUR = sorted(path for path in (ROOT / "examples").glob("*.json") if path.stem != SITE)
SITES_OF_THE_FIELD = {"hospital", "warehouse"}
FIELD = sorted(p for p in (ROOT / "examples" / "field").glob("*.json") if p.stem not in SITES_OF_THE_FIELD)
PROGRAMS = TOUR + FIELD
PAGE = ROOT / "docs" / "language" / "examples.md"
MOST_BYTES_OF_A_PICTURE = 150_000
CAUGHT = {"cure-until-cool": [("s8", "timed_out")] * 3}
"""What goes wrong on purpose, and is caught."""
NOTICES = {
    "ask-before-painting": ["Painted matt with 1 coats"],
    "cure-until-cool": ["The oven has 60 degrees", "Cool, after 3 min and more"],
    "deliver-colours": [
        "1. red stands at the mixer",
        "2. white stands at the mixer",
        "3. blue stands at the mixer",
        "3 cans were delivered",
    ],
    "hospital-delivery": ["Ward A has its medicine"],
    "kitting": ["Parts in the kit: 12 of 12"],
    "lab-drying": ["Dry; reworks: 2"],
    "nearest-mixer": ["The paint is mixed; the nearest dock is dock1"],
    "night-inspection": ["Inspected; battery left: 58 %"],
    "patrol-zones": ["The guard is in the busy corner"],
    "race-of-printers": ["The labels are fetched"],
    "replenishment": ["Pick faces seen to: 3"],
    "restock-when-low": ["Only 7 cans of paint are left", "2 cans were brought"],
    "rework-until-good": ["Good, with 3 tries to spare"],
    "rmf-cleaning": ["Clean floors: 1 of 3", "Clean floors: 2 of 3", "Clean floors: 3 of 3"],
    "two-mixers": ["Both are mixed, 4 degrees apart"],
}


def _document(path: Path) -> dict[str, Any]:
    document: dict[str, Any] = json.loads(path.read_text())["document"]
    return document


def _words(value: object) -> set[str]:
    """Return the operators and the forms of values that stand anywhere in a document."""
    if isinstance(value, list):
        return set().union(*map(_words, value))
    if not isinstance(value, dict):
        return set()
    own = {str(value["op"])} if "op" in value else set(value) & {"quantity", "at", "zone", "property", "param", "point"}
    return own.union(*map(_words, value.values()))


def test_there_are_twelve_programs_of_the_factory_and_twelve_of_the_field() -> None:
    assert (len(TOUR), len(FIELD)) == (12, 12)


def test_each_program_of_the_field_stands_on_the_page_with_its_script_and_picture() -> None:
    page = PAGE.read_text()
    for path in FIELD:
        program = read_program_file(path, None)
        assert f"### {program.name}\n" in page
        assert f"```python\n{compile_document(program.document, program.surroundings).script.strip()}\n```" in page
        picture = PAGE.parent / "images" / "examples" / f"{path.stem}.png"
        assert f"](images/examples/{picture.name})" in page
        assert 0 < picture.stat().st_size <= MOST_BYTES_OF_A_PICTURE


@pytest.mark.parametrize("site", [hospital(), warehouse()], ids=lambda site: site.id)
def test_a_site_of_the_field_is_what_its_script_writes(site: Example, tmp_path: Path) -> None:
    write(site, tmp_path)
    for written in tmp_path.iterdir():
        assert written.read_bytes() == (ROOT / "examples" / "field" / written.name).read_bytes()
    assert len(list(tmp_path.iterdir())) == 3


@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: path.stem)
def test_an_example_is_checked_printed_and_planned(path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    name = json.loads(path.read_text())["name"]
    assert main(["check", str(path)]) == 0
    assert capsys.readouterr().out == f"{name}: 0 errors, 0 warnings.\n"
    assert main(["script", str(path)]) == 0
    assert capsys.readouterr().out.startswith("class Task(object):\n    def new_task(self):\n")
    assert main(["plan", str(path)]) == 0
    assert " End" in capsys.readouterr().out


@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: path.stem)
def test_the_script_of_an_example_draws_the_same_document(path: Path) -> None:
    program = read_program_file(path, None)
    compiled = compile_document(program.document, program.surroundings)
    parsed = parse_script(compiled.script, program.surroundings)
    assert parsed.tree == compiled.tree
    assert parsed.tree is not None
    assert tree_to_document(parsed.tree, program.surroundings, program.document) == program.document


@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: path.stem)
def test_an_example_ends_well_when_it_is_rehearsed(path: Path) -> None:
    program = read_program_file(path, None)
    result = rehearse_program(document=program.document, site=dict(program.site), driver="kinematic")
    assert result["ok"] is True
    assert [(each["step"], each["kind"]) for each in result["errors"]] == CAUGHT.get(path.stem, [])
    assert (result["collisions"], result["near_misses"]) == ([], [])
    steps = {step for step, each in program.document["steps"].items() if each["kind"] == "notify"}
    told = [each["text"].removeprefix("Told: ") for each in result["log"] if each["step"] in steps]
    assert told == NOTICES.get(path.stem, [])


def test_a_mixer_that_fails_is_tried_again() -> None:
    result = _retried(Fault("paintMixer02", "fail_next", 60.0))
    assert result["ok"] is True
    assert [each["kind"] for each in result["errors"]] == ["failed"]
    assert [each["count"] for each in result["steps"] if each["device"] == "paintMixer02"].count(2) == 1


def test_a_person_is_called_when_the_mixer_is_gone() -> None:
    result = _retried(Fault("paintMixer02", "offline", 60.0))
    assert result["ok"] is True
    assert {each["kind"] for each in result["errors"]} == {"timed_out"}
    texts = [each["text"] for each in result["log"]]
    assert "Told: No paint came out of the mixer after 3 tries" in texts


def test_a_delivery_that_nobody_confirms_is_brought_back() -> None:
    program = read_program_file(FIELD[0].with_name("hospital-delivery.json"), None)
    question = next(step for step in program.document["steps"].values() if step["kind"] == "ask")
    question["params"]["timeout"] = 0.5
    result = rehearse_program(document=program.document, site=dict(program.site), driver="kinematic")
    assert result["ok"] is True
    assert [each["kind"] for each in result["errors"]] == ["timed_out"]
    texts = [each["text"] for each in result["log"]]
    assert "Told: Nobody took the medicine: it is back" in texts
    assert "Told: Ward A has its medicine" not in texts


def test_the_inspection_is_done_by_the_robot_with_enough_battery_and_charges_once() -> None:
    program = read_program_file(FIELD[0].with_name("night-inspection.json"), None)
    result = rehearse_program(document=program.document, site=dict(program.site), driver="kinematic")
    charging = {key for key, step in program.document["steps"].items() if "until" in step["params"]}
    assert [each["count"] for each in result["steps"] if each["step"] in charging] == [1]
    assert {name for name, figures in result["robots"].items() if figures["distance_m"]} == {"amr02"}
    assert result["robots"]["amr02"]["battery"] > 50


def test_the_printer_that_loses_the_race_is_called_off() -> None:
    program = read_program_file(FIELD[0].with_name("race-of-printers.json"), None)
    result = rehearse_program(document=program.document, site=dict(program.site), driver="kinematic")
    printed = {each["device"]: (each["ended_s"], each["status"]) for each in result["steps"] if each["device"]}
    assert printed == {"printer01": (120.0, "skipped"), "printer02": (120.0, "done")}


@pytest.mark.parametrize(
    ("fault", "kind", "wraps", "questions"), [("fail_next", "failed", 2, 0), ("offline", "timed_out", 1, 1)]
)
def test_a_failure_is_handled_by_its_kind(fault: str, kind: str, wraps: int, questions: int) -> None:
    path = FIELD[0].with_name("failure-by-kind.json")
    steps = _document(path)["steps"]
    result = _rehearsed_with(path, Fault("wrapper", fault, 30.0))
    assert result["ok"] is True
    assert [each["kind"] for each in result["errors"]] == [kind]
    done = [steps[each["step"]]["kind"] for each in result["steps"] for _ in range(each["count"])]
    assert (done.count("operate"), done.count("ask")) == (wraps, questions)


def _retried(fault: Fault) -> dict[str, Any]:
    return _rehearsed_with(ROOT / "examples" / "retry-then-call.json", fault)


def _rehearsed_with(path: Path, fault: Fault) -> dict[str, Any]:
    program = read_program_file(path, None)
    surroundings, scene, places = read_site(program.site, 0)
    plan = compile_document(program.document, surroundings).plan
    assert plan is not None
    return rehearse(plan, replace(scene, faults=(fault,)), places=places, conditions=Conditions("kinematic"))


def test_the_examples_use_every_construct() -> None:
    kinds = {step["kind"] for path in PROGRAMS for step in _document(path)["steps"].values()}
    assert kinds == {*BRANCHES, "comment"}
    rules = {zone["rule"] for path in PROGRAMS for zone in _document(path)["zones"].values()}
    assert rules == {"keep_out", "one_at_a_time", "slow", "door"}


def test_the_examples_use_every_form_of_value() -> None:
    words = set().union(*(_words(_document(path)) for path in PROGRAMS))
    assert words >= {"quantity", "at", "zone", "property", "param", "point"}
    assert words >= {"+", "-", ">", "<", ">=", "<=", "==", "and", "or", "not", "in", "text"}
    assert words >= {"abs", "round", "min", "max", "distance", "nearest", "count", "now"}

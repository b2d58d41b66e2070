"""Robots pass a door in a rehearsal: the delivery of the hospital, through the door of its ward."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from editor.language import compile_document
from execution.rehearsals.program_file import read_site
from execution.rehearsals.rehearsal import Conditions, rehearse
from simulation.world import Fault
from tests.kit.files import ROOT
from vipo_device.protocol.description import Description, MethodSpec, PropertySpec
from vipo_site.cli.program_file import read_program_file

FILE = ROOT / "examples" / "field" / "hospital-delivery.json"
DOOR = "wardADoor"


def rehearsed(change: Any = None, **scene_changes: Any) -> dict[str, Any]:
    """Rehearse the delivery, at a site whose door is another."""
    program = read_program_file(FILE, None)
    surroundings, scene, places = read_site(program.site, 0)
    if change is not None:
        facts = surroundings.devices[DOOR]
        other = replace(facts, description=change(facts.description))
        surroundings = replace(surroundings, devices={**surroundings.devices, DOOR: other})
        scene = replace(scene, devices=[other.description if d.id == DOOR else d for d in scene.devices])
    compiled = compile_document(program.document, surroundings)
    assert [d.code for d in compiled.diagnostics] == []
    assert compiled.plan is not None
    scene = replace(scene, **scene_changes)
    return rehearse(compiled.plan, scene, places=places, conditions=Conditions("kinematic"))


def told(result: dict[str, Any]) -> list[str]:
    """Return what the door was told, in order."""
    return [line["args"]["method"] for line in result["log"] if line["device"] == DOOR and line["code"] == "command"]


def test_the_door_opens_and_closes_by_itself() -> None:
    result = rehearsed()
    assert result["ok"] is True
    assert told(result)[:2] == ["open", "close"]
    assert told(result).count("open") == told(result).count("close") + (told(result)[-1] == "open")


def as_gate(door: Description) -> Description:
    methods = (MethodSpec("lift", "a"), MethodSpec("raiseBar", "b"), MethodSpec("lowerBar", "c"))
    up = PropertySpec("barUp", "boolean")
    return replace(door, name="Gate", device_class="gate", methods=methods, properties=(up,))


def without_words(door: Description) -> Description:
    return replace(door, properties=())


@pytest.mark.parametrize(
    ("change", "words"),
    [(as_gate, ("raiseBar", "lowerBar")), (without_words, ("open", "close"))],
    ids=["a gate", "without a reading"],
)
def test_what_the_device_is_called_does_not_matter(change: Any, words: tuple[str, str]) -> None:
    result = rehearsed(change)
    assert result["ok"] is True
    assert told(result)[:2] == list(words)


def test_a_door_that_breaks_down_once_is_told_again() -> None:
    result = rehearsed(faults=(Fault(DOOR, "fail_next", 0.0),))
    assert result["ok"] is True
    assert told(result)[:2] == ["open", "open"]


def test_a_door_that_never_answers_fails_the_run_with_the_door_as_the_reason() -> None:
    result = rehearsed(faults=(Fault(DOOR, "offline", 0.0),))
    assert result["ok"] is False
    assert [error["message"] for error in result["errors"]] == ["Ward A Door did not open in time."]
    waits = [wait for wait in result["waits"] if wait["why"]["code"] == "door_shut"]
    assert [wait["reason"].partition(" waits ")[2] for wait in waits] == ["for Ward A Door to open."]

"""Programs that fail by themselves, in a rehearsal: the result says why, or the Try around goes on."""

from editor.language import Surroundings, compile_document
from editor.language.site.surroundings import DeviceFacts
from execution.rehearsals.rehearsal import Conditions, rehearse
from simulation.world import Scene
from tests.kit import demo_floor
from tests.kit.programs import document, step


def rehearsed(steps):
    devices = demo_floor.devices()
    compiled = compile_document(document(steps), Surroundings({d.id: DeviceFacts(d) for d in devices}))
    assert [d.message for d in compiled.diagnostics] == []
    scene = Scene(demo_floor.grid(), devices, seed=1)
    return rehearse(compiled.plan, scene, places=demo_floor.places(), conditions=Conditions("kinematic"))


def test_a_program_that_fails_has_its_text_as_the_error():
    result = rehearsed({"f": step("fail", message="The box is wet.")})
    assert result["ok"] is False
    assert [error["message"] for error in result["errors"]] == ["The box is wet."]
    assert [(s["step"], s["status"]) for s in result["steps"]] == [("f", "failed")]


def test_a_rehearsal_takes_the_first_catch_that_fits():
    steps = {
        "t": step("try", kinds=["offline"], kinds2=["failed"], kinds3=[]),
        "f": step("fail", ("t", "body"), message="The box is wet."),
        "a": step("notify", ("t", "catch"), message="Call somebody.", level="info"),
        "b": step("notify", ("t", "catch2"), message="Dry it.", level="info"),
        "c": step("notify", ("t", "catch3"), message="Stop.", level="info"),
    }
    result = rehearsed(steps)
    assert result["ok"] is True
    assert [(s["step"], s["status"]) for s in result["steps"]] == [("t", "done"), ("f", "failed"), ("b", "done")]


def test_a_rehearsal_whose_failure_is_caught_goes_well_and_tells_of_it():
    steps = {
        "t": step("try", kinds=["failed"]),
        "f": step("fail", ("t", "body"), message="The box is wet."),
        "n": step("notify", ("t", "catch"), message="Dry it.", level="info"),
    }
    result = rehearsed(steps)
    assert (result["ok"], [error["message"] for error in result["errors"]]) == (True, ["The box is wet."])
    assert [(s["step"], s["status"]) for s in result["steps"]] == [("t", "done"), ("f", "failed"), ("n", "done")]

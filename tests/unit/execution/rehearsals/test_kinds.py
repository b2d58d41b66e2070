"""What a rehearsal is does not depend on what a device's class is called, in mathematics or in physics."""

from dataclasses import replace

import pytest

from editor.language import Surroundings, compile_document
from editor.language.site.surroundings import DeviceFacts
from execution.rehearsals.rehearsal import Conditions, rehearse
from simulation.world import Scene
from tests.kit import demo_floor
from vipo_device.descriptions.reader import read_description, write_description

CALLED = {"oven": "kiln", "booth": "spray-cell", "shelf": "rack", "rollers": "ramp"}
DOCUMENT = {
    "format": 2,
    "start_pos": [0, 0],
    "steps": {
        "carry": {
            "kind": "pick_and_drop",
            "place": ["program", "body", "1"],
            "pos": [1, -1],
            "params": {
                "role": "robot",
                "source": {"device": "itemInventory01"},
                "target": {"device": "curingOven01"},
                "object": "box",
                "quantity": 1,
            },
        },
        "cure": {
            "kind": "operate",
            "place": ["program", "body", "2"],
            "pos": [2, -1],
            "params": {"device": {"device": "curingOven01"}, "method": "curePaint", "args": {"time": 1}},
        },
    },
}


def renamed(device, name):
    """Return the device as its RDF describes it in another site, with another class."""
    rdf = write_description(replace(device, site="pottery"))
    written = f'vipo:deviceClass "{device.device_class}"'
    assert written in rdf
    return read_description(rdf.replace(written, f'vipo:deviceClass "{name}"').encode())


def rehearsed(devices, driver, seed):
    compiled = compile_document(DOCUMENT, Surroundings({d.id: DeviceFacts(d) for d in devices}))
    assert [d.message for d in compiled.diagnostics if d.severity == "error"] == []
    scene = Scene(demo_floor.grid(), devices, seed=seed)
    return rehearse(compiled.plan, scene, places=demo_floor.places(), conditions=Conditions(driver))


@pytest.mark.parametrize(("driver", "seed"), [("kinematic", 0), ("kinematic", 5), ("physics", 5)])
def test_a_kiln_with_the_ovens_rdf_rehearses_the_same_byte_for_byte(driver, seed):
    as_drawn = demo_floor.devices()
    others = tuple(renamed(d, CALLED.get(d.device_class, "thing")) for d in as_drawn)
    assert {d.device_class for d in others}.isdisjoint({d.device_class for d in as_drawn})
    first = rehearsed(as_drawn, driver, seed)
    assert (first["ok"], first["errors"]) == (True, [])
    assert repr(rehearsed(others, driver, seed)) == repr(first)


def test_another_seed_is_another_course():
    durations = {rehearsed(demo_floor.devices(), "kinematic", seed)["duration_s"] for seed in (0, 1, 2, 3)}
    assert len(durations) > 1

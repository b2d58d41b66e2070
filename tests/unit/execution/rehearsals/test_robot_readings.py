"""Readings of a role's robot in a rehearsal: what the simulated robot that the role has found tells."""

from dataclasses import replace
from typing import Any

from editor.language import Surroundings, compile_document
from editor.language.site.surroundings import DeviceFacts
from execution.rehearsals.rehearsal import Conditions, rehearse
from simulation.world import Scene
from tests.kit import demo_floor
from vipo_device.protocol.description import PropertySpec

CHARGE = PropertySpec("battery", "number", "PERCENT", 0, 100)
BATTERY = {"property": [{"role": "robot"}, "battery"]}


def rehearsed(battery: dict[str, int], *steps: tuple[str, dict[str, Any]], where: Any = None) -> Any:
    """Rehearse a program that begins with a move, where robots have this much left in their batteries."""
    listed = (("move", {"role": "robot", "to": {"device": "paintInventory01"}}), *steps)
    document = {
        "format": 2,
        "start_pos": [0, 0],
        "roles": {"robot": {"name": "robot", "can": [], "where": where}},
        "steps": {
            f"s{number}": {
                "kind": kind,
                "place": ["program", "body", str(number)],
                "pos": [number, -1],
                "params": params,
            }
            for number, (kind, params) in enumerate(listed, 1)
        },
    }
    devices = tuple(
        replace(d, properties=(*d.properties, CHARGE)) if d.kind == "robot" else d for d in demo_floor.devices()
    )
    compiled = compile_document(document, Surroundings({d.id: DeviceFacts(d) for d in devices}))
    assert [d.message for d in compiled.diagnostics] == []
    assert compiled.plan is not None
    readings = {robot: {"battery": value} for robot, value in battery.items()}
    scene = Scene(demo_floor.grid(), devices, seed=1, readings=readings)
    return rehearse(compiled.plan, scene, places=demo_floor.places(), conditions=Conditions("kinematic", limit_s=600))


def test_the_battery_of_the_robot_that_came_is_told() -> None:
    result = rehearsed(
        {"robot01": 71, "robot02": 72, "robot03": 73},
        ("notify", {"message": {"op": "text", "args": ["It has ", BATTERY]}, "level": "info"}),
    )
    assert (result["ok"], result["errors"]) == (True, [])
    (robot,) = {step["robot"] for step in result["steps"]} - {""}
    texts = [line["text"] for line in result["log"]]
    assert any(f"It has 7{int(robot[-1])}" in text or f"It has 7{int(robot[-1]) - 1}" in text for text in texts), texts


def test_a_wait_for_a_battery_ends_when_it_falls_so_low() -> None:
    until = {"until": {"op": "<", "args": [BATTERY, {"quantity": [50, "PERCENT"]}]}}
    result = rehearsed({"robot01": 50, "robot02": 50, "robot03": 50}, ("wait", until))
    assert (result["ok"], result["errors"]) == (True, [])
    assert 60 < result["duration_s"] < 600


def test_the_robot_is_one_that_is_charged_however_far_it_is_away() -> None:
    full = {"op": ">", "args": [BATTERY, 60]}
    anybody, chosen = (rehearsed({"robot01": 20, "robot02": 20, "robot03": 20}), [])
    (near,) = {step["robot"] for step in anybody["steps"]}
    for robot in ("robot01", "robot02", "robot03"):
        charged = {"robot01": 20, "robot02": 20, "robot03": 20, robot: 80}
        result = rehearsed(charged, where=full)
        assert (result["ok"], result["errors"]) == (True, [])
        chosen += [step["robot"] for step in result["steps"]]
    assert near in chosen
    assert chosen == ["robot01", "robot02", "robot03"]


def test_a_rehearsal_waits_until_a_robot_at_its_dock_is_charged() -> None:
    result = rehearsed({"robot01": 20, "robot02": 20, "robot03": 22}, where={"op": ">=", "args": [BATTERY, 24]})
    assert (result["ok"], result["errors"]) == (True, [])
    assert {step["robot"] for step in result["steps"]} == {"robot03"}
    assert 18 < result["duration_s"] < 600
    assert [wait["why"] for wait in result["waits"]] == [
        {"code": "no_fitting_robot", "args": {"condition": "battery >= 24 %"}}
    ]

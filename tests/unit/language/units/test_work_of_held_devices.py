"""How much work the devices that variables hold make: as much as differs, not all devices for each step."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from editor.language import compile_document
from editor.language.compiler import EditedProgram
from editor.language.site.surroundings import Surroundings
from editor.language.tree.held_devices import held_devices
from tests.kit.demo_site import factory
from tests.kit.work import count_work

Json = dict[str, Any]
OVEN = "curingOven01"


def site(ovens: int) -> Surroundings:
    """Return the factory with so many more ovens, all alike."""
    found = factory()
    oven = found.devices[OVEN]
    names = [f"oven{number}" for number in range(ovens)]
    more = {name: replace(oven, description=replace(oven.description, id=name, name=name)) for name in names}
    return replace(found, devices={**found.devices, **more})


def document(steps: Json, parameters: Json | None = None) -> Json:
    around: Json = {"functions": {}, "roles": {}, "parameters": parameters or {}, "zones": {}}
    return {"format": 2, "start_pos": [0, 0], "steps": steps, **around}


def step(kind: str, number: int, params: Json, parent: tuple[str, str] = ("program", "body")) -> Json:
    return {"kind": kind, "place": [*parent, f"{number:05d}V"], "pos": [0, 0], "params": params}


def at_the_chosen(count: int) -> Json:
    """Return a program that operates, and waits by what is read of, a device that people choose, so many times."""
    cure = {"device": {"param": "m"}, "method": "curePaint"}
    hot = {"op": ">", "args": [{"property": [{"param": "m"}, "temperature"]}, {"quantity": [300, "K"]}]}
    steps: Json = {}
    for number in range(count):
        args = {"time": {"quantity": [1 + number % 9, "min"]}}
        steps[f"o{number}"] = step("operate", 2 * number, {**cure, "args": args})
        steps[f"w{number}"] = step("wait", 2 * number + 1, {"until": hot, "timeout": 60 + number})
    return document(steps, {"m": {"name": "m", "type": "device", "default": OVEN}})


def lines_of_edit(count: int, ovens: int) -> int:
    """Return the lines of Python that a look takes at another value of one step, and the plan of the program."""
    first, where, program = at_the_chosen(count), site(ovens), EditedProgram()
    compiled = program.compile(first, where)
    assert compiled.diagnostics == ()
    assert compiled.plan is not None
    steps = {
        **first["steps"],
        "w0": {**first["steps"]["w0"], "params": {**first["steps"]["w0"]["params"], "timeout": 9}},
    }
    with count_work() as work:
        assert program.compile({**first, "steps": steps}, where).plan is not None
    return work.lines


def test_each_device_of_the_site_is_looked_at_once_for_all_steps_at_a_device_that_people_choose() -> None:
    few, many = (lines_of_edit(count, 150) - lines_of_edit(count, 10) for count in (4, 24))
    assert many < 1.3 * few


def test_steps_that_put_nothing_into_variables_are_passed_over() -> None:
    count = 500
    steps = {f"w{number}": step("wait", number, {"duration": 5 + number}) for number in range(count)}
    loop = {"variable": "m", "items": [{"device": OVEN}]}
    cure = {"device": {"param": "m"}, "method": "curePaint", "args": {"time": {"quantity": [2, "min"]}}}
    steps |= {"l": step("for_each", count, loop), "o": step("operate", 0, cure, ("l", "body"))}
    compiled = compile_document(document(steps), factory())
    assert compiled.plan is not None, compiled.diagnostics
    tree = replace(compiled.tree)
    with count_work() as work:
        assert len(held_devices(tree)) == 1
    assert work.lines < 20 * count

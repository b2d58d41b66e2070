"""New steps stand where there is room for what they say."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path
from typing import Any

import pytest

from editor.language import compile_document, parse_script, tree_to_document
from editor.language.drawing.layout import GAP_M, Area, Layout, Room, letters, room_of
from editor.language.site.surroundings import Surroundings
from execution.rehearsals.program_file import read_site
from registry.floorplan.plan import FloorPlan, Grid
from tests.kit.demo_site import factory
from tests.kit.files import ROOT
from vipo_site.cli.program_file import read_program_file

PROGRAMS = sorted(set((ROOT / "examples").glob("*.json")) - {ROOT / "examples" / "painting-factory.json"})


def area_of(step: dict[str, Any]) -> Area:
    return Area(step["pos"][0], step["pos"][1], room_of(step["kind"], step["params"]))


def overlapping(document: dict[str, Any]) -> list[tuple[str, str]]:
    areas = {name: area_of(step) for name, step in document["steps"].items()}
    return [pair for pair in combinations(areas, 2) if areas[pair[0]].covers(areas[pair[1]])]


def redrawn(script: str, site: Surroundings) -> Any:
    tree = parse_script(script, site).tree
    assert tree is not None
    return tree_to_document(tree, site)


@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: path.stem)
def test_no_step_of_a_script_is_drawn_over_another(path: Path) -> None:
    program = read_program_file(path, None)
    site, _, _ = read_site(program.site, 0)
    assert overlapping(redrawn(compile_document(program.document, site).script, site)) == []


@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: path.stem)
def test_no_step_stands_beyond_the_map_however_full_it_is(path: Path) -> None:
    program = read_program_file(path, None)
    site, _, _ = read_site(program.site, 0)
    assert site.floor is not None
    for document in (program.document, redrawn(compile_document(program.document, site).script, site)):
        assert [step["kind"] for step in document["steps"].values() if not site.floor.is_inside(*step["pos"])] == []


def test_what_a_loop_holds_stands_below_its_head_and_nothing_else_stands_there() -> None:
    waits = "\n".join(f"            self.wait({10 + number})" for number in range(4))
    script = (
        "class Task(object):\n    def new_task(self):\n        for _ in range(3):\n"
        f"{waits}\n        self.wait(1)\n\n    def run(self, ctx):\n        self.new_task()\n"
    )
    document = redrawn(script, factory())
    steps = document["steps"]
    head = next(name for name, step in steps.items() if step["kind"] == "repeat")
    inner = [step["pos"] for step in steps.values() if step["place"][0] == head]
    after = next(step["pos"] for step in steps.values() if step["params"] == {"duration": 1})
    x, y = steps[head]["pos"]
    assert inner == [[x, round(y - GAP_M - 0.7 - number * (GAP_M + 0.7), 2)] for number in range(4)]
    assert abs(after[0] - x) > 2.6 or after[1] < inner[-1][1] - 0.7


@pytest.mark.parametrize(
    ("origin", "start"),
    [
        ((0.0, -14.0), [1.9, -0.1]),
        ((-10.0, -7.0), [1.0, -0.1]),
        ((-25.0, 2.0), [-23.1, 15.9]),
        ((300_000.0, -200_000.0), [300_001.9, -199_986.1]),
    ],
)
def test_a_script_that_names_no_device_is_drawn_on_the_floor_wherever_the_map_has_its_origin(
    origin: tuple[float, float], start: list[float]
) -> None:
    hall = FloorPlan(Grid(40, 28, 0.5, *origin, bytes(40 * 28)))
    script = (
        "class Task(object):\n    def new_task(self):\n        self.wait(1)\n        self.wait(2)\n\n"
        "    def run(self, ctx):\n        self.new_task()\n"
    )
    document = redrawn(script, Surroundings(floor=hall))
    spots = [document["start_pos"], *(step["pos"] for step in document["steps"].values())]
    assert [spot for spot in spots if not hall.is_inside(*spot)] == []
    assert document["start_pos"] == start


def test_a_full_floor_takes_steps_where_they_are_wanted() -> None:
    layout = Layout(factory())
    wide = {"message": "A sentence that takes much room"}
    places = [layout.put("notify", wide, room_of("notify", wide)) for _ in range(400)]
    assert len(places) == 400


def test_a_chip_is_as_wide_as_what_it_says() -> None:
    assert letters({"param": "count"}) == 5
    assert letters(["a", 12]) == 7
    short, long = room_of("wait", {"duration": 1}), room_of("notify", {"message": "x" * 200})
    assert short == Room(2.6, 0.7)
    assert long == Room(7.25, 0.7)

from __future__ import annotations

from pathlib import Path

from registry.demo.devices import DEVICES, SITE_FILE, describe_devices, with_devices, write_devices
from registry.demo.factory import FOLDER, make_grid, read_plan, write_maps
from registry.floorplan.plan import FloorPlan, cells_array, stations


def test_the_committed_maps_are_the_ones_that_are_made(tmp_path: Path) -> None:
    write_maps(tmp_path)
    made = {p.name: p.read_bytes() for p in tmp_path.iterdir()}
    assert sorted(made) == ["painting-factory.pgm", "painting-factory.yaml", "workshop.pgm", "workshop.yaml"]
    assert made == {name: (FOLDER / name).read_bytes() for name in made}


def test_the_committed_descriptions_are_the_ones_that_are_made(tmp_path: Path) -> None:
    write_devices(tmp_path)
    made = {p.name: p.read_text() for p in tmp_path.iterdir()}
    assert made == {p.name: p.read_text() for p in DEVICES.iterdir()}
    assert len(made) == 11


def test_the_site_file_that_programs_are_checked_with_has_the_devices_as_they_describe_themselves() -> None:
    assert SITE_FILE.read_text() == with_devices(SITE_FILE.read_text()), "run `python -m registry.demo.devices`"


def test_the_factory_has_walls_doors_and_an_outside() -> None:
    grid = make_grid(read_plan())
    cells = cells_array(grid)

    def at(x: float, y: float) -> int:
        cell = grid.cell_of(x, y)
        assert cell is not None
        return int(cells[cell])

    assert (grid.width, grid.height, grid.resolution_m) == (500, 288, 0.05)
    assert (at(3, -3), at(3, 0), at(2.3, -6.8), at(5, -6.8), at(22, -11), at(-0.3, -3)) == (0, 100, 0, 100, 255, 255)
    assert at(2.3, -1.95) == 0


def test_every_machine_can_be_served_from_every_dock() -> None:
    grid, devices = make_grid(read_plan()), describe_devices()
    found, plan = stations(grid, devices, 0.18), FloorPlan(grid, devices)
    docks = [(d.pose.x, d.pose.y) for d in devices if d.kind == "robot"]
    assert sorted(found) == sorted(d.id for d in devices if d.kind == "machine")
    assert all(plan.is_reachable(dock, (s.x, s.y), 0.25) for dock in docks for s in found.values())

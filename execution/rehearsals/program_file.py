"""A program file rehearsed from the command line: its site made into a scene, its document compiled; no database."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from editor.language import PlaceFacts, Surroundings, compile_document, surroundings_from_json
from execution.rehearsals.rehearsal import Conditions, rehearse
from registry.floorplan.map_server import read_header, read_map
from registry.floorplan.plan import FREE, FloorPlan, Grid
from simulation.services import DriverName
from simulation.world import Scene

RESOLUTION_M = 0.05
ROOM_M = 3.0


def rehearse_program(
    document: object, site: Mapping[str, Any], seed: int = 0, driver: DriverName = "physics"
) -> dict[str, Any]:
    """Rehearse a document in the site of a program file (see docs/cli.md); for the command line.

    Raises:
        ValueError: the program has errors; check it first.
        UnreadableSite, BadMap: the site cannot be used.
    """
    surroundings, scene, places = read_site(site, seed)
    compiled = compile_document(document, surroundings)
    if compiled.plan is None:
        errors = [d.message for d in compiled.diagnostics if d.severity == "error"]
        raise ValueError(f"The program has errors and cannot be rehearsed. {errors[0] if errors else ''}".strip())
    zones = surroundings.zones
    return rehearse(compiled.plan, scene, places=places, zones=zones, conditions=Conditions(driver))


def read_site(site: Mapping[str, Any], seed: int) -> tuple[Surroundings, Scene, tuple[PlaceFacts, ...]]:
    """Return what a program is checked against, the scene and the places of a site file.

    `site["grid"]["yaml"]` is the path of a ROS map; without one the floor is empty around the devices and places.

    Raises:
        UnreadableSite: the site's JSON is broken.
        BadMap: the map is.
    """
    plain = surroundings_from_json(site)
    grid = _read_grid(Path(site["grid"]["yaml"])) if site.get("grid") else _empty_grid(plain)
    approved = [facts for facts in plain.devices.values() if facts.lifecycle == "approved"]
    devices = [facts.description for facts in approved]
    floor = FloorPlan(grid, devices)
    scene = Scene(
        grid=grid, devices=devices, seed=seed, readings={f.description.id: f.readings for f in approved if f.readings}
    )
    return replace(plain, floor=floor), scene, tuple(plain.places.values())


def _read_grid(path: Path) -> Grid:
    header = path.read_bytes()
    return read_map(header, (path.parent / read_header(header).image).read_bytes())


def _empty_grid(plain: Surroundings) -> Grid:
    """Return a free floor with room around everything that stands on it."""
    points = [(f.description.pose.x, f.description.pose.y) for f in plain.devices.values()]
    points += [(place.x, place.y) for place in plain.places.values()] or [(0.0, 0.0)]
    left, bottom = (min(p[axis] for p in points) - ROOM_M for axis in (0, 1))
    width, height = (
        round((max(p[axis] for p in points) - min(p[axis] for p in points) + 2 * ROOM_M) / RESOLUTION_M)
        for axis in (0, 1)
    )
    cells = np.full((height, width), FREE, dtype=np.uint8)
    return Grid(width, height, RESOLUTION_M, left, bottom, cells.tobytes())

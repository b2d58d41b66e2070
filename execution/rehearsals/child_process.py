"""`python -m execution.rehearsals.child_process`: one rehearsal in a process of its own, without Django.

It reads a job as JSON from standard input and writes lines of JSON: `{"progress": 0.3}` now and then, at the end
`{"result": {…}}` or `{"error": "…"}`.
"""

from __future__ import annotations

import base64
import json
import sys
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from editor.language import plan_from_json
from editor.language.site.surroundings import PlaceFacts
from execution.rehearsals.rehearsal import Conditions, rehearse
from registry.floorplan.plan import Grid
from simulation.world import Scene
from vipo_device.protocol.description import Description, Pose, description_from_json, description_to_json


def scene_to_json(scene: Scene, places: Sequence[PlaceFacts]) -> dict[str, Any]:
    """Return a scene and the named places as JSON."""
    grid = asdict(scene.grid) | {"cells": base64.b64encode(zlib.compress(scene.grid.cells)).decode()}
    return {
        "grid": grid,
        "devices": [description_to_json(device) for device in scene.devices],
        "places": [asdict(place) for place in places],
        "seed": scene.seed,
        "stocks": {device: dict(stock) for device, stock in scene.stocks.items()},
        "poses": {device: asdict(pose) for device, pose in scene.poses.items()},
        "carrying": {device: dict(load) for device, load in scene.carrying.items()},
        "readings": {device: dict(values) for device, values in scene.readings.items()},
    }


def scene_from_json(data: Mapping[str, Any]) -> tuple[Scene, tuple[PlaceFacts, ...]]:
    """Read what `scene_to_json` wrote."""
    grid = Grid(**{**data["grid"], "cells": zlib.decompress(base64.b64decode(data["grid"]["cells"]))})
    devices: list[Description] = [description_from_json(device) for device in data["devices"]]
    scene = Scene(
        grid=grid,
        devices=devices,
        seed=data["seed"],
        stocks=data["stocks"],
        poses={device: Pose(**pose) for device, pose in data["poses"].items()},
        carrying=data["carrying"],
        readings=data["readings"],
    )
    return scene, tuple(PlaceFacts(**place) for place in data["places"])


def run_job(job: Mapping[str, Any]) -> dict[str, Any]:
    """Carry a job out, writing progress lines; returns the result."""
    scene, places = scene_from_json(job["scene"])
    conditions = Conditions(job.get("driver", "physics"), job.get("parameters", {}))
    return rehearse(
        plan_from_json(job["plan"]),
        scene,
        places=places,
        conditions=conditions,
        on_progress=lambda share: _write({"progress": share}),
    )


def _write(line: Mapping[str, Any]) -> None:
    sys.stdout.write(json.dumps(line) + "\n")
    sys.stdout.flush()


def main() -> int:
    """Read a job, write its lines; 0 when there is a result."""
    try:
        result = run_job(json.loads(sys.stdin.read()))
    except Exception as error:  # noqa: BLE001 - the edge of the process: the one who waits is told what went wrong
        _write({"error": f"The rehearsal broke off: {error or type(error).__name__}"})
        return 1
    _write({"result": result})
    return 0


if __name__ == "__main__":
    sys.exit(main())

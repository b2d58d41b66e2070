"""`python -m execution.rehearsals.child_process`: one rehearsal in a process of its own, without Django.

It reads a job as JSON from standard input and writes lines of JSON: `{"begun": true}` when its time begins,
`{"course": {…}}` (`Progress`) four times a second, at the end `{"result": {…}}` or `{"error": "…"}`. Of a job's
`limits` it holds itself to `wall_s` by the clock and to `memory_bytes`; `parent` is the process without which nobody
wants the result.
"""

from __future__ import annotations

import base64
import ctypes
import json
import os
import resource
import signal
import sys
import time
import zlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from typing import Any

from editor.language import plan_from_json
from editor.language.site.json_form import zone_from_json, zone_to_json
from editor.language.site.surroundings import PlaceFacts, ZoneFacts
from execution.rehearsals.progress import Progress
from execution.rehearsals.rehearsal import Conditions, rehearse
from execution.traffic.messages import zone_from_json as floor_zone_from_json
from registry.floorplan.plan import Grid
from simulation.fault_form import faults_to_json, read_faults
from simulation.world import Scene
from vipo_device.protocol.description import Description, Pose, description_from_json, description_to_json

TELL_EVERY_S = 0.25
BEHIND_THE_RUNS = 15
"""How much the kernel prefers everything else: a rehearsal takes what runs leave."""
PR_SET_PDEATHSIG = 1


def scene_to_json(scene: Scene, places: Sequence[PlaceFacts], zones: Sequence[ZoneFacts] = ()) -> dict[str, Any]:
    """Return a scene, the named places and the zones of the floor as JSON."""
    grid = asdict(scene.grid) | {"cells": base64.b64encode(zlib.compress(scene.grid.cells)).decode()}
    return {
        "grid": grid,
        "devices": [description_to_json(device) for device in scene.devices],
        "places": [asdict(place) for place in places],
        "zones": [zone_to_json(zone) for zone in zones],
        "seed": scene.seed,
        "stocks": {device: dict(stock) for device, stock in scene.stocks.items()},
        "poses": {device: asdict(pose) for device, pose in scene.poses.items()},
        "carrying": {device: dict(load) for device, load in scene.carrying.items()},
        "readings": {device: dict(values) for device, values in scene.readings.items()},
        "delivery_s": scene.delivery_s,
        "delivered": None if scene.delivered is None else sorted(scene.delivered),
        "faults": faults_to_json(scene.faults),
        "paces": {device: dict(paces) for device, paces in scene.paces.items()},
        "idless": sorted(scene.idless),
    }


def scene_from_json(data: Mapping[str, Any]) -> tuple[Scene, tuple[PlaceFacts, ...], tuple[ZoneFacts, ...]]:
    """Read what `scene_to_json` wrote; jobs that wait since before there were zones or deliveries have none."""
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
        delivery_s=data.get("delivery_s"),
        delivered=None if data.get("delivered") is None else frozenset(data["delivered"]),
        faults=read_faults(data["faults"]) if "faults" in data else (),
        paces=data.get("paces", {}),
        idless=frozenset(data.get("idless", ())),
    )
    zones = tuple(zone_from_json(zone) for zone in data.get("zones", ()))
    return scene, tuple(PlaceFacts(**place) for place in data["places"]), zones


class Teller:
    """Writes how far the rehearsal is, and tells when its time by the clock is over."""

    def __init__(self, limits: Mapping[str, Any]) -> None:
        self._wall_s: float | None = limits.get("wall_s")
        self._parent: int | None = limits.get("parent")
        self._began = time.monotonic()
        self._told_at = 0.0

    def __call__(self, progress: Progress) -> float | None:
        """Take in how far it is; return the seconds that it was given, once they are over."""
        now = time.monotonic()
        if now - self._told_at >= TELL_EVERY_S:
            self._told_at = now
            if self._parent is not None and os.getppid() != self._parent:
                os._exit(1)  # the one who waits for the result has died
            _write({"course": asdict(progress) | {"share": progress.share}})
        is_over = self._wall_s is not None and now - self._began >= self._wall_s
        return self._wall_s if is_over else None


def run_job(job: Mapping[str, Any]) -> dict[str, Any]:
    """Carry a job out, writing how far it is; returns the result. Jobs from before there were `bodies` have none."""
    teller = begin(job)
    scene, places, zones = scene_from_json(job["scene"])
    bodies = tuple(map(floor_zone_from_json, job.get("bodies", ())))
    conditions = Conditions(job.get("driver", "physics"), job.get("parameters", {}), bodies=bodies)
    plan = plan_from_json(job["plan"])
    return rehearse(plan, scene, places=places, zones=zones, conditions=conditions, follow=teller)


def begin(job: Mapping[str, Any]) -> Teller:
    """Say that its time begins, hold to the job's limits, and return who says how far it is."""
    limits = job.get("limits", {})
    _write({"begun": True})  # before it gives way to others: its start is not counted, and may take long beside them
    _hold_to(limits)
    return Teller(limits)


def _hold_to(limits: Mapping[str, Any]) -> None:
    """Give way to everything else, take no more memory than allowed, and end with the parent, also one that is killed.

    Linux sends the signal when the parent ends; elsewhere the process notices at its next word.
    """
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    if "memory_bytes" in limits:
        resource.setrlimit(resource.RLIMIT_AS, (limits["memory_bytes"], limits["memory_bytes"]))
    if "parent" in limits:
        os.nice(BEHIND_THE_RUNS)
        if sys.platform == "linux":
            ctypes.CDLL(None, use_errno=True).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


def _write(line: Mapping[str, Any]) -> None:
    sys.stdout.write(json.dumps(line) + "\n")
    sys.stdout.flush()


def main(run: Callable[[Mapping[str, Any]], Mapping[str, Any]] = run_job) -> int:
    """Read a job, write its lines; 0 when there is a result."""
    try:
        result = run(json.loads(sys.stdin.read()))
    except MemoryError:
        os.write(1, b'{"memory": true}\n')
        return 1
    except Exception as error:  # noqa: BLE001 - the edge of the process: the one who waits is told what went wrong
        _write({"error": f"The rehearsal broke off: {error or type(error).__name__}"})
        return 1
    _write({"result": result})
    return 0


if __name__ == "__main__":
    sys.exit(main())

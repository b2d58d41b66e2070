"""How fast the paint order is rehearsed, and how much of that is the physics itself."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

from bench.figures import figure
from execution.rehearsals.program_file import read_site, rehearse_program
from simulation import physics
from simulation.services import make_world
from vipo_site.cli.program_file import ProgramFile, read_program_file

ORDER = Path(__file__).resolve().parent.parent / "examples" / "paint-order.json"


def measure() -> Iterator[dict[str, object]]:
    file = read_program_file(ORDER, None)
    for driver in ("kinematic", "physics"):
        with _counted() as counter:
            began = time.perf_counter()
            result = rehearse_program(file.document, file.site, driver=driver)
            took_s = time.perf_counter() - began
        assert result["ok"], result["errors"]
        simulated_s = float(result["duration_s"])
        facts = {"program": "paint order", "driver": driver}
        yield figure("rehearsal", took_s, "s", simulated_s=simulated_s, **facts)
        yield figure("rehearsal", simulated_s / took_s, "x real time", **facts)
    bare_s = _bare(file, counter.count)
    yield figure("bare stepSimulation, the same scene and number of steps", bare_s, "s", steps=counter.count)
    yield figure("rehearsal beside the bare loop", took_s / bare_s, "times as long")


class _counted:
    """Counts the steps of the physics, so that the bare loop can make as many."""

    def __enter__(self) -> _counted:
        self.count, self._step = 0, physics.pybullet.stepSimulation
        physics.pybullet.stepSimulation = self._count
        return self

    def _count(self, **options: int) -> None:
        self.count += 1
        self._step(**options)

    def __exit__(self, *_: object) -> None:
        physics.pybullet.stepSimulation = self._step


def _bare(file: ProgramFile, steps: int) -> float:
    """Return how long the steps take when nobody drives, measures or decides; all robots are awake."""
    _, scene, _ = read_site(file.site, 0)
    world = make_world(scene=scene, driver="physics")
    client = world._driver._client  # type: ignore[attr-defined]
    began = time.perf_counter()
    for _ in range(steps):
        physics.pybullet.stepSimulation(physicsClientId=client)
    took_s = time.perf_counter() - began
    world.close()
    return took_s

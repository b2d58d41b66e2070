"""How fast the paint order is rehearsed, how much of that is the physics, and how long a shift takes in a test."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from bench.figures import figure
from editor.language import compile_document
from editor.language.plan.instructions import End, Instruction, Jump
from execution.rehearsals.program_file import read_site, rehearse_program
from execution.trials.trial import Expectation, Trial
from execution.trials.trial_run import Subject, run_trial
from simulation import physics
from simulation.services import make_world
from vipo_site.cli.program_file import ProgramFile, read_program_file

ORDER = Path(__file__).resolve().parent.parent / "examples" / "paint-order.json"

SHIFT_S = 8 * 3600.0
STOCK = {"itemInventory01": {"box": 1000}, "paintInventory01": {"can": 1000}}
ROOMY = 1000


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
    yield from _shift()


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


def _shift() -> Iterator[dict[str, object]]:
    """Measure what `vipo test` needs for eight hours in the paint shop, kinematic, on one core."""
    subject = _orders_without_end()
    trial = Trial("A shift", 1, (Expectation("fails", 1, "may never end"),), limit_s=SHIFT_S, stocks=STOCK)
    began, worked = time.perf_counter(), time.process_time()
    outcome = run_trial(trial, subject)
    took_s, cpu_s = time.perf_counter() - began, time.process_time() - worked
    assert outcome.ok, outcome.said
    assert outcome.duration_s >= SHIFT_S, outcome.said
    facts = {"program": "paint order, again and again", "driver": "kinematic", "simulated_s": outcome.duration_s}
    yield figure("vipo test of a shift", took_s, "s", cpu_s=round(cpu_s, 2), to_reach_s=60, **facts)
    yield figure("vipo test of a shift", outcome.duration_s / cpu_s, "x real time by processor time", **facts)


def _orders_without_end() -> Subject:
    """Return the paint order, begun anew whenever it has ended, with a sink that never is full."""
    file = read_program_file(ORDER, None)
    compiled = compile_document(file.document, file.surroundings)
    assert compiled.plan is not None
    _, scene, places = read_site(file.site, 0)
    again = tuple(
        Instruction(Jump(0)) if i.do == End() else i for i in compiled.plan.instructions
    )  # fmt: skip
    devices = [
        replace(d, properties=tuple(replace(p, maximum=ROOMY) if p.name == "freeSlots" else p for p in d.properties))
        for d in scene.devices
    ]
    plan = replace(compiled.plan, instructions=again)
    return Subject(plan, replace(scene, devices=devices), places, compiled.numbers, ())

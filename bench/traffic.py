"""How long the floor takes to plan a way, and to decide, with three and with ten robots in the painting factory."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import replace
from itertools import permutations
from math import hypot
from typing import Any

from bench.figures import figure, share
from editor.language import DeviceFacts, Surroundings, compile_document
from execution.rehearsals import rehearsal
from execution.rehearsals.rehearsal import Conditions, rehearse
from execution.traffic import floor
from execution.traffic.layout import Layout, NoSuchSpot, make_layout
from execution.traffic.path_planner import plan_path
from simulation.world import Scene
from tests.kit import demo_floor
from vipo_device.protocol.description import Description, Pose

MACHINES = tuple(device.id for device in demo_floor.devices() if device.kind == "machine")
VISITS = 3


def measure() -> Iterator[dict[str, object]]:
    yield from measure_routes(demo_floor.layout())
    for count in (3, 10):
        yield from measure_steps(count)


def measure_routes(layout: Layout) -> Iterator[dict[str, object]]:
    times = []
    for start, goal in permutations(sorted(layout.stations), 2):
        began = time.perf_counter()
        assert plan_path(layout, start, goal) is not None
        times.append((time.perf_counter() - began) * 1000)
    for name, quantile in (("p50", 0.5), ("p99", 0.99)):
        yield figure(f"plan a way between two machines, {name}", share(times, quantile), "ms", ways=len(times))


def measure_steps(robots: int) -> Iterator[dict[str, object]]:
    """Let each robot visit three machines, all at once, and time every decision of the floor."""
    devices, layout = _with_robots(robots)
    facts = {device.id: DeviceFacts(device, "approved", True) for device in devices}
    places = demo_floor.places()
    site = Surroundings(devices=facts, places={place.id: place for place in places})
    compiled = compile_document(_tour([d.id for d in devices if d.kind == "robot"]), site)
    assert compiled.plan is not None, [d.message for d in compiled.diagnostics][:3]
    times: list[float] = []

    def timed(*arguments: Any) -> Any:
        began = time.perf_counter()
        result = real(*arguments)
        times.append((time.perf_counter() - began) * 1000)
        return result

    real, rehearsal.floor.step = floor.step, timed
    try:
        scene = Scene(layout.ground.grid, devices)
        result = rehearse(compiled.plan, scene, places=places, conditions=Conditions("kinematic"))
    finally:
        rehearsal.floor.step = real
    assert result["ok"], result["errors"]
    for name, quantile in (("p50", 0.5), ("p99", 0.99), ("longest", 1.0)):
        yield figure(f"a decision of the floor, {name}", share(times, quantile), "ms", robots=robots,
                     decisions=len(times), simulated_s=result["duration_s"])  # fmt: skip


def _with_robots(count: int) -> tuple[list[Description], Layout]:
    """Return the factory's devices with that many robots, the first three in the docks, the others on free spots."""
    devices = [device for device in demo_floor.devices() if device.kind == "machine"]
    robots = [device for device in demo_floor.devices() if device.kind == "robot"]
    spots = _free_spots(demo_floor.layout(), [(robot.pose.x, robot.pose.y) for robot in robots])
    for number in range(len(robots) + 1, count + 1):
        x, y = next(spots)
        robots.append(replace(robots[0], id=f"robot{number:02}", name=f"TurtleBot {number}", pose=Pose(x, y)))
    devices += robots[:count]
    return devices, make_layout(demo_floor.grid(), devices, demo_floor.places())


def _free_spots(layout: Layout, taken: list[tuple[float, float]]) -> Iterator[tuple[float, float]]:
    taken = taken + [(spot.x, spot.y) for spot in layout.stations.values()]
    for row in range(2, 12):
        for column in range(3, 30):
            x, y = column * 0.75, -row * 0.75
            try:
                layout.spot(f"@{x:.3f},{y:.3f}")
            except NoSuchSpot:
                continue
            if all(hypot(x - a, y - b) > 1.5 for a, b in taken):
                taken.append((x, y))
                yield x, y


def _tour(robots: list[str]) -> dict[str, Any]:
    """Return a program in which every robot visits machines, each beginning at another one."""
    branches = [chr(ord("a") + index) for index in range(len(robots))]
    steps: dict[str, Any] = {
        "all": {"kind": "parallel", "place": ["program", "body", "V"], "pos": [0, 0], "params": {"branches": branches}}
    }
    for index, branch in enumerate(branches):
        for visit in range(VISITS):
            machine = MACHINES[(index + 2 * visit) % len(MACHINES)]
            steps[f"{branch}{visit}"] = {
                "kind": "move",
                "place": ["all", branch, f"{visit + 1}V"],
                "pos": [0, 0],
                "params": {"role": f"r{index}", "to": {"device": machine}},
            }
    roles = {f"r{index}": {"name": f"r{index}", "device": robot} for index, robot in enumerate(robots)}
    return {"format": 1, "steps": steps, "functions": {}, "roles": roles, "parameters": {}, "zones": {}}

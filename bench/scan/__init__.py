"""How well and how cheaply a robot maps a floor; more maps by `VIPO_SCAN_MAPS`, a folder with .yaml files."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from math import degrees
from pathlib import Path

from bench.figures import figure, share
from registry import services as registry
from registry.floorplan.plan import Grid
from simulation.mapping.floor import LidarSpec, TrueFloor
from simulation.mapping.map_maker import RobotSpec
from simulation.mapping.scores import score
from simulation.mapping.survey import Survey, SurveyPlan, run_survey
from tests.kit.floors.halls import bare_hall, generated_hall
from vipo_site.cli.scan import read_truth

SEEDS = (1, 2, 3, 4, 5)
LIDAR_M, SHORT_M = 8.0, 3.5


def measure() -> Iterator[dict[str, object]]:
    for name, grid in _floors():
        yield from _figures(name, grid, LIDAR_M)
    yield from _figures("an empty hall of 30 x 15 m", bare_hall(30.0, 15.0), SHORT_M)


def _floors() -> Iterator[tuple[str, Grid]]:
    yield "the painting factory", registry.get_demo_grid()
    yield "a hall from a seed", generated_hall(1)
    folder = os.environ.get("VIPO_SCAN_MAPS")
    for path in sorted(Path(folder).glob("*.yaml")) if folder else ():
        yield path.stem, read_truth(path)


def _figures(name: str, grid: Grid, lidar_m: float) -> Iterator[dict[str, object]]:
    floor, f1, iou, away, turned = TrueFloor(grid), [], [], [], []
    used_s = virtual_s = 0.0
    for seed in SEEDS:
        began = time.process_time()
        survey = _survey(grid, seed, lidar_m)
        used_s += time.process_time() - began
        virtual_s += survey.virtual_s
        scores = score(survey.grid, floor, survey.start)
        f1.append(scores.f1)
        iou.append(scores.iou)
        away.append(survey.largest_error[0])
        turned.append(degrees(survey.largest_error[1]))
    facts = {"floor": name, "lidar_m": lidar_m, "seeds": len(SEEDS)}
    middle = {name: round(share(values, 0.5), 4) for name, values in (("f1", f1), ("iou", iou))}
    yield figure("walls found, F1 at one cell, least of the seeds", min(f1), "share", median=middle["f1"], **facts)
    yield figure("free floor, IoU, least of the seeds", min(iou), "share", median=middle["iou"], **facts)
    yield figure("largest pose error", max(away), "m", degrees=round(max(turned), 3), **facts)
    yield figure(
        "processor time per virtual second", 1000 * used_s / virtual_s, "ms", virtual_s=round(virtual_s), **facts
    )


def _survey(grid: Grid, seed: int, lidar_m: float) -> Survey:
    return run_survey(SurveyPlan(grid, seed, RobotSpec(range_m=lidar_m), LidarSpec(range_m=lidar_m)))

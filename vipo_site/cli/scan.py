"""`vipo scan`: a robot maps a floor in simulation, and the map is held against the truth."""

from __future__ import annotations

import argparse
import time
from math import degrees, isfinite
from pathlib import Path

from registry.errors import RegistryError
from registry.floorplan.map_server import MAX_IMAGE_BYTES, MAX_YAML_BYTES, read_header, read_map, write_pgm, write_yaml
from registry.floorplan.plan import Grid
from simulation.mapping.floor import LidarSpec, TrueFloor
from simulation.mapping.map_maker import RobotSpec
from simulation.mapping.odometry import OdometrySpec
from simulation.mapping.scores import Scores, score
from simulation.mapping.survey import NoRoom, Survey, SurveyPlan, run_survey
from vipo_device.protocol.description import Pose
from vipo_site.cli.program_file import UnreadableFile
from vipo_site.cli.terminal import CLEAN, FAULTY, Unusable, refuse_seed, write, write_json

SIDES_M = (0.01, 0.25)
SHORTEST_M = 2.0
"""A lidar that sees less takes all that is near for looked at and goes nowhere, or loses where it is."""


def scan(options: argparse.Namespace) -> int:
    """Map the floor, write the map, print how good it is; return 0, or 1 when it was not finished.

    Raises:
        Unusable: the map cannot be used, or an option is out of bounds.
    """
    _check(options)
    truth = read_truth(options.map)
    if not SIDES_M[0] <= truth.resolution_m <= SIDES_M[1]:
        raise UnreadableFile(
            f"{options.map} has cells of {truth.resolution_m:g} m; a robot maps with cells of {SIDES_M[0]:g} to "
            f"{SIDES_M[1]:g} m. Save the map with such a resolution."
        )
    options.out.mkdir(parents=True, exist_ok=True)
    began = time.process_time()
    try:
        survey = run_survey(_plan(options, truth))
    except NoRoom as error:
        raise UnreadableFile(f"{options.map}: {error} Choose another place with --start X Y THETA.") from error
    processor_s = time.process_time() - began
    (options.out / "map.pgm").write_bytes(write_pgm(survey.grid))
    (options.out / "map.yaml").write_bytes(write_yaml(survey.grid, "map.pgm"))
    scores = score(survey.grid, TrueFloor(truth), survey.start)
    body = figures(survey, scores, processor_s)
    if options.json:
        write_json({"map": str(options.map), "seed": options.seed, "lidar_m": options.lidar, **body})
    else:
        _tell(options, body, is_barred=survey.is_barred)
    return CLEAN if survey.is_whole else FAULTY


def _check(options: argparse.Namespace) -> None:
    """Refuse options that no robot has. Raises Unusable."""
    refuse_seed(options.seed)
    if not SHORTEST_M <= options.lidar <= 40:
        raise _bad_option(f"--lidar {options.lidar:g} is out of bounds; choose {SHORTEST_M:g} to 40 metres.")
    if not 0 <= options.odometry <= 0.3:
        raise _bad_option(f"--odometry {options.odometry:g} is out of bounds; choose 0 to 0.3 (0.05 is 5 %).")
    if options.start is not None and not all(isfinite(value) for value in options.start):
        raise _bad_option("--start takes three numbers: x and y in metres, theta in radians.")


def _bad_option(detail: str) -> Unusable:
    return Unusable(detail, "bad_option")


def read_truth(path: Path) -> Grid:
    """Return the map of a .yaml file, whose image lies beside it.

    Raises:
        UnreadableFile: one of the two cannot be read, or is no map.
    """
    try:
        text = _read(path, MAX_YAML_BYTES)
        return read_map(text, _read(path.parent / read_header(text).image, MAX_IMAGE_BYTES))
    except RegistryError as error:
        raise UnreadableFile(f"{path}: {error}") from error


def _read(path: Path, most: int) -> bytes:
    """Return a file's bytes, at most one more than it may have, which then is refused by who reads them."""
    try:
        with path.open("rb") as file:
            return file.read(most + 1)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise UnreadableFile(f"{path} cannot be read: {reason}.") from error


def _plan(options: argparse.Namespace, truth: Grid) -> SurveyPlan:
    start = None if options.start is None else Pose(options.start[0], options.start[1], 0.0, options.start[2])
    return SurveyPlan(
        truth,
        options.seed,
        RobotSpec(range_m=options.lidar, odometry_noise=options.odometry),
        LidarSpec(range_m=options.lidar),
        OdometrySpec(noise=options.odometry),
        start,
    )


def figures(survey: Survey, scores: Scores, processor_s: float) -> dict[str, object]:
    """Return what is said of a survey, rounded: metres, degrees, seconds, shares from 0 to 1."""
    return {
        "is_whole": survey.is_whole,
        "f1": round(scores.f1, 4),
        "precision": round(scores.precision, 4),
        "recall": round(scores.recall, 4),
        "iou": round(scores.iou, 4),
        "pose_error": {
            name: {"m": round(way, 4), "deg": round(degrees(turn), 3)} for name, way, turn in _errors(survey)
        },
        "driven_m": round(survey.driven_m, 2),
        "virtual_s": round(survey.virtual_s, 1),
        "processor_s": round(processor_s, 2),
        "scans": survey.scans,
        "points_given_up": survey.given_up,
        "bumps": survey.bumps,
        "size_cells": [survey.grid.width, survey.grid.height],
        "start": [round(survey.start.x, 4), round(survey.start.y, 4), round(survey.start.theta, 4)],
    }


def _errors(survey: Survey) -> tuple[tuple[str, float, float], ...]:
    return ("final", *survey.final_error), ("largest", *survey.largest_error)


def _tell(options: argparse.Namespace, body: dict[str, object], *, is_barred: bool) -> None:
    errors = body["pose_error"]
    assert isinstance(errors, dict)
    write(f"Walls found (F1, one cell)  {body['f1']}")
    write(f"Free floor (IoU)            {body['iou']}")
    for name in ("final", "largest"):
        write(f"Pose error, {name:<7}         {errors[name]['m']} m, {errors[name]['deg']} degrees")
    write(f"Driven                      {body['driven_m']} m in {body['virtual_s']} s")
    write(f"Processor                   {body['processor_s']} s")
    write(f"Written                     {options.out / 'map.yaml'}, {options.out / 'map.pgm'}")
    if is_barred:
        write(
            "The map is not whole: the robot did not get through a narrow place behind which there is more to see. "
            "Let it begin where it has more room, with --start X Y THETA."
        )
    elif not body["is_whole"]:
        write("The map is not whole: the time was over before the robot had seen all that it can reach.")

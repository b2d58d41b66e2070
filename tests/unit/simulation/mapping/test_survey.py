"""A robot maps a floor: whole, without touching anything, and the same again for the same seed."""

from __future__ import annotations

from dataclasses import replace
from math import degrees

import numpy as np
import pytest

from registry.floorplan.plan import FREE, OCCUPIED, UNKNOWN, Grid, cells_array
from simulation.mapping.floor import TrueFloor
from simulation.mapping.map_maker import MapMaker, RobotSpec
from simulation.mapping.scores import on_raster, score
from simulation.mapping.survey import NoRoom, SurveyPlan, run_survey
from tests.kit.floors.halls import bare_hall
from vipo_device.protocol.description import Pose


def two_rooms(gap_m: float) -> Grid:
    """Two rooms of 3 by 4 metres with a gap of that width in the wall between."""
    grid = bare_hall(6.2, 4.0)
    cells = cells_array(grid).copy()
    wall, gap = slice(60, 64), round(gap_m / grid.resolution_m)
    cells[:, wall] = OCCUPIED
    cells[40 : 40 + gap, wall] = FREE
    cells[20:26, 90:98] = OCCUPIED
    return replace(grid, cells=cells.tobytes())


def test_two_rooms_are_mapped_as_well_as_promised_without_a_bump() -> None:
    grid = two_rooms(0.8)
    grown: list[int] = []

    def watch(_: float, maker: MapMaker) -> None:
        grown.append(int(np.count_nonzero(maker.occupancy.odds < 0)))

    survey = run_survey(SurveyPlan(grid, seed=4, start=Pose(1.0, 1.0)), watch)
    found = score(survey.grid, TrueFloor(grid), survey.start)
    assert survey.is_whole
    assert survey.bumps == 0
    assert found.f1 >= 0.95
    assert found.iou >= 0.97
    assert survey.largest_error[0] <= 0.05
    assert degrees(survey.largest_error[1]) <= 1.0
    assert survey.driven_m > 3.0
    assert grown[-1] > 1.2 * grown[0]


def test_the_same_seed_gives_the_same_bytes_and_another_one_others() -> None:
    grid = bare_hall(5.0, 4.0)
    first, again, other = (run_survey(SurveyPlan(grid, seed)) for seed in (1, 1, 2))
    assert first == again
    assert first.grid.cells != other.grid.cells


def test_a_room_behind_a_gap_that_is_too_narrow_is_given_up() -> None:
    survey = run_survey(SurveyPlan(two_rooms(0.15), seed=1, start=Pose(1.0, 1.0)))
    assert survey.is_whole
    assert survey.given_up > 0
    assert survey.bumps == 0
    assert survey.virtual_s < 600


def test_a_survey_that_takes_too_long_says_that_it_is_not_whole() -> None:
    survey = run_survey(SurveyPlan(two_rooms(0.8), seed=1, start=Pose(1.0, 1.0), longest_s=5.0))
    assert not survey.is_whole
    assert survey.virtual_s == pytest.approx(5.0, abs=0.2)


def test_a_robot_that_does_not_fit_is_told_so() -> None:
    with pytest.raises(NoRoom, match=r"A robot with a radius of 0\.3 m does not fit at \(0\.3, 1\)\."):
        run_survey(SurveyPlan(bare_hall(4.0, 4.0), 1, RobotSpec(radius_m=0.3), start=Pose(0.3, 1.0)))


def test_scores_of_the_truth_are_full_and_of_a_shifted_map_are_not() -> None:
    grid = bare_hall(5.0, 4.0)
    floor, start = TrueFloor(grid), Pose(1.0, 1.0)
    assert score(grid, floor, start).f1 == 1.0
    assert score(grid, floor, start).iou == 1.0
    shifted = replace(grid, origin_x_m=0.15)
    assert score(shifted, floor, start).f1 < 0.8
    assert score(shifted, floor, start).iou < 0.97
    nothing = replace(grid, cells=bytes([UNKNOWN]) * len(grid.cells))
    assert (score(nothing, floor, start).f1, score(nothing, floor, start).iou) == (0.0, 0.0)


def test_a_map_is_laid_on_the_truths_raster() -> None:
    truth = bare_hall(2.0, 1.0)
    piece = Grid(2, 1, 0.05, 0.1, 0.5, bytes((OCCUPIED, FREE)))
    cells = on_raster(piece, truth)
    assert cells.shape == (22, 42)
    assert cells[11, 3] == OCCUPIED
    assert cells[11, 4] == FREE
    assert np.count_nonzero(cells != UNKNOWN) == 2

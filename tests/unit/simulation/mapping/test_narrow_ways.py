"""A robot leaves a narrow place in which it begins, and says so where it does not get out or through."""

from __future__ import annotations

from dataclasses import replace
from math import hypot

import pytest

from registry.floorplan.plan import FREE, OCCUPIED, Grid, cells_array
from simulation.mapping.floor import TrueFloor
from simulation.mapping.scores import score
from simulation.mapping.survey import Expedition, SurveyPlan, run_survey
from tests.kit.floors.halls import bare_hall, hall_with_a_bay
from vipo_device.protocol.description import Pose


@pytest.mark.parametrize("wide_m", [0.35, 0.4, 0.5, 0.55, 0.6, 0.7])
def test_a_robot_that_begins_in_a_bay_maps_the_hall_before_it_and_comes_back(wide_m: float) -> None:
    grid, start = hall_with_a_bay(wide_m)
    expedition = Expedition(SurveyPlan(grid, 1, start=start, longest_s=600.0))
    while not expedition.is_over:
        expedition.tick()
    survey, at = expedition.survey(), expedition.pose
    assert (survey.is_whole, survey.is_barred, survey.bumps) == (True, False, 0)
    assert score(survey.grid, TrueFloor(grid), start).iou >= 0.97
    assert hypot(at.x - start.x, at.y - start.y) <= 0.75


@pytest.mark.parametrize("wide_m", [0.25, 0.3])
def test_a_map_is_not_whole_where_the_robot_does_not_get_out_of_its_bay(wide_m: float) -> None:
    grid, start = hall_with_a_bay(wide_m)
    survey = run_survey(SurveyPlan(grid, 1, start=start, longest_s=600.0))
    assert (survey.is_whole, survey.is_barred) == (False, True)


def test_a_bay_of_a_map_in_fine_cells_is_left_too() -> None:
    """The map's cells are thinned there."""
    grid, start = hall_with_a_bay(0.45)
    fine = cells_array(grid)[:64].repeat(2, axis=0).repeat(2, axis=1)
    half = Grid(fine.shape[1], fine.shape[0], 0.025, 0.0, 0.0, fine.tobytes())
    survey = run_survey(SurveyPlan(half, 1, start=start, longest_s=600.0))
    assert survey.is_whole
    assert score(survey.grid, TrueFloor(half), start).iou >= 0.97


def shut_in(gap_m: float) -> Grid:
    """A hall with a cell of 0.8 m in it, whose wall has a gap of that width."""
    grid = bare_hall(5.0, 4.0)
    cells = cells_array(grid).copy()
    cells[30:50, 30:50] = OCCUPIED
    cells[32:48, 32:48] = FREE
    cells[39 : 39 + round(gap_m / grid.resolution_m), 48:50] = FREE
    return replace(grid, cells=cells.tobytes())


@pytest.mark.parametrize("gap_m", [0.05, 0.1, 0.15])
def test_what_is_seen_through_a_gap_that_is_narrower_than_the_robot_cannot_be_reached(gap_m: float) -> None:
    survey = run_survey(SurveyPlan(shut_in(gap_m), 1, start=Pose(2.0, 2.0), longest_s=600.0))
    assert (survey.is_whole, survey.is_barred, survey.bumps) == (True, False, 0)


def test_a_room_behind_a_door_that_is_hardly_wider_than_the_robot_is_mapped() -> None:
    grid = bare_hall(6.2, 3.0)
    cells = cells_array(grid).copy()
    cells[:, 60:64] = OCCUPIED
    cells[25:34, 60:64] = FREE
    grid = replace(grid, cells=cells.tobytes())
    survey = run_survey(SurveyPlan(grid, 1, start=Pose(1.5, 1.0), longest_s=600.0))
    assert survey.is_whole
    assert score(survey.grid, TrueFloor(grid), survey.start).iou >= 0.97

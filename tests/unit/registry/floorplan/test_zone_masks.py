"""Nav2's masks are read here as Nav2 reads them: the image by Pillow, the header by PyYAML, values by its formula."""

import io
import zipfile
from dataclasses import dataclass

import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from registry.floorplan.plan import Grid
from registry.floorplan.polygons import crosses_itself, is_in
from registry.floorplan.zone_masks import cells_touched, speed_mask, write_nav2_archive

GRID = Grid(40, 30, 0.05, -1.0, 0.5, bytes(1200))


@dataclass(frozen=True)
class Zone:
    rule: str
    points: tuple[tuple[float, float], ...]
    speed_m_s: float | None = None


def box(x1, y1, x2, y2):
    return ((x1, y1), (x2, y1), (x2, y2), (x1, y2))


def served(archive, name):
    """What map_server publishes of a mask: rows from the bottom, 0 to 100; with its resolution and origin."""
    header = yaml.safe_load(archive.read(f"{name}_mask.yaml"))
    image = np.asarray(Image.open(io.BytesIO(archive.read(header["image"])))).astype(float)
    assert (header["mode"], header["negate"]) == ("scale", 0)
    occupancy = (255 - image) / 255
    low, high = header["free_thresh"], header["occupied_thresh"]
    values = np.rint((occupancy - low) / (high - low) * 100)
    return np.flipud(values).astype(int), header["resolution"], header["origin"]


def opened(zones, grid=GRID):
    return zipfile.ZipFile(io.BytesIO(write_nav2_archive(grid, zones)))


def test_masks_lie_on_the_map_cell_for_cell():
    archive = opened([Zone("keep_out", box(-0.9, 0.6, -0.8, 0.7)), Zone("slow", box(0, 1, 0.5, 1.5), 0.3)])
    for name in ("keepout", "speed"):
        values, resolution, origin = served(archive, name)
        assert (values.shape, resolution, origin) == ((30, 40), 0.05, [-1.0, 0.5, 0])
    shut = served(archive, "keepout")[0]
    assert set(np.unique(shut)) == {0, 100}
    assert shut[2:4, 2:4].min() == 100
    assert shut[5:].max() == 0


def test_what_the_filters_are_told_gives_the_speeds_back():
    zones = [Zone("slow", box(-1, 0.5, 0, 1), 0.3), Zone("slow", box(-0.5, 0.5, 0.5, 1), 0.25)]
    archive = opened(zones)
    told = yaml.safe_load(archive.read("costmap_filters.yaml"))
    keepout, speed = (told[f"{n}_costmap_filter_info_server"]["ros__parameters"] for n in ("keepout", "speed"))
    assert (keepout["type"], keepout["base"], keepout["multiplier"], speed["type"]) == (0, 0.0, 1.0, 2)
    values = served(archive, "speed")[0]
    limits = speed["base"] + speed["multiplier"] * values
    assert limits[3, 2] == pytest.approx(0.3)
    assert limits[3, 15] == pytest.approx(0.25)  # where both lie the slower holds
    assert limits[3, 25] == pytest.approx(0.25)
    assert values[20, 35] == 0
    for name in ("keepout", "speed"):
        server = told[f"{name}_filter_mask_server"]["ros__parameters"]
        info = told[f"{name}_costmap_filter_info_server"]["ros__parameters"]
        heeds = told["global_costmap"]["global_costmap"]["ros__parameters"]
        assert server["topic_name"] == info["mask_topic"]
        assert heeds[f"{name}_filter"]["filter_info_topic"] == info["filter_info_topic"]
        assert f"{name}_filter" in heeds["filters"]


def test_speeds_that_no_value_stands_for_are_rounded_down_and_never_to_no_limit():
    zones = [Zone("slow", box(0, 1, 0.2, 1.2), 5.0), Zone("slow", box(0.5, 1, 0.7, 1.2), 0.051)]
    mask, multiplier = speed_mask(GRID, zones)
    assert mask.max() * multiplier == pytest.approx(5.0)
    slow = mask[12, 32] * multiplier
    assert 0 < slow <= 0.051


def test_a_site_without_zones_has_masks_that_forbid_nothing():
    archive = opened([Zone("one_at_a_time", box(0, 1, 1, 2))])
    assert served(archive, "keepout")[0].max() == served(archive, "speed")[0].max() == 0


@settings(max_examples=20, deadline=None)
@given(st.lists(st.tuples(st.floats(-1.5, 1.5), st.floats(0, 2.5)), min_size=3, max_size=7))
def test_a_cell_is_of_a_zone_if_the_zone_touches_it(corners):
    outline = tuple((round(x, 2), round(y, 2)) for x, y in corners)
    if crosses_itself(outline):
        return
    touched = cells_touched(GRID, outline)
    for row in range(0, 30, 3):
        for column in range(0, 40, 3):
            x, y = -1.0 + column * 0.05, 0.5 + row * 0.05
            inside = [is_in((x + dx, y + dy), outline) for dx in (0.002, 0.025, 0.048) for dy in (0.002, 0.025, 0.048)]
            assert touched[row, column] or not any(inside)
    starts, ends = np.array(outline), np.array((*outline[1:], outline[0]))
    along = (starts[:, None] + (ends - starts)[:, None] * np.linspace(0, 1, 201)[None, :, None]).reshape(-1, 2)
    for row, column in zip(*np.nonzero(touched), strict=True):
        x, y = -1.0 + (column + 0.5) * 0.05, 0.5 + (row + 0.5) * 0.05
        near = (np.abs(along - (x, y)) <= 0.025 + 0.02).all(axis=1).any()
        assert near or is_in((x, y), outline)

"""Maps that are made to cost much: what they cost is counted, in memory and in lines of Python."""

from __future__ import annotations

import tracemalloc

import numpy as np
import pytest

from registry.floorplan.map_server import MOST_COMMENTS, BadMap, read_header, read_map
from registry.floorplan.plan import MOST_RUNS, Grid, cells_array, wall_boxes
from tests.kit.work import count_work

SIDE = 2000
CELLS = SIDE * SIDE
HEADER = b"image: a.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n"
TURNED = b"image: a.pgm\nresolution: 0.05\norigin: [0, 0, 0.3]\n"
IN_TEXT = b"P2 %d %d 1\n" % (SIDE, SIDE) + b"0 1 " * (CELLS // 2)
IN_BYTES = b"P5 %d %d 1\n" % (SIDE, SIDE) + b"\0\1" * (CELLS // 2)


@pytest.mark.parametrize(("header", "image"), [(HEADER, IN_TEXT), (HEADER, IN_BYTES), (TURNED, IN_BYTES)])
def test_a_large_map_takes_a_few_bytes_for_each_cell_and_no_line_of_its_own(header: bytes, image: bytes) -> None:
    tracemalloc.start()
    try:
        with count_work() as work:
            grid = read_map(header, image)
        kept, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 6 * max(CELLS, grid.width * grid.height) + 40_000_000
    assert kept < 1.1 * grid.width * grid.height + 1_000_000
    assert work.lines < 20_000


def test_a_text_is_read_as_bytes_are() -> None:
    assert read_map(HEADER, IN_TEXT).cells == read_map(HEADER, IN_BYTES).cells


def test_no_more_is_read_than_the_header_says() -> None:
    grid = read_map(HEADER, b"P2 2 1 1\n0 1" + b" 1" * 1_000_000)
    assert grid.cells == bytes([100, 0])


@pytest.mark.parametrize("image", [b"P2 5000 5000 1\n0", b"P5 4096 4097 255\n"])
def test_the_size_is_looked_at_before_anything_is_decoded(image: bytes) -> None:
    with pytest.raises(BadMap, match="4096 x 4096 is the most"):
        read_map(HEADER, image)


def test_numbers_and_comments_are_read_wherever_a_piece_of_the_text_ends() -> None:
    wide = b"P2 4 1 255\n" + b" " * 300_000 + b"254 # " + b"x" * 300_000 + b"\n0" + b"\n" * 300_000 + b"205 254"
    assert read_map(HEADER, wide).cells == bytes([0, 100, 255, 0])


@pytest.mark.parametrize(
    ("body", "why"),
    [
        (b"#\n" * (MOST_COMMENTS + 1) + b"1", "more than 1000 comments"),
        (b"1" * 600_000, "not a number"),
        (b"0x10 -1", "not a number"),
        (b"1\0", "not a number"),
    ],
)
def test_a_text_that_is_none_is_refused(body: bytes, why: str) -> None:
    with pytest.raises(BadMap, match=why):
        read_map(HEADER, b"P2 2 1 1\n" + body)


def test_a_speckled_map_has_a_bounded_number_of_walls_that_cover_it() -> None:
    speckled = np.zeros((1001, 1003), dtype=np.uint8)
    speckled[::2, ::2] = 100
    grid = Grid(1003, 1001, 1.0, 0.0, 0.0, speckled.tobytes())
    with count_work() as work:
        walls = wall_boxes(grid)
    assert 0 < len(walls) <= MOST_RUNS
    assert work.lines < 60 * MOST_RUNS
    covered = np.zeros_like(speckled)
    for x1, y1, x2, y2 in walls:
        covered[int(y1) : int(y2), int(x1) : int(x2)] = 100
    assert ((covered == 100) | (speckled == 0)).all()
    assert cells_array(grid)[0, 0] == 100


@pytest.mark.parametrize("written", ["1:30", "0:0.05", "1:30.5", "-1:30"])
def test_a_number_to_the_base_of_sixty_is_none(written: str) -> None:
    with pytest.raises(BadMap, match=f"resolution is '{written}', which is not a number"):
        read_header(f"image: a.pgm\nresolution: {written}\norigin: [0, 0, 0]\n".encode())
    with pytest.raises(BadMap, match=f"origin is '{written}', which is not a number"):
        read_header(f"image: a.pgm\nresolution: 0.05\norigin: [0, {written}, 0]\n".encode())

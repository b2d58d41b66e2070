"""Maps that are made to cost much: what they cost is counted, in memory and in lines of Python."""

from __future__ import annotations

import io
import struct
import tracemalloc
import zlib

import numpy as np
import pytest
from PIL import Image

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


def chunk(kind: bytes, body: bytes) -> bytes:
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def png_of(*chunks: tuple[bytes, bytes]) -> bytes:
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunk(*each) for each in chunks)


def size(width: int, height: int) -> tuple[bytes, bytes]:
    return b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)


PIXEL, END = (b"IDAT", zlib.compress(b"\0\xfe")), (b"IEND", b"")


@pytest.mark.parametrize("side", [4097, 9460, 10_000, 14_000, 2**31 - 1])
def test_a_png_that_is_too_large_is_told_its_size_whatever_the_decoder_thinks_of_it(side: int) -> None:
    with pytest.raises(BadMap, match=f"{side} x {side} cells; 4096 x 4096 is the most"):
        read_map(HEADER, png_of(size(side, side), PIXEL, END))


@pytest.mark.parametrize(
    "chunks",
    [
        (size(1, 1), size(10_000, 10_000), PIXEL, END),
        (size(1, 1), size(14_000, 14_000), PIXEL, END),
        (size(1, 1), PIXEL, (b"iCCP", b""), END),
    ],
    ids=["says_89_million_pixels_later", "says_179_million_pixels_later", "odd_part_after_the_pixels"],
)
def test_a_png_that_is_odd_inside_is_damaged(chunks: tuple[tuple[bytes, bytes], ...]) -> None:
    with pytest.raises(BadMap, match="PNG image is damaged"):
        read_map(HEADER, png_of(*chunks))


def test_the_size_of_a_png_is_read_where_a_writer_puts_it() -> None:
    out = io.BytesIO()
    Image.new("L", (3, 2), 254).save(out, "PNG")
    grid = read_map(HEADER, out.getvalue())
    assert (grid.width, grid.height) == (3, 2)


@pytest.mark.parametrize("value", ["!!float ''", "!!int ''", "!!bool x", "!!timestamp foo", "!!float x", "2026-13-45"])
def test_a_value_that_does_not_fit_its_tag_is_a_header_that_cannot_be_read(value: str) -> None:
    with pytest.raises(BadMap, match="cannot be read"):
        read_header(HEADER + f"other: {value}\n".encode())


@pytest.mark.parametrize("digits", ["0x" + "f" * 5000, "9" * 5000, "0b" + "1" * 30_000])
def test_a_number_of_thousands_of_digits_is_told_as_it_is_written(digits: str) -> None:
    for name in ("resolution", "occupied_thresh", "negate", "mode"):
        with pytest.raises(BadMap, match=f"{name} is '{digits[:40]}"):
            read_header(HEADER + f"{name}: {digits}\n".encode())
    assert read_header(HEADER + f"other: {digits}\n".encode()).image == "a.pgm"


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


@pytest.mark.parametrize("yaw", [0, 0.7])
def test_a_map_of_square_kilometres_is_refused_however_few_its_cells_are(yaw: float) -> None:
    header = f"image: map.pgm\nresolution: 10\norigin: [0, 0, {yaw}]\n".encode()
    image = b"P5 400 300 255\n" + b"\xfe" * 120_000
    with pytest.raises(BadMap, match=r"m² of floor; .*Check its resolution \(metres a cell\), or cut it\.$"):
        read_map(header, image)
    assert read_map(header.replace(b"10", b"1"), image).resolution_m == 1

from __future__ import annotations

import io
from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from registry.floorplan.map_server import BadMap, read_header, read_map, write_pgm, write_yaml
from registry.floorplan.plan import Grid, cells_array

HEADER = (
    b"image: a.pgm\nresolution: 0.05\norigin: [-1.0, -2.0, 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
)
FREE, WALL, FOG = 0, 100, 255


def header(**changes: object) -> bytes:
    lines = dict(line.split(": ", 1) for line in HEADER.decode().splitlines())
    lines.update({k: str(v) for k, v in changes.items()})
    return "\n".join(f"{k}: {v}" for k, v in lines.items()).encode()


def cells(yaml: bytes, image: bytes) -> list[list[int]]:
    found: list[list[int]] = np.flipud(cells_array(read_map(yaml, image))).tolist()
    return found


def png(mode: str, pixels: list[object], size: tuple[int, int]) -> bytes:
    image, out = Image.new(mode, size), io.BytesIO()
    image.putdata(pixels)
    image.save(out, "PNG")
    return out.getvalue()


def test_a_binary_map_is_read_with_its_place_in_the_world() -> None:
    grid = read_map(HEADER, b"P5\n2 2\n255\n" + bytes([254, 0, 205, 254]))
    assert grid == Grid(2, 2, 0.05, -1.0, -2.0, bytes([FOG, FREE, FREE, WALL]))


@pytest.mark.parametrize("rows", [1, 300])
def test_what_map_saver_of_ros_2_does_not_know_is_unknown_whatever_its_threshold_says(rows: int) -> None:
    theirs = header(free_thresh=0.25)
    saved = f"P5 4 {rows} 255\n".encode() + bytes([254, 0, 205, 255] * rows)
    assert cells(theirs, saved) == [[FREE, WALL, FOG, FREE]] * rows
    assert cells(theirs, png("L", [254, 0, 205, 255] * rows, (4, rows))) == [[FREE, WALL, FOG, FREE]] * rows
    scanned = saved[:-4] + bytes([254, 0, 205, 230])
    assert cells(theirs, scanned) == [[FREE, WALL, FREE, FREE]] * rows, "a plan with other greys in any of its rows"
    assert cells(header(free_thresh=0.25, mode="scale"), saved) == [[FREE, WALL, FREE, FREE]] * rows


def test_comments_may_stand_anywhere_in_the_header() -> None:
    body = b"P5\n# CREATOR: map_saver 0.05 m/pix\n2 # columns\n1\n#more\n255\n" + bytes([254, 0])
    assert cells(HEADER, body) == [[FREE, WALL]]


def test_a_cell_that_looks_like_white_space_is_not_eaten() -> None:
    assert cells(HEADER, b"P5 2 1 255\n" + bytes([10, 32])) == [[WALL, WALL]]


def test_text_maps_and_small_largest_values_are_read() -> None:
    assert cells(HEADER, b"P2\n#c\n3 1\n2\n2 1 0 # end") == [[FREE, FOG, WALL]]


def test_two_byte_cells_are_read() -> None:
    assert cells(HEADER, b"P5 2 1 65535\n\xff\xff\x00\x00") == [[FREE, WALL]]


def test_negate_turns_light_into_wall() -> None:
    assert cells(header(negate=1), b"P5 2 1 255\n" + bytes([254, 0])) == [[WALL, FREE]]


def test_see_through_cells_are_unknown() -> None:
    assert cells(HEADER, png("LA", [(255, 255), (0, 255), (255, 0)], (3, 1))) == [[FREE, WALL, FOG]]
    assert cells(HEADER, png("RGBA", [(255, 255, 255, 255), (0, 0, 0, 255), (0, 0, 0, 0)], (3, 1))) == [
        [FREE, WALL, FOG]
    ]


def test_colour_grey_palette_bilevel_and_deep_pngs_are_read() -> None:
    assert cells(HEADER, png("RGB", [(255, 255, 255), (0, 0, 0)], (2, 1))) == [[FREE, WALL]]
    assert cells(HEADER, png("1", [255, 0], (2, 1))) == [[FREE, WALL]]
    assert cells(HEADER, png("I;16", [65535, 0], (2, 1))) == [[FREE, WALL]]


def test_raw_maps_hold_the_share_in_per_cent() -> None:
    assert cells(header(mode="raw"), b"P5 4 1 255\n" + bytes([0, 100, 50, 255])) == [[FREE, WALL, FOG, FOG]]


def test_scale_maps_are_judged_by_the_thresholds() -> None:
    assert cells(header(mode="Scale"), b"P5 3 1 255\n" + bytes([255, 128, 0])) == [[FREE, FOG, WALL]]


def test_whole_numbers_missing_thresholds_and_unknown_keys_are_fine() -> None:
    found = read_header(b"image: m.png\nresolution: 1\norigin: [-15, 2]\nlayers: {a: [1]}\n")
    assert (found.origin, found.occupied_thresh, found.free_thresh, found.mode) == (
        (-15.0, 2.0, 0.0),
        0.65,
        0.196,
        "trinary",
    )


def test_a_turned_map_is_put_upright() -> None:
    turned = header(origin=f"[1.0, 2.0, {pi / 2}]", resolution=1)
    grid = read_map(turned, b"P5 3 1 255\n" + bytes([254, 254, 0]))
    assert (grid.width, grid.height) == (1, 3)
    assert (round(grid.origin_x_m, 6), round(grid.origin_y_m, 6)) == (0.0, 2.0)
    assert list(grid.cells) == [FREE, FREE, WALL]


def test_writing_and_reading_again_gives_the_same_grid() -> None:
    grid = Grid(3, 2, 0.05, -0.5, -13.9, bytes([FREE, WALL, FOG, FOG, FREE, WALL]))
    assert read_map(write_yaml(grid, "a.pgm"), write_pgm(grid)) == grid


@pytest.mark.parametrize(
    ("yaml", "says"),
    [
        (b"\xff\xfe\x00", "cannot be read"),
        (b"image: [", "cannot be read"),
        (b"just words", "not a map's header"),
        (b"a: &a [1]\nb: *a\n", "aliases"),
        (b"x: " + b"[" * 5000, "nested too deeply"),
        (b"x: " + b"- " * 5000, "cannot be read"),
        (b"#" * 70000, "larger than 64 kB"),
        (b"!!python/object/apply:os.system ['true']", "cannot be read"),
        (header(resolution="fast"), "'fast', which is not a number"),
        (header(resolution=".nan"), "not a number"),
        (header(resolution=0), "between 0.001 and 10"),
        (header(resolution="true"), "not a number"),
        (header(origin="[1, 2, x]"), "not a number"),
        (header(origin="7"), "three numbers"),
        (header(origin="[1.0e+9, 0, 0]"), "million metres"),
        (header(negate=3), "negate"),
        (header(mode="fancy"), "trinary, scale or raw"),
        (header(image=""), "names no image"),
        (header(free_thresh=0.9), "thresholds"),
        (b"resolution: 0.05\norigin: [0, 0, 0]\n", "names no image"),
        (b"image: a.pgm\norigin: [0, 0, 0]\n", "has no resolution"),
    ],
)
def test_a_bad_header_is_refused_with_what_is_wrong(yaml: bytes, says: str) -> None:
    with pytest.raises(BadMap, match=says):
        read_header(yaml)


@pytest.mark.parametrize(
    ("image", "says"),
    [
        (None, "'a.pgm' is missing"),
        (b"", "is missing"),
        (b"GIF89a", "neither PGM"),
        (b"P5", "header is damaged"),
        (b"P5 2", "header is damaged"),
        (b"P5 a b c ", "header is damaged"),
        (b"P5 99999 99999 255\n", "4096 x 4096 is the most"),
        (b"P5 999999999999 1 255\n", "header is damaged"),
        (b"P5 0 1 255\n", "is empty"),
        (b"P5 2 2 0\n1234", "largest value"),
        (b"P5 2 2 70000\n1234", "largest value"),
        (b"P5 2 2 255\n12", "ends early: 2 of 4"),
        (b"P2 2 1 255\n1 two", "not a number"),
        (b"\x89PNG\r\n\x1a\n" + b"\x00" * 30, "PNG image is damaged"),
    ],
)
def test_a_bad_image_is_refused_with_what_is_wrong(image: bytes | None, says: str) -> None:
    with pytest.raises(BadMap, match=says):
        read_map(HEADER, image)


def test_a_png_that_claims_to_be_huge_is_refused_before_it_is_unpacked() -> None:
    whole = bytearray(png("L", [0], (1, 1)))
    whole[16:24] = (60000).to_bytes(4, "big") * 2
    with pytest.raises(BadMap):
        read_map(HEADER, bytes(whole))


@given(st.binary(max_size=300), st.binary(max_size=300))
def test_no_bytes_bring_more_than_a_refusal(yaml: bytes, image: bytes) -> None:
    refusals: list[str] = []
    for first, second in (
        (yaml, image),
        (HEADER, image),
        (HEADER, b"P5 3 3 255\n" + image),
        (HEADER, b"P2 2 2 9 " + image),
    ):
        try:
            read_map(first, second)
        except BadMap as error:
            refusals.append(error.detail)
    assert all(sentence.endswith(".") for sentence in refusals)

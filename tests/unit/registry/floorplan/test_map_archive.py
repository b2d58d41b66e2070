"""Maps in zip archives: read like their two files, and never unpacked beyond what a map may have."""

from __future__ import annotations

import io
import tracemalloc
import zipfile

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from registry.floorplan.map_archive import MOST_ENTRIES, open_archive
from registry.floorplan.map_server import MAX_IMAGE_BYTES, BadMap, read_map, write_pgm, write_yaml
from registry.floorplan.plan import Grid

HEADER = b"image: maps/a.pgm\nresolution: 0.05\norigin: [-1, -2, 0]\n"
IMAGE = b"P5 2 1 255\n" + bytes([254, 0])


def pack(files: dict[str, bytes]) -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, body in files.items():
            archive.writestr(name, body)
    return out.getvalue()


def test_the_image_is_found_by_its_name_wherever_it_stands() -> None:
    litter = {"__MACOSX/._hall.yaml": b"x", "hall/.hidden.yaml": b"y", "hall/readme.txt": b"z"}
    packed = pack({**litter, "hall/hall.yaml": HEADER, "hall/other.pgm": b"P5", "hall/a.pgm": IMAGE})
    assert open_archive(packed) == (HEADER, IMAGE)


def test_an_image_that_is_not_there_is_named_when_the_map_is_read() -> None:
    with pytest.raises(BadMap, match=r"'maps/a.pgm' is missing"):
        read_map(*open_archive(pack({"a.yaml": HEADER, "b.pgm": IMAGE})))


@pytest.mark.parametrize(
    ("data", "says"),
    [
        (b"PK\3\4 no archive", "cannot be opened"),
        (pack({"a.yaml": HEADER, "a.pgm": IMAGE})[:-30], "cannot be opened"),
        (pack({"a.pgm": IMAGE}), "has no .yaml files"),
        (pack({"a.yaml": HEADER, "b.yml": HEADER}), "has 2 .yaml files"),
        (pack({f"{n}.txt": b"" for n in range(MOST_ENTRIES + 1)}), "more than 200 files"),
        (pack({"a.yaml": b"#" * 70_000}), "unpacks to more than 65536 bytes"),
    ],
)
def test_an_archive_that_is_no_map_is_refused_with_what_is_wrong(data: bytes, says: str) -> None:
    with pytest.raises(BadMap, match=says):
        open_archive(data)


def test_an_archive_that_unpacks_to_gigabytes_is_left_where_a_map_would_end() -> None:
    bomb = pack({"a.yaml": HEADER, "a.pgm": bytes(4 * MAX_IMAGE_BYTES)})
    assert len(bomb) < 100_000
    tracemalloc.start()
    try:
        with pytest.raises(BadMap, match="unpacks to more than"):
            open_archive(bomb)
        assert tracemalloc.get_traced_memory()[1] < 2.5 * MAX_IMAGE_BYTES
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("packing", [zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_an_archive_that_is_damaged_inside_is_refused_however_it_is_packed(packing: int) -> None:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", packing) as archive:
        archive.writestr("a.yaml", HEADER)
    packed = out.getvalue()
    begins = 34 + len("a.yaml")
    damaged = packed[:begins] + b"\xff" * 5 + packed[begins + 5 :]
    with pytest.raises(BadMap, match="cannot be opened"):
        open_archive(damaged)


def test_what_an_archive_says_of_its_sizes_is_not_believed() -> None:
    packed = bytearray(pack({"a.yaml": HEADER, "a.pgm": bytes(MAX_IMAGE_BYTES + 9)}))
    at = packed.rindex(b"PK\1\2")
    packed[at + 24 : at + 28] = (5).to_bytes(4, "little")
    with pytest.raises(BadMap, match=r"cannot be opened|unpacks to more than|ends early"):
        read_map(*open_archive(bytes(packed)))


grids = st.integers(1, 9).flatmap(
    lambda width: st.integers(1, 9).flatmap(
        lambda height: st.builds(
            Grid,
            st.just(width),
            st.just(height),
            st.floats(0.001, 10),
            st.floats(-1e6, 1e6),
            st.floats(-1e6, 1e6),
            st.lists(st.sampled_from((0, 100, 255)), min_size=width * height, max_size=width * height).map(bytes),
        )
    )
)


@settings(max_examples=60)
@given(grids)
def test_whatever_goes_out_comes_in_again_exact_to_the_cell_and_the_last_bit_of_its_place(grid: Grid) -> None:
    packed = pack({"site.yaml": write_yaml(grid, "site.pgm"), "site.pgm": write_pgm(grid)})
    assert read_map(*open_archive(packed)) == grid

"""A site out of a ROS map, and what is said of a map that is broken."""

from __future__ import annotations

import re
import struct
import zlib
from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import ask

pytestmark = pytest.mark.browser

WIDTH, HEIGHT = 80, 60
HEADER = (
    "image: {image}\nresolution: 0.1\norigin: [-1.0, -2.0, 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
)


def hall() -> bytes:
    """A hall of 8 by 6 metres with a wall around it and one in the middle; a byte for each cell."""
    cells = bytearray()
    for row in range(HEIGHT):
        for column in range(WIDTH):
            around = row in {0, HEIGHT - 1} or column in {0, WIDTH - 1}
            cells.append(0 if around or (column == 40 and row > 20) else 254)
    return bytes(cells)


def pgm(cells: bytes) -> bytes:
    return b"P5\n# a hall\n%d %d\n255\n" % (WIDTH, HEIGHT) + cells


def png(cells: bytes) -> bytes:
    def chunk(kind: bytes, body: bytes) -> bytes:
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    rows = b"".join(b"\0" + cells[start : start + WIDTH] for start in range(0, len(cells), WIDTH))
    head = struct.pack(">IIBBBBB", WIDTH, HEIGHT, 8, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def choose(page: Page, parent: Path, header: str, image: str, body: bytes) -> None:
    """Choose the files of a map; each time from a folder of its own, for a browser refuses a file that has changed."""
    folder = parent / f"map-{len(list(parent.iterdir()))}"
    folder.mkdir()
    (folder / "hall.yaml").write_text(header)
    (folder / image).write_bytes(body)
    page.get_by_label("Choose a map, a picture or a drawing, or drop it here").set_input_files(
        [folder / "hall.yaml", folder / image]
    )


@pytest.mark.parametrize(("image", "encode"), [("hall.pgm", pgm), ("hall.png", png)])
def test_a_ros_map_becomes_a_site(sign_in: SignIn, tmp_path: Path, image: str, encode: object) -> None:
    assert callable(encode)
    page = sign_in("admin", "/sites/new")
    choose(page, tmp_path, HEADER.format(image=image), image, encode(hall()))
    expect(page.get_by_role("img", name="Preview of the map")).to_be_visible()
    name = page.get_by_label("Name of the site")
    expect(name).to_have_value("Hall")
    name.fill(f"Hall from {image}")
    page.get_by_role("button", name="Create the site").click()
    expect(page).to_have_url(re.compile("/sites/hall-from-.*/map$"))
    expect(page.get_by_role("heading", level=1)).to_be_visible()
    expect(page.get_by_role("button", name=re.compile(f"^Hall from {image}"))).to_be_visible()
    slug = page.url.split("/")[-2]
    found = ask(page, f"/api/sites/{slug}/map")
    assert (found["width"], found["height"], found["resolution_m"]) == (WIDTH, HEIGHT, 0.1)
    assert (found["origin"]["x"], found["origin"]["y"]) == (-1.0, -2.0)
    assert ask(page, f"/api/sites/{slug}")["role"] == "admin", "who makes a site manages it"


def test_a_broken_map_is_explained_at_the_field_and_can_be_mended(
    sign_in: SignIn, tmp_path: Path, faults: list[str]
) -> None:
    page = sign_in("admin", "/sites/new")
    choose(page, tmp_path, HEADER.format(image="hall.pgm"), "hall.pgm", pgm(hall())[:-900])
    page.get_by_role("button", name="Create the site").click()
    problem = page.get_by_role("main").get_by_role("alert")
    expect(problem).to_have_text(re.compile(r"^[A-Z].{20,}\.$"))
    field = page.get_by_label("Choose a map, a picture or a drawing, or drop it here")
    expect(field).to_have_accessible_description(re.compile(r"^[A-Z].{20,}\.$"))
    choose(page, tmp_path, "image: hall.pgm\nresolution: nonsense\n", "hall.pgm", pgm(hall()))
    page.get_by_role("button", name="Create the site").click()
    expect(problem).to_have_text(re.compile("resolution"))
    faults.clear()
    choose(page, tmp_path, HEADER.format(image="hall.pgm"), "hall.pgm", pgm(hall()))
    page.get_by_label("Name of the site").fill("Mended hall")
    page.get_by_role("button", name="Create the site").click()
    expect(page).to_have_url(re.compile("/sites/mended-hall/map$"))

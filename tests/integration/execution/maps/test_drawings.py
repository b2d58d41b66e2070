"""Drawings and scans that an admin brings are read and sent back, so that a map can be made of them in the browser."""

from __future__ import annotations

import io
import zlib
from base64 import b64decode
from typing import Any

import ezdxf
import pytest
from django.core.files.uploadedfile import SimpleUploadedFile
from django.test import Client

from registry import services as registry
from registry.floorplan.map_server import write_pgm, write_yaml
from registry.maps import drawings
from tests.kit import demo_floor
from tests.kit.programs import SITE
from tests.kit.sign_in import join_and_sign_in

pytestmark = pytest.mark.django_db
AT = f"/api/sites/{SITE}/map"


@pytest.fixture
def admin(factory: Any) -> Client:
    return join_and_sign_in("admin", SITE)


def file(drawing: Any) -> SimpleUploadedFile:
    text = io.StringIO()
    drawing.write(text)
    return SimpleUploadedFile("hall.dxf", text.getvalue().encode())


def endless() -> Any:
    """Return a drawing with a block that stands in itself."""
    drawing = ezdxf.new()
    block = drawing.blocks.new("S")
    block.add_blockref("S", (1, 0))
    drawing.modelspace().add_blockref("S", (0, 0))
    return drawing


def test_a_drawing_comes_back_as_lines_and_changes_nothing(admin: Client) -> None:
    drawing = ezdxf.new()
    drawing.units = 5
    drawing.modelspace().add_line((0, 0), (400, 0), dxfattribs={"layer": "WALLS"})
    before = registry.get_map(site=SITE).version
    answer = admin.post(f"{AT}/drawing", {"drawing": file(drawing)})
    assert answer.status_code == 200
    assert answer.json() == {
        "metres": 0.01,
        "layers": [{"name": "WALLS", "hidden": False, "lines": [[0, 0, 400, 0]]}],
        "skipped": {},
    }
    assert registry.get_map(site=SITE).version == before


def test_a_drawing_that_stands_for_too_much_ends_with_a_sentence_and_the_next_is_read(admin: Client) -> None:
    answer = admin.post(f"{AT}/drawing", {"drawing": file(endless())})
    assert (answer.status_code, answer.json()["code"]) == (422, "bad_drawing")
    assert answer.json()["detail"].startswith("Blocks stand in blocks more than 12 deep.")


def test_a_reader_that_takes_too_long_is_ended(admin: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(drawings, "WALL_S", 0.01)
    answer = admin.post(f"{AT}/drawing", {"drawing": file(endless())})
    assert (answer.status_code, answer.json()["code"]) == (422, "bad_drawing")
    assert "too long" in answer.json()["detail"]


def test_no_file_a_large_one_and_what_is_none_are_refused(admin: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    assert admin.post(f"{AT}/drawing").json()["code"] == "bad_drawing"
    junk = SimpleUploadedFile("hall.dxf", b"GIF89a")
    assert "no DXF drawing" in admin.post(f"{AT}/drawing", {"drawing": junk}).json()["detail"]
    monkeypatch.setattr(drawings, "MAX_IMAGE_BYTES", 5)
    junk.seek(0)
    assert "6 bytes" in admin.post(f"{AT}/drawing", {"drawing": junk}).json()["detail"]


def test_a_scan_comes_back_cell_for_cell(admin: Client) -> None:
    grid = demo_floor.grid()
    files = {
        "yaml": SimpleUploadedFile("m.yaml", write_yaml(grid, "m.pgm")),
        "image": SimpleUploadedFile("m.pgm", write_pgm(grid)),
    }
    answer = admin.post(f"{AT}/read", files)
    told = answer.json()
    assert (answer.status_code, told["width"], told["height"]) == (200, grid.width, grid.height)
    assert told["origin"] == {"x": grid.origin_x_m, "y": grid.origin_y_m, "yaw": 0.0}
    assert zlib.decompress(b64decode(told["cells"])) == grid.cells
    assert admin.post(f"{AT}/read").json()["code"] == "bad_map"

"""A DXF drawing becomes another map of a site, laid on the present one by three points, by keyboard."""

from __future__ import annotations

import io
import re
from typing import Any

import ezdxf
import pytest
from playwright.sync_api import Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import SITE, ask, violations

pytestmark = pytest.mark.browser


def hall() -> bytes:
    """Return a drawing of a hall of 12 m by 8 m that does not say its unit."""
    drawing = ezdxf.new()
    drawing.units = 0
    space = drawing.modelspace()
    space.add_lwpolyline([(0, 0), (12000, 0), (12000, 8000), (0, 8000)], close=True, dxfattribs={"layer": "WALLS"})
    drawing.layers.add("AXES").off()
    space.add_line((0, 4000), (12000, 4000), dxfattribs={"layer": "AXES"})
    space.add_text("Hall")
    text = io.StringIO()
    drawing.write(text)
    return text.getvalue().encode()


def bring(page: Page, name: str, data: bytes) -> None:
    page.locator('input[type="file"]').set_input_files(
        {"name": name, "mimeType": "application/octet-stream", "buffer": data}
    )


def version(page: Page) -> Any:
    return ask(page, f"{SITE}/map")["version"]


def test_a_drawing_is_read_aligned_and_looked_at_before_it_replaces_the_map(sign_in: SignIn) -> None:
    page = sign_in("admin", "/sites/painting-factory/map/new")
    before = version(page)
    bring(page, "hall.dxf", hall())
    unit = page.get_by_label("One unit of the drawing is")
    expect(unit).to_have_value("0")
    use = page.get_by_role("button", name="Use this map")
    expect(use).to_be_disabled()
    unit.select_option(label="a millimetre")
    expect(page.get_by_text(re.compile(r"What is chosen is 12\.0.m . 8\.0.m"))).to_be_visible()
    expect(page.get_by_role("checkbox", name="WALLS, one line")).to_be_checked()
    expect(page.get_by_role("checkbox", name="AXES")).not_to_be_checked()
    expect(page.get_by_text("One part of the drawing is no line")).to_be_visible()
    expect(use).to_be_enabled()
    page.get_by_role("switch", name="Align it with the present map").press("Space")
    point = page.get_by_role("button", name="Point 1 of the brought map")
    expect(page.get_by_text("The points miss each other by")).to_be_visible()
    told = page.get_by_text("Point 1:", exact=False)
    missed = told.text_content()
    for _ in range(3):
        point.press("Shift+ArrowRight")
    expect(told).not_to_have_text(missed or "")
    assert violations(page) == []
    use.click()
    dialog = page.get_by_role("dialog", name="Use this map?")
    expect(dialog.get_by_text("New walls")).to_be_visible()
    assert violations(page) == []
    dialog.get_by_role("button", name="Keep as it is").click()
    assert version(page) == before


def test_a_finger_puts_a_point_of_the_alignment_elsewhere(sign_in: SignIn) -> None:
    page = sign_in("admin", "/sites/painting-factory/map/new", width=820, height=600)
    bring(page, "hall.dxf", hall())
    expect(page.get_by_label("One unit of the drawing is")).to_have_value("0")
    page.get_by_label("One unit of the drawing is").select_option(label="a millimetre")
    expect(page.get_by_text(re.compile(r"What is chosen is 12\.0.m . 8\.0.m"))).to_be_visible()
    expect(page.get_by_role("button", name="Use this map")).to_be_enabled()
    page.get_by_role("switch", name="Align it with the present map").press("Space")
    point = page.get_by_role("button", name="Point 1 of the brought map")
    point.scroll_into_view_if_needed()
    before, box = point.get_attribute("transform"), point.bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    cdp = page.context.new_cdp_session(page)
    cdp.send("Emulation.setTouchEmulationEnabled", {"enabled": True})
    page.evaluate("addEventListener('pointercancel', () => (window.taken = true), true)")
    for kind, up in (("touchStart", 0), *(("touchMove", 5 * part) for part in range(1, 9))):
        cdp.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [{"x": x, "y": y - up}]})
        page.wait_for_timeout(30)
    cdp.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    expect(point).not_to_have_attribute("transform", before or "")
    assert page.evaluate("window.taken") is None, "the browser took the finger to scroll the page"


def test_a_file_that_is_no_drawing_is_refused_where_it_was_chosen(sign_in: SignIn, faults: list[str]) -> None:
    page = sign_in("admin", "/sites/painting-factory/map/new")
    bring(page, "hall.dxf", b"AC1032 not this one")
    expect(page.get_by_role("alert").filter(has_text="This is a DWG file.")).to_be_visible()
    expect(page.get_by_role("button", name="Use this map")).to_be_disabled()
    faults.clear()

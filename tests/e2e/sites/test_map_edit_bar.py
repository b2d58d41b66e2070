"""The map's editor where German words have little room."""

from __future__ import annotations

import pytest
from playwright.sync_api import expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import shoot, until, violations

pytestmark = pytest.mark.browser
NONE_CUT = """() => [...document.querySelectorAll("main button, header button, header a")].every(
  (each) => [...each.querySelectorAll("*")].every(
    (part) => getComputedStyle(part).clipPath !== "none" || part.scrollWidth <= part.clientWidth + 1))"""


@pytest.mark.parametrize(("width", "height"), [(820, 1180), (1600, 1000)])
def test_no_button_is_cut_off_in_german(sign_in: SignIn, width: int, height: int) -> None:
    page = sign_in("admin", "/sites/painting-factory/map/edit", width=width, height=height, language="de")
    surface = page.get_by_role("application", name="Die Karte. Werkzeug: Wand")
    surface.focus()
    for key in ("Enter", "Shift+ArrowRight", "Enter"):
        page.keyboard.press(key)
    expect(page.get_by_role("button", name="Speichern")).to_be_enabled()
    expect(page.get_by_role("link", name="Schließen")).to_be_visible()
    expect(page.get_by_role("button", name="Alles anhalten")).to_be_in_viewport(ratio=1)
    until(page, NONE_CUT)
    shoot(page, f"map-edit-{width}", "light", "dark")
    assert violations(page) == []

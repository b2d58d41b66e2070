"""A screen in a hall shows a site by a link, says when it is not live, and goes dark when it is turned off."""

from __future__ import annotations

import pytest
from playwright.sync_api import Browser, Page, expect

from tests.e2e.conftest import SignIn, listen
from tests.e2e.screens import violations

pytestmark = pytest.mark.browser
PAGE = "/sites/painting-factory/people"


def make_wall_screen(page: Page) -> str:
    """Make a wall screen by keyboard, and return its link."""
    walls = page.get_by_role("region", name="Wall screens")
    walls.get_by_role("button", name="New wall screen").press("Enter")
    form = page.get_by_role("dialog", name="New wall screen")
    form.get_by_label("Where it hangs").fill("Hall 1, east wall")
    assert violations(page) == []
    form.get_by_role("button", name="Make the link").press("Enter")
    shown = page.get_by_role("dialog", name="Wall screen Hall 1, east wall")
    link = shown.get_by_label("Link", exact=True).input_value()
    assert violations(page) == []
    shown.get_by_role("button", name="I have it").press("Enter")
    expect(walls.get_by_role("row", name="Hall 1, east wall")).to_contain_text("Not opened yet")
    return link


def test_a_screen_in_a_hall_shows_the_site_and_goes_dark(sign_in: SignIn, chromium: Browser, faults: list[str]) -> None:
    admin = sign_in("admin", PAGE)
    link = make_wall_screen(admin)
    context = chromium.new_context(viewport={"width": 1600, "height": 1000}, locale="en-GB", color_scheme="dark")
    listen(context, faults)
    wall = context.new_page()
    try:
        wall.goto(link)
        expect(wall.get_by_role("heading", level=1, name="Painting Factory")).to_be_visible()
        expect(wall.get_by_text("Live", exact=True)).to_be_visible()
        expect(wall.get_by_role("group", name="Map of Painting Factory")).to_be_visible()
        assert wall.url == link.partition("#")[0]
        assert "Ada Meyer" not in wall.content()
        assert wall.get_by_role("button").or_(wall.get_by_role("link")).count() == 0
        assert violations(wall) == []
        context.set_offline(True)
        expect(wall.get_by_text("Not live")).to_be_visible()
        context.set_offline(False)
        expect(wall.get_by_text("Live", exact=True)).to_be_visible()
        # Of what the page or its worker asked for meanwhile, the console says that it did not come.
        faults[:] = [fault for fault in faults if "Failed to load resource: net::ERR_" not in fault]
        wall.set_viewport_size({"width": 820, "height": 1180})
        wall.emulate_media(color_scheme="light")
        wall.reload()
        expect(wall.get_by_text("Live", exact=True)).to_be_visible()
        assert violations(wall) == []
        admin.get_by_role("button", name="Turn off the wall screen Hall 1, east wall").press("Enter")
        expect(wall.get_by_role("heading", level=1, name="This wall screen has ended")).to_be_visible()
        assert violations(wall) == []
        wall.reload()
        expect(wall.get_by_role("heading", level=1, name="This wall screen has ended")).to_be_visible()
    finally:
        context.close()

"""A long library is read part by part: on its page, in the palette and in the editor, and each function is found."""

from __future__ import annotations

import re
from typing import Any

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.conftest import SignIn, in_shell, make_member
from tests.e2e.screens import ask, tell, violations
from tests.kit.demo import Demo
from tests.kit.programs import document, step

pytestmark = pytest.mark.browser
SITE = "painting-factory"
COUNT = 130
SAVE_MANY = """
from editor import services
from registry.models import User
user = User.objects.get(display_name="Cleo Many")
for number in range(count):
    said = services.Said(f"Resting {number:03}", "", "me")
    saved = services.save_function(site=site, program_id=program, function="f", said=said, user=user)
print(saved.id)
"""


@pytest.fixture
def page(demo: Demo, sign_in: SignIn, signed_in: dict[str, Any]) -> Page:
    """Somebody who keeps many functions to themselves, so that nobody else's library grows."""
    if "collector" not in signed_in:
        signed_in["collector"] = make_member(demo, "author", "Cleo Many")
    return sign_in("collector")


def origin(page: Page) -> str:
    return re.sub(r"(https?://[^/]+).*", r"\1", page.url)


def fill(demo: Demo, page: Page) -> str:
    """Save one function under many names; return the address of the last."""
    steps = {"w": step("wait", ("f", "body"), duration=1)}
    drawn = document(steps, functions={"f": {"name": "Rest", "parameters": []}})
    program = tell(page, f"/api/sites/{SITE}/programs", {"name": "Source of functions"})["id"]
    base, token = origin(page), ask(page, "/api/me")["csrf"]
    tag = page.request.get(f"{base}/api/programs/{program}/document").headers["etag"]
    put = page.request.put(
        f"{base}/api/programs/{program}/document",
        data={**drawn, "format": 2},
        headers={"X-CSRFToken": token, "If-Match": tag},
    )
    assert put.ok, put.text()
    last = in_shell(demo, f"count, site, program = {COUNT}, {SITE!r}, {program!r}{SAVE_MANY}").strip()
    return f"/sites/{SITE}/library/{last}"


def test_each_function_of_a_long_library_is_reached(demo: Demo, page: Page) -> None:
    last = fill(demo, page)
    base = origin(page)
    page.goto(f"{base}/sites/{SITE}/library")
    expect(page.get_by_text(re.compile(r"^The first \d+ functions$"))).to_be_visible()
    more = page.get_by_role("button", name="Show more")
    assert page.get_by_role("link", name=re.compile("Resting 129")).count() == 0
    more.press("Enter")
    expect(page.get_by_text("The first 120 functions", exact=True)).to_be_visible()
    more.press("Enter")
    expect(page.get_by_role("link", name=re.compile("Resting 129"))).to_be_visible()
    expect(more).to_have_count(0)
    assert violations(page) == []
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url) if "/api/library?" in request.url else None)
    page.get_by_role("checkbox", name="Runs on our devices").check()
    expect(page.get_by_text("The first 60 functions", exact=True)).to_be_visible()
    expect(page.get_by_role("link", name=re.compile("Resting 129"))).to_have_count(0)
    assert ["only_fitting=true" in url for url in asked] == [True], asked
    page.goto(base + last)
    expect(page.get_by_role("complementary", name="Resting 129")).to_be_visible()
    page.keyboard.press("Control+k")
    page.get_by_role("combobox", name="Search or jump to").fill("Resting 128")
    expect(page.get_by_role("option", name=re.compile("Resting 128"))).to_be_visible()
    page.keyboard.press("Escape")
    page.get_by_role("textbox", name="Search").fill("resting 127")
    expect(page.get_by_role("link", name=re.compile("Resting 127"))).to_be_visible()
    expect(page.get_by_text("1 function", exact=True)).to_be_visible()

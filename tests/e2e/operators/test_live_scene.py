"""A run is watched in 3D while it is carried out: what robots do on the floor, they do there."""

from __future__ import annotations

import re
from typing import Any

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import ask, draw_task, make_program, saved, the_map, violations

pytestmark = pytest.mark.browser


def scene(page: Page) -> Any:
    return page.get_by_role("img", name=re.compile("^The place in 3D at "))


def test_a_run_is_watched_in_3d_by_two_and_the_map_is_one_press_away(sign_in: SignIn) -> None:
    page = sign_in("author")
    make_program(page, "To be watched")
    draw_task(page)
    expect(page.get_by_text("Nothing to fix")).to_be_visible()
    saved(page)
    page.get_by_role("banner").get_by_role("button", name="Run", exact=True).click()
    page.get_by_role("dialog", name="Run this program").get_by_role("button", name="Run", exact=True).click()
    expect(page).to_have_url(re.compile("/runs/"))
    page.set_viewport_size({"width": 1100, "height": 700})  # without a graphics card each pixel in 3D takes its time
    page.get_by_role("radio", name="3D").press("Space")
    expect(page).to_have_url(re.compile("view=3d$"))
    expect(scene(page)).to_have_accessible_name(re.compile("Carrying 1 box"))
    watcher = sign_in("admin", re.sub(r"https?://[^/]+", "", page.url), width=1100, height=700)
    expect(scene(watcher)).to_be_visible()
    expect(watcher.get_by_text("Curing Oven").first).to_be_visible()
    assert violations(watcher) == []
    run = re.search(r"/runs/([0-9a-f-]+)", page.url)
    assert run is not None
    expect(page.get_by_role("banner").get_by_text("Finished")).to_be_visible(timeout=180_000)
    assert ask(page, f"/api/runs/{run[1]}")["status"] == "finished"
    expect(scene(page)).not_to_have_accessible_name(re.compile("Carrying 1 box"))
    page.get_by_role("radio", name="From the robot").press("Space")
    page.get_by_role("combobox", name="Robot", exact=True).select_option(label="TurtleBot 2")
    page.get_by_role("radio", name="3D").press("ArrowLeft")
    expect(the_map(page)).to_be_visible()
    expect(page).not_to_have_url(re.compile("view="))
    expect(scene(page)).to_have_count(0)

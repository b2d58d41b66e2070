"""A run is watched in 3D while it is carried out: what robots do on the floor, they do there."""

from __future__ import annotations

import re
from typing import Any

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import SITE, ask, draw_task, make_program, run_of, saved, start_run, tell, the_map, violations
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.browser


def scene(page: Page) -> Any:
    return page.get_by_role("img", name=re.compile("^The place in 3D at "))


def test_a_run_is_watched_in_3d_by_two_and_the_map_is_one_press_away(sign_in: SignIn) -> None:
    page = sign_in("author")
    make_program(page, "To be watched")
    draw_task(page)
    expect(page.get_by_text("Nothing to fix")).to_be_visible()
    saved(page)
    start_run(page)
    run = run_of(page)
    wait_for("the robot with the box", lambda: any(each["carrying"] for each in ask(page, f"{SITE}/devices")))
    tell(page, f"/api/runs/{run}/pause")  # it keeps the box until both have seen it
    page.set_viewport_size({"width": 1100, "height": 700})  # without a graphics card each pixel in 3D takes its time
    page.get_by_role("radio", name="3D").press("Space")
    expect(page).to_have_url(re.compile("view=3d$"))
    expect(scene(page)).to_have_accessible_name(re.compile("Carrying 1 box"))
    watcher = sign_in("admin", re.sub(r"https?://[^/]+", "", page.url), width=1100, height=700)
    expect(scene(watcher)).to_be_visible()
    expect(watcher.get_by_text("Curing Oven").first).to_be_visible()
    assert violations(watcher) == []
    tell(page, f"/api/runs/{run}/resume")
    expect(page.get_by_role("banner").get_by_text("Finished")).to_be_visible(timeout=180_000)
    assert ask(page, f"/api/runs/{run}")["status"] == "finished"
    expect(scene(page)).not_to_have_accessible_name(re.compile("Carrying 1 box"))
    page.get_by_role("radio", name="From the robot").press("Space")
    page.get_by_role("combobox", name="Robot", exact=True).select_option(label="TurtleBot 2")
    page.get_by_role("radio", name="3D").press("ArrowLeft")
    expect(the_map(page)).to_be_visible()
    expect(page).not_to_have_url(re.compile("view="))
    expect(scene(page)).to_have_count(0)

"""A device is simulated in a run of real ones: switched by keyboard, seen by others, marked, switched back."""

from __future__ import annotations

import re
import time

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import (
    address_of,
    ask,
    draw_task,
    end_run,
    make_program,
    run_state,
    saved,
    shoot,
    start_run,
    violations,
)
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.browser
SITE = "/api/sites/painting-factory"
DEVICES = "/sites/painting-factory/devices"
ROBOTS = ("robot01", "robot02", "robot03")
CALM_S = 4.0


def switch(page: Page, robot: str, *, simulated: bool) -> None:
    """Let a stand-in speak for a robot, or the robot itself, once it has done what it still does."""
    address = address_of(page, f"{SITE}/devices/{robot}/stand-in")
    send = page.request.put if simulated else page.request.delete
    headers = {"X-CSRFToken": ask(page, "/api/me")["csrf"]}
    wait_for("the end of what it does", lambda: send(address, headers=headers).ok, every_s=0.3)
    wait_for(robot, lambda: ask(page, f"{SITE}/devices/{robot}")["status"] != "offline")


def end_others(page: Page) -> None:
    """End what tests before this one have begun, and wait until no robot does anything for it any more."""
    for state in ("running", "paused"):
        for run in ask(page, f"{SITE}/runs?state={state}"):
            end_run(page, run["id"])
    calm_since = time.monotonic()

    def are_calm() -> bool:
        """Whether no robot does anything, for some seconds: between two ways it is idle, too."""
        nonlocal calm_since
        if any(ask(page, f"{SITE}/devices/{robot}")["status"] not in ("idle", "done") for robot in ROBOTS):
            calm_since = time.monotonic()
        return time.monotonic() - calm_since > CALM_S

    wait_for("robots that rest", are_calm, every_s=0.5)


def test_a_robot_is_simulated_in_a_run(sign_in: SignIn, faults: list[str]) -> None:
    page, other = (
        sign_in("author", f"{DEVICES}/robot01"),
        sign_in("admin", f"{DEVICES}/robot01", width=820, height=1180),
    )
    end_others(page)
    detail = page.get_by_role("complementary", name="TurtleBot 1")
    detail.get_by_role("button", name="Simulate this one").press("Enter")
    card = detail.get_by_role("region", name="Simulated in place of the real device")
    expect(card).to_contain_text("The real device is told nothing")
    expect(other.get_by_role("complementary").get_by_role("button", name="Use the real one again")).to_be_visible()
    expect(detail.get_by_text("Ready", exact=False).first).to_be_visible()
    expect(detail.get_by_text("Simulated from now on; the device itself is told nothing").first).to_be_visible()
    shoot(page, "stand-in")
    shoot(other, "stand-in-narrow")
    assert violations(page) == []
    for robot in ROBOTS[1:]:
        switch(page, robot, simulated=True)
    make_program(page, "With simulated robots")
    draw_task(page)
    saved(page)
    start_run(page)
    facts = page.get_by_role("complementary").get_by_text(re.compile("Simulated: TurtleBot"))
    expect(facts).to_be_visible(timeout=180_000)
    shoot(page, "stand-in-run")
    expect(run_state(page)).to_have_text(re.compile("Finished"), timeout=180_000)
    assert violations(page) == []
    run = page.url.rsplit("/", 1)[1]
    told = [event for event in ask(page, f"/api/runs/{run}/events") if event["kind"] == "command"]
    assert {event["device"] for event in told if event["args"].get("simulated")} <= set(ROBOTS)
    shoot(page, "stand-in-over")
    for robot in ROBOTS:
        switch(page, robot, simulated=False)
    for robot in ROBOTS:
        assert not ask(page, f"{SITE}/devices/{robot}")["stand_in"]
    faults[:] = [line for line in faults if "/map" not in line]  # it may have sent no map yet

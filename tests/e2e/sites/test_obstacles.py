"""An operator puts something in the way of a simulated robot: the run says so, and goes through when it is gone."""

from __future__ import annotations

import re
from typing import Any

import pytest
from playwright.sync_api import expect

from tests.e2e.conftest import SignIn, make_member
from tests.e2e.screens import SITE, ask, run_state, saved, shoot, start_run, the_map, violations, write_program
from tests.kit.demo import Demo

pytestmark = pytest.mark.browser
OBSTACLE = re.compile(r"^Obstacle, 50\scm wide, at ")
HOME = "/sites/painting-factory"
SCRIPT = """class Task(object):
    def new_task(self):
        self.robot.move((17.3, -7.2))
        self.robot.move((8.0, -8.3))

    def run(self, ctx):
        self.robot = ctx.get("robot01")
        self.new_task()
"""


def test_a_robot_meets_what_an_operator_put_on_the_floor(
    demo: Demo, signed_in: dict[str, Any], sign_in: SignIn
) -> None:
    signed_in["floor hand"] = make_member(demo, "operator", "Fred Floor")
    signed_in["onlooker of obstacles"] = make_member(demo, "viewer", "Olga Looks")
    tablet = sign_in("floor hand", f"{HOME}/map", width=820, height=1180)
    viewer = sign_in("onlooker of obstacles", f"{HOME}/map", language="de")
    author = sign_in("author")

    expect(tablet.get_by_role("button", name="Edit zones")).to_have_count(0)
    tablet.get_by_role("button", name="Put obstacles").press("Enter")
    floor = tablet.get_by_role("button", name="Put an obstacle: click where it shall lie")
    expect(floor).to_be_focused()
    floor.press("Enter")
    panel = tablet.get_by_role("region", name="Obstacles")
    handle = tablet.get_by_role("group", name="Map of").get_by_role("button", name=OBSTACLE)
    expect(handle).to_have_count(1)
    handle.press("Delete")
    expect(panel.get_by_text("Nothing lies in the way.")).to_be_visible()

    for x, y in ((12.0, -8.3), (12.0, -7.8), (12.0, -8.8)):
        tablet.evaluate(PUT, [x, y])
    expect(handle).to_have_count(3)
    tablet.mouse.move(0, 0)
    shoot(tablet, "obstacles-tablet", "light", "dark")
    assert violations(tablet) == []
    shown = viewer.get_by_role("region", name="Hindernisse")
    expect(shown.get_by_role("listitem")).to_have_count(3)
    expect(shown.get_by_text("Nur simulierte Roboter treffen darauf.")).to_be_visible()
    expect(viewer.get_by_role("button", name="Hindernisse legen")).to_have_count(0)
    expect(shown.get_by_role("button")).to_have_count(0)
    shoot(viewer, "obstacles-viewer", "light", "dark")

    write_program(author, "Down the corridor", SCRIPT)
    saved(author)
    program = author.url
    start_run(author)
    expect(run_state(author)).to_contain_text("Failed", timeout=180_000)
    expect(author.get_by_text("something that is not on the map is in its way").first).to_be_visible()
    shoot(author, "obstacles-run", "light", "dark")
    assert the_map(author)
    assert len(ask(author, f"{SITE}/map")["obstacles"]) == 3

    panel.get_by_role("button", name="Take all away").press("Enter")
    expect(panel.get_by_text("Nothing lies in the way.")).to_be_visible()
    expect(shown).to_have_count(0)
    author.goto(program)
    start_run(author)
    expect(run_state(author)).to_contain_text("Finished", timeout=180_000)


PUT = """([x, y]) => {
  const floor = document.querySelector('rect[role=button][aria-label^="Put an obstacle"]');
  const at = new DOMPoint(x * 46, -y * 46).matrixTransform(floor.parentElement.getScreenCTM());
  const click = new MouseEvent("click", { clientX: at.x, clientY: at.y, bubbles: true });
  floor.dispatchEvent(click);
}"""

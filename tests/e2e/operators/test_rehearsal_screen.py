"""A rehearsal under chosen conditions, and what its screen offers: marks, a link, files, a film, a run."""

from __future__ import annotations

import re
from io import BytesIO
from pathlib import Path

import pytest
from mcap.reader import make_reader
from playwright.sync_api import Locator, Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import address_of, ask, program_named, saved, tell, until, violations, write_program
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.browser
SHORT = """class Task(object):
    def new_task(self):
        self.wait(2)

    def run(self, ctx):
        self.new_task()
"""
WEBM = b"\x1a\x45\xdf\xa3"


def choose(form: Locator, label: str, option: str) -> None:
    form.get_by_role("combobox", name=label, exact=True).click()
    form.page.get_by_role("option", name=option, exact=True).click()


def open_dialog(page: Page) -> Locator:
    page.get_by_role("banner").get_by_role("button", name="Simulate with").click()
    dialog = page.get_by_role("dialog", name="Simulate with")
    expect(dialog.get_by_role("heading", name="Faults on purpose")).to_be_visible()
    return dialog


def test_conditions_are_chosen_kept_and_told_and_what_was_rehearsed_is_run(sign_in: SignIn) -> None:
    page = sign_in("author")
    write_program(page, "Under conditions", SHORT)
    expect(page.get_by_role("banner").get_by_role("button", name="Run", exact=True)).to_be_enabled()
    saved(page)
    dialog = open_dialog(page)
    dialog.get_by_text("Kinematic", exact=True).click()
    dialog.get_by_label("Chance (seed)").fill("7")
    dialog.get_by_role("button", name="Add a fault").click()
    dialog.get_by_role("button", name="Simulate", exact=True).click()
    device = dialog.get_by_role("combobox", name="Device", exact=True)
    expect(device).to_be_focused()
    expect(device).to_have_accessible_description("Needs a choice")
    page.keyboard.press("Escape")  # the list of devices, which came with the focus
    assert violations(page) == []
    choose(dialog, "What goes wrong", "Goes dead")
    choose(dialog, "Device", "Curing Oven")
    choose(dialog, "Begins", "with a step")
    dialog.get_by_role("combobox", name="Step", exact=True).click()
    page.get_by_role("option", name=re.compile("^1 · Wait")).click()
    dialog.get_by_role("button", name="Simulate", exact=True).click()
    result = page.get_by_role("region", name="Result")
    expect(result.get_by_text("version 1 · Kinematic · seed 7 · 1 fault on purpose")).to_be_visible()
    asked = ask(page, f"/api/rehearsals/{page.url.rsplit('/', 1)[1]}")["asked"]
    assert (asked["seed"], asked["driver"]) == (7, "kinematic")
    assert [(fault["fault"], fault["device"], fault["nth"]) for fault in asked["faults"]] == [
        ("dead", "curingOven01", 1)
    ]
    again = open_dialog(page)
    expect(again.get_by_label("Chance (seed)")).to_have_value("7")
    expect(again.get_by_role("combobox", name="Device", exact=True)).to_have_value("Curing Oven")
    page.keyboard.press("Escape")
    page.get_by_role("banner").get_by_role("button", name="Run", exact=True).click()
    run = page.get_by_role("dialog", name="Run this program")
    expect(run.get_by_text("Version 1 is run, the one that was rehearsed.")).to_be_visible()
    assert violations(page) == []
    run.get_by_role("button", name="Run", exact=True).click()
    expect(page).to_have_url(re.compile("/runs/"))
    number = page.url.rsplit("/", 1)[1]
    ended = wait_for("the run's end", lambda: ask(page, f"/api/runs/{number}")["status"] == "finished")
    assert ended


def rehearse_order(page: Page) -> tuple[str, str]:
    """Rehearse the demo's program, in which robots wait for each other; return its path and the rehearsal."""
    program = program_named(page, "Paint order")
    rehearsal = str(tell(page, f"/api/programs/{program}/rehearsals", {"driver": "kinematic"})["id"])
    wait_for("the rehearsal", lambda: ask(page, f"/api/rehearsals/{rehearsal}")["status"] == "done")
    return f"/programs/{program}/simulate/{rehearsal}", rehearsal


def test_waits_are_marked_a_link_names_the_moment_and_files_are_handed_out(sign_in: SignIn, tmp_path: Path) -> None:
    page = sign_in("author")
    path, rehearsal = rehearse_order(page)
    wait = ask(page, f"/api/rehearsals/{rehearsal}")["result"]["waits"][0]
    origin = address_of(page, "")
    page.goto(f"{origin}{path}?t={wait['t'] + 0.2:.1f}")
    mark = page.get_by_role("region", name="Map", exact=True).get_by_role("button", name=re.compile("^1: "))
    row = page.get_by_role("region", name="Result").get_by_role("button", name=re.compile("^1 "))
    expect(row).to_have_attribute("aria-current", "true")
    scrub = page.get_by_role("slider", name="Moment of the recording")
    scrub.press("Home")
    expect(row).not_to_have_attribute("aria-current", "true")
    expect(page).not_to_have_url(re.compile("t="))
    mark.press("Enter")
    expect(row).to_have_attribute("aria-current", "true")
    expect(page).to_have_url(re.compile("[?]t="))
    assert float(page.url.split("?t=")[1]) == pytest.approx(wait["t"], abs=0.051)  # the address has tenths of a second
    page.get_by_role("radio", name="0.25 times as fast").click()
    page.get_by_role("button", name="Lidar").click()
    page.get_by_role("radio", name="From the robot").press("Space")
    expect(page.get_by_role("img", name=re.compile("lidar would see"))).to_be_visible()
    assert violations(page) == []
    page.get_by_role("button", name="Share").click()
    expect(page.get_by_label(re.compile("^Link to this rehearsal"))).to_have_value(page.url)
    page.keyboard.press("Escape")
    page.get_by_role("button", name="Export").click()
    with page.expect_download() as file:
        page.get_by_role("menuitem", name="MCAP").click()
    file.value.save_as(tmp_path / "order.mcap")
    topics = {
        channel.topic for _, channel, _ in make_reader(BytesIO((tmp_path / "order.mcap").read_bytes())).iter_messages()
    }
    assert {"/robots/robot01/pose", "/waits", "/steps", "/log"} <= topics
    page.get_by_role("button", name="Export").click()
    page.get_by_role("menuitem", name="WebM").click()
    page.get_by_role("dialog").get_by_role("button", name="Film it").click()
    expect(page.get_by_role("progressbar", name="Filming")).to_be_visible()
    until(page, "() => document.querySelector('progress').value > 20")
    with page.expect_download() as film:
        page.get_by_role("button", name="End and save").click()
    film.value.save_as(tmp_path / "order.webm")
    content = (tmp_path / "order.webm").read_bytes()
    assert content.startswith(WEBM)
    assert len(content) > 5_000
    expect(page.get_by_role("progressbar", name="Filming")).to_have_count(0)

"""The whole language as people meet it: a run asks and is answered by somebody else, a program starts by itself."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import (
    SITE,
    ask,
    draw_task,
    make_program,
    reading,
    run_state,
    show_programs,
    start_run,
    write_program,
)
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.browser
LONG_MS = 240_000
"""A run of another test may still hold a robot or a machine."""

ASKING = """class Task(object):
    def new_task(self):
        self.count = 0
        for _ in range(3):
            self.count = self.count + 1
        self.dry = self.ask("Is the paint dry?", type="boolean")
        if self.dry:
            self.notify(f"Counted to {self.count}", level="info")
        else:
            self.end()

    def run(self, ctx):
        self.new_task()
"""
LATE_JOURNAL = """
const { fetch } = window;
window.fetch = async (...request) => {
  const answer = await fetch(...request);
  if (String(request[0]).includes("/events")) await new Promise((done) => setTimeout(done, 3000));
  return answer;
};
"""
"""An answer with a run's journal arrives when the run has long gone on."""
RESTOCKING = """class Task(object):
    def new_task(self):
        self.wait(1)

    def when_e1(self):
        self.notify("Fewer than %d boxes are left", level="warning")

    def run(self, ctx):
        self.item_inventory = ctx.get("itemInventory01")
        ctx.start_when(self.item_inventory.stock < %d, self.when_e1)
        self.new_task()
"""


def wait_until_no_run_is_under_way(page: Page) -> None:
    """Another test's run would take the box too early."""

    def is_quiet() -> bool:
        return all(run["status"] not in {"pending", "running", "paused"} for run in ask(page, f"{SITE}/runs"))

    wait_for("the end of another test's run", is_quiet, LONG_MS / 1000, every_s=0.5)


def test_a_run_asks_and_somebody_else_answers(sign_in: SignIn) -> None:
    author, admin = sign_in("author"), sign_in("admin", "/")
    author.add_init_script(LATE_JOURNAL)
    write_program(author, "Asking", ASKING)
    expect(author.get_by_role("tab", name="Problems")).to_be_visible()
    start_run(author)
    admin.get_by_role("button", name="1 question waits for an answer").click()
    card = admin.get_by_role("region", name="A question")
    expect(card).to_contain_text("Is the paint dry?")
    card.get_by_role("button", name="Yes").click()
    expect(run_state(author)).to_contain_text("Finished")
    log = author.get_by_role("main")
    expect(log).to_contain_text("Counted to 3")
    expect(log).to_contain_text("answered: Yes")


def test_an_armed_program_starts_when_its_condition_becomes_true(sign_in: SignIn) -> None:
    page, operator = sign_in("author"), sign_in("admin")
    wait_until_no_run_is_under_way(page)
    boxes = int(reading(page, "itemInventory01", "stock"))
    write_program(page, "Restocking", RESTOCKING % (boxes, boxes))
    show_programs(operator)
    row = operator.get_by_role("row").filter(has_text="Restocking")
    switch = row.get_by_role("switch", name=re.compile("^Starts by itself"))
    expect(switch).to_be_enabled()  # what is armed has been asked; a press before goes nowhere
    switch.click(force=True)
    expect(row.get_by_role("switch")).to_be_checked()
    make_program(page, "Takes a box")
    draw_task(page)
    start_run(page)
    expect(operator.get_by_text(f"Fewer than {boxes} boxes are left")).to_be_visible(timeout=LONG_MS)
    expect(run_state(page)).to_contain_text("Finished", timeout=LONG_MS)

"""A site that demands an approval: one person asks, another looks at the comparison and approves, an edit voids it."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import SITE, ask, draw_task, end_run, make_program, run_of, saved, shoot, violations

pytestmark = pytest.mark.browser
RULE_PAGE = "/sites/painting-factory/review"


@pytest.fixture
def admin(sign_in: SignIn) -> Iterator[Page]:
    """An admin who has made the site demand one approval; afterwards it demands none, as the other tests need it."""
    page = sign_in("admin", RULE_PAGE)
    set_rule(page, "1")
    yield page
    page.goto(page.url.split("/", 3)[0] + "//" + page.url.split("/")[2] + RULE_PAGE)
    set_rule(page, "None")


def set_rule(page: Page, approvals: str) -> None:
    page.get_by_label("Approvals needed").select_option(approvals)
    page.get_by_role("button", name="Save").press("Enter")
    expect(page.get_by_text("The rule is saved")).to_be_visible()


def open_run_dialog(page: Page) -> Locator:
    page.get_by_role("banner").get_by_role("button", name="Run", exact=True).click()
    dialog = page.get_by_role("dialog")
    expect(dialog.get_by_role("list", name="Review")).to_be_visible()
    return dialog


def compare(page: Page, path: str, old: int, new: int) -> None:
    origin = re.match(r"https?://[^/]+", page.url)
    assert origin is not None
    page.goto(f"{origin[0]}{path}/compare?old={old}&new={new}")
    expect(page.get_by_role("list", name="Review")).to_be_visible()


def test_one_asks_another_approves_an_edit_voids_it_and_it_runs_once_it_is_approved_again(
    sign_in: SignIn, admin: Page
) -> None:
    assert violations(admin) == []
    shoot(admin, "rule")
    page = sign_in("author")
    path = make_program(page, "To be reviewed")
    draw_task(page)
    saved(page)
    dialog = open_run_dialog(page)
    start = dialog.get_by_role("button", name="Run", exact=True)
    expect(dialog).to_contain_text("Nobody has approved it as it is; 1 needed")
    expect(start).to_be_disabled()
    assert violations(page) == []
    shoot(page, "run-missing")
    dialog.get_by_role("button", name="Ask for review").press("Enter")
    page.keyboard.type("First trip to the booth.")
    dialog.get_by_role("button", name="Ask", exact=True).press("Enter")
    expect(dialog).to_contain_text("asked for a review: First trip to the booth.")
    bell = admin.get_by_role("button", name="1 version waits for your review")
    bell.press("Enter")
    assert violations(admin) == []
    shoot(admin, "waiting")
    admin.get_by_role("link", name="To be reviewed, v1").press("Enter")
    expect(admin.get_by_role("list", name="Review")).to_contain_text("First trip to the booth.")
    admin.get_by_role("button", name="Approve v1").press("Enter")
    expect(admin.get_by_role("list", name="Review")).to_contain_text("Approved by Ada Meyer")
    expect(bell).to_have_count(0)
    expect(dialog).to_contain_text("Approved by Ada Meyer")
    expect(start).to_be_enabled()
    page.keyboard.press("Escape")
    draw_task(page, "Painting Machine", "Curing Oven")
    saved(page)
    dialog = open_run_dialog(page)
    expect(dialog).to_contain_text("Nobody has approved it as it is")
    expect(dialog.get_by_role("button", name="Run", exact=True)).to_be_disabled()
    refused = page.request.post(
        page.url.split("/programs/")[0] + f"/api{path}/runs",
        data={},
        headers={"X-CSRFToken": ask(page, "/api/me")["csrf"]},
    )
    assert (refused.status, refused.json()["code"]) == (409, "not_approved")
    dialog.get_by_role("button", name="Ask for review").click()
    dialog.get_by_role("button", name="Ask", exact=True).click()
    expect(dialog).to_contain_text("asked for a review")
    compare(admin, path, 2, 2)
    expect(admin.get_by_text("This is one version, whole: there is no earlier one beside it.")).to_be_visible()
    admin.get_by_role("button", name="Only what changed since v1").click()
    expect(admin.get_by_role("heading", name="1 change")).to_be_visible()
    assert violations(admin) == []
    admin.get_by_role("button", name="Rehearse both").press("Enter")
    rehearsed = admin.get_by_role("table", name="Both sides rehearsed")
    expect(rehearsed.get_by_role("cell", name="Finishes without errors")).to_have_count(2, timeout=180_000)
    expect(rehearsed.get_by_role("columnheader", name="Devices only here")).to_be_visible()
    expect(rehearsed.get_by_role("row", name="New")).to_contain_text("Painting Machine")
    assert violations(admin) == []
    shoot(admin, "compare-review")
    admin.set_viewport_size({"width": 820, "height": 1180})
    shoot(admin, "compare-review-narrow")
    admin.get_by_role("button", name="Ask for changes").press("Enter")
    admin.keyboard.type("Leave the oven out.")
    admin.get_by_role("button", name="Ask for changes").press("Enter")
    expect(dialog).to_contain_text("Ada Meyer asks for changes: Leave the oven out.")
    admin.get_by_role("button", name="Approve v2").click()
    expect(dialog).to_contain_text("Approved by Ada Meyer")
    dialog.get_by_role("button", name="Run", exact=True).press("Enter")
    expect(page).to_have_url(re.compile("/runs/"))
    expect(page.get_by_text("Approved by Ada Meyer")).to_be_visible()
    shoot(page, "run-approved")
    end_run(page, run_of(page))


@pytest.mark.parametrize(("dark", "language"), [(True, "de")])
def test_an_admin_starts_in_an_emergency_with_a_reason_that_stands_on_the_runs_page(
    sign_in: SignIn, admin: Page, dark: bool, language: str
) -> None:
    path = make_program(admin, "Emergency")
    draw_task(admin)
    saved(admin)
    assert ask(admin, f"{SITE}/review-rule") == {"approvals": 1, "least_role": "author"}
    page = sign_in("admin", path, width=820, height=1180, dark=dark, language=language)
    page.get_by_role("banner").get_by_role("button", name="Ausführen", exact=True).click()
    dialog = page.get_by_role("dialog")
    start = dialog.get_by_role("button", name="Ausführen", exact=True)
    expect(dialog).to_contain_text("So, wie es ist, hat es niemand freigegeben")
    expect(start).to_be_disabled()
    dialog.get_by_label("Notstart: warum?").fill("Der Ofen muss leer werden.")
    assert violations(page) == []
    shoot(page, "emergency")
    start.press("Enter")
    expect(page).to_have_url(re.compile("/runs/"))
    expect(page.get_by_text("Notstart: Der Ofen muss leer werden.")).to_be_visible()
    assert violations(page) == []
    shoot(page, "run-emergency")
    lines = ask(page, f"{SITE}/audit?kind=runs")
    assert "Der Ofen muss leer werden." in str(lines)
    end_run(page, run_of(page))

"""What could not be taken in: said to admins on every screen, looked at, tried again and dropped, by keyboard alone."""

from __future__ import annotations

import re
import sqlite3
from collections.abc import Iterator
from contextlib import suppress
from uuid import uuid4

import pytest
from playwright.sync_api import Error, Locator, Page, Route, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import violations
from tests.kit.demo import Demo

pytestmark = pytest.mark.browser
SITE = "/sites/painting-factory"
LIST = "**/dead-letters?state=open"
NONE = "Nothing is set aside: all that came was processed."


@pytest.fixture
def bad_message(demo: Demo) -> Iterator[None]:
    """Put what nobody can read into the inbox of the floor, as a gateway of another version might."""
    run(
        demo,
        "INSERT INTO execution_inboxevent (site, target, key, payload, created_at) VALUES "
        "('painting-factory', 'site:painting-factory', ?, '{\"type\": \"nonsense\", \"x\": 1}', CURRENT_TIMESTAMP)",
        uuid4().hex,
    )
    yield
    run(demo, "DELETE FROM execution_deadletter")


def run(demo: Demo, statement: str, *values: object) -> None:
    with sqlite3.connect(demo.state / "vipo.sqlite3", timeout=30) as database:
        database.execute(statement, values)


def section(page: Page, name: str = "Set aside") -> Locator:
    return page.get_by_role("region", name=name)


def press(page: Page, name: str) -> None:
    page.keyboard.press("Tab")
    expect(page.locator(":focus")).to_contain_text(name)
    page.keyboard.press("Enter")


@pytest.mark.usefixtures("bad_message")
def test_an_admin_is_led_to_what_was_set_aside_and_settles_it_by_keyboard(sign_in: SignIn) -> None:
    page = sign_in("admin", f"{SITE}/runs")
    strip = page.get_by_role("status").filter(has_text="could not be processed wait for you: 1.")
    expect(strip).to_be_visible()
    strip.get_by_role("link", name="Look").press("Enter")
    expect(section(page).get_by_role("heading", name="Set aside")).to_be_focused()
    letter = section(page).get_by_role("listitem")
    expect(letter).to_contain_text("A message of the kind “nonsense” could not be processed.")
    for name in ("Retry", "Drop", "Why, and what it says"):
        page.keyboard.press("Tab")
        expect(page.locator(":focus")).to_contain_text(name)
    page.keyboard.press("Enter")
    expect(letter.get_by_text("UnreadableMessage: There is no message of type 'nonsense'.")).to_be_visible()
    expect(letter.locator("pre")).to_contain_text('"x": 1')
    assert violations(page) == []
    letter.get_by_role("button", name="Retry").press("Enter")
    expect(page.get_by_text("It is given to its run once more.")).to_be_visible()
    expect(section(page).get_by_role("heading", name="Set aside")).to_be_focused()
    expect(letter).to_have_count(1)  # it cannot be read now, either, and is set aside anew
    letter.get_by_role("button", name="Drop").press("Enter")
    dialog = page.get_by_role("dialog", name="Drop this?")
    expect(dialog).to_contain_text("The floor never hears of it.")
    expect(dialog.get_by_role("button", name="Keep")).to_be_focused()
    assert violations(page) == []
    page.keyboard.press("Escape")
    expect(letter.get_by_role("button", name="Drop")).to_be_focused()
    page.keyboard.press("Enter")
    expect(dialog.get_by_role("button", name="Keep")).to_be_focused()
    press(page, "Drop")
    expect(section(page).get_by_text(NONE)).to_be_visible()
    expect(section(page).get_by_role("heading", name="Set aside")).to_be_focused()
    press(page, "Settled before")
    expect(letter).to_have_count(2)
    expect(letter.first).to_contain_text(re.compile("Dropped by .+, "))
    expect(letter.last).to_contain_text(re.compile("Retried by .+, "))
    assert violations(page) == []


@pytest.mark.usefixtures("bad_message")
def test_who_retries_what_another_has_just_dropped_is_told_who_was_first(sign_in: SignIn, faults: list[str]) -> None:
    first, second = sign_in("admin", f"{SITE}/operations"), sign_in("admin", f"{SITE}/operations")
    retry = section(second).get_by_role("button", name="Retry")
    expect(retry).to_be_visible()
    held: list[Route] = []

    def hold(route: Route) -> None:
        held.append(route)

    with second.expect_request(LIST):
        second.route(LIST, hold)
    section(first).get_by_role("button", name="Drop").press("Enter")
    first.get_by_role("dialog").get_by_role("button", name="Drop").press("Enter")
    expect(section(first).get_by_text(NONE)).to_be_visible()
    with second.expect_response("**/retry") as answered:
        retry.press("Enter")
    assert answered.value.status == 409
    second.unroute(LIST)
    for route in held:
        with suppress(Error):  # the page has given some up meanwhile
            route.continue_()
    expect(section(second).get_by_role("alert")).to_contain_text("has dropped it already.")
    expect(section(second).get_by_text(NONE)).to_be_visible()
    expect(section(second).get_by_role("heading", name="Set aside")).to_be_focused()
    assert [fault for fault in faults if "409" not in fault] == []
    faults.clear()


@pytest.mark.usefixtures("bad_message")
def test_in_german_in_the_dark_on_a_small_screen_it_is_read_and_touched(sign_in: SignIn) -> None:
    page = sign_in("admin", f"{SITE}/operations", language="de", dark=True, width=820, height=1180)
    letter = section(page, "Beiseitegelegt").get_by_role("listitem")
    expect(letter).to_contain_text("Nicht verarbeitet: eine Nachricht der Art „nonsense“.")
    letter.get_by_text("Warum, und was darin steht").press("Enter")
    assert violations(page) == []
    assert page.evaluate("document.documentElement.scrollWidth <= window.innerWidth")
    letter.get_by_role("button", name="Verwerfen").press("Enter")
    assert violations(page) == []
    page.get_by_role("dialog").get_by_role("button", name="Verwerfen").press("Enter")
    expect(letter).to_have_count(0)
    section(page, "Beiseitegelegt").get_by_text("Früher erledigt").press("Enter")
    expect(letter).to_contain_text(re.compile("Verworfen von .+, "))
    assert violations(page) == []
    assert page.evaluate("document.documentElement.scrollWidth <= window.innerWidth")


def test_an_author_sees_how_much_waits_for_an_admin_and_nothing_to_press(sign_in: SignIn) -> None:
    page = sign_in("author", f"{SITE}/operations")
    expect(page.get_by_text("Set aside, for an admin")).to_be_visible()
    expect(section(page)).to_have_count(0)

"""A newer version of a library function: seen as a picture, tried with a program's own tests, then taken in."""

from __future__ import annotations

import re
from typing import Any

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.conftest import NOWHERE, SignIn, make_member
from tests.e2e.screens import address_of, ask, shoot, tell, themed, violations
from tests.kit.demo import Demo
from tests.kit.programs import document, step

pytestmark = pytest.mark.browser
SITE = "/api/sites/painting-factory"
F = ("f", "body")
SHELF, BOOTH = {"device": "itemInventory01"}, {"device": "paintMachine01"}
TESTS_LIMIT_MS = 120_000
MANY = 60


def put(page: Page, name: str, content: dict[str, Any]) -> str:
    """Make a program of this content; return its id."""
    program = str(tell(page, f"{SITE}/programs", {"name": name})["id"])
    path = address_of(page, f"/api/programs/{program}/document")
    headers = {"X-CSRFToken": ask(page, "/api/me")["csrf"], "If-Match": page.request.get(path).headers["etag"]}
    sent = page.request.put(path, data={**content, "format": 2}, headers=headers)
    assert sent.status == 204, sent.text()
    return program


def bringing(pause_s: int, **more: Any) -> dict[str, Any]:
    """A program whose function brings a box to the painting machine, and waits."""
    carry = step("pick_and_drop", F, "1V", role="robot", object="box", quantity=1, source=SHELF, target=BOOTH)
    pause = {**step("wait", F, "3V", duration=pause_s), "pos": [16.5, -7.4]}
    return document({"carry": carry, "pause": pause, **more}, functions={"f": {"name": "bringBox", "parameters": []}})


def save(page: Page, name: str, content: dict[str, Any]) -> Any:
    said = {"program": put(page, f"Source of {name}", content), "function": "f", "name": name, "visibility": "site"}
    return tell(page, f"{SITE}/library", said)


def holder(page: Page, library: str) -> str:
    """A program that holds the first version and calls it, with tests of which one is about how long it takes."""
    held = bringing(5)
    held["functions"]["f"]["source"] = {"library": library, "version": 1}
    held["steps"]["call"] = {**step("call", function="f", args={}), "pos": [8.0, -7.4]}
    program = put(page, "Holds an older version", held)
    for text in ("name: It ends\nthen:\n- ends: well\n", "name: It is quick\nthen:\n- within_s: 300\n"):
        tell(page, f"/api/programs/{program}/tests", {"text": text})
    return program


def test_an_update_is_seen_as_a_picture_tried_with_the_tests_and_taken_in(
    sign_in: SignIn, demo: Demo, signed_in: dict[str, Any]
) -> None:
    page = sign_in("author", NOWHERE)
    library = save(page, "Bring a box", bringing(5))["id"]
    told = {**step("notify", F, "5V", message="The box is there", level="info"), "pos": [18.6, -4.6]}
    save(page, "Bring a box", bringing(600, told=told))
    program = holder(page, library)
    page.goto(address_of(page, f"/programs/{program}"))
    page.get_by_role("tab", name=re.compile("^Problems")).press("Enter")
    link = page.get_by_role("link", name="See what changes, and try your tests on it")
    expect(link).to_be_visible()
    shoot(page, "update-offered")
    assert violations(page) == []
    link.press("Enter")

    changes = page.get_by_role("complementary", name="Changes")
    expect(changes.get_by_role("heading", name="2 changes")).to_be_visible()
    expect(page.get_by_text("compatible", exact=True)).to_be_visible()
    page.keyboard.press("ArrowRight")
    expect(changes.locator("[aria-current]")).to_have_count(1)
    tests = page.get_by_role("region", name="Tests of “Holds an older version”")
    tests.get_by_role("button", name="Run them with version 2").press("Enter")
    expect(tests.get_by_text("1 of 2 tests pass")).to_be_visible(timeout=TESTS_LIMIT_MS)
    expect(tests.get_by_text(re.compile("It is quick"))).to_be_visible()
    expect(tests.get_by_text(re.compile("Expected: ends within 5.min"))).to_be_visible()
    for scheme in ("light", "dark"):
        themed(page, scheme)
        assert violations(page) == []
        shoot(page, f"update-compared-{scheme}")

    signed_in["update viewer"] = make_member(demo, "viewer", "Ursel Update")
    viewer = sign_in("update viewer", page.url.removeprefix(demo.url), width=820, height=1180, language="de")
    expect(viewer.get_by_role("heading", name="2 Änderungen")).to_be_visible()
    expect(viewer.get_by_role("button", name=re.compile("ausführen"))).to_have_count(0)
    shoot(viewer, "update-compared-narrow")
    assert violations(viewer) == []

    page.get_by_role("button", name="Back to editor").press("Enter")
    page.get_by_role("tab", name=re.compile("^Problems")).press("Enter")
    assert ask(page, f"/api/programs/{program}/document")["functions"]["f"]["source"]["version"] == 1
    page.get_by_role("button", name=re.compile("^Use version 2")).press("Enter")
    expect(page.get_by_text("Version 2 brought in")).to_be_visible()
    expect(page.get_by_role("link", name="See what changes, and try your tests on it")).to_have_count(0)


def test_a_function_of_many_steps_is_compared_from_the_library(sign_in: SignIn) -> None:
    page = sign_in("author", NOWHERE)
    many = {f"s{at}": step("wait", F, f"5V{at:03d}", duration=1) for at in range(MANY)}
    library = save(page, "Wait often", bringing(5))["id"]
    save(page, "Wait often", bringing(5, **many))
    page.goto(address_of(page, f"/sites/painting-factory/library/{library}"))
    page.get_by_role("tab", name=re.compile("Versions")).press("Enter")
    page.get_by_role("link", name="Compare on the map").press("Enter")
    expect(page.get_by_role("heading", name=f"{MANY} changes")).to_be_visible()
    expect(page.get_by_role("region", name=re.compile("^Tests of"))).to_have_count(0)
    page.get_by_role("combobox", name="New").select_option("1")
    expect(page.get_by_text(re.compile("^This is one version, whole"))).to_be_visible()
    shoot(page, "function-same")
    assert violations(page) == []

"""The library over sites: found by what functions do, told as compatible or breaking, copied; a program promoted."""

from __future__ import annotations

import os
import re
from typing import Any

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import ask, opened, problems, program_named, tell, violations
from tests.kit.programs import document, operate

pytestmark = pytest.mark.browser
SITE = "/sites/painting-factory"
OTHER = "Zinc works"
"""It stands behind all others, so that nobody comes to it who did not choose it."""


def make_site(page: Page) -> str:
    """Make a site without devices and map, and return what it is called in addresses."""
    token = ask(page, "/api/me")["csrf"]
    origin = re.match(r"https?://[^/]+", page.url)
    assert origin is not None
    answer = page.request.post(f"{origin[0]}/api/sites", multipart={"name": OTHER}, headers={"X-CSRFToken": token})
    assert answer.ok, answer.text()
    return str(answer.json()["slug"])


def make_versions(page: Page, name: str, *parameters: list[dict[str, Any]]) -> str:
    """Save a function under a name with these parameters, one version after the other, and return its id."""
    function = ""
    for listed in parameters:
        steps = {"mix": operate("paintMixer01", "mixPaint", ("f", "body"), time=3)}
        drawn = document(steps, functions={"f": {"name": name, "parameters": listed}})
        program = tell(page, f"/api{SITE}/programs", {"name": f"Source of {name}"})["id"]
        url = re.match(r"https?://[^/]+", page.url)
        assert url is not None
        token = ask(page, "/api/me")["csrf"]
        tag = page.request.get(f"{url[0]}/api/programs/{program}/document").headers["etag"]
        put = page.request.put(
            f"{url[0]}/api/programs/{program}/document",
            data={**drawn, "format": 2},
            headers={"X-CSRFToken": token, "If-Match": tag},
        )
        assert put.ok, put.text()
        saved = tell(page, f"/api{SITE}/library", {"program": program, "function": "f", "name": name})
        function = str(saved["id"])
        page.request.delete(f"{url[0]}/api/programs/{program}", headers={"X-CSRFToken": token})
    return function


MINUTES = {"name": "minutes", "type": "number", "unit": "MIN"}


def test_functions_are_found_by_what_they_do_compared_and_copied(sign_in: SignIn) -> None:
    page = sign_in("author", f"{SITE}/library")
    function = make_versions(page, "stirWell", [MINUTES], [{**MINUTES, "unit": "SEC"}])
    page.reload()
    cards = page.get_by_role("main").get_by_role("listitem")
    expect(cards.filter(has_text="cureBox")).to_contain_text("Runs on your devices")
    page.get_by_label("Search by name or what it does").fill("mischt")
    expect(cards.filter(has_text="cureBox")).to_have_count(0)
    expect(cards.filter(has_text="mixPaint")).to_have_count(1)
    page.get_by_role("link", name="stirWell").click()
    detail = page.get_by_role("complementary", name="stirWell")
    expect(detail).to_contain_text("Yes: the devices of this site can do all that it needs.")
    assert violations(page) == []
    detail.get_by_role("tab", name="Versions").press("Enter")
    expect(detail.get_by_role("listitem").filter(has_text="v1")).to_contain_text("first version")
    expect(detail.get_by_role("status")).to_have_text("Breaking since version 1: look at your calls and devices.")
    expect(detail.get_by_text("minutes is in s now instead of min.")).to_have_count(2)
    expect(detail.get_by_role("region", name="Both scripts line by line")).to_contain_text('Number("s")')
    assert violations(page) == []
    detail.get_by_role("tab", name="Used in").press("Enter")
    expect(detail.get_by_text("No program of your sites holds it yet.")).to_be_visible()
    detail.get_by_role("button", name="Copy to a site").press("Enter")
    form = page.get_by_role("dialog", name="Copy stirWell to a site")
    form.get_by_label("Name there").fill("stirWell of ours")
    assert violations(page) == []
    form.get_by_role("button", name="Copy", exact=True).press("Enter")
    copy = page.get_by_role("complementary", name="stirWell of ours")
    expect(copy.get_by_role("link", name="Made from stirWell v2")).to_have_attribute(
        "href", f"{SITE}/library/{function}?from=2"
    )


def test_a_program_goes_to_another_site_and_what_has_no_match_is_marked(sign_in: SignIn) -> None:
    page = sign_in("admin", f"{SITE}/programs")
    origin = page.url.removesuffix(f"{SITE}/programs")
    slug = make_site(page)
    try:
        page.reload()
        row = page.get_by_role("row", name="Paint order")
        row.get_by_role("button", name="Paint order: more").click()
        page.get_by_role("menuitem", name="To another site").click()
        form = page.get_by_role("dialog", name="Take Paint order to another site")
        form.get_by_label("Site", exact=True).select_option(OTHER)
        expect(form.get_by_text(re.compile(r"^\d+ stay open"))).to_be_visible()
        expect(form.get_by_label("Curing Oven")).to_have_value("")
        expect(form).to_contain_text("must: curePaint")
        assert violations(page) == []
        form.get_by_label("Name there").fill("Paint order of zinc")
        form.get_by_role("button", name=f"Make it at {OTHER}").click()
        opened(page)
        expect(problems(page).first).to_be_visible()
        made = page.url.rpartition("/")[2]
        page.goto(f"{origin}/sites/{slug}/history/{made}")
        expect(page.get_by_role("link", name=re.compile("^Made from Paint order, version"))).to_be_visible()
        page.get_by_role("link", name="Compare with it").press("Enter")
        expect(page.get_by_role("heading", name=re.compile(r"^\d+ changes$"))).to_be_visible()
        old = page.get_by_role("button", name=re.compile("painting-factory: v"))
        assert violations(page) == []
        if folder := os.environ.get("VIPO_PICTURES"):
            page.screenshot(path=f"{folder}/compared-with-origin.png")
        old.press("Enter")
        page.get_by_role("menuitem", name=re.compile("painting-factory: Paint order, as drawn now")).press("Enter")
        expect(page.get_by_role("button", name=re.compile("painting-factory: draft"))).to_be_visible()
        expect(page.get_by_role("heading", name=re.compile(r"^\d+ changes$"))).to_be_visible()
    finally:
        page.goto(f"{origin}{SITE}/programs")  # so that the next page of this person begins there
    assert ask(page, f"/api/programs/{made}/origin")["origin"]["id"] == program_named(page, "Paint order")

"""Anybody who may see a site takes its floor along in the forms of other systems, by keyboard."""

from __future__ import annotations

import io
import json
import zipfile
from pathlib import Path

import pytest
import yaml
from playwright.sync_api import Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import violations

pytestmark = pytest.mark.browser
FORMS = ("Nav2 masks", "Open-RMF building", "VDA 5050 layout")


def fetch(page: Page, form: str) -> tuple[str, bytes]:
    page.get_by_role("button", name="Download", exact=True).press("Enter")
    item = page.get_by_role("menuitem", name=form)
    item.focus()
    with page.expect_download() as got:
        page.keyboard.press("Enter")
        # The notice goes after some seconds, and a busy machine may tell of the download no sooner.
        expect(page.get_by_text(form).filter(has_text="is in your downloads")).to_be_visible()
    return got.value.suggested_filename, Path(got.value.path()).read_bytes()


def test_a_viewer_takes_the_floor_along(sign_in: SignIn) -> None:
    page = sign_in("author", "/sites/painting-factory/map")
    page.get_by_role("button", name="Download", exact=True).click()
    expect(page.get_by_role("menuitem")).to_have_count(5)
    assert violations(page) == []
    page.keyboard.press("Escape")
    files = dict(fetch(page, form) for form in FORMS)
    assert list(files) == [f"painting-factory.{ending}" for ending in ("nav2.zip", "building.yaml", "lif.json")]
    masks, building, lif = files.values()
    assert "keepout_mask.pgm" in zipfile.ZipFile(io.BytesIO(masks)).namelist()
    assert yaml.safe_load(building)["levels"]["L1"]["lanes"]
    assert json.loads(lif)["layouts"][0]["stations"]

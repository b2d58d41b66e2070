"""What a browser has to fetch before somebody can draw."""

from __future__ import annotations

import pytest
from playwright.sync_api import Response

from tests.e2e.conftest import SignIn
from tests.e2e.screens import make_program, saved

pytestmark = pytest.mark.browser
MOST_BYTES = 440_000
WITHOUT = "scriptView"
"""The editor of scripts comes beside the map, which does not wait for it; dialogs, which come later, are counted."""


def test_a_program_opens_with_few_scripts_and_all_of_them_are_sent_compressed(sign_in: SignIn) -> None:
    page = sign_in("author")
    make_program(page, "Opened for the first time")
    saved(page)
    address, context, fetched = page.url, page.context, list[Response]()
    page.close()
    assert context.browser is not None
    fresh = context.browser.new_context(locale="en-GB", storage_state=context.storage_state(), service_workers="block")
    try:
        page = fresh.new_page()
        page.on("response", lambda response: fetched.append(response))
        page.goto(address)
        saved(page)
        page.wait_for_load_state("networkidle")
        scripts = {each.url.rsplit("/", 1)[1]: each.all_headers() for each in fetched if each.url.endswith(".js")}
        bytes_of = {name: int(headers["content-length"]) for name, headers in scripts.items()}
        assert [
            name for name, size in bytes_of.items() if size > 1024 and scripts[name].get("content-encoding") != "br"
        ] == []
        assert [name for name in scripts if name.startswith(("Scene3D", "RunScreen", "DevicesPage"))] == []
        assert sum(size for name, size in bytes_of.items() if not name.startswith(WITHOUT)) <= MOST_BYTES
    finally:
        fresh.close()

"""What a browser has to fetch before somebody can draw."""

from __future__ import annotations

import json
import re
import subprocess

import httpx
import pytest
from playwright.sync_api import Response

from tests.e2e.conftest import SignIn
from tests.e2e.screens import make_program, saved
from tests.kit.demo import Demo

pytestmark = pytest.mark.browser
MOST_BYTES = 450_000
WITHOUT = re.compile(r"^(scriptView|\w*Dialog|StepForm|ZoneForm)-")
"""The editor of scripts comes beside the map, which does not wait for it; dialogs and forms come once the program is
on the screen, some time after it or when they are needed."""


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
        assert sum(size for name, size in bytes_of.items() if not WITHOUT.match(name)) <= MOST_BYTES, sorted(
            bytes_of.items(), key=lambda each: -each[1]
        )
    finally:
        fresh.close()


FETCHES = """
const [address] = process.argv.slice(1);
fetch(address, { headers: { "accept-encoding": "br" } }).then(async (answer) => {
  process.stdout.write(JSON.stringify([answer.headers.get("content-encoding"), (await answer.text()).length]));
});
"""


def test_whoever_asks_gets_a_script_as_they_can_read_it(demo: Demo) -> None:
    """Python's and Node's own clients, and one that reads nothing compressed."""
    page = httpx.get(demo.url, timeout=20).text
    address = demo.url.rstrip("/") + re.findall(r'src="(/assets/[^"]+\.js)"', page)[0]

    def get(accepted: str, **headers: str) -> httpx.Response:
        return httpx.get(address, headers={"Accept-Encoding": accepted, **headers}, timeout=20)

    plain = get("identity")
    assert (plain.status_code, plain.headers.get("content-encoding")) == (200, None)
    for accepted, wanted in {"gzip, deflate": "gzip", "gzip, deflate, br": "br", "deflate": None, "": None}.items():
        answer = get(accepted)
        assert answer.headers.get("content-encoding") == wanted, accepted
        assert "accept-encoding" in answer.headers["vary"].lower()
        assert "immutable" in answer.headers["cache-control"]
        assert wanted == "br" or answer.content == plain.content
        assert get(accepted, **{"If-None-Match": answer.headers["etag"]}).status_code == 304
    node = subprocess.run(["node", "-e", FETCHES, address], capture_output=True, text=True, check=True, timeout=60)
    assert json.loads(node.stdout) == ["br", len(plain.text)]

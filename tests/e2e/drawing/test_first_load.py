"""What a browser has to fetch before somebody can draw."""

from __future__ import annotations

import json
import re
import subprocess

import httpx
import pytest
from playwright.sync_api import Response, Route, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import address_of, make_program, saved
from tests.kit.demo import Demo

pytestmark = pytest.mark.browser
MOST_BYTES = 350_000
MOST_SCRIPTS = 12
MOST_FILES = 32
"""Scripts, styles and fonts of a screen beside the editor's: six of them come at a time."""
ENTRIES = ("EditorScreen", "catalogue.en")
"""What opening a program begins with, beside the page's own script. The editor of scripts comes beside the map, which
does not wait for it; dialogs, forms and panels come once the program is on the screen."""
IMPORT = re.compile(r"""(?:from|import)\s*"\./([\w.-]+\.js)\"""")


def bytes_before_drawing(address: str) -> dict[str, int]:
    """Return the scripts that must be there before somebody can draw, with their bytes as sent."""
    with httpx.Client(base_url=address, timeout=60) as client:

        def read(name: str) -> str:
            return client.get(f"/assets/{name}").text

        def size(name: str) -> int:
            sent = client.get(f"/assets/{name}", headers={"Accept-Encoding": "br"})
            return int(sent.headers["content-length"])

        found: dict[str, int] = {}
        texts = ""

        def follow(*waiting: str) -> None:
            nonlocal texts
            for name in waiting:
                if name not in found:
                    found[name] = size(name)
                    text = read(name)
                    texts += text
                    follow(*IMPORT.findall(text))

        [own] = re.findall(r'src="/assets/([^"]+\.js)"', client.get("/").text)
        follow(own)
        follow(*(re.findall(rf"{re.escape(name)}-[\w-]+\.js", texts)[0] for name in ENTRIES))
    return found


def test_a_program_opens_with_few_scripts_and_all_of_them_are_sent_compressed(demo: Demo, sign_in: SignIn) -> None:
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
        large = [name for name, headers in scripts.items() if int(headers["content-length"]) > 1024]
        assert [name for name in large if scripts[name].get("content-encoding") != "br"] == []
        assert [name for name in scripts if name.startswith(("Scene3D", "RunScreen", "DevicesPage"))] == []
        needed = bytes_before_drawing(demo.url)
        assert needed.keys() <= scripts.keys()
        assert sum(needed.values()) <= MOST_BYTES, needed
        assert len(needed) <= MOST_SCRIPTS, needed
    finally:
        fresh.close()


def test_panels_come_while_the_program_does_and_dialogs_after_it(sign_in: SignIn) -> None:
    drawn, page, held = sign_in("author"), sign_in("author"), list[Route]()
    make_program(drawn, "Opened slowly")
    saved(drawn)
    page.route(re.compile(r"/api/programs/[\w-]+$"), lambda route: held.append(route))
    with page.expect_response(re.compile(r"/assets/beside-[\w-]+\.js$")):
        page.goto(drawn.url)
    expect(page.get_by_role("application")).to_have_count(0)
    with page.expect_response(re.compile(r"/assets/later-[\w-]+\.js$")):
        for route in held:
            route.continue_()
    saved(page)


@pytest.mark.parametrize("screen", ["", "/programs", "/devices", "/map", "/runs", "/people"])
def test_a_screen_asks_for_few_files(sign_in: SignIn, screen: str) -> None:
    page, files = sign_in("author"), list[str]()
    page.on("response", lambda response: files.append(response.url))
    page.goto(address_of(page, f"/sites/painting-factory{screen}"))
    expect(page.get_by_role("heading", level=1)).to_be_visible()
    page.wait_for_load_state("networkidle")
    assets = [each.rsplit("/", 1)[1] for each in files if "/assets/" in each]
    assert len(assets) <= MOST_FILES, assets
    assert [each for each in assets if each.startswith(("EditorScreen", "later", "text"))] == []


FETCHES = """
const [address] = process.argv.slice(1);
fetch(address, { headers: { "accept-encoding": "br" } }).then(async (answer) => {
  process.stdout.write(JSON.stringify([answer.headers.get("content-encoding"), (await answer.text()).length]));
});
"""


def test_whoever_asks_gets_a_script_as_they_can_read_it(demo: Demo) -> None:
    """Python's and Node's own clients, and one that reads nothing compressed."""
    page = httpx.get(demo.url, timeout=60).text
    address = demo.url.rstrip("/") + re.findall(r'src="(/assets/[^"]+\.js)"', page)[0]

    def get(accepted: str, **headers: str) -> httpx.Response:
        return httpx.get(address, headers={"Accept-Encoding": accepted, **headers}, timeout=60)

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

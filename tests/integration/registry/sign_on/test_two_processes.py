"""Signing on where two web processes answer for one address: what one has begun the other brings to its end, once."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import httpx
import pytest

from tests.kit.openid import answer_of, run_openid, visit
from tests.kit.servers import free_port
from tests.kit.web import Web, prepare

pytestmark = pytest.mark.servers
AT = "/api/sign-in/providers/acme"
PASSWORD = "a long password"
"""Of all people whom tests.kit.web_process makes."""


@dataclass
class Pair:
    """Two processes that stand behind one address, as behind a proxy: that of the first."""

    webs: tuple[Web, Web]
    host: str

    def ask(self, at: int, browser: httpx.Client, method: str, path: str, body: Any = None) -> httpx.Response:
        """Ask one of them, as the page that one browser has open does."""
        address = f"http://127.0.0.1:{self.webs[at].port}{path}"
        headers = {"Host": self.host, "Origin": f"http://{self.host}"}
        if method != "GET":
            headers["X-CSRFToken"] = self.ask(at, browser, "GET", "/api/me").json()["csrf"]
        return browser.request(method, address, json=body, headers=headers)

    def who_is(self, at: int, browser: httpx.Client) -> str | None:
        user = self.ask(at, browser, "GET", "/api/me").json()["user"]
        return user["email"] if user else None


@pytest.fixture(scope="module")
def pair(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Pair]:
    folder, port = tmp_path_factory.mktemp("web"), free_port()
    host = f"127.0.0.1:{port}"
    with run_openid(tmp_path_factory.mktemp("openid"), [f"http://{host}/sign-on/acme"]) as openid:
        extra = openid.environment()
        sessions = prepare(folder, extra)["sessions"]
        webs = Web(folder, sessions, "", extra, port), Web(folder, sessions, "", extra)
        for web in webs:
            web.start()
        try:
            yield Pair(webs, host)
        finally:
            for web in webs:
                web.kill()


@pytest.mark.parametrize(("begun", "ended"), [(0, 1), (1, 0)])
def test_what_one_process_began_the_other_ends_and_nobody_ends_it_again(pair: Pair, begun: int, ended: int) -> None:
    with httpx.Client(cookies={"sessionid": pair.webs[0].sessions["author"]}, timeout=30) as browser:
        wanted = {"provider": "acme", "password": PASSWORD}
        begin = pair.ask(begun, browser, "POST", "/api/me/sign-ons", wanted)
        assert begin.status_code == 200, begin.text
        address = begin.json()["address"]
        linked = pair.ask(ended, browser, "POST", f"{AT}/finish", answer_of(visit(address, "ada")))
        assert linked.status_code == 200, linked.text

    with httpx.Client(timeout=30) as browser:
        address = pair.ask(begun, browser, "POST", AT, {"next": "/account"}).json()["address"]
        answer = answer_of(visit(address, "ada"))
        first = pair.ask(ended, browser, "POST", f"{AT}/finish", answer)
        assert first.status_code == 200, first.text
        assert [pair.who_is(at, browser) for at in (begun, ended)] == ["author@vipo.example"] * 2
        assert pair.ask(begun, browser, "POST", f"{AT}/finish", answer).json()["code"] == "sign_on_failed"
        assert pair.ask(begun, browser, "POST", "/api/sign-out").status_code == 200
        assert [pair.who_is(at, browser) for at in (begun, ended)] == [None, None]


def test_what_one_browser_began_another_cannot_end_at_the_other_process(pair: Pair) -> None:
    with httpx.Client(timeout=30) as mine, httpx.Client(timeout=30) as theirs:
        answer = answer_of(visit(pair.ask(0, mine, "POST", AT, {}).json()["address"], "ada"))
        assert pair.ask(1, theirs, "POST", f"{AT}/finish", answer).json()["code"] == "sign_on_failed"
        assert pair.who_is(1, theirs) is None

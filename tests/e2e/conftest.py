"""A running demo, a real Chromium, and people who sign in.

The fixtures live as long as this package's tests: Playwright keeps an event loop of its own, which tests elsewhere that
bring their own loop would meet.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Protocol

import pytest
from playwright.sync_api import Browser, BrowserContext, ConsoleMessage, Page, WebError, expect, sync_playwright

from tests.kit.demo import Demo, running_demo
from tests.kit.files import ROOT
from tests.kit.processes.forked import run_forked

CHROMIUM = "/usr/bin/chromium-headless-shell"
FLAGS = [
    "--no-sandbox",
    "--disable-gpu",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
PATIENCE_MS = 90_000
DEVICES = 11

MAKE_MEMBER = """
import json
from django.conf import settings
from django.contrib.auth import BACKEND_SESSION_KEY, HASH_SESSION_KEY, SESSION_KEY
from django.contrib.sessions.backends.db import SessionStore
from django.utils.text import slugify
from registry.models import Membership, Site, User
email = f"{slugify(name)}@x.example"
user = User.objects.create_user(email=email, password="not used here", display_name=name)
Membership.objects.create(user=user, site=Site.objects.get(slug="painting-factory"), role=role)
session = SessionStore()
session[SESSION_KEY], session[HASH_SESSION_KEY] = str(user.pk), user.get_session_auth_hash()
session[BACKEND_SESSION_KEY] = settings.AUTHENTICATION_BACKENDS[0]
session.create()
print(json.dumps({"name": settings.SESSION_COOKIE_NAME, "value": session.session_key}))
"""


NOWHERE = "/health"
"""An address that shows no screen, for who goes on to another at once: a first screen takes a second of a processor."""


class SignIn(Protocol):
    """Opens a browser of its own for a person of a role, signed in, and in it a screen, if one is named.

    It keeps nothing for times without a server, and prefers no motion, unless the test is of that: without a graphics
    card a frame of what moves takes long.
    """

    def __call__(
        self,
        role: str,
        at: str = NOWHERE,
        *,
        width: int = 1600,
        height: int = 1000,
        dark: bool = False,
        language: str = "",
        offline: bool = False,
        motion: bool = False,
    ) -> Page: ...


@pytest.fixture(scope="package")
def demo(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Demo]:
    with pytest.MonkeyPatch.context() as surroundings:
        surroundings.setenv("VIPO_REHEARSALS_AT_ONCE", "2")  # on whatever machine: more wait
        with running_demo(tmp_path_factory.mktemp("demo") / "state") as running:
            yield running


@pytest.fixture(scope="package")
def chromium() -> Iterator[Browser]:
    assert Path(CHROMIUM).exists(), "Chromium is missing: run `make servers`, which installs Debian's."
    expect.set_options(timeout=PATIENCE_MS)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield browser
        browser.close()


@pytest.fixture(scope="package")
def signed_in(demo: Demo, chromium: Browser) -> dict[str, Any]:
    """What a browser keeps of each role's sign-in, so that most tests need not go through the form."""
    states = {role: sign_in_by_form(chromium, demo, role) for role in ("admin", "author")}
    wait_for_devices(chromium, demo, states["author"])
    return states


def sign_in_by_form(chromium: Browser, demo: Demo, role: str) -> Any:
    context = chromium.new_context(locale="en-GB", service_workers="block")
    page = context.new_page()
    account = demo.account(role)
    page.goto(f"{demo.url}/sign-in")
    page.get_by_label("Email address").fill(account.email)
    page.get_by_label("Password", exact=True).fill(account.password)
    page.get_by_role("button", name="Sign in", exact=True).click()
    page.wait_for_url(f"{demo.url}/")
    # The site that was last looked at: other tests make sites, and without it the first of all would be theirs.
    page.evaluate("localStorage.setItem('vipo.site', 'painting-factory')")
    state = context.storage_state()
    context.close()
    return state


def make_member(demo: Demo, role: str, name: str) -> Any:
    """Make somebody with this role at the painting factory; return what their browser keeps of their sign-in."""
    made = in_shell(demo, f"role, name = {role!r}, {name!r}{MAKE_MEMBER}")
    common = {"domain": "127.0.0.1", "path": "/", "expires": -1, "httpOnly": True, "secure": False, "sameSite": "Lax"}
    return {"cookies": [{**json.loads(made), **common}], "origins": []}


def in_shell(demo: Demo, script: str) -> str:
    """Carry out Python with the demo's database, as `manage.py shell` does; return what it prints."""
    command = [sys.executable, "manage.py", "shell", "--verbosity", "0", "-c", script]
    environment = {**os.environ, "VIPO_STATE_DIR": str(demo.state)}
    environment.pop("DJANGO_SETTINGS_MODULE", None)
    return str(run_forked(command, cwd=ROOT, env=environment, check=True, capture_output=True, text=True).stdout)


def wait_for_devices(chromium: Browser, demo: Demo, state: Any) -> None:
    """Wait until the factory is complete: the machines and robots join by themselves, one after the other."""
    context = chromium.new_context(locale="en-GB", storage_state=state, service_workers="block")
    page = context.new_page()
    page.goto(f"{demo.url}/sites/painting-factory/devices")
    expect(page.locator("tbody tr")).to_have_count(DEVICES, timeout=180_000)
    context.close()


@pytest.fixture
def faults() -> Iterator[list[str]]:
    """What the test's browsers complain of; a test that provokes a complaint clears it, all others must have none."""
    heard: list[str] = []
    yield heard
    assert heard == []


@pytest.fixture
def sign_in(demo: Demo, chromium: Browser, signed_in: dict[str, Any], faults: list[str]) -> Iterator[SignIn]:
    contexts: list[BrowserContext] = []

    def open_for(
        role: str,
        at: str = NOWHERE,
        *,
        width: int = 1600,
        height: int = 1000,
        dark: bool = False,
        language: str = "",
        offline: bool = False,
        motion: bool = False,
    ) -> Page:
        context = chromium.new_context(
            viewport={"width": width, "height": height},
            color_scheme="dark" if dark else "light",
            locale="de-DE" if language == "de" else "en-GB",
            storage_state=signed_in.get(role),
            permissions=["clipboard-read", "clipboard-write"],
            service_workers="allow" if offline else "block",
            reduced_motion="no-preference" if motion else "reduce",
        )
        contexts.append(context)
        listen(context, faults)
        page = context.new_page()
        page.set_default_timeout(PATIENCE_MS)
        page.goto(demo.url + at)
        return page

    yield open_for
    for context in contexts:
        context.close()


def listen(context: BrowserContext, faults: list[str]) -> None:
    def on_console(message: ConsoleMessage) -> None:
        if message.type == "error":
            faults.append(f"{message.text} ({json.dumps(message.location)})")

    def on_error(error: WebError) -> None:
        faults.append(f"{error.error.message}\n{error.error.stack or ''}")

    context.on("console", on_console)
    context.on("weberror", on_error)

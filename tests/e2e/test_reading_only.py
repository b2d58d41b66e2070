"""Who may only look sees the whole editor, and can change nothing in it."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from typing import Any

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import SITE, ask, chip, the_map
from tests.kit.demo import Demo
from tests.kit.files import ROOT

pytestmark = pytest.mark.browser

MAKE_VIEWER = """
import json
from django.conf import settings
from django.contrib.auth import BACKEND_SESSION_KEY, HASH_SESSION_KEY, SESSION_KEY
from django.contrib.sessions.backends.db import SessionStore
from registry.models import Membership, Site, User
user = User.objects.create_user(email="viewer@x.example", password="not used here", display_name="Vera Look")
Membership.objects.create(user=user, site=Site.objects.get(slug="painting-factory"), role="viewer")
session = SessionStore()
session[SESSION_KEY], session[HASH_SESSION_KEY] = str(user.pk), user.get_session_auth_hash()
session[BACKEND_SESSION_KEY] = settings.AUTHENTICATION_BACKENDS[0]
session.create()
print(json.dumps({"name": settings.SESSION_COOKIE_NAME, "value": session.session_key}))
"""


@pytest.fixture(scope="module")
def viewer(demo: Demo, signed_in: dict[str, Any]) -> None:
    """Somebody who may look at the painting factory, signed in."""
    command = [sys.executable, "manage.py", "shell", "--verbosity", "0", "-c", MAKE_VIEWER]
    environment = {**os.environ, "VIPO_STATE_DIR": str(demo.state)}
    environment.pop("DJANGO_SETTINGS_MODULE", None)
    made = subprocess.run(command, cwd=ROOT, env=environment, check=True, capture_output=True, text=True)
    common = {"domain": "127.0.0.1", "path": "/", "expires": -1, "httpOnly": True, "secure": False, "sameSite": "Lax"}
    signed_in["viewer"] = {"cookies": [{**json.loads(made.stdout), **common}], "origins": []}


def open_paint_order(page: Page) -> None:
    program = next(each["id"] for each in ask(page, f"{SITE}/programs") if each["name"] == "Paint order")
    page.goto(f"{page.url.rstrip('/')}/programs/{program}")
    expect(page.get_by_role("banner").get_by_text("Read only")).to_be_visible()


@pytest.mark.usefixtures("viewer")
def test_who_may_only_look_changes_nothing(sign_in: SignIn) -> None:
    page = sign_in("viewer")
    open_paint_order(page)
    expect(page.get_by_label("Name of the program")).to_have_count(0)
    expect(page.get_by_role("toolbar", name="Tools").get_by_role("button")).to_have_count(2)
    for name in ("Simulate", "Run"):
        expect(page.get_by_role("banner").get_by_role("button", name=name, exact=True)).to_be_disabled()
    task = chip(page, "2, Pick-and-Drop")
    task.click()
    expect(page.get_by_role("complementary", name="Selected step")).to_contain_text("Step 2")
    expect(page.get_by_role("combobox", name="Quantity")).to_be_disabled()
    expect(page.locator("[data-form] :is(input, textarea, button):enabled")).to_have_count(0)
    expect(page.get_by_role("tabpanel").locator(".cm-content")).to_have_attribute("contenteditable", "false")
    keys_do_nothing(page)
    dragging_moves_nothing(page)


def keys_do_nothing(page: Page) -> None:
    steps = chip(page, "").count()
    for key in ("Delete", "p", "Control+d", "Alt+ArrowLeft"):
        page.keyboard.press(key)
    expect(page.get_by_role("toolbar", name="Tools").get_by_role("button", pressed=True)).to_have_accessible_name(
        "Select"
    )
    assert chip(page, "").count() == steps


def away(first: Locator, second: Locator) -> dict[str, float]:
    """Return how far one stands from the other, both measured at one moment: the map may still be moving."""
    places = "(one, other) => [one, other].map((each) => each.getBoundingClientRect().toJSON())"
    one, other = first.evaluate(places, second.element_handle())
    return {axis: one[axis] - other[axis] for axis in ("x", "y")}


def dragging_moves_nothing(page: Page) -> None:
    """The map moves under the pointer as a whole: the step stays where it is among the machines."""
    first, second = chip(page, "2, Pick-and-Drop"), chip(page, "9, Move")
    before = away(first, second)
    first.hover()
    page.mouse.down()
    page.mouse.move(500, 500, steps=4)
    page.mouse.up()
    assert away(first, second) == pytest.approx(before, abs=1)
    expect(the_map(page).get_by_role("group", name=re.compile("^2, Pick-and-Drop"))).to_have_count(1)

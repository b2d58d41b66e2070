"""What devices take is measured beside their copies, seen by everybody, and used in rehearsals by who decides it."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import ask, tell, violations
from tests.kit.waiting import wait_for

pytestmark = pytest.mark.browser
SITE = "painting-factory"
TIMES = 6


def blink(page: Page, robot: str) -> None:
    """Let a robot blink for half a minute of its time, and wait for the end of it."""
    call = tell(page, f"/api/sites/{SITE}/devices/{robot}/call", {"method": "blink", "args": {"time": 30}})
    is_over = ("done", "failed", "rejected", "timed_out")
    wait_for("the end of it", lambda: ask(page, f"/api/sites/{SITE}/calls/{call['id']}")["status"] in is_over)


def test_measured_times_grow_and_are_taken_over_by_keyboard_while_another_looks_on(
    sign_in: SignIn, faults: list[str]
) -> None:
    operator = sign_in("admin", f"/sites/{SITE}/devices/robot03")
    onlooker = sign_in("author", f"/sites/{SITE}/devices/robot03")
    times = [page.get_by_role("region", name="Measured times") for page in (operator, onlooker)]
    for _ in range(TIMES):
        blink(operator, "robot03")
    for part in times:
        expect(part).to_contain_text(re.compile(r"blink.*measured [6-9]"))
        expect(part.get_by_role("img", name=re.compile("^blink, the last [6-9]: from "))).to_be_visible()
    paces = {pace["method"]: pace for pace in ask(operator, f"/api/sites/{SITE}/devices/robot03/paces")}
    assert paces["blink"]["count"] >= TIMES
    assert violations(operator) == []
    taken = operator.evaluate(
        """async (path) => (await fetch(path, {method: 'PUT', headers: {'X-CSRFToken':
        (await (await fetch('/api/me')).json()).csrf}})).status""",
        f"/api/sites/{SITE}/devices/robot03/paces/blink",
    )
    assert taken == 200
    operator.reload()
    expect(times[0]).to_contain_text("Rehearsals and tests take")
    times[0].get_by_role("button", name=re.compile("^Use the model.s time of blink in rehearsals")).press("Enter")
    expect(times[0]).not_to_contain_text("Rehearsals and tests take")
    faults[:] = [line for line in faults if "/robot03/map" not in line]  # it may have sent no map yet

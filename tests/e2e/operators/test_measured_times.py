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


def call(page: Page, device: str, method: str, time: float) -> None:
    """Let a device do something for so long, and wait for the end of it."""
    call = tell(page, f"/api/sites/{SITE}/devices/{device}/call", {"method": method, "args": {"time": time}})
    is_over = ("done", "failed", "rejected", "timed_out")
    wait_for("the end of it", lambda: ask(page, f"/api/sites/{SITE}/calls/{call['id']}")["status"] in is_over)


def test_measured_times_grow_and_are_taken_over_by_keyboard_while_another_looks_on(
    sign_in: SignIn, faults: list[str]
) -> None:
    operator = sign_in("admin", f"/sites/{SITE}/devices/robot03")
    onlooker = sign_in("author", f"/sites/{SITE}/devices/robot03")
    times = [page.get_by_role("region", name="Measured times") for page in (operator, onlooker)]
    for _ in range(TIMES):
        call(operator, "robot03", "blink", 30)
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
    times[0].get_by_role("button", name=re.compile("^Use the model.s time: blink")).press("Enter")
    expect(times[0]).not_to_contain_text("Rehearsals and tests take")
    faults[:] = [line for line in faults if "/robot03/map" not in line]  # it may have sent no map yet


def test_the_firmware_is_measured_like_any_other_device(sign_in: SignIn) -> None:
    """It runs on MicroPython in a process of its own, and shares no code with the copy."""
    page = sign_in("author", f"/sites/{SITE}/devices/paintMixer02")
    call(page, "paintMixer02", "mixPaint", 3)  # so long that a busy machine adds less than a tenth
    times = page.get_by_role("region", name="Measured times")
    expect(times).to_contain_text(re.compile("mixPaint.*as its model"))
    (pace,) = ask(page, f"/api/sites/{SITE}/devices/paintMixer02/paces")
    assert 0.9 < pace["usual"] < 1.1

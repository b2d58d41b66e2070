"""The page for operators: what waits, which processes beat, and what every screen says while one stands still."""

from __future__ import annotations

import sqlite3
from datetime import UTC, datetime, timedelta
from uuid import uuid4

import pytest
from playwright.sync_api import expect

from tests.e2e.conftest import SignIn
from tests.e2e.screens import violations
from tests.kit.demo import Demo

pytestmark = pytest.mark.browser
SITE = "/sites/painting-factory"


def test_an_admin_finds_by_keyboard_that_all_processes_work(sign_in: SignIn) -> None:
    page = sign_in("admin", f"{SITE}/runs")
    page.get_by_role("link", name="Operations").press("Enter")
    expect(page.get_by_role("heading", level=1, name="Operations")).to_be_visible()
    processes = page.get_by_role("region", name="Processes")
    for kind, count in {"Gateway": 1, "Ticker": 1, "Twin": 1, "Web": 1, "Worker": 2}.items():
        expect(processes.get_by_role("row").filter(has_text=kind).filter(has_text="Works")).to_have_count(count)
    expect(processes.get_by_role("row").filter(has_text="Ticker")).to_contain_text("leads")
    expect(page.get_by_text("All processes work")).to_be_visible()
    expect(page.get_by_text("Commands to send").first).to_be_visible()


def test_an_author_sees_what_waits_and_not_the_processes(sign_in: SignIn) -> None:
    page = sign_in("author", f"{SITE}/operations")
    expect(page.get_by_text("Commands to send")).to_have_count(1)
    expect(page.get_by_text("Every device has answered its commands.")).to_be_visible()
    expect(page.get_by_role("region", name="Processes")).to_have_count(0)


@pytest.mark.parametrize(
    ("language", "dark", "width", "height", "strip", "silent"),
    [
        ("en", False, 1600, 1000, "61.3\u202fs behind", "has been silent for"),
        ("de", True, 820, 1180, "61,3\u202fs nach", "schweigt seit"),
    ],
)
def test_a_clock_that_is_off_is_said_on_every_screen_until_it_is_right(
    demo: Demo, sign_in: SignIn, language: str, dark: bool, width: int, height: int, strip: str, silent: str
) -> None:
    page = sign_in("admin", f"{SITE}/runs", language=language, dark=dark, width=width, height=height)
    worker, gateway = uuid4().hex, uuid4().hex
    told_of_gateway = page.get_by_text(f"gateway-edge {silent}")
    try:
        write_process(demo, worker, "worker", ahead_s=600, apart_s=-61.3)
        write_process(demo, gateway, "gateway", ahead_s=-42)
        said = page.get_by_role("status").filter(has_text=strip)
        expect(said).to_be_visible()
        assert violations(page) == []
        said.get_by_role("link").press("Enter")
        expect(told_of_gateway).to_be_visible()
        assert violations(page) == []
        assert page.evaluate("document.documentElement.scrollWidth <= window.innerWidth")
    finally:
        run(demo, "DELETE FROM registry_heartbeat WHERE id IN (?, ?)", worker, gateway)
    expect(told_of_gateway).to_have_count(0)


def write_process(demo: Demo, key: str, kind: str, *, ahead_s: float, apart_s: float | None = None) -> None:
    """Let a process of another machine have beaten; `ahead_s` is when, from now."""
    at = (datetime.now(UTC) + timedelta(seconds=ahead_s)).strftime("%Y-%m-%d %H:%M:%S.%f")
    run(
        demo,
        "INSERT INTO registry_heartbeat (id, kind, name, machine, process, version, activity, since, at, "
        "clock_apart_s, counters) VALUES (?, ?, ?, 'edge', 7, '0.1.0', 'works', ?, ?, ?, '{}')",
        *(key, kind, f"{kind}-edge", at, at, apart_s),
    )


def run(demo: Demo, statement: str, *values: object) -> None:
    with sqlite3.connect(demo.state / "vipo.sqlite3", timeout=30) as database:
        database.execute(statement, values)

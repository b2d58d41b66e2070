"""Ctrl-C ends everything, and the next start has everything that was there."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from playwright.sync_api import Browser, expect

from tests.e2e.conftest import sign_in_by_form
from tests.e2e.screens import TASK, chip, draw_task, open_program, saved
from tests.kit.demo import Demo, running_demo, stop_process_group

pytestmark = pytest.mark.browser


def children_of(group: int) -> list[str]:
    """The command lines of the processes that live in a process group."""
    found = []
    for entry in Path("/proc").iterdir():
        if not entry.name.isdigit():
            continue
        try:
            state, _, process_group = (entry / "stat").read_text().rpartition(")")[2].split()[:3]
            command = (entry / "cmdline").read_text().replace("\0", " ")
        except (FileNotFoundError, ProcessLookupError):
            continue
        if int(process_group) == group and state != "Z" and int(entry.name) != os.getpid():
            found.append(command)
    return found


def draw_and_leave(chromium: Browser, demo: Demo) -> None:
    context = chromium.new_context(locale="en-GB", storage_state=sign_in_by_form(chromium, demo, "author"))
    page = context.new_page()
    page.goto(demo.url)
    open_program(page, "First task")
    draw_task(page)
    expect(chip(page, f"1, {TASK}")).to_be_visible()
    saved(page)
    context.close()


def test_a_drawing_survives_ctrl_c_and_nothing_is_left_running(chromium: Browser, tmp_path: Path) -> None:
    state = tmp_path / "state"
    with running_demo(state, from_nothing=True) as demo:
        draw_and_leave(chromium, demo)
        assert "manage.py twin" in " ".join(children_of(demo.process.pid))
        assert stop_process_group(demo.process) == 0
        assert children_of(demo.process.pid) == []
        assert "Traceback" not in demo.log.read_text()
    with running_demo(state) as demo:
        context = chromium.new_context(locale="en-GB", storage_state=sign_in_by_form(chromium, demo, "author"))
        page = context.new_page()
        page.goto(demo.url)
        open_program(page, "First task")
        expect(chip(page, f"1, {TASK}")).to_be_visible()
        context.close()

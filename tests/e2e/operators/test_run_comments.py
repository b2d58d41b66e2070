"""Two people talk about a moment of a run: chosen on the timeline or in the journal, read there and at the program."""

from __future__ import annotations

import re
from typing import Any
from urllib.parse import urlsplit

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.conftest import SignIn, make_member
from tests.e2e.screens import address_of, draw_task, make_program, run_state, saved, shoot, start_run, violations
from tests.kit.demo import Demo

pytestmark = pytest.mark.browser
RUN_OVER_MS = 120_000


@pytest.fixture(scope="module")
def people(demo: Demo, signed_in: dict[str, Any]) -> tuple[str, str]:
    """Somebody who may comment, and somebody who may only look, signed in."""
    signed_in["run commenter"] = make_member(demo, "commenter", "Runa Note")
    signed_in["run viewer"] = make_member(demo, "viewer", "Victor Look")
    return "run commenter", "run viewer"


def path_of(page: Page) -> str:
    return urlsplit(page.url).path


def test_a_moment_of_a_run_is_talked_about_and_leads_back_to_it(sign_in: SignIn, people: tuple[str, str]) -> None:
    author = sign_in("author")
    program = make_program(author, "Talked about while it runs")
    draw_task(author)
    saved(author)
    start_run(author)
    expect(author.get_by_role("slider", name="Moment of the run")).to_be_visible(timeout=180_000)
    run = path_of(author)
    writer = sign_in(people[0], run, dark=True, language="de", width=820, height=1180)
    scale = writer.get_by_role("slider", name="Augenblick des Laufs")
    expect(scale).not_to_have_attribute("aria-valuenow", re.compile("^[01]$"))  # before that there is no second one
    scale.press("Home")
    scale.press("ArrowRight")
    expect(scale).to_have_attribute("aria-valuetext", "0:01")
    shoot(writer, "run-moment")
    assert violations(writer) == []
    scale.press("Enter")
    expect(writer.get_by_role("textbox", name=re.compile("^Kommentar zu 0:01"))).to_be_focused()
    writer.keyboard.type("Warum fährt er hier so spät los?")
    writer.keyboard.press("Control+Enter")
    written = writer.get_by_role("tabpanel", name=re.compile("^Kommentare"))
    expect(written.get_by_text("Warum fährt er hier so spät los?")).to_be_visible()
    shoot(writer, "run-comments-narrow")
    assert violations(writer) == []

    expect(author.get_by_role("tab", name="Comments 1 unread comment")).to_be_visible()
    shoot(author, "run-pin")
    assert violations(author) == []
    author.get_by_role("button", name="1 open thread: 0:01").press("Enter")
    talk = author.get_by_role("listitem", name=re.compile("^0:01"))
    expect(talk).to_be_focused()
    talk.get_by_role("button", name="Answer").press("Enter")
    author.keyboard.type("It waits for the box.")
    author.keyboard.press("Control+Enter")
    expect(written.get_by_text("It waits for the box.")).to_be_visible()
    shoot(author, "run-comments")
    assert violations(author) == []
    expect(run_state(author)).to_have_text(re.compile("Finished"), timeout=RUN_OVER_MS)

    author.goto(address_of(author, program))
    author.get_by_role("tab", name=re.compile("^Comments")).press("Enter")
    expect(author.get_by_role("link", name=re.compile(r"^Run \d+ at 0:01 · 1 .* box"))).to_be_visible()
    shoot(author, "run-moment-editor")
    assert violations(author) == []
    author.get_by_role("link", name=re.compile(r"^Run \d+ at 0:01")).press("Enter")
    expect(author.get_by_role("listitem", name=re.compile("^0:01"))).to_be_focused()
    author.get_by_role("tab", name="Timeline").press("Enter")
    expect(author.get_by_role("slider", name="Moment of the run")).to_have_attribute("aria-valuetext", "0:01")
    author.get_by_role("button", name="1 open thread: 0:01").press("Enter")
    talk.get_by_role("button", name="Resolve").press("Enter")
    expect(written.get_by_text("Warum fährt er hier so spät los?")).to_have_count(0)
    author.get_by_role("tab", name="Timeline").press("Enter")
    expect(author.get_by_role("button", name=re.compile("open thread"))).to_have_count(0)


def test_who_may_only_look_reads_and_is_offered_nothing_to_write(sign_in: SignIn, people: tuple[str, str]) -> None:
    author = sign_in("author")
    make_program(author, "Looked at while it runs")
    draw_task(author)
    saved(author)
    start_run(author)
    journal = author.get_by_role("region", name="Journal")
    journal.get_by_role("button", name=re.compile("^Comment on 0:")).first.click()
    author.keyboard.type("Seen by all.")
    author.keyboard.press("Control+Enter")
    reader = sign_in(people[1], path_of(author))
    expect(reader.get_by_role("region", name="Journal").locator("li").first).to_be_visible()
    expect(reader.get_by_role("button", name=re.compile("^Comment on"))).to_have_count(0)
    reader.get_by_role("tab", name="Comments 1 unread comment").press("Enter")
    told = reader.get_by_role("tabpanel", name=re.compile("^Comments"))
    expect(told.get_by_text("Seen by all.")).to_be_visible()
    expect(told.get_by_role("button", name=re.compile("Comment on|Answer|Resolve"))).to_have_count(0)
    told.get_by_role("button", name="Mark 1 as read").press("Enter")
    expect(reader.get_by_role("tab", name="Comments", exact=True)).to_be_visible()
    shoot(reader, "run-comments-viewer")
    assert violations(reader) == []

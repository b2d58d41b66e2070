"""docs/shapes names the messages that are told, to browsers of a site and to devices of a stop, and what a zone is."""

from __future__ import annotations

import json
import re
from datetime import UTC, datetime

from editor.language.tree.zones import FEWEST_CORNERS, MOST_CORNERS, RULES
from execution.floor.stops import StopView, stop_payload
from tests.kit.files import ROOT

SHAPES = ROOT / "docs" / "shapes"


def test_the_page_of_the_site_socket_names_the_messages_that_browsers_know() -> None:
    source = (ROOT / "frontend" / "src" / "live" / "messages.ts").read_text(encoding="utf-8")
    (known,) = re.findall(r"export type LiveMessage =(.*?);\n\n", source, re.DOTALL)
    named = re.findall(r"^\| `(\w+)` \|", (SHAPES / "site-socket.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert sorted(set(named) - {"type"}) == sorted(set(re.findall(r'\btype: "(\w+)"', known)) | {"library"})


def test_the_page_of_wake_ups_shows_a_stop_as_devices_are_told_it() -> None:
    (shown,) = re.findall(r"^A stop is `(.*?)`", (SHAPES / "wake-ups.md").read_text(encoding="utf-8"), re.MULTILINE)
    stop = StopView("hall", True, "Ada", datetime(2026, 1, 1, 12, tzinfo=UTC), 1767268800000)
    assert json.loads(shown) == json.loads(stop_payload(stop))


def test_the_page_of_the_document_names_the_rules_of_zones_and_how_many_corners_one_has() -> None:
    (shown,) = re.findall(r"`zones: \{id: .*? in metres, .*?\.", (SHAPES / "document.md").read_text(encoding="utf-8"))
    assert [rule for rule in RULES if f"`{rule}`" not in shown] == []
    assert shown.endswith(f"{FEWEST_CORNERS} to {MOST_CORNERS}.")

"""Every reason that execution gives is known by a code, and the screens have words for it."""

from __future__ import annotations

import ast
import json
import re
from collections.abc import Iterator
from datetime import UTC, datetime

import pytest

from execution.models import RunEvent
from execution.reasons import SAID, SENTENCES, cause_of
from execution.views import view_event
from tests.kit.files import ROOT

SOURCES = sorted((ROOT / "execution").rglob("*.py"))
GIVERS = {"Failure", "Wake", "EvaluationError", "NoReading", "NoSuchSpot", "finish", "_give_up"}
OTHERS = {"rehearsal.py"}
"""Rehearsals give up with errors that have codes of their own."""


def given_reasons() -> Iterator[str]:
    """Give the sentences with which the code gives reasons, with `7` for what it fills in."""
    for path in SOURCES:
        calls = [node for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))) if isinstance(node, ast.Call)]
        for call in calls if path.name not in OTHERS else []:
            name = getattr(call.func, "id", getattr(call.func, "attr", ""))
            for text in map(sentence_of, call.args if name in GIVERS else []):
                if " " in text:
                    yield text


def is_foreign(reason: str) -> bool:
    cause = cause_of(reason)
    return cause is None or cause["code"] == SAID


def sentence_of(node: ast.expr) -> str:
    if isinstance(node, ast.JoinedStr):
        return "".join(str(part.value) if isinstance(part, ast.Constant) else "7" for part in node.values)
    return node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else ""


def test_every_reason_in_the_code_has_a_code() -> None:
    reasons = list(given_reasons())
    assert len(reasons) > 35
    assert [reason for reason in reasons if is_foreign(reason)] == []


@pytest.mark.parametrize("code", SENTENCES)
def test_a_reason_is_taken_apart_into_what_it_was_made_of(code: str) -> None:
    args = {name: f"some {name}, 7." for name in re.findall(r"\{(\w+)\}", SENTENCES[code])}
    assert cause_of(SENTENCES[code].format_map(args)) == {"code": code, "args": args}


@pytest.mark.parametrize("words", ["Lid open", "It paused it twice\nand again.", "Ada paused it, too"])
def test_what_a_device_says_itself_stays_as_it_is(words: str) -> None:
    assert cause_of(words) == {"code": SAID, "args": {"words": words}}


def test_no_reason_has_no_cause() -> None:
    assert cause_of("") is None


@pytest.mark.parametrize(
    ("kind", "code", "text", "cause"),
    [
        ("step", "step_offline", "Oven is offline.", {"code": "offline", "args": {"device": "Oven"}}),
        ("step", "step_failed", "Lid: open", {"code": SAID, "args": {"words": "Lid: open"}}),
        ("step", "step_done", "The step is done.", None),
        ("run", "paused", "The run is paused: Ada paused it", {"code": "paused_by", "args": {"by": "Ada"}}),
        ("run", "failed", "The run failed.", None),
        ("run", "finished", "The run is finished.", None),
        ("question", "asked", "Is it: hot?", None),
    ],
)
def test_a_line_of_a_runs_journal_tells_why(kind: str, code: str, text: str, cause: object) -> None:
    event = RunEvent(seq=1, at=datetime(2026, 11, 22, tzinfo=UTC), t_s=0.0, kind=kind, code=code, text=text)
    assert view_event(event).cause == cause


@pytest.mark.parametrize("language", ["en", "de"])
def test_the_screens_have_words_for_every_reason(language: str) -> None:
    catalogue = ROOT / "frontend" / "src" / "i18n" / language / "screens" / "reason.json"
    texts = json.loads(catalogue.read_text(encoding="utf-8"))["because"]
    assert set(texts) == {*SENTENCES, SAID}
    for code, sentence in SENTENCES.items():
        assert set(re.findall(r"\{\{(\w+)\}\}", texts[code])) <= set(re.findall(r"\{(\w+)\}", sentence))

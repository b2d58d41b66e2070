"""Every reason that execution gives is known by a code, and the screens have words for it."""

from __future__ import annotations

import ast
import json
import re
from collections.abc import Collection, Iterator
from datetime import UTC, datetime

import pytest

from execution.models import RunEvent
from execution.reasons import SAID, SENTENCES, cause_of
from execution.views import view_event
from tests.kit.files import ROOT

SOURCES = sorted([*(ROOT / "execution").rglob("*.py"), ROOT / "registry" / "maps" / "site_maps.py"])
"""Of the registry only what says why there is no floor: tasks fail with that."""
ASKERS = {"CancelAsked", "PauseAsked"}
GIVERS = ASKERS | {
    "Failure",
    "Wake",
    "EvaluationError",
    "NoReading",
    "NoSuchSpot",
    "NoMap",
    "TaskEnded",
    "finish",
    "_give_up",
}
OTHERS = {"rehearsal.py"}
"""Rehearsals give up with errors that have codes of their own."""
ASKED_ONLY = {"Version 7 of this site's map is not kept. Choose one of the list."}
"""Answers to who asks over HTTP for what is not there; no task is told them."""


def given_reasons(givers: Collection[str]) -> Iterator[str]:
    """Give the sentences with which the code gives reasons to some of these, with `7` for what it fills in."""
    for path in SOURCES:
        module = ast.parse(path.read_text(encoding="utf-8"))
        constants = dict(constants_of(module))
        calls = [node for node in ast.walk(module) if isinstance(node, ast.Call)]
        for call in calls if path.name not in OTHERS else []:
            name = getattr(call.func, "id", getattr(call.func, "attr", ""))
            for part in (part for given in (call.args if name in givers else []) for part in alternatives(given)):
                text = constants.get(part.id, "") if isinstance(part, ast.Name) else sentence_of(part)
                if " " in text:
                    yield text


def constants_of(module: ast.Module) -> Iterator[tuple[str, str]]:
    """Give the texts that a module has under a name."""
    for node in module.body:
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.Constant(value=str(text))):
                yield name, text


def alternatives(node: ast.expr) -> list[ast.expr]:
    """Return what a value may be: each side of `… or …`, and of `… if … else …`."""
    match node:
        case ast.BoolOp(values=values):
            return [part for value in values for part in alternatives(value)]
        case ast.IfExp(body=body, orelse=other):
            return [*alternatives(body), *alternatives(other)]
    return [node]


def is_foreign(reason: str) -> bool:
    cause = cause_of(reason)
    return cause is None or cause["code"] == SAID


def sentence_of(node: ast.expr) -> str:
    """Return a text as it is written, `SENTENCES["…"]` or `SENTENCES["…"].format(…)`; empty for anything else."""
    match node:
        case ast.Constant(value=str(text)):
            return text
        case ast.JoinedStr(values=parts):
            return "".join(str(part.value) if isinstance(part, ast.Constant) else "7" for part in parts)
        case ast.Subscript(value=ast.Name(id="SENTENCES"), slice=ast.Constant(value=str(code))):
            return filled(SENTENCES[code])
        case ast.Call(func=ast.Attribute(value=inner, attr="format")):
            return sentence_of(inner)
    return ""


def filled(sentence: str) -> str:
    return re.sub(r"\{\w+\}", "7", sentence)


def test_reasons_are_seen_in_each_way_in_which_the_code_writes_them() -> None:
    written = (
        '"Nobody came."',
        'f"{by} paused it"',
        'SENTENCES["approval_gone"]',
        'SENTENCES["set_aside"].format(error=why)',
        "reason",
    )
    assert [sentence_of(ast.parse(code, mode="eval").body) for code in written] == [
        "Nobody came.",
        "7 paused it",
        SENTENCES["approval_gone"],
        filled(SENTENCES["set_aside"]),
        "",
    ]


def test_every_reason_in_the_code_has_a_code() -> None:
    reasons = list(given_reasons(GIVERS))
    assert len(reasons) > 35
    assert {reason for reason in reasons if is_foreign(reason)} == ASKED_ONLY


def test_a_reason_is_a_sentence_with_a_full_stop_unless_it_says_why_a_run_was_paused_or_cancelled() -> None:
    """Those stand behind a colon: “The run is paused: Ada paused it”. What ends with others' words has their end."""
    behind_colon = set(given_reasons(ASKERS))
    assert len(behind_colon) == 5
    assert {filled(text) for text in SENTENCES.values() if not re.search(r"[.}]$", text)} == {
        text for text in behind_colon if not text.endswith("7")
    }


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

"""What an edit does to the outline of a document is what reading the whole document again would do."""

from __future__ import annotations

from typing import Any

import pytest

from editor.language.document.incremental_outline import LastOutline
from editor.language.document.outline import DEEPEST_STEP, make_outline

Json = dict[str, Any]


def step(kind: str, *place: str, **params: object) -> Json:
    return {"kind": kind, "place": list(place), "params": params}


STEPS: Json = {
    "w": step("while", "program", "body", "1"),
    "in": step("wait", "w", "body", "1"),
    "try": step("try", "program", "body", "2"),
    "caught": step("wait", "try", "catch", "1"),
    "if": step("if", "program", "body", "3"),
    "a": step("wait", "program", "body", "4"),
    "b": step("wait", "program", "body", "5"),
    "draft": step("wait", "later", "body", "1"),
    "event": step("on_event", "program", "events", "1"),
    "note": step("comment", "program", "body", "9"),
    "new": step("dance", "program", "body", "9"),
}
GONE = None
EDITS: dict[str, dict[str, Json | None]] = {
    "a value": {"a": step("wait", "program", "body", "4", duration=5)},
    "behind": {"a": step("wait", "program", "body", "6")},
    "before": {"b": step("wait", "program", "body", "0")},
    "the same order": {"b": step("wait", "program", "body", "4")},
    "into another": {"a": step("wait", "if", "else", "1"), "b": step("wait", "if", "else", "0")},
    "the last of a branch": {"in": step("wait", "program", "body", "7")},
    "new": {"c": step("move", "program", "body", "45")},
    "new ones in each other": {"c": step("if", "program", "body", "45"), "d": step("wait", "c", "then", "1")},
    "gone": {"a": GONE},
    "gone with others in it": {"w": GONE},
    "gone with all in it": {"w": GONE, "in": GONE},
    "another kind": {"a": step("notify", "program", "body", "4")},
    "another kind with the same branch": {"w": step("repeat", "program", "body", "1")},
    "another kind without the branch": {"w": step("if", "program", "body", "1")},
    "no kind": {"a": step("dance", "program", "body", "4")},
    "a comment": {"a": step("comment", "program", "body", "4")},
    "without its catch": {"try": step("try", "program", "body", "2", catch=False)},
    "with others in it, elsewhere": {"w": step("while", "if", "then", "1")},
    "with others in it, further on": {"w": step("while", "program", "body", "8")},
    "into itself": {"if": step("if", "if", "then", "1")},
    "into each other": {"if": step("if", "c", "then", "1"), "c": step("if", "if", "then", "1")},
    "nowhere": {"a": step("wait", "nowhere", "body", "1")},
    "no place": {"a": {"kind": "wait", "place": None}},
    "no branch": {"a": step("wait", "if", "body", "1")},
    "into a draft": {"later": step("while", "nowhere", "body", "1")},
    "a place for a draft": {"later": step("while", "program", "body", "1")},
    "a draft placed": {"draft": step("wait", "program", "body", "1")},
    "a draft gone": {"draft": GONE},
    "an event as a step": {"event": step("on_event", "program", "body", "1")},
    "a step as an event": {"a": step("on_event", "program", "body", "4")},
    "no step": {"a": {}, "": step("wait", "program", "body", "1")},
    "an unknown one gone": {"new": GONE, "note": GONE},
}


def after(steps: Json, edit: dict[str, Json | None]) -> Json:
    return {"steps": {name: body for name, body in {**steps, **edit}.items() if body is not None}}


@pytest.mark.parametrize("edit", EDITS.values(), ids=EDITS)
def test_an_edit_and_its_undoing_are_what_the_whole_says(edit: dict[str, Json | None]) -> None:
    last = LastOutline()
    for document in ({"steps": STEPS}, after(STEPS, edit), {"steps": STEPS}):
        assert last.look(document) == make_outline(document)


@pytest.mark.parametrize(
    "name",
    [
        "a value",
        "behind",
        "into another",
        "new",
        "new ones in each other",
        "gone",
        "another kind with the same branch",
        "with others in it, further on",
    ],
)
def test_what_stands_elsewhere_is_not_read_again(name: str) -> None:
    last = LastOutline()
    before, document = last.look({"steps": STEPS}), after(STEPS, EDITS[name])
    edited = last.look(document)
    assert edited.drafts is before.drafts
    assert edited.params["caught"] is before.params["caught"]


@pytest.mark.parametrize("depth", range(DEEPEST_STEP - 2, DEEPEST_STEP + 2))
def test_a_step_that_comes_too_deep_is_told(depth: int) -> None:
    chain = {f"s{i}": step("while", f"s{i - 1}" if i else "program", "body", "1") for i in range(DEEPEST_STEP)}
    chain["a"] = step("wait", "program", "body", "2")
    last = LastOutline()
    last.look({"steps": chain})
    deep = after(chain, {"a": step("wait", f"s{depth - 1}", "body", "1")})
    assert last.look(deep) == make_outline(deep)
    assert ("a" in make_outline(deep).too_deep) == (depth == DEEPEST_STEP)


def test_a_function_that_goes_takes_its_steps_along() -> None:
    last = LastOutline()
    steps = {"a": step("wait", "f", "body", "1")}
    for functions in ({"f": {}}, {}, {"f": {}}):
        document = {"steps": steps, "functions": functions}
        assert last.look(document) == make_outline(document)

"""A program that is edited step by step: every look says what a look at the whole document says."""

from __future__ import annotations

from typing import Any

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from editor.language import Surroundings, compile_document
from editor.language.compiler import EditedProgram
from editor.language.document.incremental_outline import LastOutline
from editor.language.document.outline import make_outline
from tests.kit.demo_site import factory, with_device
from tests.unit.language.sound_programs import sound_documents
from tests.unit.language.strategies import BRANCHES, PARAMS, documents

Json = dict[str, Any]
slow = settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
SITES = (
    factory(),
    with_device("robot01", standing_at="itemInventory01"),
    with_device("robot01", online=False),
    with_device("curingOven01", lifecycle="retired"),
)
ORDERS = ("0", "1V", "5", "a")


def _set_params(draw: st.DrawFn, document: Json) -> Json:
    name = draw(st.sampled_from(sorted(document["steps"])))
    step = document["steps"][name]
    return _with_step(document, name, {**step, "params": draw(PARAMS[step["kind"]])})


def _add(draw: st.DrawFn, document: Json) -> Json:
    kind = draw(st.sampled_from(sorted(PARAMS)))
    step = {"kind": kind, "place": _place(draw, document), "pos": [0, 0], "params": draw(PARAMS[kind])}
    return _with_step(document, f"n{draw(st.integers(0, 99))}", step)


def _move(draw: st.DrawFn, document: Json) -> Json:
    name = draw(st.sampled_from(sorted(document["steps"])))
    return _with_step(document, name, {**document["steps"][name], "place": _place(draw, document)})


def _delete(draw: st.DrawFn, document: Json) -> Json:
    gone = draw(st.sampled_from(sorted(document["steps"])))
    return {**document, "steps": {name: step for name, step in document["steps"].items() if name != gone}}


def _change_kind(draw: st.DrawFn, document: Json) -> Json:
    name = draw(st.sampled_from(sorted(document["steps"])))
    return _with_step(document, name, {**document["steps"][name], "kind": draw(st.sampled_from(sorted(PARAMS)))})


def _around(draw: st.DrawFn, document: Json) -> Json:
    """Return the document with something else of another program around the same steps."""
    other = draw(st.one_of(documents(0), sound_documents()))
    part = draw(st.sampled_from(["functions", "roles", "parameters", "zones"]))
    return {**document, part: draw(st.sampled_from([other[part], {}]))}


def _with_step(document: Json, name: str, step: Json) -> Json:
    return {**document, "steps": {**document["steps"], name: step}}


def _place(draw: st.DrawFn, document: Json) -> list[str] | None:
    parent = draw(st.sampled_from(["program", "program", "f", *sorted(document["steps"])]))
    branch = "body" if parent in {"program", "f"} else draw(st.sampled_from(BRANCHES))
    place: list[str] | None = draw(st.sampled_from([None, [parent, branch, draw(st.sampled_from(ORDERS))]]))
    return place


@st.composite
def edited(draw: st.DrawFn) -> list[tuple[Json, Surroundings]]:
    """Draw a document as it is after each of some edits, with the site at that time."""
    document = draw(st.one_of(sound_documents(), documents()))
    looks = [(document, SITES[0])]
    for _ in range(draw(st.integers(1, 6))):
        edits = [_set_params, _set_params, _add, _move, _delete, _change_kind, _around]
        edit = draw(st.sampled_from(edits)) if document["steps"] else _add
        document = edit(draw, document)
        looks.append((document, draw(st.sampled_from([looks[-1][1], *SITES]))))
    return looks


@slow
@given(edited())
def test_every_look_says_what_a_look_at_the_whole_document_says(looks: list[tuple[Json, Surroundings]]) -> None:
    program = EditedProgram()
    for document, site in looks:
        whole = compile_document(document, site)
        compiled = program.compile(document, site)
        assert compiled == whole
        assert repr(compiled) == repr(whole)
        assert program.look(document, site).diagnostics() == whole.diagnostics


@settings(slow, max_examples=150)
@given(edited())
def test_the_outline_of_an_edited_document_is_that_of_the_whole(looks: list[tuple[Json, Surroundings]]) -> None:
    last = LastOutline()
    for document, _ in looks:
        assert last.look(document) == make_outline(document)


def test_a_number_that_becomes_a_yes_is_another_value() -> None:
    document: Json = {
        "format": 2,
        "steps": {"s": {"kind": "wait", "place": ["program", "body", "1"], "params": {"duration": 1}}},
    }
    program = EditedProgram()
    assert program.compile(document, SITES[0]).diagnostics == ()
    changed = _with_step(document, "s", {**document["steps"]["s"], "params": {"duration": True}})
    assert [d.code for d in program.compile(changed, SITES[0]).diagnostics] == ["wrong_type"]


def test_what_a_called_function_does_is_followed_again_when_it_changes() -> None:
    load = {"role": "robot", "object": "box", "quantity": 1}
    pick = {"kind": "pick", "place": ["f", "body", "1"], "params": {**load, "at": {"device": "itemInventory01"}}}
    drop = {"kind": "drop", "place": ["program", "body", "2"], "params": {**load, "at": {"device": "dropOff01"}}}
    hot = {"op": ">", "args": [{"property": ["curingOven01", "temperature"]}, 30]}
    calls = {
        "if": {"kind": "if", "place": ["program", "body", "1"], "params": {"condition": hot}},
        "a": {"kind": "call", "place": ["if", "then", "1"], "params": {"function": "f"}},
        "b": {"kind": "call", "place": ["if", "else", "1"], "params": {"function": "f"}},
    }
    functions = {"f": {"name": "fetch", "parameters": []}}
    document: Json = {"format": 2, "steps": {**calls, "pick": pick, "drop": drop}, "functions": functions}
    program = EditedProgram()
    assert "drops_nothing" not in [d.code for d in program.compile(document, SITES[0]).diagnostics]
    wait = {"kind": "wait", "place": ["f", "body", "1"], "params": {"duration": 1}}
    changed = program.compile(_with_step(document, "pick", wait), SITES[0])
    assert "drops_nothing" in [d.code for d in changed.diagnostics]

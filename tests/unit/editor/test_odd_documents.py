"""Whatever stands in a document can be read: at every door it is a diagnostic, and never an exception."""

from __future__ import annotations

import json
import random
from contextlib import suppress
from functools import cache
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pycrdt import Doc, Map

from editor.documents.shared_document import ROOTS, SharedDocument, encode_document, migrate_document
from editor.errors import BadRequest
from editor.language import compile_document, compiled_to_json, parse_script, tree_to_document
from editor.language.compiler import EditedProgram
from editor.language.one_line.scope import make_line_scope
from editor.language.one_line.values import print_line, type_of_line
from editor.language.reading.well_formed import well_formed
from editor.library.function_extraction import cut_out_function
from editor.programs.compiled_patch import apply_patch, make_patch
from editor.programs.summary import names_in
from tests.cases.odd_documents import ODD, make_odd, sound_documents
from tests.kit.demo_site import factory

SITE = factory()
SOUND = sound_documents()


@st.composite
def documents(draw: st.DrawFn) -> tuple[dict[str, Any], dict[str, Any]]:
    """Make a sound document, and the same with something odd in it."""
    sound = draw(st.sampled_from(SOUND))
    return sound, make_odd(sound, random.Random(draw(st.integers(0, 2**32))))


@cache
def form_of(number: int) -> dict[str, Any]:
    return compiled_to_json(compile_document(SOUND[number], SITE), 1)


def shared(document: dict[str, Any]) -> SharedDocument:
    """Return a shared document with these values in its roots, steps as shared maps where they are objects."""
    theirs = Doc[Any]()
    for name in ROOTS:
        root, given = theirs.get(name, type=Map), document.get(name)
        for key, value in given.items() if isinstance(given, dict) else ():
            is_step = name == "steps" and isinstance(value, dict)
            params = value.get("params") if is_step else None
            whole = {**value, "params": Map(params)} if isinstance(params, dict) else value
            with suppress(OverflowError):  # a number that Yjs has no form for
                root[key] = Map(whole) if is_step else whole
    return SharedDocument([theirs.get_update()])


@given(documents())
def test_any_document_is_compiled_and_patched(pair: tuple[dict[str, Any], dict[str, Any]]) -> None:
    sound, odd = pair
    before, after = form_of(SOUND.index(sound)), compiled_to_json(compile_document(odd, SITE), 2)
    assert json.loads(json.dumps(after)) == json.loads(json.dumps(apply_patch(before, make_patch(before, after))))
    assert all(set(found["messages"]) == {"en", "de"} for found in after["diagnostics"])
    edited = EditedProgram()
    for each in (sound, odd, sound):
        looked = compiled_to_json(edited.look(each, SITE).compiled(with_plan=False), 2)
    assert looked == {**before, "revision": 2}


@given(documents())
def test_what_is_left_out_changes_nothing_in_what_a_program_means(
    pair: tuple[dict[str, Any], dict[str, Any]],
) -> None:
    _, odd = pair
    whole = well_formed(odd)
    assert well_formed(whole) == whole
    assert compile_document(whole, SITE).tree == compile_document(odd, SITE).tree
    codes = {found.code for found in compile_document(whole, SITE).diagnostics}
    assert not codes & {"odd_shape", "odd_position"}


@given(documents())
def test_a_script_is_drawn_over_any_document(pair: tuple[dict[str, Any], dict[str, Any]]) -> None:
    sound, odd = pair
    for script in (compile_document(sound, SITE).script, compile_document(odd, SITE).script):
        parsed = parse_script(script, SITE)
        if parsed.tree is not None:
            encode_document(tree_to_document(parsed.tree, SITE, odd))


@given(documents())
def test_any_document_goes_through_the_shared_one(pair: tuple[dict[str, Any], dict[str, Any]]) -> None:
    sound, odd = pair
    document = shared(odd)
    document.migrate()
    plain = document.to_json()
    compile_document(plain, SITE)
    again = SharedDocument([encode_document(plain)])
    assert again.to_json()["steps"].keys() == plain["steps"].keys()
    document.change_to(migrate_document(sound))
    assert document.to_json()["steps"].keys() == sound["steps"].keys()
    document.change_to(plain)


@given(documents(), st.sampled_from(ODD))
def test_values_of_any_document_are_printed_as_lines(
    pair: tuple[dict[str, Any], dict[str, Any]], value: object
) -> None:
    _, odd = pair
    steps = well_formed(odd)["steps"]
    script = compile_document(odd, SITE).script
    for step in ["", *list(steps)[:3]]:
        scope = make_line_scope(odd, SITE, script, step)
        for each in (value, *(steps[step]["params"].values() if step in steps else ())):
            print_line(each, scope)
            type_of_line(each, scope)


@given(documents())
def test_functions_and_devices_are_found_in_any_document(pair: tuple[dict[str, Any], dict[str, Any]]) -> None:
    _, odd = pair
    names_in(odd)
    for function in [*well_formed(odd)["functions"], "gone"]:
        try:
            definition = cut_out_function(odd, function)
        except BadRequest:
            assert function == "gone"
        else:
            assert isinstance(definition["function"], dict)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"roles": {"r": "zzz"}}, [("odd_shape", "roles.r")]),
        ({"roles": {"r": {"can": ["x", 7]}}}, [("odd_shape", "roles.r.can")]),
        ({"functions": {"f": 7}}, [("odd_shape", "functions.f")]),
        ({"functions": {"f": {"parameters": "n"}}}, [("odd_shape", "functions.f.parameters")]),
        ({"parameters": []}, [("odd_shape", "parameters")]),
        ({"zones": {"z": {"points": [[0, 0], "b"]}}}, [("odd_shape", "zones.z.points")]),
        ({"start_pos": "left"}, [("odd_position", "start_pos")]),
        ({"start_pos": [1e9, 0]}, [("odd_position", "start_pos")]),
        ({"steps": {"k": "zzz"}}, [("unknown_kind", "kind")]),
    ],
)
def test_what_is_odd_is_told_with_its_place(change: dict[str, Any], said: list[tuple[str, str]]) -> None:
    wait = {"kind": "wait", "place": ["program", "body", "V"], "pos": [1, 1], "params": {"duration": 5}}
    sound = {"format": 2, "start_pos": [0, 0], "steps": {"s": wait}, "functions": {}, "roles": {}}
    document = {**sound, **change, "steps": {**sound["steps"], **change.get("steps", {})}}
    assert [(found.code, found.field) for found in compile_document(document, SITE).diagnostics] == said

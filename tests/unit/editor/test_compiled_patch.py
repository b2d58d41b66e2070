"""What an edit sends: it makes the new form of the old one, whatever the edit, and is short where the edit is."""

from __future__ import annotations

import json
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from bench.programs import make_program, with_step
from editor.language.compiler import compile_document, compiled_to_json
from editor.programs.compiled_patch import OtherBase, apply_patch, hunks_between, make_patch
from tests.cases.make_compiled_patches import FILE, make_cases
from tests.kit.demo_site import factory
from tests.unit.language.sound_programs import sound_documents
from tests.unit.language.strategies import documents

slow = settings(max_examples=80, deadline=None, suppress_health_check=list(HealthCheck))
SITE = factory()


def form(document: object, revision: int) -> dict[str, Any]:
    compiled: dict[str, Any] = json.loads(json.dumps(compiled_to_json(compile_document(document, SITE), revision)))
    return compiled


def sent(patch: dict[str, Any]) -> dict[str, Any]:
    """Return a patch as it comes out of the network."""
    got: dict[str, Any] = json.loads(json.dumps(patch))
    return got


@slow
@given(st.one_of(documents(), sound_documents()), st.one_of(documents(), sound_documents()))
def test_any_program_becomes_any_other(one: object, other: object) -> None:
    before, after = form(one, 1), form(other, 2)
    made = apply_patch(before, sent(make_patch(before, after)))
    assert made == after
    assert [*made["numbers"]] == [*after["numbers"]]


@slow
@given(st.lists(st.integers(0, 3), max_size=60), st.lists(st.integers(0, 3), max_size=60))
def test_hunks_make_one_list_of_another(old: list[int], new: list[int]) -> None:
    made: list[int] = []
    at = 0
    for start, gone, come in hunks_between(old, new):
        made += [*old[at:start], *come]
        at = start + gone
    assert made + old[at:] == new


def test_the_cases_that_browsers_are_tested_with_are_of_now() -> None:
    assert json.loads(FILE.read_text()) == make_cases(), "python -m tests.cases.make_compiled_patches"


@pytest.mark.parametrize("place", [["program", "body", "0"], ["s500", "then", "zz"]])
def test_a_step_more_in_a_thousand_is_told_in_less_than_a_kilobyte(place: list[str]) -> None:
    document = make_program(1000)
    before = form(document, 1)
    step = {"kind": "wait", "place": place, "pos": [0, 0], "params": {"duration": 7}}
    after = form(with_step(document, "new", step), 2)
    patch = make_patch(before, after)
    assert apply_patch(before, sent(patch)) == after
    assert len(json.dumps(patch)) < 1000 < len(json.dumps(after)) / 100


def test_a_patch_of_another_form_is_refused() -> None:
    before, after = form({"steps": {}}, 1), form({"steps": {}}, 2)
    with pytest.raises(OtherBase, match=r"The change begins from 1; 2 is here\."):
        apply_patch(after, make_patch(before, after))


def test_many_changes_all_over_a_large_program_cost_no_more_than_its_size() -> None:
    old = [f"line {number}" for number in range(20_000)]
    new = [line + ("!" if number % 7 == 0 else "") for number, line in enumerate(old)]
    assert len(hunks_between(old, new)) == 65

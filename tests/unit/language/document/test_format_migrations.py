from __future__ import annotations

import json
from typing import Any

import pytest

from editor.language import compile_document
from editor.language.document.format_migrations import FORMAT, format_of, migrate
from tests.kit.demo_site import factory
from tests.kit.files import ROOT

OLD = sorted((ROOT / "tests" / "cases" / "old").glob("*.json"))


@pytest.mark.parametrize("path", OLD, ids=lambda path: path.stem)
def test_a_document_of_a_former_format_climbs_to_the_format_of_today(path: Any) -> None:
    case = json.loads(path.read_text())
    assert migrate(case["document"]) == case["expected"]
    assert migrate(case["expected"]) == case["expected"]
    old, new = (compile_document(case[name], factory()) for name in ("document", "expected"))
    assert (old.script, old.diagnostics, old.plan) == (new.script, new.diagnostics, new.plan)


def test_a_document_of_today_is_left_alone() -> None:
    document = {"format": FORMAT, "steps": {"w": {"kind": "wait", "params": {"seconds": 1}}}}
    assert migrate(document) is document


def test_a_new_name_that_is_there_already_is_kept() -> None:
    document = {"steps": {"w": {"kind": "wait", "params": {"seconds": 1, "duration": 2}}}}
    assert migrate(document) == {"format": 2, "steps": {"w": {"kind": "wait", "params": {"duration": 2}}}}


def test_a_document_of_a_later_format_is_left_alone_and_told() -> None:
    document = {"format": 99, "steps": {}}
    assert migrate(document) is document
    compiled = compile_document(document, factory())
    assert [(d.code, d.severity) for d in compiled.diagnostics] == [
        ("newer_format", "error"),
        ("empty_program", "error"),
    ]
    assert compiled.plan is None


@pytest.mark.parametrize(
    ("document", "found"),
    [(None, 2), ([], 2), ({}, 1), ({"format": "x"}, 1), ({"format": True}, 1), ({"format": 2}, 2)],
)
def test_nonsense_has_a_format_too(document: object, found: int) -> None:
    assert format_of(document) == found
    migrate(document)

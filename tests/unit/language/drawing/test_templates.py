"""The templates that the editor begins programs with are drawn without a finding; the frontend's tests write them."""

from __future__ import annotations

import json

import pytest

from editor.language import compile_document, parse_script, tree_to_document
from tests.kit.demo_site import factory
from tests.kit.files import ROOT

TEMPLATES: dict[str, list[str]] = json.loads((ROOT / "tests" / "cases" / "templates.json").read_text())


def test_there_are_five_templates() -> None:
    assert list(TEMPLATES) == ["fetch", "process", "patrol", "wait", "charge"]


@pytest.mark.parametrize("name", TEMPLATES)
def test_a_template_is_drawn_without_a_finding(name: str) -> None:
    parsed = parse_script("\n".join(TEMPLATES[name]), factory())
    assert parsed.diagnostics == ()
    assert parsed.tree is not None
    compiled = compile_document(tree_to_document(parsed.tree, factory()), factory())
    assert [(each.code, each.message) for each in compiled.diagnostics] == []
    assert compiled.plan is not None

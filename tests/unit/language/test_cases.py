"""Every program in tests: a document, what the site is like, and what shall come out."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from editor.language import (
    Surroundings,
    compile_document,
    compiled_to_json,
    parse_script,
    plan_to_json,
    tree_to_document,
)
from tests.kit.demo_site import factory
from tests.kit.files import ROOT

FOLDERS = (ROOT / "tests" / "fixtures" / "programs", ROOT / "tests" / "cases" / "constructs")
NAMES = ("lines", "numbers", "added_moves", "order", "depth")
CASES = sorted(path for folder in FOLDERS for path in folder.glob("*.json"))


def _site(changes: dict[str, Any]) -> Surroundings:
    site = factory()
    devices = {name: replace(site.devices[name], **change) for name, change in changes.items()}
    return replace(site, devices={**site.devices, **devices})


def _case(path: Path) -> tuple[dict[str, Any], Surroundings, dict[str, Any]]:
    case = json.loads(path.read_text())
    return case["document"], _site(case["devices"]), case["expected"]


@pytest.mark.parametrize("path", CASES, ids=lambda path: path.stem)
def test_a_program_compiles_as_its_case_says(path: Path) -> None:
    document, site, expected = _case(path)
    compiled = compile_document(document, site)
    body = compiled_to_json(compiled)
    assert compiled.script.splitlines() == expected["script"]
    assert json.loads(json.dumps(body["diagnostics"])) == expected["diagnostics"]
    assert {name: body[name] for name in NAMES} == {name: expected[name] for name in NAMES}
    plan = None if compiled.plan is None else plan_to_json(compiled.plan)["instructions"]
    assert json.loads(json.dumps(plan)) == expected["plan"]


@pytest.mark.parametrize("path", CASES, ids=lambda path: path.stem)
def test_a_case_reads_back_from_its_script(path: Path) -> None:
    document, site, _ = _case(path)
    compiled = compile_document(document, site)
    parsed = parse_script(compiled.script, site)
    assert parsed.tree == compiled.tree
    if parsed.tree is not None:
        assert compile_document(tree_to_document(parsed.tree, site), site).tree == compiled.tree


def test_there_is_a_good_number_of_cases() -> None:
    assert len(CASES) >= 120

"""Every file in tests/cases/outline, which the frontend reads, too: both must find the same program."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from editor.language.document.outline import make_outline
from tests.cases.make_outline_cases import CASES, FOLDER
from tests.cases.outline_case import text_of

FILES = sorted(FOLDER.glob("*.json"))


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_a_document_is_read_as_its_case_says(path: Path) -> None:
    case: dict[str, Any] = json.loads(path.read_text())
    outline = make_outline(case["document"])
    children = sorted([parent, branch, list(ids)] for (parent, branch), ids in outline.children.items() if ids)
    assert {"children": children, "drafts": list(outline.drafts), "unknown": list(outline.unknown)} == case["expected"]


def test_the_folder_is_what_the_script_writes() -> None:
    assert {path.stem: path.read_text() for path in FILES} == {name: text_of(each) for name, each in CASES.items()}
    assert len(FILES) >= 40

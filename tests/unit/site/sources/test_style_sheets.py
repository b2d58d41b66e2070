"""A class means one thing in its file: of two rules for one name the later would change the earlier's elements."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import pytest

from tests.kit.files import ROOT

SOURCES = ROOT / "frontend" / "src"
SHEETS = sorted(SOURCES.rglob("*.module.css"))
ALONE = re.compile(r"(?:^|(?<=\}))\s*(\.[\w-]+)\s*(?=\{)")


def names_alone(sheet: str) -> list[str]:
    """Return the classes that stand alone before a rule outside of any query, each as often as it does."""
    text = re.sub(r"/\*.*?\*/", "", sheet, flags=re.DOTALL)
    text = re.sub(r"@[^{;]*\{(?:[^{}]*\{[^{}]*\})*[^{}]*\}", "", text)
    return ALONE.findall(text)


def test_names_alone_leaves_out_queries_and_lists() -> None:
    sheet = ".a { top: 0; }\n.a,\n.b { left: 0; }\n@media print { .a { top: 1px; } }\n.a b { }\n.b { }\n"
    assert names_alone(sheet) == [".a", ".b"]


@pytest.mark.parametrize("sheet", SHEETS, ids=lambda each: str(each.relative_to(SOURCES)))
def test_no_class_has_two_rules_of_its_own(sheet: Path) -> None:
    counts = Counter(names_alone(sheet.read_text()))
    assert [name for name, count in counts.items() if count > 1] == []

"""Every code of the checks has an example that it is told of, one that it is not, and a place on the page."""

from __future__ import annotations

from functools import lru_cache

import pytest

from editor.language.messages.en import TEXTS
from editor.language.site.surroundings import Surroundings
from scripts.check_explanations import EXPLANATIONS, GROUPS
from scripts.checks_page import CASES, ROOT, read_case, read_site, write_page


@lru_cache(maxsize=1)
def site() -> Surroundings:
    return read_site()


@pytest.mark.parametrize("code", TEXTS)
def test_the_bad_example_is_told_of(code: str) -> None:
    told = read_case(code, "bad", site()).tells(code)
    assert told
    assert all(set(diagnostic.messages) == {"en", "de"} for diagnostic in told)
    assert all(diagnostic.messages["en"] != diagnostic.messages["de"] for diagnostic in told)


@pytest.mark.parametrize("code", TEXTS)
def test_nothing_is_said_of_the_good_example(code: str) -> None:
    assert [(d.code, d.message) for d in read_case(code, "good", site()).diagnostics] == []


def test_every_code_has_its_place_on_the_page() -> None:
    assert EXPLANATIONS.keys() == TEXTS.keys()
    assert sorted(code for _, codes in GROUPS for code in codes) == sorted(TEXTS)


def test_there_are_no_examples_of_codes_that_are_gone() -> None:
    assert {path.name.split(".")[0] for path in CASES.glob("*.json")} == set(TEXTS)


def test_the_page_of_the_checks_is_up_to_date() -> None:
    page = ROOT / "docs" / "language" / "checks.md"
    assert page.read_text(encoding="utf-8") == write_page(), "make checks-page"

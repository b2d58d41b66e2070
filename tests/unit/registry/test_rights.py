"""The table of rights and the record of deeds have words on the screen, and the guide shows the table as it is."""

from __future__ import annotations

import json
from typing import Any

import pytest

from registry.audit.codes import KIND_OF, KINDS
from registry.people.access import ROLES, allows
from registry.people.rights import DEEDS, RIGHTS
from scripts.rights_table import BEGIN, END, print_rights
from tests.kit.files import ROOT


def words(language: str, area: str = "screens/people") -> dict[str, Any]:
    found: dict[str, Any] = json.loads((ROOT / "frontend" / "src" / "i18n" / language / f"{area}.json").read_text())
    return found


@pytest.mark.parametrize("language", ["en", "de"])
def test_every_deed_of_a_site_has_a_sentence(language: str) -> None:
    assert set(words(language)["deed"]) == {deed.name for deed in DEEDS if deed.roles}


@pytest.mark.parametrize("language", ["en", "de"])
def test_everything_that_is_written_down_has_a_sentence(language: str) -> None:
    said = words(language)["audit"]
    variants = {"access_end_none", "invitation_mailed", "run_armed", "second_factor_demanded_none"}
    assert set(said["what"]) == {*KIND_OF, *variants}
    assert set(said["kind"]) == {*KINDS, "all"}


@pytest.mark.parametrize("language", ["en", "de"])
def test_every_role_has_a_name(language: str) -> None:
    assert tuple(words(language, "role"))[: len(ROLES)] == ROLES


def test_every_operation_stands_in_one_deed() -> None:
    assert sum(len(deed.operations) for deed in DEEDS) == len(RIGHTS)


def test_a_role_may_all_that_those_before_it_may() -> None:
    for deed in DEEDS:
        for role in deed.roles:
            assert {higher for higher in ROLES if allows(higher, role)} <= set(deed.roles), deed.name


def test_the_guide_shows_the_table_as_it_is() -> None:
    guide = (ROOT / "docs" / "administration.md").read_text()
    assert guide.partition(BEGIN)[2].partition(END)[0].strip() == print_rights().strip()

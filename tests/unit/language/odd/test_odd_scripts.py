"""What is told of scripts that chance wrote is what was told of them before; see `odd_scripts`."""

from __future__ import annotations

import json

import pytest

from tests.kit.demo_site import factory
from tests.unit.language.odd.odd_scripts import FILE, HOW_MANY, script_of, told_of

TOLD: list[list[str]] = json.loads(FILE.read_text())
AT_ONCE = 100


@pytest.mark.parametrize("first", range(0, HOW_MANY, AT_ONCE))
def test_what_is_told_of_odd_scripts_is_as_it_was(first: int) -> None:
    site = factory()
    for seed in range(first, min(first + AT_ONCE, HOW_MANY)):
        assert told_of(seed, site) == TOLD[seed], f"the script of seed {seed}:\n{script_of(seed)}"

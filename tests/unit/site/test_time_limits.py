"""The table of time limits in docs/operations.md says what the code holds."""

import re
from datetime import timedelta
from importlib import import_module
from pathlib import Path

import pytest

TEXT = (Path(__file__).resolve().parents[3] / "docs" / "operations.md").read_text()
ROW = re.compile(r"^\| [^|]+ \| (\d+) (s|min|h|d) \| `([a-z_.]+)` \| `([A-Z_]+)` \|$", re.MULTILINE)
SECONDS = {"s": 1, "min": 60, "h": 3600, "d": 86_400}
LIMITS = ROW.findall(TEXT)


def test_the_table_is_read():
    assert len(LIMITS) == TEXT.split("## Time limits")[1].split("## ")[0].count("\n| ") - 2


@pytest.mark.parametrize(("number", "unit", "module", "name"), LIMITS)
def test_a_limit_is_where_the_table_says_and_as_long(number, unit, module, name):
    value = getattr(import_module(module), name)
    seconds = value.total_seconds() if isinstance(value, timedelta) else value
    assert seconds == int(number) * SECONDS[unit]

"""Lines of CSV (RFC 4180) that no spreadsheet carries out; pure."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable

_RUNS_AS_FORMULA = ("=", "+", "-", "@", "\t", "\r")


def csv_line(fields: Iterable[str]) -> str:
    """Return a line of CSV; a field that a spreadsheet would carry out as a formula begins with an apostrophe."""
    text = io.StringIO()
    csv.writer(text).writerow(f"'{field}" if field.startswith(_RUNS_AS_FORMULA) else field for field in fields)
    return text.getvalue()

"""A line of CSV says what it was given, and is nothing that a spreadsheet carries out."""

from __future__ import annotations

import csv

import pytest

from vipo_device.protocol.csv_lines import csv_line


def test_a_line_is_read_as_it_was_written() -> None:
    fields = ["a", 'b "c", d', "two\nlines", "", "ü"]
    (read,) = csv.reader([*csv_line(fields).splitlines(keepends=True)])
    assert read == fields


@pytest.mark.parametrize("text", ["=1+1", "+1", "-1", "@SUM(A1)", "\t=1", "\r=1"])
def test_what_would_be_a_formula_begins_with_an_apostrophe(text: str) -> None:
    assert next(csv.reader([csv_line([text])])) == [f"'{text}"]

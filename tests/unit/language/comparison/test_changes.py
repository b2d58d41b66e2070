"""Two documents compared value by value: what was found, applied, gives the other document."""

from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from editor.language.comparison.changes import (
    ABSENT,
    BadChange,
    ValueChange,
    apply_changes,
    apply_where_same,
    change_to_json,
    check_change,
    find_changes,
    is_same,
    read_change,
)
from editor.language.comparison.difference import compare
from tests.kit.drawn.edits import edited, empty

SEEDS = st.integers(0, 2**32)
COUNTS = st.integers(0, 40)


@given(SEEDS, COUNTS, SEEDS, COUNTS)
def test_the_difference_applied_to_the_old_document_gives_the_new_one(
    first: int, before: int, second: int, after: int
) -> None:
    old = edited(empty(), first, before)
    new = edited(old, second, after)
    kept = json.dumps(old)
    changes = compare(old, new).changes
    assert is_same(apply_changes(old, changes), new)
    assert is_same(apply_changes(new, [change.reversed() for change in changes]), old)
    assert json.dumps(old) == kept


@given(SEEDS, COUNTS, SEEDS, COUNTS)
def test_so_it_does_between_documents_that_have_nothing_in_common(
    first: int, before: int, second: int, after: int
) -> None:
    old, new = edited(empty(), first, before), edited(empty(), second, after)
    written = [read_change(json.loads(json.dumps(change_to_json(each)))) for each in find_changes(old, new)]
    assert is_same(apply_changes(old, written), new)


def test_null_one_and_true_are_three_values_and_absent_is_none_of_them() -> None:
    sides = [{"steps": {"s": {"params": params}}} for params in ({}, {"v": None}, {"v": 1}, {"v": True})]
    values = [ABSENT, None, 1, True]
    for before, old in zip(values, sides, strict=True):
        for after, new in zip(values, sides, strict=True):
            found = find_changes(old, new)
            wanted = () if before is after else (ValueChange(("steps", "s", "params", "v"), before, after),)
            assert found == wanted
    assert not find_changes({"steps": {"s": {"pos": [1.0, 2]}}}, {"steps": {"s": {"pos": [1, 2]}}})


def test_a_value_of_several_parts_is_one_change_and_arguments_are_one_each() -> None:
    old = {"steps": {"s": {"params": {"to": {"device": "a"}, "args": {"x": 1, "y": 2}}}}}
    new = {"steps": {"s": {"params": {"to": {"place": "b"}, "args": {"x": 1, "y": 3}}}}}
    assert find_changes(old, new) == (
        ValueChange(("steps", "s", "params", "to"), {"device": "a"}, {"place": "b"}),
        ValueChange(("steps", "s", "params", "args", "y"), 2, 3),
    )


def test_a_change_is_made_only_where_its_old_value_still_stands() -> None:
    document = {"steps": {"s": {"params": {"x": 1, "y": 2}}}}
    mine = ValueChange(("steps", "s", "params", "x"), 1, 5)
    theirs = ValueChange(("steps", "s", "params", "y"), 9, 5)
    gone = ValueChange(("steps", "t", "params", "y"), 9, 5)
    applied = apply_where_same(document, [mine, theirs, gone])
    assert applied.document == {"steps": {"s": {"params": {"x": 5, "y": 2}}}}
    assert (applied.applied, applied.skipped) == ((mine,), (theirs, gone))


@pytest.mark.parametrize("path", [(), ("steps",), ("format",), ("meta", "x"), ("steps", ""), ("start_pos", "x")])
def test_only_constructs_and_the_start_can_be_changed(path: tuple[str, ...]) -> None:
    with pytest.raises(BadChange, match="A change"):
        check_change(ValueChange(path, 1, 2))

"""How far a document is known, deletions included."""

from __future__ import annotations

import random

import pytest
from pycrdt import Doc, Map

from editor.documents.knowledge import Knowledge, decode_snapshot, joined_ranges
from editor.documents.shared_document import SharedDocument
from editor.documents.yjs_encoding import BadFrame, encode_integer

SNAPSHOT = bytes.fromhex("0101020804" + "0d01" + "0101" + "19")
"""Written by Yjs 13.6: client 1 with 25 changes, of which 8 to 11 and 13 are deleted."""


def test_a_snapshot_of_yjs_is_read() -> None:
    assert decode_snapshot(SNAPSHOT) == Knowledge({1: 25}, {1: ((8, 12), (13, 14))})


@pytest.mark.parametrize("cut", range(len(SNAPSHOT)))
def test_a_snapshot_that_ends_too_early_is_refused(cut: int) -> None:
    with pytest.raises(BadFrame):
        decode_snapshot(SNAPSHOT[:cut])


def test_a_snapshot_that_promises_more_than_it_has_is_refused_at_once() -> None:
    with pytest.raises(BadFrame, match="more parts than it has"):
        decode_snapshot(encode_integer(2**40) + b"\x01")
    with pytest.raises(BadFrame, match="524288 are taken"):
        decode_snapshot(bytes(600_000))


def test_deletions_are_known_or_not_as_a_set_of_clocks_would_say() -> None:
    dice = random.Random(5)
    for _ in range(500):
        more, less = ({dice.randrange(20) for _ in range(dice.randrange(25))} for _ in range(2))
        ranges = [joined_ranges((clock, clock + 1) for clock in each) for each in (more, less)]
        covers = Knowledge({}, {1: ranges[0]}).covers(Knowledge({}, {1: ranges[1]}))
        assert covers == (less <= more)


def test_a_document_knows_what_it_has_deleted() -> None:
    theirs = Doc(client_id=7)
    steps = theirs.get("steps", type=Map)
    steps["a"] = Map({"kind": "wait"})
    before = SharedDocument([theirs.get_update()])
    del steps["a"]
    after = SharedDocument([theirs.get_update()])
    assert before.state() == after.state()
    assert after.knowledge().covers(before.knowledge())
    assert not before.knowledge().covers(after.knowledge())

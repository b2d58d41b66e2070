"""A large update cut into pieces: together they are the update, and each builds only on those before it."""

from __future__ import annotations

import random

import pytest
from pycrdt import Doc, Map

from editor.documents.shared_document import ROOTS_AS_BYTES, SharedDocument, UpdateHole, merge
from editor.documents.slices import SLICE_BYTES, SLICE_CHANGES, Cutting, CutUpdate, cut_update
from editor.documents.yjs_encoding import BadFrame, encode_integer
from editor.documents.yjs_updates import MOST_CLIENTS, check_update


def cut(update: bytes) -> CutUpdate:
    return cut_update(update, ROOTS_AS_BYTES, MOST_CLIENTS)


def applied(pieces: CutUpdate, document: SharedDocument) -> SharedDocument:
    """Apply the pieces; each must be whole when its turn comes."""
    for piece in pieces.slices:
        document.check_whole(check_update(piece.update, ROOTS_AS_BYTES))
        document.apply_slice(piece)
    return document


def drawn_by_many(people: int, rounds: int) -> bytes:
    """Return what people have drawn who build on each other's changes, moved, and deleted again."""
    chance, documents = random.Random(7), [Doc(client_id=100 + number) for number in range(people)]
    for number in range(rounds):
        document = chance.choice(documents)
        steps = document.get("steps", type=Map)
        names = sorted(steps)
        if names and number % 5 == 4:
            del steps[chance.choice(names)]
        elif names and number % 2:
            steps[chance.choice(names)]["pos"] = [float(number), 0.0]
        else:
            steps[f"s{number}"] = Map({"kind": "wait", "params": Map({"duration": number})})
        other = chance.choice(documents)
        other.apply_update(document.get_update(other.get_state()))
    return merge(document.get_update() for document in documents)


def test_pieces_of_what_many_drew_upon_each_other_come_in_an_order_and_hold_the_same() -> None:
    update = drawn_by_many(people=8, rounds=1200)
    pieces = cut(update)
    document, whole = applied(pieces, SharedDocument()), SharedDocument([update])
    assert len(pieces.slices) > 10
    assert document.digest() == whole.digest()
    assert document.knowledge() == whole.knowledge()
    assert document.clocks() == whole.clocks()


def test_a_piece_is_small_unless_one_change_is_large() -> None:
    document = Doc(client_id=5)
    with document.transaction():
        for number in range(3000):
            document.get("parameters", type=Map)[f"p{number}"] = number
        document.get("parameters", type=Map)["large"] = "x" * 100_000
    pieces = cut(document.get_update())
    sizes = [len(piece.update) for piece in pieces.slices]
    assert len(sizes) >= 3000 / SLICE_CHANGES
    assert [size > SLICE_BYTES + 100 for size in sizes].count(True) == 1
    assert applied(pieces, SharedDocument()).digest() == SharedDocument([document.get_update()]).digest()


def test_deletions_are_cut_too() -> None:
    ranges = b"".join(encode_integer(2 * number) + b"\x01" for number in range(1000))
    pieces = cut(b"\x00\x01\x07" + encode_integer(1000) + ranges)
    assert len(pieces.slices) == 1000 / SLICE_CHANGES
    with pytest.raises(UpdateHole, match="It deletes what is not known"):
        SharedDocument().check_whole(pieces.said)


def test_changes_that_build_on_each_other_in_a_circle_are_none() -> None:
    one = b"\x01\x07\x00" + b"\x84\x08\x00\x01a"
    other = b"\x01\x08\x00" + b"\x84\x07\x00\x01a"
    with pytest.raises(BadFrame, match="in a circle"):
        cut(b"\x02" + one + other + b"\x00")
    with pytest.raises(BadFrame, match="twice"):
        cut(b"\x02" + one + one + b"\x00")


def test_what_an_update_builds_on_is_known_before_it_is_applied() -> None:
    document = Doc(client_id=5)
    document.get("steps", type=Map)["s1"] = Map({"kind": "wait"})
    before = document.get_state()
    other = Doc(client_id=6)
    other.apply_update(document.get_update())
    other.get("steps", type=Map)["s1"]["kind"] = "move"
    said = check_update(other.get_update(before), ROOTS_AS_BYTES)
    assert said.needs.keys() == {5}
    with pytest.raises(UpdateHole, match="It builds on what is not known"):
        SharedDocument().check_whole(said)
    SharedDocument([document.get_update()]).check_whole(said)


def test_of_deletions_only_the_last_are_kept_for_who_applies_them() -> None:
    update = b"\x00\x01\x07\x02\x00\x01\x04\x02"
    asked = Cutting(update, ROOTS_AS_BYTES, MOST_CLIENTS, with_deletions=False).cut()
    assert asked.said.deletions == {7: ((4, 6),)}
    compared = Cutting(update, ROOTS_AS_BYTES, MOST_CLIENTS, with_deletions=True).cut()
    assert (compared.said.deletions, compared.slices) == ({7: ((0, 1), (4, 6))}, ())

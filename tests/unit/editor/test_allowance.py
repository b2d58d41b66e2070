"""What a person may cost, over all connections."""

from __future__ import annotations

import pytest

from editor.documents.yjs_encoding import encode_integer
from editor.rooms import yjs_protocol
from editor.rooms.member import Allowance, Close, Person
from tests.unit.editor.people import Client, room


def test_what_a_person_may_cost_is_counted_over_all_connections() -> None:
    allowance = Allowance()
    allowance.spend_parts(400_000, 0.0)
    allowance.spend_parts(100_000, 1.0)
    with pytest.raises(Close, match="more changes than a program has") as refused:
        allowance.spend_parts(100_000, 2.0)
    assert refused.value.code == Close.ABUSE
    allowance.spend_parts(100_000, 30.0)


def test_who_is_closed_for_abuse_again_and_again_is_held_off_longer_and_then_forgiven() -> None:
    allowance = Allowance()
    assert allowance.held_off_s(0.0) == 0.0
    held = []
    for _ in range(7):
        allowance.note_close(Close.ABUSE, 100.0)
        held.append(allowance.held_off_s(100.0))
    assert held == [10, 20, 40, 80, 160, 300, 300]
    assert (allowance.held_off_s(399.0), allowance.held_off_s(400.0)) == (1.0, 0.0)
    assert (allowance.is_like_new(999.0), allowance.is_like_new(1000.0)) == (False, True)
    allowance.note_close(Close.ABUSE, 1100.0)
    assert allowance.held_off_s(1100.0) == 10


def test_who_comes_back_again_and_again_with_another_fault_is_held_off_too() -> None:
    allowance, held = Allowance(), []
    faults = (Close.MALFORMED, Close.TOO_LARGE, Close.COME_AGAIN, Close.SIGNED_OUT)
    for number in range(4 * 150):
        allowance.note_close(faults[number % 4], 100.0)
        held.append(allowance.held_off_s(100.0))
    assert (set(held[:597]), held[597:]) == ({0.0}, [10, 10, 10])
    allowance.note_close(Close.ABUSE, 100.0)
    assert allowance.held_off_s(100.0) == 20


@pytest.mark.parametrize("can_write", [True, False])
def test_an_update_is_paid_for_by_who_sent_it(can_write: bool) -> None:
    client = Client(room(), can_write=can_write, number=7)
    client.read()
    client.send(yjs_protocol.encode_update(client.edit("s1", 1)))
    gone = b"\x00\x01\x07" + encode_integer(200_000) + b"\x00\x01" * 200_000
    client.send(yjs_protocol.encode_update(gone))
    client.send(yjs_protocol.encode_update(gone))
    with pytest.raises(Close, match="more changes than a program has"):
        client.send(yjs_protocol.encode_update(gone))
    Client(client.room, Person(2, "Bob", "B")).send(yjs_protocol.encode_update(gone))

"""A room without a network: order, holding back, roles, and two processes that hold the same room."""

from __future__ import annotations

import random
from typing import Any

import pytest

from editor.documents.shared_document import SharedDocument
from editor.rooms import yjs_protocol
from editor.rooms.member import FRAMES_PER_S, Close, Member, Person
from editor.rooms.room import MOST_OF_PERSON, MOST_READERS, MOST_WRITERS
from editor.rooms.stream import Entry, Note
from tests.unit.editor.people import Client, nobody, room


def test_a_new_connection_is_asked_for_what_it_has() -> None:
    here = room()
    client = Client(here)
    assert [type(message) for message in client.read()] == [yjs_protocol.SyncStep1]


def test_a_change_reaches_the_others_and_not_its_sender() -> None:
    here = room()
    ada, bob = Client(here), Client(here, number=2)
    ada.read()
    bob.read()
    ada.send(yjs_protocol.encode_update(ada.edit("s1", 3)))
    assert ada.read() == []
    bob.read()
    assert bob.steps() == {"s1": {"kind": "wait", "pos": [3, 0], "params": {}}}
    assert [(each.change.author, len(here.to_publish)) for each in here.ledger.own()] == [(1, 1)]


def test_updates_wait_for_the_step_2_of_their_client() -> None:
    here = room()
    ada = Client(here)
    first, second = ada.edit("s1", 1), ada.edit("s2", 2)
    ada.send(yjs_protocol.encode_update(second))
    assert (here.document.step_count(), len(here.ledger.own())) == (0, 0)
    ada.send(yjs_protocol.encode_step_2(first))
    assert here.document.to_json()["steps"].keys() == {"s1", "s2"}


def test_a_change_after_a_hole_is_not_let_in_and_the_client_is_asked() -> None:
    here = room()
    ada = Client(here)
    ada.read()
    lost, later = ada.edit("s1", 1), ada.edit("s1", 2)
    ada.send(yjs_protocol.encode_update(later))
    assert (here.document.to_json()["steps"], here.ledger.own()) == ({}, [])
    ada.read()
    assert here.document.to_json()["steps"] == ada.steps()
    assert lost != later


def test_a_reader_is_answered_and_never_heard() -> None:
    here = room()
    author, reader = Client(here), Client(here, can_write=False, number=2)
    author.read()
    author.send(yjs_protocol.encode_update(author.edit("s1", 1)))
    reader.read()
    reader.send(yjs_protocol.encode_step_2(reader.edit("bad", 1)))
    reader.send(yjs_protocol.encode_update(reader.edit("worse", 1)))
    reader.send(yjs_protocol.encode_step_1(b"\x00"))
    assert [type(message) for message in reader.read()] == [yjs_protocol.SyncStep2]
    assert list(here.document.to_json()["steps"]) == ["s1"]
    assert len(here.ledger.own()) == 1


def test_of_somebody_whose_session_was_not_looked_at_lately_no_change_is_taken() -> None:
    here, sure = room(), [True]
    ada = Client(here)
    ada.member.is_sure = lambda: sure[0]
    ada.read()
    ada.send(yjs_protocol.encode_update(ada.edit("s1", 1)))
    sure[0] = False
    ada.send(yjs_protocol.encode_step_1(b"\x00"))
    with pytest.raises(Close, match="What was typed stays in the browser") as refused:
        ada.send(yjs_protocol.encode_update(ada.edit("s2", 1)))
    assert refused.value.code == 4503
    assert (list(here.document.to_json()["steps"]), len(here.ledger.own())) == (["s1"], 1)


def test_a_room_is_full_at_some_point() -> None:
    here = room()
    for number in range(MOST_WRITERS):
        Client(here, person(number), number=number + 1)
    with pytest.raises(Close, match="50 people are in this program already") as refused:
        Client(here, person(99), number=99)
    assert (refused.value.code, len(here.members)) == (4503, MOST_WRITERS)


def test_readers_never_keep_writers_out() -> None:
    here = room()
    for number in range(MOST_READERS):
        Client(here, person(number), can_write=False, number=number + 1)
    with pytest.raises(Close, match="300 people are in this program already"):
        Client(here, person(99), can_write=False, number=99)
    Client(here, person(100), number=100)
    assert len(here.members) == MOST_READERS + 1


def test_one_person_has_a_program_open_ten_times_at_most_and_others_come_in() -> None:
    here = room()
    for number in range(MOST_OF_PERSON):
        Client(here, person(1), number=number + 1)
    with pytest.raises(Close, match="Close other copies of the page") as refused:
        Client(here, person(1), number=99)
    Client(here, person(2), number=100)
    assert (refused.value.code, len(here.members)) == (4429, MOST_OF_PERSON + 1)
    here.leave(here.members[0])
    Client(here, person(1), number=101)


def person(number: int) -> Person:
    return Person(number, f"Person {number}", "PP")


def test_too_many_frames_in_a_second_are_refused_and_a_steady_hand_is_not() -> None:
    here = room()
    steady, flood = Client(here), Client(here, number=2)
    for number in range(3000):
        steady.send(b"\x03", number / FRAMES_PER_S)
    with pytest.raises(Close, match="more than 60 messages a second") as refused:
        send_often(flood, 3000)
    assert refused.value.code == 4429


def send_often(client: Client, times: int) -> None:
    for _ in range(times):
        client.send(b"\x03")


def test_what_fails_half_way_leaves_no_trace() -> None:
    here = room()
    ada = Client(here)
    ada.read()
    ada.send(yjs_protocol.encode_update(ada.edit("s1", 1)))
    before = here.document.to_json()
    base = here.document.encode()
    dice, refused = random.Random(7), 0
    for _ in range(400):
        noise = bytearray(base)
        noise[dice.randrange(4, len(noise))] ^= 1 << dice.randrange(8)
        refused += is_refused(ada, bytes(noise))
    assert refused > 50
    assert here.document.to_json()["steps"]["s1"] == before["steps"]["s1"]


def is_refused(client: Client, update: bytes) -> bool:
    try:
        client.room.receiver.receive(
            Member(client.person, can_write=True, wake=nobody), yjs_protocol.encode_step_2(update), 0.0
        )
    except Close as close:
        return close.code == Close.MALFORMED
    return False


def test_a_connection_that_does_not_read_is_sent_away() -> None:
    here = room()
    lazy = Client(here)
    lazy.read()
    for _ in range(40):
        lazy.member.post(bytes(1024 * 1024))
    assert lazy.member.closing is not None
    assert (lazy.member.closing.code, len(lazy.member.outbox)) == (4503, 0)


def test_a_connection_that_reads_a_lot_stays() -> None:
    here = room()
    keen = Client(here)
    for _ in range(100):
        keen.member.post(yjs_protocol.encode_update(bytes(500_000)))
        keen.member.outbox.clear()
        keen.send(yjs_protocol.encode_step_1(b"\x00"))
        keen.read()
    assert keen.member.closing is None


def test_a_process_of_another_version_has_another_digest_is_sent_the_document_and_changes_nothing() -> None:
    here = Client(room())
    here.read()
    here.send(yjs_protocol.encode_update(here.edit("s1", 1)))
    here.room.to_publish.clear()
    before = here.room.document.encode()
    for number in range(2):
        here.room.hear(Entry(f"{number}-0", "older", Note("state", b"0" * 64 + here.room.document.state())))
        note = here.room.to_publish.popleft()
        assert (note.kind, SharedDocument([note.data]).to_json()) == ("full", here.room.document.to_json())
        assert not here.room.to_publish
    here.room.hear(Entry("9-0", "older", Note("full", before)))
    assert here.room.document.encode() == before


def test_a_note_that_only_a_newer_version_knows_is_passed_over() -> None:
    here = Client(room())
    here.read()
    kind: Any = "of tomorrow"
    here.room.hear(Entry("1-0", "newer", Note(kind, b"x")))
    assert (list(here.room.to_publish), here.room.ledger.stored_to) == ([], "1-0")


def test_a_number_that_browsers_cannot_read_is_refused_and_ends_no_other_process_room() -> None:
    here, there = room("one"), room("two")
    ada = Client(here)
    ada.read()
    shown = b'{"x":1e999}'
    with pytest.raises(Close, match="1e999 is larger than a number may be"):
        ada.send(b"\x01" + bytes((4 + len(shown), 1, 5, 1, len(shown))) + shown)
    assert list(here.to_publish) == []
    there.hear(Entry("1-0", "one", Note("awareness", bytes((1, 5, 1, len(shown))) + shown)), 0.0)
    assert there.board.everybody() == []

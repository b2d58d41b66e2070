"""A room without a network: order, holding back, roles, and two processes that hold the same room."""

from __future__ import annotations

import random

import pytest
from pycrdt import Map

from editor.documents import yjs_encoding
from editor.documents.yjs_encoding import encode_integer
from editor.rooms import yjs_protocol
from editor.rooms.ledger import last_numbers
from editor.rooms.member import FRAMES_PER_S, Allowance, Close, Member, Person
from editor.rooms.room import MOST_OF_PERSON, MOST_READERS, MOST_WRITERS, Room
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
        client.room.receive(Member(client.person, can_write=True, wake=nobody), yjs_protocol.encode_step_2(update), 0.0)
    except Close as close:
        return close.code == Close.MALFORMED
    return False


def saved(client: Client) -> tuple[int, int]:
    """Take the frames that were sent; return the numbers of the last one that tells what is saved."""
    told = [frame for frame in client.member.outbox if frame[0] == yjs_protocol.SAVED]
    client.member.outbox.clear()
    reader = yjs_encoding.Reader(told[-1])
    reader.integer()
    return reader.integer(), reader.integer()


ASK = yjs_encoding.encode_integer(yjs_protocol.SAVED)


def test_who_asks_is_told_how_many_of_their_messages_are_in_the_database() -> None:
    here = room()
    ada, bob = Client(here), Client(here, number=2)
    ada.read()
    bob.read()
    ada.send(ASK)
    assert saved(ada) == (1, 0)
    ada.send(yjs_protocol.encode_update(ada.edit("s1", 1)))
    ada.send(yjs_protocol.encode_update(ada.edit("s2", 1)))
    assert not ada.member.outbox
    here.say_stored({"here": 1}, range(7, 7 + 1))
    assert saved(ada) == (2, 0)
    here.say_stored({"here": 2}, range(8, 8 + 1))
    assert saved(ada) == (3, 0)
    here.spread()
    assert [frame[0] for frame in bob.member.outbox] == [yjs_protocol.SYNC]


def test_a_deletion_is_saved_when_it_is_in_the_database_and_not_before() -> None:
    here = room()
    ada = Client(here)
    ada.read()
    ada.send(ASK)
    ada.send(yjs_protocol.encode_update(ada.edit("s1", 1)))
    here.say_stored({"here": 1}, range(1, 1 + 1))
    state = ada.document.get_state()
    del ada.document.get("steps", type=Map)["s1"]
    ada.send(yjs_protocol.encode_update(ada.document.get_update(state)))
    assert saved(ada) == (2, 0)
    here.say_stored({"here": 2}, range(2, 2 + 1))
    assert saved(ada) == (3, 0)


def test_what_builds_on_a_change_of_another_process_is_saved_with_it() -> None:
    both = TwoProcesses()
    a, b = both.pair()
    ada, bob = Client(a), Client(b, number=2)
    ada.read()
    bob.read()
    bob.send(ASK)
    ada.send(yjs_protocol.encode_update(ada.edit("s1", 1)))
    both.carry()
    bob.read()
    bob.send(yjs_protocol.encode_update(bob.edit("s1", 2)))
    b.say_stored({"b": 1}, range(1, 1 + 1))
    bob.send(ASK)
    assert saved(bob) == (1, 0)
    adopted = b.ledger.adoptable(1.0)
    assert [(each.origin, each.change.author) for each in adopted] == [("a", 1)]
    b.say_stored(last_numbers(adopted), range(2, 2 + 1))
    assert saved(bob) == (2, 0)


def test_a_message_after_a_hole_is_not_saved_before_the_client_has_said_all() -> None:
    here = room()
    ada = Client(here)
    ada.read()
    ada.send(ASK)
    ada.edit("s1", 1)
    ada.send(yjs_protocol.encode_update(ada.edit("s2", 1)))
    assert saved(ada) == (1, 0)
    ada.send(yjs_protocol.encode_step_2(ada.document.get_update(here.document.state())))
    here.say_stored({"here": 2}, range(1, 1 + 1))
    assert (saved(ada), sorted(here.document.to_json()["steps"])) == ((3, 0), ["s1", "s2"])


def test_a_reader_is_told_that_a_change_was_not_taken() -> None:
    here = room()
    author, eve = Client(here), Client(here, can_write=False, number=2)
    author.read()
    author.send(yjs_protocol.encode_update(author.edit("s1", 1)))
    here.spread()
    eve.read()
    eve.send(ASK)
    eve.send(yjs_protocol.encode_step_2(eve.document.get_update()))
    assert saved(eve) == (0, 0)
    eve.send(yjs_protocol.encode_update(eve.edit("s2", 1)))
    assert saved(eve) == (0, 1)
    state = eve.document.get_state()
    del eve.document.get("steps", type=Map)["s1"]
    eve.send(yjs_protocol.encode_update(eve.document.get_update(state)))
    assert saved(eve) == (0, 2)
    assert list(here.document.to_json()["steps"]) == ["s1"]


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


class TwoProcesses:
    """Two rooms of the same program, joined by a stream that may lose things."""

    def __init__(self) -> None:
        self.rooms = {"a": room("a"), "b": room("b")}
        self.number = 0

    def carry(self, lose: bool = False) -> None:
        for _ in range(10):
            for origin, source in self.rooms.items():
                while source.to_publish:
                    note = source.to_publish.popleft()
                    if not lose:
                        self.deliver(origin, note)

    def deliver(self, origin: str, note: Note) -> None:
        self.number += 1
        for name, target in self.rooms.items():
            if name != origin:
                target.hear(Entry(str(self.number), origin, note))

    def pair(self) -> tuple[Room, Room]:
        return self.rooms["a"], self.rooms["b"]


def test_two_processes_hold_the_same_and_each_keeps_only_its_own() -> None:
    both = TwoProcesses()
    a, b = both.pair()
    ada, bob = Client(a), Client(b, Person(2, "Bob", "B"), number=2)
    ada.read()
    bob.read()
    ada.send(yjs_protocol.encode_update(ada.edit("s1", 1)))
    both.carry()
    bob.read()
    bob.send(yjs_protocol.encode_update(bob.edit("s1", 2)))
    both.carry()
    ada.read()
    assert a.document.digest() == b.document.digest()
    assert ada.steps() == bob.steps() == {"s1": {"kind": "wait", "pos": [2, 0], "params": {}}}
    assert [[waiting.change.author for waiting in each.ledger.own()] for each in (a, b)] == [[1], [2]]


def test_what_the_stream_lost_is_found_by_comparing() -> None:
    both = TwoProcesses()
    a, b = both.pair()
    ada, bob = Client(a), Client(b, number=2)
    ada.read()
    bob.read()
    for client, name in ((ada, "s1"), (bob, "s2")):
        client.send(yjs_protocol.encode_update(client.edit(name, 1)))
    both.carry(lose=True)
    assert a.document.digest() != b.document.digest()
    a.say_state()
    both.carry()
    assert a.document.digest() == b.document.digest()
    assert set(a.document.to_json()["steps"]) == {"s1", "s2"}


def test_a_lost_deletion_is_found_by_its_hash() -> None:
    both = TwoProcesses()
    a, b = both.pair()
    ada = Client(a)
    ada.read()
    ada.send(yjs_protocol.encode_update(ada.edit("s1", 1)))
    both.carry()
    state = ada.document.get_state()
    del ada.document.get("steps", type=type(ada.document["steps"]))["s1"]
    ada.send(yjs_protocol.encode_step_2(ada.document.get_update(state)))
    both.carry(lose=True)
    assert list(b.document.to_json()["steps"]) == ["s1"]
    b.say_state()
    both.carry()
    assert a.document.to_json()["steps"] == b.document.to_json()["steps"] == {}


def test_a_change_before_which_one_was_lost_waits_until_it_has_been_asked_for() -> None:
    both = TwoProcesses()
    a, b = both.pair()
    ada, bob = Client(a), Client(b, number=2)
    ada.read()
    bob.read()
    ada.send(yjs_protocol.encode_update(ada.edit("s0", 1)))
    both.carry()
    ada.send(yjs_protocol.encode_update(ada.edit("s1", 1)))
    a.to_publish.clear()
    ada.send(yjs_protocol.encode_update(ada.edit("s2", 1)))
    both.deliver("a", a.to_publish.popleft())
    assert list(b.document.to_json()["steps"]) == ["s0"]
    assert (b.ledger.doubts, [each.number for each in b.ledger.adoptable(9.0)]) == (1, [1])
    both.carry()
    bob.read()
    assert sorted(bob.steps()) == ["s0", "s1", "s2"]
    assert a.document.digest() == b.document.digest()


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
        allowance.note_abuse(100.0)
        held.append(allowance.held_off_s(100.0))
    assert held == [10, 20, 40, 80, 160, 300, 300]
    assert (allowance.held_off_s(399.0), allowance.held_off_s(400.0)) == (1.0, 0.0)
    assert (allowance.is_like_new(999.0), allowance.is_like_new(1000.0)) == (False, True)
    allowance.note_abuse(1100.0)
    assert allowance.held_off_s(1100.0) == 10


@pytest.mark.parametrize("can_write", [True, False])
def test_an_update_is_paid_for_by_who_sent_it(can_write: bool) -> None:
    client = Client(room(), can_write=can_write)
    client.read()
    gone = b"\x00\x01\x07" + encode_integer(200_000) + b"\x00\x01" * 200_000
    client.send(yjs_protocol.encode_update(gone))
    client.send(yjs_protocol.encode_update(gone))
    with pytest.raises(Close, match="more changes than a program has"):
        client.send(yjs_protocol.encode_update(gone))
    Client(client.room, Person(2, "Bob", "B")).send(yjs_protocol.encode_update(gone))

"""What connections are told of what is saved, and two processes that hold one room."""

from __future__ import annotations

from pycrdt import Map

from editor.documents import yjs_encoding
from editor.rooms import yjs_protocol
from editor.rooms.ledger import last_numbers
from editor.rooms.member import Person
from tests.unit.editor.people import Client, TwoProcesses, room


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

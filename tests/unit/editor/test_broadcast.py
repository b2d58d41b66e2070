"""What goes out of a room to who reads, reads slowly or not at all."""

from __future__ import annotations

import pytest
from pycrdt import Map

from editor.rooms import yjs_protocol
from editor.rooms.member import BURST_AWARENESS, BURST_FRAMES, MOST_BEHIND_BYTES, MOST_SILENT_BEATS, Close
from editor.rooms.yjs_protocol import AwarenessEntry
from tests.unit.editor.people import Client, room

LARGE, SMALL = 300_000, 10


def write(author: Client, size: int, number: int, now_s: float = 0.0) -> None:
    """Have an author write a text of so many characters in the place of the one before."""
    before = author.document.get_state()
    author.document.get("parameters", type=Map)["text"] = f"{number}" * size
    author.send(yjs_protocol.encode_update(author.document.get_update(before)), now_s)
    author.read()


def pair() -> tuple[Client, Client]:
    here = room()
    author, reader = Client(here), Client(here, can_write=False, number=2)
    author.read()
    reader.read()
    return author, reader


def text(client: Client) -> str:
    return str(client.document.get("parameters", type=Map)["text"])


def waiting(client: Client) -> int:
    return sum(map(len, client.member.outbox))


def test_who_reads_all_and_never_writes_stays_and_is_never_behind() -> None:
    author, reader = pair()
    for number in range(100):
        write(author, LARGE, number % 10, number)
        reader.read()
        assert reader.member.behind is None
    assert (reader.member.closing, text(reader)) == (None, text(author))


@pytest.mark.parametrize(("size", "edits"), [(LARGE, 60), (SMALL, 4000)])
def test_who_reads_nothing_is_kept_a_little_and_let_go_after_a_minute(size: int, edits: int) -> None:
    author, reader = pair()
    most = 0
    for number in range(edits):
        write(author, size, number % 10, number)
        most = max(most, waiting(reader))
    assert most <= MOST_BEHIND_BYTES + size + 1000
    assert len(reader.member.outbox) <= 2000
    for _ in range(MOST_SILENT_BEATS - 1):
        reader.room.beat()
    assert reader.member.closing is None
    reader.room.beat()
    assert reader.member.closing is not None
    assert reader.member.closing.code == Close.COME_AGAIN
    assert author.member.closing is None


@pytest.mark.parametrize(("size", "edits"), [(LARGE, 60), (SMALL, 4000)])
def test_who_reads_late_is_told_the_difference_and_has_all(size: int, edits: int) -> None:
    author, reader = pair()
    for number in range(edits):
        write(author, size, number % 10, number)
    assert reader.member.behind is not None
    updates = [each for each in reader.read() if isinstance(each, yjs_protocol.Update)]
    assert len(updates) < edits
    assert (reader.member.behind, reader.member.closing, text(reader)) == (None, None, text(author))
    write(author, SMALL, 7, 5001)
    reader.read()
    assert text(reader) == "7" * SMALL


def test_who_catches_up_sees_who_is_here() -> None:
    author, reader = pair()
    for number in range(20):
        write(author, LARGE, number % 10)
    author.send(yjs_protocol.encode_awareness([AwarenessEntry(1, 1, {"cursor": [1, 2]})]))
    reader.room.spread_awareness()
    shown = [each.entries for each in reader.read() if isinstance(each, yjs_protocol.Awareness)]
    assert [[(e.client, e.state["cursor"]) for e in entries if e.state] for entries in shown] == [[(1, [1, 2])]]


def test_an_author_who_is_behind_keeps_what_it_draws_meanwhile() -> None:
    author, reader = pair()
    other = Client(author.room, number=3)
    other.read()
    for number in range(20):
        write(author, LARGE, number % 10)
    assert other.member.behind is not None
    other.send(yjs_protocol.encode_update(other.edit("s1", 4)))
    other.read()
    author.read()
    reader.read()
    assert other.member.behind is None
    assert author.steps() == other.steps() == reader.steps() == {"s1": {"kind": "wait", "pos": [4, 0], "params": {}}}
    assert text(other) == text(author)


def test_awareness_of_nobody_is_counted() -> None:
    author = Client(room())
    frame = yjs_protocol.encode_awareness(())
    for _ in range(int(BURST_FRAMES)):
        author.send(frame)
    with pytest.raises(Close, match="60 messages a second"):
        author.send(frame)


def test_repeating_what_others_show_is_counted_apart_and_has_an_end() -> None:
    author, reader = pair()
    author.send(yjs_protocol.encode_awareness([AwarenessEntry(1, 1, {})]))
    echo = yjs_protocol.encode_awareness([AwarenessEntry(1, 1, {})])
    for _ in range(int(BURST_AWARENESS)):
        reader.send(echo)
    reader.send(yjs_protocol.encode_step_1(b"\x00"))
    with pytest.raises(Close, match="who is here"):
        reader.send(echo)


def test_bytes_of_awareness_are_told_so_that_they_can_be_slowed_down() -> None:
    author, reader = pair()
    author.send(yjs_protocol.encode_awareness([AwarenessEntry(1, 1, {"text": "x" * 3000})]))
    assert author.room.spread_awareness() == waiting(reader) > 3000
    assert author.room.spread_awareness() == 0

"""The gateway's own bookkeeping, without a broker or a database."""

from __future__ import annotations

import json

from execution.gateway.queue import COMPLAINT_EVERY_S, KNOWN_DEVICES, Complaints, Entry, Inbox, TokenBucket
from vipo_device.protocol.mqtt_client import Message


def entry(device: str, kind: str, payload: bytes = b"") -> Entry:
    return Entry(Message(f"vipo/v1/dev/{device}/up/{kind}", payload, False, lambda: None), device, kind)


def taken(inbox: Inbox) -> list[tuple[str, str, bytes, bool]]:
    return [(one.device, one.kind, one.message.payload, one.outdated) for one in inbox.get_all(0, 10)]


def test_messages_come_out_in_the_order_of_their_arrival_and_only_the_newest_state_counts() -> None:
    inbox = Inbox()
    for one in (
        entry("a", "state", b"1"),
        entry("a", "ack", b"2"),
        entry("b", "state", b"3"),
        entry("a", "state", b"4"),
    ):
        assert inbox.put(one)
    assert taken(inbox) == [
        ("a", "state", b"1", True),
        ("a", "ack", b"2", False),
        ("b", "state", b"3", False),
        ("a", "state", b"4", False),
    ]


def test_a_state_that_was_taken_out_is_not_outdated_by_a_later_one() -> None:
    inbox = Inbox()
    inbox.put(entry("a", "state", b"1"))
    (first,) = inbox.get_all(0, 10)
    inbox.put(entry("a", "state", b"2"))
    assert not first.outdated


def state(seq: int, done: bool, boot: int = 1) -> bytes:
    return json.dumps({"boot": boot, "seq": seq, "done": done, "props": {"done": not done}}).encode()


def kept(*payloads: bytes) -> list[bytes]:
    inbox = Inbox()
    for payload in payloads:
        assert inbox.put(entry("a", "state", payload))
    return [payload for _, _, payload, is_outdated in taken(inbox) if not is_outdated]


def test_states_that_tell_the_same_flag_join_and_each_turn_of_it_is_kept() -> None:
    said = [state(seq, done) for seq, done in enumerate((True, False, False, True, True, True, False), 1)]
    assert kept(*said) == [said[0], said[2], said[5], said[6]]


def test_a_state_is_outdated_by_none_that_is_older_or_will_be_refused() -> None:
    new, old, older_start = state(5, True), state(3, True), state(9, True, boot=0)
    assert kept(new, old) == [new, old]
    assert kept(new, older_start) == [new, older_start]
    for refused in (b"", b"{", b"7", b'{"seq": 6, "done": true}', b"[" * 16_000, new[:-1] + b" " * 16_384 + b"}"):
        assert kept(new, refused) == [new, refused]
        assert kept(refused, refused, new) == [refused, new]


def test_a_device_that_alternates_fills_no_more_of_the_inbox_than_it_sends() -> None:
    inbox = Inbox(limit=10)
    assert [inbox.put(entry("a", "state", state(seq, seq % 2 == 0))) for seq in range(12)] == [True] * 10 + [False] * 2
    assert [one.outdated for one in inbox.get_all(0, 20)] == [False] * 10
    assert (len(inbox), inbox.put(entry("b", "state", state(1, True)))) == (0, True)


def test_no_more_come_out_than_were_asked_for() -> None:
    inbox = Inbox()
    for number in range(5):
        inbox.put(entry("a", "ack", str(number).encode()))
    assert [one.message.payload for one in inbox.get_all(0, 3)] == [b"0", b"1", b"2"]
    assert [one.message.payload for one in inbox.get_all(0, 3)] == [b"3", b"4"]
    assert inbox.get_all(0, 3) == []


def test_a_full_inbox_takes_nothing_more() -> None:
    inbox = Inbox(limit=2)
    assert [inbox.put(entry("a", "ack")) for _ in range(3)] == [True, True, False]


def test_what_nobody_keeps_leaves_room_for_what_the_broker_keeps() -> None:
    inbox = Inbox(limit=4, room_for_kept=2)
    unkept = Entry(Message("vipo/v1/dev/a/up/state", b"", False, lambda: None, qos=0), "a", "state")
    assert [inbox.put(unkept) for _ in range(3)] == [True, True, False]
    assert [inbox.put(entry("b", "ack")) for _ in range(3)] == [True, True, False]
    inbox.get_all(0, 3)
    assert inbox.put(unkept)


def test_a_bucket_gives_its_burst_and_then_its_rate() -> None:
    bucket = TokenBucket(rate=8, burst=3, tokens=3, filled_at=100.0)
    assert [bucket.take(100.0) for _ in range(4)] == [True, True, True, False]
    assert [bucket.take(100.125), bucket.take(100.125)] == [True, False]
    assert [bucket.take(200.0) for _ in range(4)] == [True, True, True, False]


def test_each_other_complaint_is_written_too_but_does_not_fill_the_history() -> None:
    complaints = Complaints()
    said = [complaints.add("a", f"desc: number {number}", float(number)) for number in range(20)]
    assert [line is not None for line in said] == [True] * 6 + [False] * 14
    assert complaints.add("a", "desc: number 5", 64.0) is None
    assert complaints.add("a", "desc: number 99", 64.0) == "desc: number 99 (15 more since the last note)"
    assert [complaints.add("a", f"x: {number}", 64.0) for number in range(3)] == [None] * 3


def test_complaints_of_one_kind_that_differ_in_figures_alone_are_one_complaint() -> None:
    complaints = Complaints()
    said = [complaints.count("a", f"state {number} is old", float(number), ("old_state",)) for number in range(20)]
    assert [others is not None for others in said] == [True] + [False] * 19
    assert complaints.count("a", "no description", 20.0, ("markup",)) == 19
    assert complaints.count("a", "state 60 is old", 60.0, ("old_state",)) == 0


def test_names_that_strangers_make_up_are_not_kept_for_ever() -> None:
    complaints = Complaints()
    for number in range(KNOWN_DEVICES + 10):
        for _ in range(2):
            complaints.add(f"made-up-{number}", "knock/: not JSON", float(number))
    assert (len(complaints.waiting), "made-up-9" in complaints.waiting) == (KNOWN_DEVICES, False)


def test_complaints_are_counted_and_written_once_a_minute() -> None:
    complaints = Complaints()
    assert complaints.add("a", "ack: not JSON", 0.0) == "ack: not JSON"
    assert complaints.add("a", "ack: not JSON", 1.0) is None
    assert complaints.add("b", "state: no boot", 1.0) == "state: no boot"
    assert complaints.add("a", "state: no boot", COMPLAINT_EVERY_S) == "state: no boot (1 more since the last note)"
    assert dict(complaints.counts) == {"ack": 2, "state": 2}

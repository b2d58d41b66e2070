"""The embedded broker's own bookkeeping: who asked for a topic, what is kept, and what waits."""

from __future__ import annotations

from typing import Any

from amqtt.broker import Broker
from hypothesis import given
from hypothesis import strategies as st

from vipo_site.embedded_broker.client_queue import Letter, Outbox, Room
from vipo_site.embedded_broker.subscriptions import KeptTopics, Subscriptions

LEVELS = st.lists(st.sampled_from(["a", "b", "", "$x"]), min_size=1, max_size=4)
FILTERS = st.lists(st.sampled_from(["a", "b", "", "+", "$x"]), min_size=1, max_size=4)
ENDINGS = st.sampled_from(["", "/#"])


class Matching(Broker):  # type: ignore[misc]  # amqtt has no types
    """amqtt's own idea of what a filter fits, without a broker."""

    def __init__(self) -> None:
        import logging

        self.logger = logging.getLogger("amqtt")


@given(LEVELS, st.lists(st.tuples(FILTERS, ENDINGS), max_size=12), st.integers(0, 12))
def test_a_topic_finds_every_filter_that_fits_it(levels: list[str], asked: list[Any], removed: int) -> None:
    filters = list(dict.fromkeys("/".join(parts) + ending for parts, ending in asked))
    subscriptions = Subscriptions()
    for topic_filter in filters:
        subscriptions[topic_filter] = [(topic_filter, 1)]
    for topic_filter in filters[:removed]:
        del subscriptions[topic_filter]
    topic = "/".join(levels)
    found = sorted(holder for holder, _qos in subscriptions.find(topic))
    assert found == sorted(f for f in filters[removed:] if Matching()._matches(topic, f))


def test_nothing_is_left_of_filters_that_went() -> None:
    subscriptions = Subscriptions()
    for number in range(100):
        subscriptions[f"a/{number}/+/#"] = []
        del subscriptions[f"a/{number}/+/#"]
    assert (dict(subscriptions), subscriptions._root.below) == ({}, {})


def test_what_is_kept_is_counted_by_who_said_it_last() -> None:
    kept = KeptTopics()
    assert [kept.add("one", f"t{n}", 10, most=2) for n in range(3)] == [True, True, False]
    assert kept.add("one", "t0", 99, most=2)
    assert kept.add("two", "t0", 10, most=2)
    assert kept.add("one", "t2", 10, most=2)
    kept.remove("t0")
    kept.remove("t0")
    kept.remove("t1")
    kept.remove("t2")
    assert (kept._owners, kept._counts, kept._size) == ({}, {}, 0)


def letter(number: int, qos: int = 1) -> Letter:
    return Letter(b"t", b"%d" % number, qos)


def numbers(outbox: Outbox) -> list[tuple[int, int]]:
    """Return (packet id, flags) of what may be sent now; a packet is `30 05 00 01 t id id payload`."""
    return [(int.from_bytes(packet[5:7], "big"), packet[0] & 0x0F) for packet in outbox.packets()]


def test_an_outbox_sends_as_many_as_may_fly_and_the_others_when_these_have_come() -> None:
    outbox = Outbox(Room(messages=6, size=10_000, flying=2))
    assert [outbox.put(letter(number)) for number in range(7)] == [True] * 6 + [False]
    assert numbers(outbox) == [(1, 2), (2, 2)]
    outbox.acknowledge(2)
    outbox.acknowledge(2)
    outbox.acknowledge(9)
    assert numbers(outbox) == [(3, 2)]
    outbox.begin()
    assert numbers(outbox) == [(1, 10), (3, 10)]
    for number in (1, 3):
        outbox.acknowledge(number)
    assert numbers(outbox) == [(4, 2), (5, 2)]
    assert len(outbox) == 3


def test_an_outbox_has_room_in_bytes_too_and_messages_of_qos_0_leave_it_when_they_are_sent() -> None:
    outbox = Outbox(Room(messages=100, size=3 * letter(0).size, flying=2))
    assert [outbox.put(letter(number, qos=0)) for number in range(4)] == [True, True, True, False]
    assert len(list(outbox.packets())) == 3
    assert (len(outbox), outbox.put(letter(4))) == (0, True)


def test_packet_ids_that_are_in_use_are_left_out() -> None:
    outbox = Outbox(Room(messages=100_000, size=10**9, flying=3))
    for number in range(70_000):
        outbox.put(letter(number))
    sent = numbers(outbox)
    while sent[-1][0] != 65_535:
        outbox.acknowledge(sent[-1][0])
        sent += numbers(outbox)
    outbox.acknowledge(65_535)
    assert (sent[:2], numbers(outbox)) == ([(1, 2), (2, 2)], [(3, 2)])

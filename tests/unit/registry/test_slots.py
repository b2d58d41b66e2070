"""Slots for what costs much: nobody keeps others from theirs."""

from __future__ import annotations

import threading

import pytest

from registry.bounds.slots import Claim, Slots
from registry.maps.kept_work import KeptWork
from tests.kit.waiting import wait_for


def test_a_person_a_site_and_all_have_so_many_places() -> None:
    slots = Slots(in_all=4, of_site=3, of_person=2)
    wanted = [(1, "a"), (1, "a"), (1, "b"), (2, "a"), (3, "a"), (3, "b"), (4, "c")]
    assert [slots.take(Claim(*each)) for each in wanted] == [True, True, False, True, False, True, False]
    slots.give_back(Claim(1, "a"))
    assert (slots.take(Claim(4, "a")), slots.take(Claim(1, "a")), slots.taken) == (True, False, 4)


def test_a_place_is_held_while_something_is_done_and_given_back_whatever_becomes_of_it() -> None:
    slots = Slots(in_all=1, of_site=1, of_person=1)

    def fail() -> None:
        with slots.held(Claim(1), LookupError("full")):
            assert slots.taken == 1
            with pytest.raises(LookupError, match="full"):
                slots.held(Claim(2), LookupError("full")).__enter__()
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    assert slots.taken == 0


def test_whoever_waits_comes_in_turn_past_those_whose_own_site_is_full() -> None:
    slots = Slots(in_all=2, of_site=1, of_person=1, most_waiting=2)
    order: list[str] = []
    assert slots.take(Claim(1, "a"))
    assert slots.take(Claim(9, "z"))

    def wait(person: int, site: str) -> None:
        if slots.take(Claim(person, site), patience_s=60):
            order.append(f"{person} {site}")

    waiting = []
    for claim in ((2, "a"), (3, "b"), (4, "c")):
        thread = threading.Thread(target=wait, args=claim)
        thread.start()
        waiting.append(thread)
        wait_for("its turn", lambda: len(slots._waiting) == len(waiting))
    slots.give_back(Claim(9, "z"))
    wait_for("the other site", lambda: order == ["3 b"])
    slots.give_back(Claim(1, "a"))
    wait_for("the first", lambda: order == ["3 b", "2 a"])
    assert not slots.take(Claim(5, "d"))
    slots.give_back(Claim(3, "b"))
    wait_for("the last", lambda: order == ["3 b", "2 a", "4 c"])
    for thread in waiting:
        thread.join()


def test_one_who_is_not_served_in_time_leaves_no_trace() -> None:
    slots = Slots(in_all=1, of_site=1, of_person=1, most_waiting=1)
    assert slots.take(Claim(1))
    assert not slots.take(Claim(2), patience_s=0.01)
    slots.give_back(Claim(1))
    assert slots.take(Claim(3))


def test_a_large_map_pushes_out_what_was_kept_before() -> None:
    kept: KeptWork[str] = KeptWork(100)
    made = []

    def get(name: str, cells: int) -> str:
        return kept.get(name, lambda: made.append(name) or name, lambda _: cells)  # type: ignore[func-returns-value]

    for name, cells in (("a", 60), ("b", 40), ("a", 60), ("c", 30), ("huge", 1000)):
        assert get(name, cells) == name
    assert (made, kept.cells) == (["a", "b", "c", "huge"], 1000)
    get("a", 60)
    assert (made[-1], kept.cells) == ("a", 60)


def test_ten_who_want_the_same_have_it_made_once() -> None:
    kept: KeptWork[int] = KeptWork(100)
    made: list[int] = []
    begin = threading.Barrier(10)

    def make() -> int:
        made.append(1)
        return 1

    def ask() -> None:
        begin.wait()
        kept.get("map", make, lambda _: 1)

    threads = [threading.Thread(target=ask) for _ in range(10)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert made == [1]

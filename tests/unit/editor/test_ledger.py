"""What is known to be stored, of one's own changes and of others'."""

from __future__ import annotations

import random

from editor.documents.store import Change
from editor.rooms.ledger import Ledger, decode_change, decode_stored, encode_change, encode_stored, last_numbers


def change(author: int | None = 1) -> Change:
    return Change(author, b"\x00\x00")


def test_what_follows_an_unstored_change_is_not_stored_either() -> None:
    ledger = Ledger("me")
    ledger.hear("1-0", "other", 1, change(), 0.0)
    ledger.add(change(), 0.0)
    ledger.note_stored("me", 1)
    assert (ledger.stored_place, ledger.place) == (0, 2)
    ledger.note_stored("other", 1)
    assert ledger.stored_place == 2


def test_a_change_is_adopted_when_its_process_has_not_stored_it_for_a_second() -> None:
    ledger = Ledger("me")
    ledger.hear("1-0", "other", 1, change(7), 10.0)
    ledger.hear("1-1", "other", 2, change(7), 10.9)
    assert ledger.adoptable(10.9) == []
    adopted = ledger.adoptable(11.0)
    assert [(each.number, each.change.author) for each in adopted] == [(1, 7)]
    ledger.note_stored("other", last_numbers(adopted)["other"])
    assert ledger.stored_place == 1


def test_a_change_that_is_told_twice_or_late_counts_once() -> None:
    ledger = Ledger("me")
    ledger.hear("1-0", "other", 1, change(), 0.0)
    ledger.hear("1-1", "other", 1, change(), 0.0)
    ledger.note_stored("other", 3)
    ledger.hear("1-2", "other", 2, change(), 0.0)
    assert (ledger.place, ledger.stored_place, ledger.stored_to) == (1, 1, "1-2")


def test_the_stream_is_stored_up_to_the_first_entry_that_is_not() -> None:
    ledger = Ledger("me")
    ledger.add(change(), 0.0)
    ledger.hear("1-0", "other", 1, change(), 0.0)
    ledger.hear("1-1", "me", 1, change(), 0.0)
    ledger.hear("1-2", "other", 2, change(), 0.0)
    ledger.note_stored("other", 1)
    assert ledger.stored_to == "1-0"
    ledger.pass_entry("1-3")
    ledger.note_stored("me", 1)
    assert ledger.stored_to == "1-1"
    ledger.note_stored("other", 2)
    ledger.pass_entry("1-4")
    assert ledger.stored_to == "1-4"


def test_what_is_in_doubt_holds_up_what_follows_until_it_is_compared() -> None:
    ledger = Ledger("me")
    ledger.doubt("1-0", 0.0)
    ledger.add(change(), 0.0)
    ledger.note_stored("me", 1)
    assert (ledger.stored_place, ledger.doubts, ledger.own(), ledger.adoptable(9.0)) == (0, 1, [], [])
    ledger.settle(ledger.last_doubt)
    assert (ledger.stored_place, ledger.doubts, ledger.stored_to) == (2, 0, "1-0")


def test_nothing_is_called_stored_that_a_plain_count_would_not_call_so() -> None:
    dice = random.Random(3)
    for _ in range(300):
        ledger, came, stored = Ledger("me"), [], {"me": 0, "a": 0, "b": 0}
        told = dict.fromkeys(stored, 0)
        for entry in range(dice.randrange(60)):
            origin = dice.choice(list(stored))
            if dice.random() < 0.6:
                told[origin] += 1
                came.append((origin, told[origin]))
                if origin == "me":
                    ledger.add(change(), 0.0)
                ledger.hear(f"1-{entry}", origin, told[origin], change(), 0.0)
            else:
                stored[origin] = max(stored[origin], dice.randint(0, told[origin]))
                ledger.note_stored(origin, stored[origin])
            plain = next((place for place, (of, number) in enumerate(came) if number > stored[of]), len(came))
            assert ledger.stored_place == plain


def test_rows_of_which_nobody_tells_are_looked_at_after_a_second() -> None:
    ledger = Ledger("me")
    ledger.know_rows(range(1, 5))
    ledger.see_row(6, 0.0)
    ledger.know_rows(range(6, 7))
    ledger.see_row(6, 0.9)
    assert (ledger.rows_to, ledger.doubts) == (4, 0)
    ledger.know_rows(range(5, 6))
    ledger.see_row(6, 1.5)
    assert (ledger.rows_to, ledger.doubts) == (6, 0)
    ledger.see_row(8, 2.0)
    ledger.see_row(8, 3.1)
    assert ledger.doubts == 1


def test_notes_are_read_back() -> None:
    assert decode_change(encode_change(300, Change(None, b"abc")).data) == (300, Change(None, b"abc"))
    assert decode_change(encode_change(1, Change(0, b"")).data) == (1, Change(0, b""))
    assert decode_stored(encode_stored({"ä": 3, "b": 400}, range(300, 312)).data) == (
        {"ä": 3, "b": 400},
        range(300, 312),
    )

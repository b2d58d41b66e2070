"""Presence: who may speak for whom, and what is told."""

from __future__ import annotations

import pytest

from editor.rooms.awareness import MOST_CLIENTS_PER_MEMBER, AwarenessBoard
from editor.rooms.member import Close, Member, Person
from editor.rooms.yjs_protocol import AwarenessEntry
from tests.unit.editor.people import nobody


def member(number: int = 1) -> Member:
    return Member(Person(number, f"Person {number}", "P"), can_write=True, wake=nobody)


def test_the_name_is_the_sessions_and_the_rest_the_clients() -> None:
    board, ada = AwarenessBoard(), member()
    board.take(ada, (AwarenessEntry(5, 1, {"cursor": [1, 2], "user": {"name": "Root", "admin": True}}),))
    (entry,) = board.everybody()
    assert entry.state == {
        "cursor": [1, 2],
        "user": {"id": 1, "name": "Person 1", "initials": "P", "color": "#c2410c"},
    }


def test_repeating_what_others_show_changes_nothing_and_costs_nothing() -> None:
    board, ada, bob = AwarenessBoard(), member(1), member(2)
    board.take(ada, (AwarenessEntry(5, 1, {}),))
    board.take_changes()
    echo = (AwarenessEntry(5, 9, {"cursor": [0, 0]}),)
    assert not board.speaks_for_itself(bob, echo)
    board.take(bob, echo)
    assert board.take_changes() == ([], [])


def test_a_client_of_another_process_cannot_be_taken_over() -> None:
    board, bob = AwarenessBoard(), member(2)
    board.hear("elsewhere", (AwarenessEntry(5, 1, {"user": {"name": "Ada"}}),))
    board.take(bob, (AwarenessEntry(5, 2, {}), AwarenessEntry(5, 3, None)))
    assert board.everybody() == [AwarenessEntry(5, 1, {"user": {"name": "Ada"}})]


def test_who_leaves_is_shown_to_have_left_and_then_forgotten() -> None:
    board, ada = AwarenessBoard(), member()
    board.take(ada, (AwarenessEntry(5, 4, {}),))
    board.take_changes()
    board.drop(ada)
    assert board.take_changes() == ([AwarenessEntry(5, 4, None)], [])
    assert board.everybody() == []
    board.take(member(2), (AwarenessEntry(5, 4, {"an echo": "of who has left"}),))
    assert board.everybody() == []
    board.take(ada, (AwarenessEntry(5, 5, {}),))
    assert len(board.everybody()) == 1


def test_an_older_word_does_not_replace_a_newer_one() -> None:
    board, ada = AwarenessBoard(), member()
    board.take(ada, (AwarenessEntry(5, 4, {"at": 4}), AwarenessEntry(5, 3, {"at": 3})))
    (entry,) = board.everybody()
    assert (entry.clock, entry.state and entry.state["at"]) == (4, 4)


def test_one_connection_cannot_bring_a_crowd() -> None:
    board, ada = AwarenessBoard(), member()
    with pytest.raises(Close) as refused:
        board.take(ada, tuple(AwarenessEntry(number, 1, {}) for number in range(MOST_CLIENTS_PER_MEMBER + 1)))
    assert refused.value.code == 4429
    assert len(board.everybody()) == MOST_CLIENTS_PER_MEMBER


def test_the_clients_of_a_process_that_went_are_taken_off() -> None:
    board = AwarenessBoard()
    board.hear("gone", (AwarenessEntry(5, 1, {}),))
    board.hear("here", (AwarenessEntry(6, 1, {}),))
    board.forget_process("gone")
    board.take_changes()
    assert [entry.client for entry in board.everybody()] == [6]

"""What the mirror missed, or hears late, is not measured."""

from __future__ import annotations

from execution.mirror.attention import FROZEN_S, SETTLING_S, Attention


def test_who_comes_round_in_time_has_missed_nothing() -> None:
    attention = Attention()
    assert all(attention.turn(100 + 0.5 * turn, is_new_line=False) for turn in range(20))
    assert attention.hears(105)


def test_who_was_frozen_gives_up_what_was_under_way_and_listens_a_little_later() -> None:
    attention = Attention()
    assert attention.turn(100, is_new_line=False)
    assert not attention.turn(100 + FROZEN_S, is_new_line=False)
    assert not attention.hears(100 + FROZEN_S + 0.9 * SETTLING_S)
    assert attention.turn(100 + FROZEN_S + 0.5, is_new_line=False)
    assert attention.hears(100 + FROZEN_S + SETTLING_S)


def test_a_new_line_brings_what_was_kept_first() -> None:
    attention = Attention()
    assert not attention.turn(100, is_new_line=True)
    assert not attention.hears(101)
    assert attention.turn(101, is_new_line=False)
    assert attention.hears(100 + SETTLING_S)

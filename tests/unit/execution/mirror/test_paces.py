"""Paces: a slowdown is found within ten measurements, and chance alone raises nothing."""

from __future__ import annotations

from random import Random

import pytest

from execution.mirror.paces import find_change, pace_of


def spread(chance: Random, count: int, around: float = 1.0) -> list[float]:
    """Return paces as a machine has them whose times vary by a tenth."""
    return [around * (1 + 0.1 * (2 * chance.random() - 1)) for _ in range(count)]


@pytest.mark.parametrize("known", [20, 25, 60, 150, 300])
def test_a_slowdown_of_a_fifth_is_found_within_ten(known: int) -> None:
    needed = []
    for seed in range(50):
        chance = Random(f"{known}:{seed}")
        paces = spread(chance, known)
        for count in range(1, 11):
            paces += spread(chance, 1, 1.2)
            change = find_change(paces)
            if change is not None:
                assert 10 <= change.percent <= 32
                needed.append(count)
                break
    assert len(needed) == 50
    assert max(needed) <= 10


def test_what_varies_as_always_is_no_change() -> None:
    found = 0
    for seed in range(300):
        chance = Random(f"calm:{seed}")
        paces = spread(chance, 20)
        for _ in range(100):
            paces += spread(chance, 1)
            found += find_change(paces) is not None
    assert found == 0


def test_a_device_that_became_faster_is_told_as_well() -> None:
    chance = Random("faster")
    change = find_change([*spread(chance, 40), *spread(chance, 10, 0.7)])
    assert change is not None
    assert change.percent == pytest.approx(-30, abs=5)


def test_a_sure_but_small_change_is_not_worth_a_word() -> None:
    assert find_change([1.0] * 40 + [1.05] * 10) is None


def test_what_was_always_slow_is_usual() -> None:
    pace = pace_of([1.4] * 40)
    assert (pace.usual, pace.low, pace.high, pace.change) == (1.4, 1.4, 1.4, None)


def test_the_band_leaves_the_ends_out_once_there_are_enough() -> None:
    pace = pace_of([1.0] * 150 + [9.0] + [1.0] * 49)
    assert pace.high < 2


def test_a_change_that_has_lasted_is_usual_again() -> None:
    chance = Random("new normal")
    before, after = spread(chance, 60), spread(chance, 60, 1.3)
    assert find_change([*before, *after[:10]]) is not None
    assert find_change([*before, *after]) is None

"""What many seeds tell."""

import pytest

from execution.trials.odds import find_odds, percentile, wilson


@pytest.mark.parametrize(
    ("hits", "tries", "low", "high"),
    [
        (0, 100, 0.0, 0.0370),
        (4, 100, 0.0157, 0.0984),
        (11, 100, 0.0625, 0.1863),
        (10, 10, 0.7225, 1.0),
        (0, 0, 0.0, 1.0),
    ],
)
def test_the_interval_of_a_share_is_wilsons(hits, tries, low, high):
    assert wilson(hits, tries) == pytest.approx((low, high), abs=5e-5)


def test_percentiles_are_values_that_came():
    assert [percentile([4, 1, 3, 2], share) for share in (0.25, 0.5, 0.95)] == [1, 2, 4]
    assert percentile([], 0.5) is None


def test_durations_are_those_that_went_well():
    odds = find_odds([10.0, 30.0, 20.0], 1)
    assert (odds.seeds, odds.failed, odds.share, odds.p50_s, odds.p95_s) == (4, 1, 0.25, 20.0, 30.0)
    assert find_odds([], 2).p50_s is None

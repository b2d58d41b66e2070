"""What measurements of one device's method say: how it usually is, how widely it varies, and whether it has changed.

A pace is what the device took divided by what its copy took: 1.2 is a fifth longer. Pure.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt
from statistics import median, quantiles

USUAL_OF = 30
"""The usual pace is the median of so many, the newest ones."""
RECENT = 10
LEAST_BEFORE = 20
"""What is recent is compared with at least so many before it."""
SURE = 3.9
"""Standard deviations; by chance a single look is as far off once in 10,000 times."""
LEAST_CHANGE = 0.1
"""A change of less than this part is not worth anybody's attention, however sure it is."""
KEPT = 300


@dataclass(frozen=True, slots=True)
class Change:
    """A pace that has changed; both are medians."""

    before: float
    now: float

    @property
    def percent(self) -> int:
        """How much longer it takes now, in percent; negative where it is faster."""
        return round(100 * (self.now / self.before - 1))


@dataclass(frozen=True, slots=True)
class Pace:
    """How one method of one device is: `low` to `high` is the band from the 1st to the 99th percentile."""

    count: int
    usual: float
    low: float
    high: float
    change: Change | None


def pace_of(paces: Sequence[float]) -> Pace:
    """Return what paces (all over 0, the oldest first, at least one) say."""
    low, high = _band(paces)
    return Pace(len(paces), median(paces[-USUAL_OF:]), low, high, find_change(paces))


def find_change(paces: Sequence[float]) -> Change | None:
    """Tell whether the newest ten paces are others than those before, by the rank test of Mann and Whitney.

    It asks nothing of how paces are spread, and one odd value moves it by one rank.
    """
    before, recent = paces[:-RECENT], paces[-RECENT:]
    if len(before) < LEAST_BEFORE:
        return None
    change = Change(median(before[-USUAL_OF:]), median(recent))
    if abs(change.now / change.before - 1) < LEAST_CHANGE:
        return None
    return change if abs(_deviation(before, recent)) >= SURE else None


def _deviation(before: Sequence[float], recent: Sequence[float]) -> float:
    """Return by how many standard deviations the rank sum of `recent` is off what chance would give it."""
    wins = sum((new > old) + 0.5 * (new == old) for new in recent for old in before)
    many, few = len(before), len(recent)
    return (wins - many * few / 2) / sqrt(many * few * (many + few + 1) / 12)


def _band(paces: Sequence[float]) -> tuple[float, float]:
    """Return the 1st and the 99th percentile; of fewer than a hundred, the least and the greatest."""
    if len(paces) < 100:
        return min(paces), max(paces)
    cuts = quantiles(paces, n=100, method="inclusive")
    return cuts[0], cuts[-1]

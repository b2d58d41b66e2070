"""What many seeds tell: usual durations, and the odds of failing with an interval; pure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, sqrt

Z_95 = 1.959963984540054
"""The standard normal deviate of a 95 % interval."""


@dataclass(frozen=True, slots=True)
class Odds:
    """Of so many seeds: how many failed, the 95 % interval of that share, and durations (s); None: none went well.

    Durations are those of the rehearsals in which all held that was expected.
    """

    seeds: int
    failed: int
    low: float
    high: float
    p50_s: float | None
    p95_s: float | None

    @property
    def share(self) -> float:
        """The share that failed."""
        return self.failed / self.seeds


def find_odds(durations_s: Sequence[float], failed: int) -> Odds:
    """Return what is known from the durations of those that went well, and how many did not."""
    seeds = len(durations_s) + failed
    low, high = wilson(failed, seeds)
    return Odds(seeds, failed, low, high, percentile(durations_s, 0.5), percentile(durations_s, 0.95))


def wilson(hits: int, tries: int) -> tuple[float, float]:
    """Return Wilson's 95 % interval of a share."""
    if tries == 0:
        return 0.0, 1.0
    share, weight = hits / tries, Z_95 * Z_95 / tries
    middle = (share + weight / 2) / (1 + weight)
    half = Z_95 / (1 + weight) * sqrt(share * (1 - share) / tries + weight / (4 * tries))
    return max(0.0, middle - half) if hits else 0.0, min(1.0, middle + half) if hits < tries else 1.0


def percentile(values: Sequence[float], share: float) -> float | None:
    """Return the least of the values that so large a share is not above (nearest rank); None of none."""
    return sorted(values)[max(0, ceil(share * len(values)) - 1)] if values else None

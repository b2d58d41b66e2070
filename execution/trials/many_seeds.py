"""A test carried out with many seeds: the odds of failing, and how far apart times and figures lie; as JSON."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from typing import Any, Final

from execution.trials.odds import find_odds, percentile
from execution.trials.trial_run import Outcome

MOST_NAMED: Final = 5


@dataclass(slots=True)
class ManySeeds:
    """What came of so many seeds as were carried out; `asked` is how many should have been."""

    asked: int
    durations_s: list[float] = field(default_factory=list)
    """Of those in which all held."""
    failed: list[int] = field(default_factory=list)
    figures: list[list[float]] = field(default_factory=list)
    """What each expectation has measured."""

    def take(self, seed: int, outcome: Outcome) -> None:
        """Take in what came of a seed."""
        if outcome.ok:
            self.durations_s.append(outcome.duration_s)
        else:
            self.failed.append(seed)
        self.figures = self.figures or [[] for _ in outcome.verdicts]
        for known, verdict in zip(self.figures, outcome.verdicts, strict=True):
            if verdict.figure is not None:
                known.append(verdict.figure)

    def to_json(self) -> dict[str, Any]:
        """Return the odds with their 95 % interval, the first seeds that failed, and the spans of times and figures."""
        odds = find_odds(self.durations_s, len(self.failed))
        return {
            "asked": self.asked,
            **{name: value for name, value in asdict(odds).items() if name in {"seeds", "failed", "low", "high"}},
            "failing": self.failed[:MOST_NAMED],
            "took_s": _span(self.durations_s),
            "figures": [_span(known) for known in self.figures],
        }


def _span(values: Sequence[float]) -> dict[str, float | None] | None:
    """Return the least, the median, the 95th percentile and the most of values; None of none."""
    if not values:
        return None
    p50, p95 = percentile(values, 0.5), percentile(values, 0.95)
    return {"least": min(values), "median": p50, "p95": p95, "most": max(values)}

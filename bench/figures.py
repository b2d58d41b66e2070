"""How figures are taken: repeated, with the machine said beside them."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Sequence


def figure(what: str, value: float, unit: str, **more: object) -> dict[str, object]:
    """Return a figure as it is printed; `cores` are those that this process may use."""
    return {"what": what, "figure": float(f"{value:.4g}"), "unit": unit, **more, "cores": len(os.sched_getaffinity(0))}


def best_ms(work: Callable[[], object], repeats: int = 5, clock: Callable[[], float] = time.perf_counter) -> float:
    """Return the time of the quickest of several repeats, which the rest of the machine disturbs least."""
    times = []
    for _ in range(repeats):
        began = clock()
        work()
        times.append(clock() - began)
    return min(times) * 1000


def best_cpu_ms(work: Callable[[], object], repeats: int = 5) -> float:
    """Return the time that this process was at work itself, on one core, in the quickest of several repeats."""
    return best_ms(work, repeats, time.process_time)


def share(values: Sequence[float], quantile: float) -> float:
    """Return the value below which that share of the values lies; 0 without values."""
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(quantile * len(ordered)))] if ordered else 0.0

"""The faults of one simulated device: which wait, which have begun, and when they are over; pure."""

from __future__ import annotations

from collections.abc import Iterable
from math import inf

from simulation.world import Fault, FaultKind

SPENT_BY_USE: frozenset[FaultKind] = frozenset({"fail_next", "lose_ack", "doubled", "drops"})
"""Faults that are over once they have done harm; the others last, for a time or for good."""


class Troubles:
    """Time, steps that are reached and commands that come let faults begin."""

    def __init__(self, faults: Iterable[Fault]) -> None:
        self._waiting = sorted(faults, key=lambda f: f.at_s)
        self._commands = 0
        self._active: list[tuple[Fault, float]] = []

    @property
    def wait_for_time(self) -> bool:
        """True while time alone lets a fault begin or end."""
        return any(_by_time(f) for f in self._waiting) or any(until < inf for _, until in self._active)

    def pass_time(self, t_s: float) -> tuple[list[Fault], list[Fault]]:
        """Return the faults that have begun until now, and those that are over."""
        if not self._waiting and not self._active:
            return [], []
        begun = [f for f in self._waiting if _by_time(f) and f.at_s <= t_s]
        self._waiting = [f for f in self._waiting if f not in begun]
        over = [f for f, until in self._active if until <= t_s]
        self._active = [(f, until) for f, until in self._active if until > t_s]
        self._active += [(f, f.at_s + f.for_s) for f in begun]
        return begun, over

    def reach(self, t_s: float, step: str, count: int) -> list[Fault]:
        """Return the faults that begin with this step, which is entered for the so-manieth time."""
        begun = [f for f in self._waiting if f.step == step and f.nth == count]
        self._waiting = [f for f in self._waiting if f not in begun]
        self._active += [(f, t_s + f.for_s) for f in begun]
        return begun

    def draw(self, t_s: float, chance: float | None) -> list[Fault]:
        """Return the faults that begin by chance with a command; without `chance` they begin evenly."""
        self._commands += 1
        begun = [f for f in self._waiting if f.odds > 0 and self._strikes(f.odds, chance)]
        self._active += [(f, t_s + f.for_s) for f in begun]
        return begun

    @property
    def hang_on_chance(self) -> bool:
        """True when a command may let a fault begin."""
        return any(f.odds > 0 for f in self._waiting)

    def has(self, *kinds: FaultKind) -> bool:
        """Tell whether a fault of one of these kinds is under way."""
        return any(f.kind in kinds for f, _ in self._active)

    def find(self, kind: FaultKind, name: str = "") -> Fault | None:
        """Return the fault of a kind that began last, of this property if one is named."""
        fits = (f for f, _ in reversed(self._active) if f.kind == kind and (not name or f.name == name))
        return next(fits, None)

    def spend(self, kind: FaultKind) -> Fault | None:
        """Return a fault of a kind and let it be over."""
        found = next((item for item in self._active if item[0].kind == kind), None)
        if found is None:
            return None
        self._active.remove(found)
        return found[0]

    def _strikes(self, odds: float, chance: float | None) -> bool:
        if chance is not None:
            return chance < odds
        return int(self._commands * odds + 1e-9) > int((self._commands - 1) * odds + 1e-9)


def _by_time(fault: Fault) -> bool:
    return not fault.step and not fault.odds

"""Slots for what costs much: so many in this process in all, so many at a site, so many of a person.

Several web processes have so many each: what they guard is the memory and the processors of one process.
"""

from __future__ import annotations

import threading
import time
from collections import Counter, deque
from collections.abc import Hashable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TypeVar


@dataclass(frozen=True, slots=True)
class Claim:
    """Who wants a slot, and at which site (empty: at none)."""

    person: int
    site: str = ""


Name = TypeVar("Name", bound=Hashable)


class Slots:
    """Slots that are taken and given back. Whoever waits comes in turn, past those whose own site or person is full.

    So a site or a person that takes all that it may never keeps others from theirs for longer than one of theirs lasts.
    """

    def __init__(self, *, in_all: int, of_site: int, of_person: int, most_waiting: int = 0) -> None:
        """`most_waiting` is how many of a person may wait at once."""
        self._in_all, self._of_site, self._of_person = in_all, of_site, of_person
        self._most_waiting = most_waiting
        self._sites: Counter[str] = Counter()
        self._people: Counter[int] = Counter()
        self._waiting: deque[tuple[object, Claim]] = deque()
        self._changed = threading.Condition()

    @property
    def taken(self) -> int:
        """How many slots are taken."""
        return self._people.total()

    def take(self, claim: Claim, *, patience_s: float = 0.0) -> bool:
        """Take a slot, waiting for it so long at most; False when there is none. Without patience it never blocks."""
        with self._changed:
            if not patience_s or self._waits(claim.person) >= self._most_waiting:
                return self._first_that_fits() is None and self._enter(claim)
            me, until = object(), time.monotonic() + patience_s
            self._waiting.append((me, claim))
            try:
                self._changed.wait_for(lambda: self._first_that_fits() is me, until - time.monotonic())
                return self._first_that_fits() is me and self._enter(claim)
            finally:
                self._waiting.remove((me, claim))
                self._changed.notify_all()

    @contextmanager
    def held(self, claim: Claim, refusal: Exception, *, patience_s: float = 0.0) -> Iterator[None]:
        """Hold a slot while something is done, waiting for it so long at most; raises `refusal` when there is none."""
        if not self.take(claim, patience_s=patience_s):
            raise refusal
        try:
            yield
        finally:
            self.give_back(claim)

    def give_back(self, claim: Claim) -> None:
        """Give a slot back that was taken."""
        with self._changed:
            _count_down(self._sites, claim.site)
            _count_down(self._people, claim.person)
            self._changed.notify_all()

    def _waits(self, person: int) -> int:
        return sum(1 for _, claim in self._waiting if claim.person == person)

    def _first_that_fits(self) -> object | None:
        return next((who for who, claim in self._waiting if self._fits(claim)), None)

    def _fits(self, claim: Claim) -> bool:
        return (
            self.taken < self._in_all
            and self._sites[claim.site] < self._of_site
            and self._people[claim.person] < self._of_person
        )

    def _enter(self, claim: Claim) -> bool:
        if not self._fits(claim):
            return False
        self._sites[claim.site] += 1
        self._people[claim.person] += 1
        return True


def _count_down(counter: Counter[Name], name: Name) -> None:
    counter[name] -= 1
    if not counter[name]:
        del counter[name]

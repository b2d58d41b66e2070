"""In which order rehearsals that wait are taken: sites in turn, and of a site its people in turn; pure."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from uuid import UUID

Whose = tuple[int, int | None]
"""A site and a person."""
NEVER = datetime.min.replace(tzinfo=UTC)


@dataclass(frozen=True, slots=True)
class Entry:
    """A rehearsal that waits or is under way: whose it is, and since when it waits. No `person`: nobody known."""

    id: UUID
    site: int
    person: int | None
    since: datetime
    is_running: bool


def order_fairly(entries: Iterable[Entry], begun_at: Mapping[Whose, datetime]) -> tuple[UUID, ...]:
    """Return those that wait in the order in which they are taken; `begun_at` is when somebody's last one was begun.

    The n-th of a person waits behind the first n - 1 of everybody else at the site, and the n-th of a site behind the
    first n - 1 of every other site; what is under way counts. Among equals comes who was served longest ago, then who
    has waited longest.
    """
    entries = sorted(entries, key=lambda entry: (entry.since, entry.id))
    running = [entry for entry in entries if entry.is_running]
    waiting = [entry for entry in entries if not entry.is_running]
    served: dict[Hashable, datetime] = {}
    for (site, person), at in begun_at.items():
        served[site, person] = at
        served[site] = max(at, served.get(site, NEVER))
    of_site = _take_turns(waiting, running, lambda entry: (entry.site, entry.person), served)
    return tuple(entry.id for entry in _take_turns(of_site, running, lambda entry: entry.site, served))


def _take_turns(
    waiting: list[Entry], running: list[Entry], whose: Callable[[Entry], Hashable], served: Mapping[Hashable, datetime]
) -> list[Entry]:
    """Return those that wait in rounds, in each of which everybody has one; their own order stays."""
    counts = Counter(map(whose, running))
    keyed = []
    for place, entry in enumerate(waiting):
        keyed.append((counts[whose(entry)], served.get(whose(entry), NEVER), place, entry))
        counts[whose(entry)] += 1
    return [entry for *_, entry in sorted(keyed, key=lambda key: key[:3])]

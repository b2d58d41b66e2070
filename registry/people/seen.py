"""When a member's pages last showed a site: noted to the minute, by one statement for all whose minute is over."""

from __future__ import annotations

import time
from collections import defaultdict
from collections.abc import Collection

from django.utils import timezone

from registry.models import Membership

EVERY_S = 60.0


class Seen:
    """Knows of whom it was noted when; of one event loop."""

    def __init__(self) -> None:
        self._noted_at: dict[tuple[int, str], float] = {}

    def take_due(self, looking: Collection[tuple[int, str]]) -> frozenset[tuple[int, str]]:
        """Return those of who looks (person, site) that are to be noted again, as noted now.

        All are noted together once a minute, and each when they begin to look.
        """
        now = time.monotonic()
        old = [pair for pair, at in self._noted_at.items() if now - at >= EVERY_S]
        if old:
            self._noted_at = {}
        due = frozenset(pair for pair in looking if pair not in self._noted_at)
        self._noted_at.update(dict.fromkeys(due, now))
        return due


def note_seen(seen: Collection[tuple[int, str]]) -> None:
    """Keep that pages of these people show these sites (person, slug) now."""
    people: defaultdict[str, list[int]] = defaultdict(list)
    for person, site in seen:
        people[site].append(person)
    for site, ids in people.items():
        Membership.objects.filter(site__slug=site, user_id__in=ids).update(seen_at=timezone.now())

"""Who asked for what, and what is kept for those who will ask."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

MOST_LEVELS = 200
MOST_FILTERS = 500
MOST_FILTERS_OF_READER = 100
ASKS_PER_S, ASKS_AT_ONCE = 2.0, 200.0
"""How often a program that looks on may ask: each time all that is kept is gone through."""
MOST_KEPT = 64
MOST_KEPT_IN_ALL = 20_000
MOST_KEPT_BYTES = 2**26
Holder = tuple[Any, int]


@dataclass(slots=True)
class _Node:
    below: dict[str, _Node] = field(default_factory=dict)
    holders: list[Holder] | None = None


class Subscriptions(dict[str, list[Holder]]):
    """Topic filters with the sessions that hold them; may change while somebody walks through them.

    A tree of the filters' levels finds the holders for a topic without looking at every filter.
    """

    def __init__(self) -> None:
        super().__init__()
        self._root = _Node()

    def __setitem__(self, topic_filter: str, holders: list[Holder]) -> None:
        super().__setitem__(topic_filter, holders)
        node = self._root
        for level in topic_filter.split("/"):
            node = node.below.setdefault(level, _Node())
        node.holders = holders

    def __delitem__(self, topic_filter: str) -> None:
        super().__delitem__(topic_filter)
        path, levels = [self._root], topic_filter.split("/")
        for level in levels:
            path.append(path[-1].below[level])
        path[-1].holders = None
        for parent, level in zip(reversed(path[:-1]), reversed(levels), strict=True):
            if parent.below[level].below or parent.below[level].holders is not None:
                return
            del parent.below[level]

    def __iter__(self) -> Iterator[str]:
        return iter(list(super().keys()))

    def items(self) -> Any:
        """Return a copy: amqtt awaits in the middle of its loops."""
        return [(topic_filter, list(holders)) for topic_filter, holders in super().items()]

    def find(self, topic: str) -> list[Holder]:
        """Return who asked for a topic, once for each filter that fits."""
        nodes, found = [self._root], list[Holder]()
        levels = topic.split("/")
        for depth, level in enumerate(levels):
            wild = depth > 0 or not level.startswith("$")
            for node in nodes:
                if wild and "#" in node.below:
                    found += node.below["#"].holders or []
            names = (level, "+") if wild else (level,)
            nodes = [node.below[name] for node in nodes for name in names if name in node.below]
        for node in nodes:
            found += node.holders or []
            if "#" in node.below:
                found += node.below["#"].holders or []
        return found


class KeptTopics:
    """How many retained messages each user has, and how large all of them are."""

    def __init__(self) -> None:
        self._owners: dict[str, tuple[str, int]] = {}
        self._counts: dict[str, int] = {}
        self._size = 0

    def add(self, user: str, topic: str, size: int, *, most: int) -> bool:
        """Enter a retained message in place of the one before on its topic; False when it is one too many."""
        owner, before = self._owners.get(topic, ("", 0))
        mine = self._counts.get(user, 0) + (owner != user)
        in_all = len(self._owners) + (topic not in self._owners)
        if mine > most or in_all > MOST_KEPT_IN_ALL or self._size - before + size > MOST_KEPT_BYTES:
            return False
        self.remove(topic)
        self._owners[topic] = (user, size)
        self._counts[user] = self._counts.get(user, 0) + 1
        self._size += size
        return True

    def remove(self, topic: str) -> None:
        """Forget a topic; harmless when nothing is kept on it."""
        user, size = self._owners.pop(topic, ("", 0))
        if user:
            self._size -= size
            self._counts[user] -= 1
            if not self._counts[user]:
                del self._counts[user]

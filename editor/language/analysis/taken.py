"""The domain of robots that are taken: which roles surely, and which perhaps, have a robot; before, it is nowhere."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

from editor.language.analysis.domain import PairwiseDomain, Place, Transfer
from editor.language.analysis.effects import Effects
from editor.language.tree import nodes as n

Taken = tuple[frozenset[str], frozenset[str]]
"""The roles that have a robot on every path to here, and those that have one on some."""


@dataclass(frozen=True, slots=True)
class Takers(PairwiseDomain[Taken]):
    """The domain of robots that are taken; `roles` are those of which that matters."""

    roles: frozenset[str]

    def begin(self) -> Taken:
        """Return that no role has a robot yet."""
        return frozenset(), frozenset()

    def somewhere(self) -> Taken:
        """Return that every role is taken to have one: an event begins whenever, and a function where it is called."""
        return self.roles, self.roles

    def either(self, first: Taken, second: Taken) -> Taken:
        """Return what holds after one path or the other."""
        return first[0] & second[0], first[1] | second[1]

    def disturb(self, place: Place, known: Taken, effects: Effects) -> Taken:
        """Return that these roles may have got a robot; who has one keeps it, if it is not released."""
        return known[0] - effects.released, known[1] | (effects.used & self.roles)

    def join(self, place: Place, before: Taken, ends: Sequence[tuple[Taken, Effects]]) -> Taken:
        """Return the roles of all branches, but for those that one of them has released."""
        sure = before[0].union(*(taken[0] for taken, _ in ends))
        sure = sure.difference(*(effects.released - taken[0] for taken, effects in ends))
        return sure, before[1].union(*(taken[1] for taken, _ in ends))

    def _take(self, place: Place, node: n.Move | n.Pick | n.Drop | n.Cover | n.Perform, known: Taken) -> Taken:
        return (known[0] | {node.role}, known[1] | {node.role}) if node.role in self.roles else known

    def _release(self, place: Place, node: n.Release, known: Taken) -> Taken:
        if node.role not in known[1]:
            place.report(node, "releases_nothing", "role", {"role": node.role})
        return known[0] - {node.role}, known[1] - {node.role}

    transfers: ClassVar[Mapping[type[n.Node], Transfer]] = {**dict.fromkeys(n.ACTS, _take), n.Release: _release}

    def tell(self, place: Place, known: Taken, node: n.Node, asked: Mapping[str, str]) -> None:
        """Tell of a step that asks where a robot is which no step before it has taken."""
        for role, field in asked.items():
            if role not in known[1]:
                place.report(node, "no_robot_yet", field, {"role": role})
            elif role not in known[0] and not isinstance(node, n.WaitUntil):  # a wait goes on until there is one
                place.report(node, "perhaps_no_robot_yet", field, {"role": role})

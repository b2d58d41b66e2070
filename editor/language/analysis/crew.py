"""The domain of the crew: which roles surely have a robot already; each keeps its own until it is released."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import ClassVar

from editor.language.analysis.domain import PairwiseDomain, Place, Transfer
from editor.language.analysis.effects import Effects
from editor.language.messages.phrases import Options
from editor.language.tree import nodes as n

Held = frozenset[str]
Robots = Mapping[tuple[str, str], Sequence[str]]


@dataclass(slots=True)
class Crew(PairwiseDomain[Held]):
    """The domain of the crew; `robots` gives what tells a role's robot apart, and the ids of those that can be it."""

    robots: Callable[[str], tuple[tuple[str, str], Sequence[str]]]
    released: frozenset[str] = frozenset()
    """The roles that events may release at any time; none of them surely has a robot."""
    _enough: dict[Held, bool] = field(default_factory=dict)

    def begin(self) -> Held:
        """Return that no role has a robot yet."""
        return frozenset()

    def somewhere(self) -> Held:
        """Return that no role surely has one."""
        return frozenset()

    def either(self, first: Held, second: Held) -> Held:
        """Return the roles that have one on both paths."""
        return first & second

    def disturb(self, place: Place, known: Held, effects: Effects) -> Held:
        """Return who has a robot that is not released: who has one keeps it, whatever else happens."""
        return known - effects.released

    def beside(self, place: Place, known: Held, ends: Sequence[Held], effects: Effects) -> Held:
        """Return the roles of the branches before, too: all of them need their robots at the same time."""
        return (ends[-1] if ends else known) - effects.released

    def interrupted(self, place: Place, known: Held, effects: Effects, passed: Held) -> Held:
        """Return the roles that had a robot before, or got one in a branch that surely ended."""
        return known - (effects.used - passed) - effects.released

    def join(self, place: Place, before: Held, ends: Sequence[tuple[Held, Effects]]) -> Held:
        """Return the roles of all branches, but for those that one of them has released."""
        whole = before.union(*(held for held, _ in ends))
        return whole.difference(*(effects.released - held for held, effects in ends))

    def _take(self, place: Place, node: n.Move | n.Pick | n.Drop | n.Cover | n.Perform, known: Held) -> Held:
        if node.role in known or node.role in self.released:
            return known
        together = known | {node.role}
        if together not in self._enough:
            self._enough[together] = self._has_robots_for(together)
        if self._enough[together]:
            return together
        count = len({robot for role in together for robot in self.robots(role)[1]})
        names = Options(tuple(sorted(together)), "and")
        place.report(node, "too_few_robots", n.robot_field(node), {"roles": names, "count": count})
        return known

    def _release(self, place: Place, node: n.Release, known: Held) -> Held:
        return known - {node.role}

    transfers: ClassVar[Mapping[type[n.Node], Transfer]] = {**dict.fromkeys(n.ACTS, _take), n.Release: _release}

    def _has_robots_for(self, roles: Held) -> bool:
        """Tell whether each of these roles can have a robot of its own; one without any robot is told elsewhere."""
        wants = dict(self.robots(role) for role in sorted(roles))
        given: dict[str, tuple[str, str]] = {}

        def find(role: tuple[str, str], seen: set[str]) -> bool:
            for robot in wants[role]:
                if robot not in seen:
                    seen.add(robot)
                    if robot not in given or find(given[robot], seen):
                        given[robot] = role
                        return True
            return False

        return all(find(role, set()) for role, robots in wants.items() if robots)

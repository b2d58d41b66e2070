"""What can be followed along the paths of a program: a domain says how its knowledge begins, changes and meets.

Knowledge is a value that its domain alone understands. A domain is asked for what each step makes of it (`transfers`)
and for what holds where paths divide and meet; the order of steps is the interpreter's business alone.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import reduce
from typing import Any, ClassVar, Generic, Protocol, TypeVar

from editor.language.analysis.effects import Effects, EffectTable
from editor.language.expressions.nodes import Expression
from editor.language.expressions.ranges import Known, Range
from editor.language.messages.diagnostics import Fix, TextArguments
from editor.language.tree import nodes as n
from editor.language.tree.program import Function, Tree

States = list[Any]
"""What each domain knows at one point. Where no path leads there are no states (None)."""


@dataclass(slots=True)
class Frame:
    """One call of a function, or a body of the program, with the loops around and how these are left."""

    name: str
    function: Function | None = None
    loops: tuple[n.ForEach, ...] = ()
    breaks: list[list[States]] = field(default_factory=list)
    continues: list[list[States]] = field(default_factory=list)
    """For each loop around, what is known at the steps that go on with its next round."""
    returns: list[States] = field(default_factory=list)

    def exits(self) -> tuple[list[States], ...]:
        """Return what is known at the steps that lead out of what stands around, to be added to and changed."""
        return (*self.breaks[-1:], *self.continues[-1:], self.returns)


class Place(Protocol):
    """Where a walk stands: what a domain may ask there, and tell."""

    tree: Tree
    effects: EffectTable
    frame: Frame
    states: States
    """What is known at the step that is being looked at."""
    volatile: Mapping[str, Known]
    """Variables that something beside the path may set at any time, with what is known of them then."""
    put: dict[str, Known] | None
    """The variables of the program that were set, with all that they were set to, where that is wanted."""
    instead: dict[int, n.Block]
    """What a domain that rewrites the tree puts in the place of steps, by their identity."""

    def report(
        self, node: n.Node, code: str, field_name: str, args: TextArguments | None = None, fix: Fix | None = None
    ) -> None:
        """Note a problem with a field of a node's step, once."""


K = TypeVar("K")
"""What a domain knows at one point of a program."""
Transfer = Callable[[Any, Place, Any, Any], Any]
"""Returns what is known after a step, from the domain, the place, the step and what is known before it."""


class Domain(ABC, Generic[K]):
    """One domain: what it must say, and what it need not where knowledge is never changed in place."""

    transfers: ClassVar[Mapping[type[n.Node], Transfer]] = {}

    @abstractmethod
    def begin(self) -> K:
        """Return what is known where the program begins."""

    @abstractmethod
    def somewhere(self) -> K:
        """Return what is known where nobody knows what came before: in an event, or in a function called anyhow."""

    def in_event(self) -> K:
        """Return what is known where an event begins, whenever that is."""
        return self.somewhere()

    @abstractmethod
    def meet(self, place: Place, before: K, ends: Sequence[K], effects: Effects) -> K:
        """Return what holds where paths meet that began at `before` and may have changed so much."""

    @abstractmethod
    def widen(self, place: Place, entry: K, after: K, effects: Effects) -> K:
        """Return what holds at the beginning of every round, given what one round makes of it."""

    @abstractmethod
    def disturb(self, place: Place, known: K, effects: Effects) -> K:
        """Return what is still known when any of this may have happened, also in part."""

    @abstractmethod
    def join(self, place: Place, before: K, ends: Sequence[tuple[K, Effects]]) -> K:
        """Return what holds after a Parallel, given the end of each branch with what that branch may change."""

    def passing(self, passed: K, known: K) -> K:
        """Return what holds anywhere in branches that may be called off, given what holds so far and behind a step."""
        return passed

    def interrupted(self, place: Place, known: K, effects: Effects, passed: K) -> K:
        """Return what is still known when branches with these effects were called off anywhere, or have ended."""
        return self.disturb(place, known, effects)

    def copy(self, known: K) -> K:
        """Return what is known for a path that begins here; what is known here stays as it is."""
        return known

    def beside(self, place: Place, known: K, ends: Sequence[K], effects: Effects) -> K:
        """Return what is known in a branch of a Parallel, given the ends of those before it and what others may do."""
        return self.disturb(place, known, effects)

    def key(self, place: Place, known: K, node: n.Call, function: Function) -> object:
        """Return all of what is known that a function depends on which is called here, to be compared."""
        return known

    def enter(self, place: Place, known: K, node: n.Call, function: Function) -> K:
        """Return what is known where a function begins that is called here."""
        return known

    def leave(self, place: Place, known: K, after: K, function: Function) -> K:
        """Return what is known after a call, given what is known where the function comes back."""
        return after

    def enter_round(
        self, place: Place, known: K, node: n.ForEach, items: Sequence[Expression], rounds: Range
    ) -> K:  # fmt: skip
        """Return what is known in one of these rounds, in which the loop's variable is one of these items."""
        return known

    def end(self, place: Place, node: n.Node | None, known: K) -> None:
        """Look at what is known where the program ends; `node` is its End, if there is one."""
        return


class PairwiseDomain(Domain[K]):
    """A domain that is known by what holds after one path or another: paths meet two by two, rounds as paths do."""

    @abstractmethod
    def either(self, first: K, second: K) -> K:
        """Return what holds after one path or the other."""

    def meet(self, place: Place, before: K, ends: Sequence[K], effects: Effects) -> K:
        """Return what holds on each of the paths."""
        return reduce(self.either, ends)

    def widen(self, place: Place, entry: K, after: K, effects: Effects) -> K:
        """Return what holds before a round and after it; right where that cannot go on for ever."""
        return self.either(entry, after)

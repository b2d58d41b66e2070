"""The walk of the abstract interpreter: what is known where it stands, and what it found on its way."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from operator import is_
from typing import Any, Protocol

from editor.language.analysis.domain import Domain, Frame, PairwiseDomain, Place, States, Transfer
from editor.language.analysis.effects import NOTHING, Effects, EffectTable, together
from editor.language.analysis.memo import Memo
from editor.language.expressions.nodes import Constant
from editor.language.expressions.ranges import Known
from editor.language.expressions.values import MOST_ITEMS, is_number
from editor.language.messages.diagnostics import Fix, Problem, TextArguments
from editor.language.tree import nodes as n
from editor.language.tree.program import Function, Tree

_DECIDING = (n.If, n.While)
MOST_STEPS_AGAIN = 5000
"""Steps that are followed in one loop or call of the program, with all that stands in it."""
MOST_FOR_EACH_STEP = 20
"""Steps that are followed in all, for each step that the program has."""


class Values(Protocol):
    """What decides where paths go: the domain of variables, which is the first where there is one."""

    def truth(self, place: Place, known: Any, node: n.If | n.While) -> bool | None:
        """Tell whether a step's condition holds here; None where that depends on the run."""

    def count(self, place: Place, known: Any, node: n.Repeat) -> tuple[int, int | None]:
        """Return how often a counted loop goes round, at least and at most."""

    def length(self, place: Place, known: Any, node: n.ForEach) -> tuple[int, int]:
        """Return how many items a loop goes through, at least and at most."""

    def assume(self, place: Place, known: Any, node: n.If | n.While, *, holds: bool) -> Any:
        """Return what is known of the variables where a step's condition holds, or does not."""


@dataclass(frozen=True, slots=True)
class _Found:
    """What was found in a step that holds others."""

    after: States | None
    steps: int
    """How many steps were followed."""
    visited: set[int]
    falls_off: set[str]
    endless: set[int]
    broken: set[int]
    found: dict[tuple[str, int, str], Problem]


@dataclass(frozen=True, slots=True)
class _Rewritten:
    """What stands in the place of a step that holds others, if it is something else, and what was found in it."""

    after: States | None
    instead: n.Block | None
    found: dict[tuple[str, int, str], Problem]


@dataclass(slots=True)
class _Unsure:
    """Within, nobody knows whether the path is taken. (Entered at every branch, so it is made once.)"""

    walk: Walk

    def __enter__(self) -> None:
        self.walk.undecided += 1

    def __exit__(self, *_: object) -> None:
        self.walk.undecided -= 1


@dataclass(slots=True)
class _Again:
    """Within, steps are followed more than once; how often is bounded for all of it."""

    walk: Walk
    _nested: int = 0
    _left_in_all: int = 0

    def __enter__(self) -> None:
        if not self._nested:
            self.walk.left = min(MOST_STEPS_AGAIN, self._left_in_all)
        self._nested += 1

    def __exit__(self, *_: object) -> None:
        self._nested -= 1
        if not self._nested:
            self._left_in_all -= MOST_STEPS_AGAIN - max(self.walk.left, 0)


@dataclass(slots=True)
class Walk:
    """One walk over one tree; what it found stands in `found`, `visited` and the sets after them."""

    tree: Tree
    domains: Sequence[Domain[Any]]
    effects: EffectTable
    follow: Mapping[type[n.Node], Callable[[Walk, Any, States], States | None]]
    """What is to be done at the steps that decide which step comes next."""
    values: Values | None = None
    look: Callable[[Walk, n.Node], None] | None = None
    """Is told each step of `readers` when the walk comes to it."""
    readers: frozenset[int] = frozenset()
    """The steps that read variables, by identity."""
    summaries: Mapping[str, bool] | None = None
    """Function → whether it ever comes back, where functions shall not be followed."""
    memo: Memo | None = None
    """What was found at the last look."""
    rewrites: bool = False
    """Whether a domain puts something else in the place of steps, which must be right whenever they are come to: each
    is followed just once then, also where no path leads, and neither conditions nor rounds are decided.
    """
    instead: dict[int, n.Block] = field(default_factory=dict)
    """What stands in the place of a step, by its identity, where that is something else."""
    states: States = field(default_factory=list)
    """What is known at the step that is being looked at."""
    frame: Frame = field(default_factory=lambda: Frame(""))
    volatile: Mapping[str, Known] = field(default_factory=dict)
    """Variables that something beside the path may set at any time, with what is known of them then."""
    put: dict[str, Known] | None = None
    """The variables of the program that were set, with all that they were set to, where that is wanted."""
    found: dict[tuple[str, int, str], Problem] = field(default_factory=dict)
    visited: set[int] = field(default_factory=set)
    falls_off: set[str] = field(default_factory=set)
    """Functions whose end is reached."""
    endless: set[int] = field(default_factory=set)
    """Loops and calls that are begun and never left, and Parallels of which too few branches end, by identity."""
    broken: set[int] = field(default_factory=set)
    """Loops that a step in them may leave."""
    functions: dict[str, Function] = field(init=False)
    contexts: dict[object, tuple[States | None, bool, list[str]]] = field(default_factory=dict)
    """Calls that were followed → what holds after them, whether the program may end in them, and how they may fail."""
    running: dict[object, object] = field(default_factory=dict)
    """Calls that are being followed → what could have led elsewhere until they began."""
    known_calls: dict[str, int] = field(default_factory=dict)
    opened: set[str] = field(default_factory=set)
    """Functions that were not followed somewhere with what is known there."""
    silent: bool = False
    first: bool = False
    """Whether only the first round of an uncounted loop is followed here."""
    finals: int = 0
    limited: int = 0
    """Time limits around the step, which end whatever never ends by itself."""
    undecided: int = 0
    """Branches around the step of which nobody knows whether they are taken."""
    passed: States | None = None
    """What holds anywhere in the branches around the step that may be called off."""
    raced: int = 0
    """Parallels around the step that may call it off."""
    returned: int = 0
    ended: int = 0
    """How often the program's end was come to."""
    failures: list[str] = field(default_factory=list)
    """The kinds of failures that the text itself brings about, and that no Try has caught since."""
    left: int = MOST_STEPS_AGAIN
    unsure: _Unsure = field(init=False)
    again: _Again = field(init=False)
    _copying: list[tuple[int, Domain[Any]]] = field(init=False)
    """The domains whose knowledge is changed in place, and where it is."""
    _meets_by_effects: bool = field(init=False)
    _transfers: dict[type[n.Node], list[tuple[int, Domain[Any], Transfer]]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.functions = {function.method: function for function in self.tree.functions}
        for index, domain in enumerate(self.domains):
            for kind, transfer in domain.transfers.items():
                self._transfers.setdefault(kind, []).append((index, domain, transfer))
        self._copying = [pair for pair in enumerate(self.domains) if type(pair[1]).copy is not Domain.copy]
        self._meets_by_effects = not all(isinstance(domain, PairwiseDomain) for domain in self.domains)
        self.unsure, self.again = _Unsure(self), _Again(self)
        if self.rewrites:
            return
        blocks = (self.tree.body, *(f.body for f in self.tree.functions), *(e.body for e in self.tree.events))
        steps = sum(len(self.tree.walked(block)) for block in blocks)
        self.again = _Again(self, _left_in_all=20_000 + MOST_FOR_EACH_STEP * steps)

    def report(
        self, node: n.Node, code: str, field_name: str, args: TextArguments | None = None, fix: Fix | None = None
    ) -> None:
        """Note a problem with a field of a node's step, once."""
        if not self.silent:
            self.found.setdefault((code, id(node), field_name), Problem(code, node.step, field_name, args or {}, fix))

    def block(self, block: n.Block, states: States) -> States | None:
        """Return what is known after a block, None where its end is never reached; `states` is used up."""
        telling, readers = not (self.silent or self.rewrites), self.readers
        memo = self.memo if telling and self.frame.function is None else None
        leads_on = True
        for node in block:
            if telling:
                self.visited.add(id(node))
            self.left -= 1
            if id(node) in readers:
                self.read(node, states)
            follow = self.follow.get(node.__class__)
            if follow is None:
                if node.__class__ in self._transfers:
                    self.transfer(node, states)
                continue
            if self.rewrites and node.__class__ in n.COMPOSITES:
                after = self._rewrite(node, states)
            elif memo is None or node.__class__ not in n.COMPOSITES:
                after = follow(self, node, states)
            else:
                after = self._remembered(memo, node, states)
            if after is None:
                if not self.rewrites:
                    return None
                leads_on, after = False, self.somewhere()
            states = after
        return states if leads_on else None

    def _remembered(self, memo: Memo, node: n.Node, states: States) -> States | None:
        """Follow a step that holds others; what depends on nothing but what is known before it is remembered."""
        known: _Found | None = memo.get(node, (self.limited > 0, self.first, states))
        if known is None or known.steps > self.left:
            known = self._found_in(memo, node, states)
        else:
            self.left -= known.steps
        self.visited |= known.visited
        self.falls_off |= known.falls_off
        self.endless |= known.endless
        self.broken |= known.broken
        for key, problem in known.found.items():
            self.found.setdefault(key, problem)
        return None if known.after is None else self.copy(known.after)

    def _found_in(self, memo: Memo, node: n.Node, states: States) -> _Found:
        given, left, exits = self.copy(states), self.left, self._exits()
        outside = self.visited, self.falls_off, self.endless, self.broken, self.found
        self.visited, self.falls_off, self.endless, self.broken, self.found = set(), set(), set(), set(), {}
        after = self.follow[node.__class__](self, node, states)
        kept = None if after is None else self.copy(after)
        inside = self.visited, self.falls_off, self.endless, self.broken, self.found
        known = _Found(kept, left - self.left, *inside)
        self.visited, self.falls_off, self.endless, self.broken, self.found = outside
        if exits == self._exits() and not self.effects.of_node(node).calls and not self.finals:
            memo.put(node, known, (self.limited > 0, self.first, given))
        return known

    def rewritten(self, block: n.Block) -> n.Block:
        """Return a block with what stands in the place of its steps; the same where that is nothing else."""
        instead, nodes = self.instead, list[n.Node]()
        for node in block if instead else ():
            other = instead.get(id(node))
            if other is None:
                nodes.append(node)
            else:
                nodes += other
        return block if not instead or all(map(is_, nodes, block)) else tuple(nodes)

    def _rewrite(self, node: n.Node, states: States) -> States | None:
        """Follow a step that holds others, and put it in its own place with what stands in theirs."""
        known: _Rewritten | None = None if self.memo is None else self.memo.get(node, states)
        if known is None:
            memo, outside = self.memo, self.found
            given, exits = (self.copy(states), self._exits()) if memo is not None else (states, None)
            self.found = {}
            after = self.follow[node.__class__](self, node, states)
            before = n.blocks_of(node)
            blocks = tuple(map(self.rewritten, before))
            other = None if all(map(is_, before, blocks)) else (n.with_blocks(node, blocks),)
            known, self.found = _Rewritten(after, other, self.found), outside
            if memo is not None and exits == self._exits() and not self.effects.of_node(node).calls:
                memo.put(node, known, given)
        if known.found:
            self.found.update(known.found)
        if known.instead is not None:
            self.instead[id(node)] = known.instead
        return None if known.after is None else self.copy(known.after)

    def _exits(self) -> tuple[tuple[int, ...], int, int]:
        return tuple(map(len, self.frame.exits())), self.ended, len(self.failures)

    def read(self, node: n.Node, states: States) -> None:
        """Have a look at a step that reads variables."""
        if self.look is not None and not self.silent and id(node) in self.readers:
            self.states = states
            self.look(self, node)

    def ways_out(self) -> object:
        """Return what tells, compared with later, whether every path has led from there to here."""
        return self.undecided, self.returned, self.ended, len(self.failures)

    def transfer(self, node: n.Node, states: States) -> None:
        """Let every domain say what it knows after a step."""
        for index, domain, transfer in self._transfers.get(node.__class__, ()):
            self.states = states
            states[index] = transfer(domain, self, node, states[index])
            if self.passed is not None:
                self.passed[index] = domain.passing(self.passed[index], states[index])

    def end(self, node: n.End | None, states: States) -> None:
        """Have a look at what is known where the program ends."""
        self.ended += 1
        for domain, known in zip(self.domains, states, strict=True):
            self.states = states
            domain.end(self, node, known)

    # what is known where paths divide and meet

    def begin(self) -> States:
        """Return what is known where the program begins."""
        return [domain.begin() for domain in self.domains]

    def somewhere(self) -> States:
        """Return what is known where nobody knows what came before."""
        return [domain.somewhere() for domain in self.domains]

    def in_event(self) -> States:
        """Return what is known where an event begins, whenever that is."""
        return [domain.in_event() for domain in self.domains]

    def copy(self, states: States) -> States:
        """Return what is known for another path."""
        copied = states.copy()
        for index, domain in self._copying:
            copied[index] = domain.copy(states[index])
        return copied

    def meet(self, before: States, ends: Sequence[States | None], *blocks: n.Block) -> States | None:
        """Return what holds where paths through these blocks meet; one that leads nowhere has no say."""
        alive = [end for end in ends if end is not None]
        if not alive:
            return None
        effects = self.changes(*blocks) if self._meets_by_effects else NOTHING
        return [
            domain.meet(self, before[index], [end[index] for end in alive], effects)
            for index, domain in enumerate(self.domains)
        ]

    def widen(self, entry: States, after: States, effects: Effects) -> States:
        """Return what holds at the beginning of every round, given what one round makes of it."""
        rows = zip(self.domains, entry, after, strict=True)
        return [domain.widen(self, known, later, effects) for domain, known, later in rows]

    def disturb(self, states: States, effects: Effects) -> States:
        """Return what is still known when any of this may have happened."""
        return [domain.disturb(self, known, effects) for domain, known in zip(self.domains, states, strict=True)]

    def changes(self, *blocks: n.Block) -> Effects:
        """Return what any of these blocks may change."""
        return together(self.effects.of(block) for block in blocks)

    def truth(self, node: n.If | n.While, states: States) -> bool | None:
        """Tell whether a step's condition holds here, None where that depends on the run."""
        if self.rewrites:
            return None
        if isinstance(node.condition, Constant):
            return node.condition.value if isinstance(node.condition.value, bool) else None
        return None if self.values is None else self.values.truth(self, states[0], node)

    def count(self, node: n.Repeat, states: States) -> tuple[int, int | None]:
        """Return how often a counted loop goes round, at least and at most."""
        times = node.times.value if isinstance(node.times, Constant) and not self.rewrites else None
        if is_number(times):
            return (max(0, int(times)),) * 2
        return (0, None) if self.values is None else self.values.count(self, states[0], node)

    def length(self, node: n.ForEach, states: States) -> tuple[int, int]:
        """Return how many items a loop goes through, at least and at most."""
        if self.values is not None:
            return self.values.length(self, states[0], node)
        return (len(node.items),) * 2 if node.over is None and not self.rewrites else (0, MOST_ITEMS)

    def assume(self, states: States, node: n.Node, *, holds: bool) -> States:
        """Return what is known where a step's condition holds, or does not; `states` is used up."""
        if self.values is not None and isinstance(node, _DECIDING) and not isinstance(node.condition, Constant):
            states[0] = self.values.assume(self, states[0], node, holds=holds)
        return states

    @contextmanager
    def silently(self, *, silent: bool = True) -> Iterator[None]:
        """Within, nothing is told."""
        before, self.silent = self.silent, self.silent or silent
        yield
        self.silent = before

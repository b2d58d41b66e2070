"""A whole program as a tree: its bodies of steps, its functions, roles and parameters."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping
from dataclasses import field, replace
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

from editor.language.expressions.nodes import Expression, Zone
from editor.language.tree.nodes import Block, Event, Node, walk
from vipo_device.protocol.description import Scalar

if TYPE_CHECKING:
    from dataclasses import dataclass
else:
    from editor.language.allocation import dataclass

D = TypeVar("D")
K = TypeVar("K", bound=Node)


@dataclass(frozen=True, slots=True)
class Parameter:
    """A parameter of a function or of the program, under its name in the script; an empty type is not known."""

    name: str
    default: Scalar = None
    type: str = ""
    unit: str = ""
    given: Scalar = None
    """What the run gives the program that is looked at; None: whatever people may choose."""


@dataclass(frozen=True, slots=True)
class Function:
    """A function: `method` is its name in the script, `id` and `name` those in the document."""

    method: str
    parameters: tuple[Parameter, ...] = ()
    body: Block = ()
    result_type: str = ""
    """Empty: it gives nothing back."""
    result_unit: str = ""
    id: str = field(default="", compare=False)
    name: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class Role:
    """A robot of the program, under its name in the script: one device, or any that can do all of `can`.

    `at` is the device where it stands at the beginning, when the program relies on that. Of any robot `where` must
    hold when it is chosen, a condition on the readings of `tree.choice.ITSELF`.
    """

    name: str
    device: str | None = None
    can: tuple[str, ...] = ()
    at: str | None = None
    id: str = field(default="", compare=False)
    where: Expression | None = None
    holds: int = field(default=0, compare=False)
    """How many objects any robot must be able to hold at once; 0: one will do."""
    looks_elsewhere: bool = field(default=False, compare=False)
    """Its condition spoke of something else than the robot itself, and is left out."""


@dataclass(frozen=True, slots=True)
class Tree:
    """A whole program."""

    body: Block = ()
    functions: tuple[Function, ...] = ()
    roles: tuple[Role, ...] = ()
    parameters: tuple[Parameter, ...] = ()
    events: tuple[Event, ...] = ()
    zones: tuple[Zone, ...] = ()
    """By id."""
    named_zones: frozenset[str] = field(default=frozenset(), compare=False)
    """The ids of zones of which a script says no more: they stay as they are drawn."""
    _walked: dict[int, list[Node]] = field(default_factory=dict, init=False, repr=False, compare=False)
    _derived: dict[object, Any] = field(default_factory=dict, init=False, repr=False, compare=False)
    _by_kind: defaultdict[type[Node], list[Node]] = field(
        default_factory=partial(defaultdict, list), init=False, repr=False, compare=False
    )

    def walked(self, block: Block) -> list[Node]:
        """Return the nodes of one of the tree's own blocks as `walk` does; they are gathered once."""
        nodes = self._walked.get(id(block))
        if nodes is None:
            nodes = self._walked[id(block)] = walk(block)
        return nodes

    def derived(self, make: Callable[[Tree], D]) -> D:
        """Return what a function makes of the tree; it is called once for each tree."""
        if make not in self._derived:
            self._derived[make] = make(self)
        found: D = self._derived[make]
        return found

    def of_kind(self, kind: type[K]) -> list[K]:
        """Return the steps of one kind in the whole program, in reading order within each body; gathered once."""
        kinds: Mapping[Any, list[Any]] = self._kinds()
        return kinds.get(kind, [])

    def holds(self, *kinds: type[Node]) -> bool:
        """Tell whether any step of the program is of one of these kinds."""
        return not self._kinds().keys().isdisjoint(kinds)

    def roles_of(self, *kinds: type[Node]) -> set[str]:
        """Return the roles that the steps of some kinds name, each of them one of `OF_ROBOTS`."""
        by_kind: Mapping[Any, list[Any]] = self._kinds()
        return {node.role for kind in kinds for node in by_kind.get(kind, ())}

    def in_order(self, functions: tuple[Function, ...], roles: tuple[Role, ...]) -> Tree:
        """Return the tree with its functions and roles in another order; its blocks need not be gathered again."""
        tree = replace(self, functions=functions, roles=roles)
        tree._walked.update(self._walked)
        return tree

    def _kinds(self) -> dict[type[Node], list[Node]]:
        by_kind = self._by_kind
        if not by_kind:
            for block in (self.body, *(f.body for f in self.functions), *(event.body for event in self.events)):
                for node in self.walked(block):
                    by_kind[node.__class__].append(node)
        return by_kind

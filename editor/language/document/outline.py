"""The document made whole: which steps there are and where each belongs, whatever people or merges have left.

The rules are the same for every reader of a document, so that all copies show the same program:
a step without a good place is a draft; where places run in a circle, the step with the smallest id of that
circle is the draft; brothers stand in the order of (order, id), both compared bytewise.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from string import ascii_lowercase
from typing import Final

from editor.language.constructs.table import COMMENT, STEPS
from editor.language.document.catches import catches_of

PROGRAM = "program"
EVENTS = "events"
BRANCHES: Mapping[str, tuple[str, ...]] = {
    construct.kind: tuple(name for name, _ in construct.branches) for construct in STEPS
}
"""The kinds of steps and their branches; a Parallel names its own, a Try has the catches that it says."""
DEEPEST_STEP = 30
MOST_BRANCHES = 26
LONGEST_ID = 64
"""A step whose id is longer, in characters, cannot be carried out: no line of a run has room for it."""

_LISTS: Final = (list, tuple)
Place = tuple[str, str, str]
Params = Mapping[str, object]


@dataclass(frozen=True, slots=True)
class Outline:
    """The steps that can be read: their kinds and parameters, and the ids in each (parent, branch) in order."""

    kinds: Mapping[str, str]
    params: Mapping[str, Params]
    children: Mapping[tuple[str, str], tuple[str, ...]]
    drafts: tuple[str, ...]
    """Steps that stand nowhere in the program, sorted; what stands below them is not listed."""
    too_deep: frozenset[str]
    unknown: tuple[str, ...]
    """Steps of kinds that this version does not know, sorted; they are drafts, too."""

    def branches(self, step: str) -> tuple[str, ...]:
        """Return the names of the branches that a step has."""
        return branches_of(self.kinds[step], self.params[step])

    def with_inner(self, roots: Iterable[str]) -> dict[str, int]:
        """Return these steps and all that stands in them, each with how deep it stands, in reading order."""
        depths: dict[str, int] = {}
        left = [(root, 0) for root in roots][::-1]
        while left:
            step, depth = left.pop()
            depths[step] = depth
            branches = self.branches(step) if step in self.kinds else ()
            inner = [child for branch in branches for child in self.children.get((step, branch), ())]
            left.extend((child, depth + 1) for child in reversed(inner))
        return depths


def mapping(value: object) -> Mapping[str, object]:
    """Return the value if it is an object, else an empty one."""
    return value if value.__class__ is dict or isinstance(value, Mapping) else {}


def branches_of(kind: str, params: Params) -> tuple[str, ...]:
    """Return the branches of a step of that kind with those parameters."""
    if kind == "parallel":
        return _parallel_branches(params.get("branches"))
    if kind == "try":
        return ("body", *catches_of(params), "finally")
    return BRANCHES[kind]


def _parallel_branches(value: object) -> tuple[str, ...]:
    named = value if isinstance(value, _LISTS) else ()
    names = dict.fromkeys(name for name in named if isinstance(name, str) and name in set(ascii_lowercase))
    return tuple(names)[:MOST_BRANCHES] or ("a", "b")


def make_outline(document: object) -> Outline:
    """Read what can be read of a document's steps; nothing is too broken for it."""
    whole = mapping(document)
    raw = {name: mapping(step) for name, step in mapping(whole.get("steps")).items() if name and name.__class__ is str}
    kinds = {name: str(step["kind"]) for name, step in raw.items() if kind_of(step) in BRANCHES}
    params = {name: mapping(raw[name].get("params")) for name in kinds}
    functions = frozenset(mapping(whole.get("functions")))
    places = {name: place_of(raw[name].get("place")) for name in kinds}
    sound = {name: place for name, place in places.items() if place and leads_on(name, place, kinds, params, functions)}
    for name in _circle_breakers(sound):
        del sound[name]
    children = _children(sound)
    deep = frozenset(_too_deep(children, functions))
    if deep:
        sound = {name: place for name, place in sound.items() if name not in deep}
        children = _children(sound)
    drafts = tuple(sorted(kinds.keys() - sound.keys()))
    unknown = tuple(sorted(name for name in raw.keys() - kinds.keys() if raw[name].get("kind") != COMMENT))
    return Outline(kinds, params, children, drafts, deep, unknown)


def kind_of(step: Mapping[str, object]) -> str:
    """Return the kind that a step says it is, empty for nonsense."""
    kind = step.get("kind")
    return kind if isinstance(kind, str) else ""


def place_of(value: object) -> Place | None:
    """Return parent, branch and order as a step has them; None for nonsense."""
    if not isinstance(value, _LISTS) or len(value) != 3:
        return None
    parent, branch, order = value
    if not (isinstance(parent, str) and isinstance(branch, str) and isinstance(order, str)):
        return None
    return parent, branch, order


def leads_on(
    name: str, place: Place, kinds: Mapping[str, str], params: Mapping[str, Params], functions: frozenset[str]
) -> bool:
    """Tell whether a step's place is one where a step of its kind can stand."""
    parent, branch, _ = place
    is_event = kinds[name] == "on_event"
    if parent in kinds:
        return not is_event and branch in branches_of(kinds[parent], params[parent])
    if is_event:
        return parent == PROGRAM and branch == EVENTS
    return branch == "body" and (parent == PROGRAM or parent in functions)


def _circle_breakers(places: Mapping[str, Place]) -> list[str]:
    """Return the step with the smallest id of each circle of parents."""
    visited: set[str] = set()
    breakers: list[str] = []
    for name, (parent, _, _) in places.items():
        if parent in visited or parent not in places:  # as it is where there are no circles
            visited.add(name)
            continue
        path: dict[str, None] = {}
        here = name
        while here in places and here not in visited and here not in path:
            path[here] = None
            here = places[here][0]
        if here in path:
            steps = list(path)
            breakers.append(min(steps[steps.index(here) :]))
        visited.update(path)
    return breakers


def _children(places: Mapping[str, Place]) -> dict[tuple[str, str], tuple[str, ...]]:
    found: dict[tuple[str, str], list[tuple[str, str]]] = {}
    for name, (parent, branch, order) in places.items():
        found.setdefault((parent, branch), []).append((order, name))
    return {key: tuple(name for _, name in sorted(members)) for key, members in found.items()}


def _too_deep(children: Mapping[tuple[str, str], Sequence[str]], functions: frozenset[str]) -> Iterator[str]:
    """Yield the steps at the first level that is too deep to be read."""
    by_parent: dict[str, list[str]] = {}
    for (parent, _), members in children.items():
        by_parent.setdefault(parent, []).extend(members)
    level = [name for root in (PROGRAM, *functions) for name in by_parent.get(root, ())]
    for _ in range(DEEPEST_STEP):
        level = [child for name in level for child in by_parent.get(name, ())]
    yield from level

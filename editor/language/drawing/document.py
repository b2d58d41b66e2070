"""Tree → document: a script becomes a drawing, in which what did not change keeps its id and its place."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from string import ascii_lowercase

from editor.language.analysis.positions import add_moves
from editor.language.document.catches import catches_of, with_known_branches
from editor.language.document.format_migrations import FORMAT, migrate
from editor.language.document.fractional_index import keep_orders
from editor.language.document.outline import PROGRAM, branches_of, make_outline, mapping
from editor.language.document.references import with_document_names
from editor.language.drawing.alignment import align
from editor.language.drawing.layout import FRAMES, GAP_M, Layout, Room, room_of
from editor.language.drawing.merge import (
    Functions,
    merge_functions,
    merge_parameters,
    merge_roles,
    merge_values,
    merge_zones,
    with_named_zones,
    without_unknown_names,
)
from editor.language.drawing.steps import Drawable, EncodedStep, StepEncoder, grouped
from editor.language.expressions import nodes as e
from editor.language.expressions.values import read_point
from editor.language.reading.document import read_document
from editor.language.site.surroundings import Surroundings, standing_places
from editor.language.tree import nodes as n
from editor.language.tree.program import Tree
from editor.language.tree.robots import with_roles_of_robots

VARIABLE_FIELDS = frozenset({"variable", "result", "index"})
"""Parameters that name a variable."""


@dataclass(frozen=True, slots=True)
class _Before:
    """The document before: its steps as they are, and what a script says of them."""

    raw: Mapping[str, Mapping[str, object]]
    said: Mapping[str, tuple[str, Mapping[str, object]]]
    """Kind and parameters of each step that takes part in the program."""

    def variables(self) -> dict[str, str]:
        """Return what the document calls the variables that a script speaks of."""
        names: dict[str, str] = {}
        for step, (_, said) in self.said.items():
            raw = mapping(self.raw[step].get("params"))
            for field_name in VARIABLE_FIELDS:
                name, written = raw.get(field_name), said.get(field_name)
                if isinstance(name, str) and isinstance(written, str):
                    names[written] = name
        return names


@dataclass(slots=True)
class _Builder:
    """The steps so far."""

    encoder: StepEncoder
    before: _Before
    layout: Layout
    functions: Functions
    names: Mapping[str, str]
    """What the document calls the parameters that can be seen here."""
    steps: dict[str, object] = field(default_factory=dict)
    count: int = 0

    def block(self, parent: str, branch: str, block: Sequence[Drawable], *, framed: bool = False) -> None:
        """Draw the steps of one branch; those in a frame stand below each other."""
        groups = [(nodes, self.encoder.draw(nodes)) for nodes in grouped(block)]
        ids = [self._id(nodes[-1].step, drawn[0]) for nodes, drawn in groups]
        orders = keep_orders([(step, self._order_before(step, parent, branch)) for step in ids])
        for step, order, (_, drawn) in zip(ids, orders, groups, strict=True):
            self._step(step, [parent, branch, order], drawn, framed=framed)

    def _id(self, wanted: str, kind: str) -> str:
        """Return the step's id: the one it had, unless it is taken or the step became one of another kind."""
        known = self.before.said.get(wanted)
        if not wanted or wanted in self.steps or (wanted in self.before.raw and (known is None or known[0] != kind)):
            self.count += 1
            while f"s{self.count}" in self.steps or f"s{self.count}" in self.before.raw:
                self.count += 1
            wanted = f"s{self.count}"
        self.steps[wanted] = {}
        return wanted

    def _order_before(self, step: str, parent: str, branch: str) -> str | None:
        place = self.before.raw.get(step, {}).get("place")
        same = isinstance(place, list | tuple) and len(place) == 3 and list(place[:2]) == [parent, branch]
        return str(place[2]) if same and isinstance(place, list | tuple) else None

    def _step(self, step: str, place: list[str], drawn: EncodedStep, *, framed: bool) -> None:
        kind, given, branches = drawn
        raw = self.before.raw.get(step)
        names = self.functions.names.get(self._method(given), {}) if kind == "call" else {}
        says = self._named(given, names)
        if raw is None:
            self.layout.follow(self._first_known(branches), Room(0.0, 0.0))
            pos = self.layout.put_below(kind, says) if framed else self.layout.put(kind, says, self._room(drawn))
            body: dict[str, object] = {"kind": kind, "place": place, "pos": pos}
            params = says
        else:
            self.layout.follow(read_point(raw.get("pos")), room_of(kind, says))
            body = {**raw, "place": place}
            said, held = self._named(self.before.said[step][1], names), mapping(raw.get("params"))
            if kind == "try":
                said, says = with_known_branches(said, held), with_known_branches(says, held)
                caught = zip(catches_of(says), branches[1:-1], strict=True)
                branches = (branches[0], *((name, inner) for name, (_, inner) in caught), branches[-1])
            params = merge_values(held, said, says)
        if kind == "parallel":
            letters = _letters(mapping(raw or {}).get("params"), len(branches))
            branches = tuple((letter, inner) for letter, (_, inner) in zip(letters, branches, strict=True))
            params = {**params, "branches": letters} if letters != _letters(params, None) else params
        self.steps[step] = {**body, "params": params}
        head = self.layout.last
        self._branches(step, kind, branches, framed=framed)
        if raw is None and not framed and kind in FRAMES:
            self.layout.keep_block(head, self._room(drawn))

    def _branches(self, step: str, kind: str, branches: tuple[tuple[str, n.Block], ...], *, framed: bool) -> None:
        head = self.layout.last
        for name, inner in branches:
            in_frame = framed or (kind in FRAMES and name == "body")
            if not in_frame:
                self.layout.enter(head, name)
            self.block(step, name, inner, framed=in_frame)

    def _room(self, drawn: EncodedStep) -> Room:
        """Return the room for a step with all that stands below it in its frame."""
        kind, params, branches = drawn
        own = room_of(kind, params)
        inner = [self._column(block) for name, block in branches if kind in FRAMES and name == "body"]
        return _stacked([own, *inner])

    def _column(self, block: n.Block) -> Room:
        """Return the room for steps and all their branches below each other."""
        rooms: list[Room] = []
        for nodes in grouped(block):
            kind, params, branches = self.encoder.draw(nodes)
            rooms += [room_of(kind, params), *(self._column(inner) for _, inner in branches)]
        return _stacked(rooms)

    def _method(self, given: Mapping[str, object]) -> str:
        wanted = given.get("function")
        return next((method for method, key in self.encoder.function_ids.items() if key == wanted), "")

    def _named(self, given: Mapping[str, object], arguments: Mapping[str, str]) -> dict[str, object]:
        named = {key: with_document_names(value, self.names) for key, value in given.items()}
        for key in VARIABLE_FIELDS & given.keys():
            named[key] = self.names.get(str(given[key]), given[key])
        if arguments and "args" in named:
            named["args"] = {arguments.get(key, key): value for key, value in mapping(named["args"]).items()}
        return named

    def _first_known(self, branches: tuple[tuple[str, n.Block], ...]) -> e.Point | None:
        """Return where the first step stands that was there before and now stands in a new one."""
        for _, block in branches:
            for node in block:
                point = read_point(self.before.raw.get(node.step, {}).get("pos"))
                if point is not None:
                    return point[0], point[1] + 2.4
        return None


def _stacked(rooms: Sequence[Room]) -> Room:
    """Return the room for some that stand below each other."""
    filled = [room for room in rooms if room.height_m > 0]
    height_m = sum(room.height_m for room in filled) + GAP_M * max(0, len(filled) - 1)
    return Room(max((room.width_m for room in filled), default=0.0), round(height_m, 2))


def _letters(params: object, count: int | None) -> list[str]:
    """Return the names of a Parallel's branches: those that it has, as many as are needed."""
    known = list(branches_of("parallel", mapping(params)))
    if count is None or len(known) == count:
        return known
    spare = [letter for letter in ascii_lowercase if letter not in known]
    return [*known, *spare][:count]


def tree_to_document(
    tree: Tree, surroundings: Surroundings, previous: Mapping[str, object] | None = None
) -> dict[str, object]:
    """Return the document of a tree; what the previous document has, too, stays there as it is.

    Steps that did not change, moved or changed a value keep their ids, positions and everything that no script
    says; drafts and comments stay. New steps stand near their devices.
    """
    old = mapping(migrate(previous or {})) if previous else {}
    tree = with_named_zones(tree, old)
    if not old:
        return _draw(tree, surroundings, {}, Tree())
    before = _read(old, surroundings)
    drawn = _draw(tree, surroundings, old, before)
    if _read(drawn, surroundings) == tree:
        return drawn
    return _draw(tree, surroundings, _without_unknown_names(old, before), before)


def _read(document: Mapping[str, object], surroundings: Surroundings) -> Tree:
    tree = with_roles_of_robots(read_document(document).tree, surroundings)
    return add_moves(tree, standing_places(surroundings))


def _without_unknown_names(old: Mapping[str, object], tree: Tree) -> dict[str, object]:
    """Return the document without values that name what did not exist: a name that is new now would give them sense."""
    before = _look_back(old, tree)
    steps: dict[str, object] = dict(before.raw)
    for name, (_, said) in before.said.items():
        raw = before.raw[name]
        steps[name] = {**raw, "params": without_unknown_names(mapping(raw.get("params")), said)}
    return {**old, "steps": steps}


def _draw(tree: Tree, surroundings: Surroundings, old: Mapping[str, object], tree_before: Tree) -> dict[str, object]:
    aligned = align(tree, tree_before) if old else tree
    functions = merge_functions(aligned, tree_before, mapping(old.get("functions")), set(mapping(old.get("steps"))))
    roles, role_ids = merge_roles(aligned, tree_before, mapping(old.get("roles")))
    parameters, names = merge_parameters(aligned, tree_before, mapping(old.get("parameters")))
    before = _look_back(old, tree_before)
    layout = Layout(surroundings)
    for step in before.raw.values():
        layout.occupy(read_point(step.get("pos")), room_of(str(step.get("kind")), mapping(step.get("params"))))
    names = {**before.variables(), **names}
    builder = _Builder(StepEncoder(role_ids, functions.ids), before, layout, functions, names)
    builder.block(PROGRAM, "body", aligned.body)
    builder.block(PROGRAM, "events", aligned.events)
    for function in aligned.functions:
        builder.names = {**names, **functions.names[function.method]}
        builder.block(functions.ids[function.method], "body", function.body)
    start = read_point(old.get("start_pos"))
    return {
        **old,
        "format": FORMAT,
        "start_pos": list(start) if start else layout.start(),
        "steps": _with_drafts(builder.steps, before, functions.document),
        "functions": functions.document,
        "roles": roles,
        "parameters": parameters,
        "zones": merge_zones(aligned.zones, mapping(old.get("zones"))),
    }


def _look_back(old: Mapping[str, object], tree: Tree) -> _Before:
    roles = {role.name: role.id for role in tree.roles}
    encoder = StepEncoder(roles, {function.method: function.id for function in tree.functions})
    said: dict[str, tuple[str, Mapping[str, object]]] = {}
    left: list[Sequence[Drawable]] = [tree.body, tree.events, *(function.body for function in tree.functions)]
    for block in left:
        for nodes in grouped(block):
            kind, params, branches = encoder.draw(nodes)
            said[nodes[-1].step] = (kind, params)
            left.extend(inner for _, inner in branches)
    steps = mapping(old.get("steps"))
    return _Before({str(name): mapping(step) for name, step in steps.items()}, said)


def _with_drafts(drawn: dict[str, object], before: _Before, functions: Mapping[str, object]) -> dict[str, object]:
    """Return the steps with those that were no part of the program, which they do not become by this."""
    kept = {name: dict(step) for name, step in before.raw.items() if name not in before.said}
    steps: dict[str, object] = {**kept, **drawn}
    outline = make_outline({"steps": steps, "functions": functions})
    roots = [child for (parent, _), inner in outline.children.items() for child in inner
             if parent == PROGRAM or parent in functions or parent in drawn]  # fmt: skip
    for name in roots:
        if name in kept:
            steps[name] = {**kept[name], "place": None}
    return steps

"""Tree → document: a script becomes a drawing; what did not change keeps its id and place, new steps stand near
their devices.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field

from editor.language import nodes as n
from editor.language.layout import Layout
from editor.language.names import snake_case
from editor.language.outline import PROGRAM, make_outline, mapping
from editor.language.surroundings import Surroundings
from editor.language.values import read_point, write_place, write_value

_DIGITS = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
_Drawn = tuple[str, dict[str, object], tuple[tuple[str, n.Block], ...]]
"""Kind, parameters and branches of one step."""


@dataclass(slots=True)
class _Drawer:
    """The document so far, and what the previous one offers."""

    tree: n.Tree
    layout: Layout
    taken: set[str]
    known: dict[str, list[tuple[str, Mapping[str, object]]]]
    """Kind and parameters → steps of the previous document that are just so, the first one last."""
    steps: dict[str, object] = field(default_factory=dict)
    function_ids: dict[str, str] = field(default_factory=dict)
    role_ids: dict[str, str] = field(default_factory=dict)
    count: int = 0

    def block(self, parent: str, branch: str, block: n.Block) -> None:
        """Draw the steps of one branch."""
        drawn = list(_grouped(block))
        width = 1 if len(drawn) < len(_DIGITS) else 3
        for index, nodes in enumerate(drawn):
            kind, params, branches = self._draw(nodes)
            step, pos = self._place(kind, params, nodes[-1].step)
            order = _order(index, width)
            self.steps[step] = {"kind": kind, "place": [parent, branch, order], "pos": pos, "params": params}
            for name, inner in branches:
                self.block(step, name, inner)

    def _draw(self, nodes: n.Block) -> _Drawn:
        loads = [node for node in nodes if isinstance(node, n.Pick | n.Drop)]
        if len(loads) == 2:
            return _pick_and_drop(self, nodes)
        if loads:
            return DRAWERS[type(loads[0])](self, loads[0])
        return DRAWERS[type(nodes[0])](self, nodes[0])

    def _place(self, kind: str, params: dict[str, object], wanted: str) -> tuple[str, list[float]]:
        """Return the step's id and position: those that it had, or new ones."""
        alike = self.known.get(_fingerprint(kind, params), [])
        same = next((item for item in alike if item[0] == wanted), alike[-1] if alike else None)
        if same is not None:
            alike.remove(same)
            point = read_point(same[1].get("pos"))
            return same[0], list(point) if point else self.layout.put(kind, params)
        if wanted and wanted not in self.steps and wanted not in self.taken:
            self.taken.add(wanted)
            return wanted, self.layout.put(kind, params)
        self.count += 1
        while f"s{self.count}" in self.taken:
            self.count += 1
        self.taken.add(f"s{self.count}")
        return f"s{self.count}", self.layout.put(kind, params)


def _order(index: int, width: int) -> str:
    digits = ""
    for _ in range(width):
        index, digit = divmod(index, len(_DIGITS))
        digits = _DIGITS[digit] + digits
    return f"{digits}V"


def _fingerprint(kind: str, params: Mapping[str, object]) -> str:
    return json.dumps([kind, params], sort_keys=True, default=str)


def _grouped(block: n.Block) -> Iterator[n.Block]:
    """Yield the nodes of each step: a move belongs to the pick or drop behind it, a pick to a drop of the same load."""
    index = 0
    while index < len(block):
        length = _length(block[index:])
        yield block[index : index + length]
        index += length


def _length(rest: n.Block) -> int:
    """Return how many nodes the first step has."""
    step = rest[0].step
    if step:
        return next((i for i, node in enumerate(rest) if node.step != step), len(rest))
    start = 1 if isinstance(rest[0], n.Move) and not rest[0].route and _leads_to(rest[0], rest[1:]) else 0
    if isinstance(rest[0], n.Move) and not start:
        return 1
    first, behind = rest[start], rest[start + 1 :]
    if (
        isinstance(first, n.Pick)
        and len(behind) > 1
        and isinstance(behind[0], n.Move)
        and _leads_to(behind[0], behind[1:])
    ):
        drop = behind[1]
        if isinstance(drop, n.Drop) and _load(first) == _load(drop):
            return start + 3
    return start + 1


def _leads_to(move: n.Move, rest: n.Block) -> bool:
    following = rest[0] if rest else None
    return isinstance(following, n.Pick | n.Drop) and (following.role, following.at) == (move.role, move.to)


def _load(node: n.Pick | n.Drop) -> tuple[object, ...]:
    return node.role, node.object, node.quantity


def _kept(**params: object) -> dict[str, object]:
    """Return the parameters that have a value."""
    return {name: value for name, value in params.items() if value not in (None, [], {})}


def _pick_and_drop(drawer: _Drawer, nodes: n.Block) -> _Drawn:
    pick, drop = (node for node in nodes if isinstance(node, n.Pick | n.Drop))
    moves = [node for node in nodes[nodes.index(pick) :] if isinstance(node, n.Move)]
    params = _kept(
        role=drawer.role_ids[pick.role],
        source=write_place(pick.at),
        target=write_place(drop.at),
        object=write_value(pick.object),
        quantity=write_value(pick.quantity),
        route=[list(point) for point in (moves[0].route if moves else drop.route)],
    )
    return "pick_and_drop", params, ()


def _move(drawer: _Drawer, node: n.Move) -> _Drawn:
    route = [list(point) for point in node.route]
    return "move", _kept(role=drawer.role_ids[node.role], to=write_place(node.to), route=route), ()


def _pick_or_drop(drawer: _Drawer, node: n.Pick | n.Drop) -> _Drawn:
    thing, quantity = write_value(node.object), write_value(node.quantity)
    params = _kept(role=drawer.role_ids[node.role], at=write_place(node.at), object=thing, quantity=quantity)
    return "pick" if isinstance(node, n.Pick) else "drop", params, ()


def _operate(drawer: _Drawer, node: n.Operate) -> _Drawn:
    arguments = {name: write_value(value) for name, value in node.arguments}
    return "operate", _kept(device=write_place(node.device), method=node.method or None, args=arguments), ()


def _wait(drawer: _Drawer, node: n.Wait) -> _Drawn:
    return "wait", _kept(seconds=write_value(node.seconds)), ()


def _wait_until(drawer: _Drawer, node: n.WaitUntil) -> _Drawn:
    until = write_value(node.condition)
    missing = {} if until is None else until
    return "wait", {"until": missing, **_kept(timeout_s=write_value(node.timeout_s))}, ()


def _if(drawer: _Drawer, node: n.If) -> _Drawn:
    return "if", _kept(condition=write_value(node.condition)), (("then", node.then), ("else", node.otherwise))


def _while(drawer: _Drawer, node: n.While) -> _Drawn:
    return "while", _kept(condition=write_value(node.condition)), (("body", node.body),)


def _parallel(drawer: _Drawer, node: n.Parallel) -> _Drawn:
    letters = [chr(97 + index) for index in range(len(node.branches))]
    return "parallel", {"branches": letters}, tuple(zip(letters, node.branches, strict=True))


def _try(drawer: _Drawer, node: n.Try) -> _Drawn:
    return "try", {"kinds": list(node.kinds)}, (("body", node.body), ("catch", node.catch))


def _call(drawer: _Drawer, node: n.Call) -> _Drawn:
    arguments = {name: write_value(value) for name, value in node.arguments}
    return "call", _kept(function=drawer.function_ids.get(node.function), args=arguments), ()


DRAWERS: Mapping[type[n.Node], Callable[..., _Drawn]] = {
    n.Move: _move,
    n.Pick: _pick_or_drop,
    n.Drop: _pick_or_drop,
    n.Operate: _operate,
    n.Wait: _wait,
    n.WaitUntil: _wait_until,
    n.If: _if,
    n.While: _while,
    n.Parallel: _parallel,
    n.Try: _try,
    n.Call: _call,
}


def tree_to_document(
    tree: n.Tree, surroundings: Surroundings, previous: Mapping[str, object] | None = None
) -> dict[str, object]:
    """Return the document of a tree; steps that the previous document has, too, keep their ids and places there."""
    old = mapping(previous)
    layout = Layout(surroundings)
    drawer = _Drawer(tree, layout, set(make_outline(old).kinds), _known_steps(old, layout))
    functions = _functions(tree, mapping(old.get("functions")), drawer)
    roles = _roles(tree, mapping(old.get("roles")), drawer)
    drawer.block(PROGRAM, "body", tree.body)
    for function in tree.functions:
        drawer.block(drawer.function_ids[function.method], "body", function.body)
    start = read_point(old.get("start_pos"))
    return {
        "format": 1,
        "start_pos": list(start) if start else layout.start(),
        "steps": drawer.steps,
        "functions": functions,
        "roles": roles,
        "parameters": {p.name: _parameter(p) for p in tree.parameters},
        "zones": dict(mapping(old.get("zones"))),
    }


def _known_steps(old: Mapping[str, object], layout: Layout) -> dict[str, list[tuple[str, Mapping[str, object]]]]:
    outline, steps = make_outline(old), mapping(old.get("steps"))
    known: dict[str, list[tuple[str, Mapping[str, object]]]] = {}
    for name in sorted(outline.kinds, reverse=True):
        step = mapping(steps.get(name))
        params = outline.params[name]
        known.setdefault(_fingerprint(outline.kinds[name], params), []).append((name, step))
        point = read_point(step.get("pos"))
        if point is not None:
            layout.occupy(point)
    return known


def _functions(tree: n.Tree, old: Mapping[str, object], drawer: _Drawer) -> dict[str, object]:
    by_method = {snake_case(str(mapping(item).get("name", key))): key for key, item in sorted(old.items())}
    functions: dict[str, object] = {}
    for function in tree.functions:
        key = function.id or by_method.get(function.method, function.method)
        while key in functions or key == PROGRAM or key in drawer.taken:
            key = f"{key}_"
        drawer.function_ids[function.method] = key
        before = mapping(old.get(key))
        given = {"name": function.name or function.method, "parameters": [_parameter(p) for p in function.parameters]}
        functions[key] = {**before, **given} if not before or function.id else {**given, **before}
    return functions


def _parameter(parameter: n.Parameter) -> dict[str, object]:
    kind = parameter.type or ("text" if isinstance(parameter.default, str) else "number")
    body: dict[str, object] = {"name": parameter.name, "type": kind, "unit": parameter.unit}
    return body if parameter.default is None else {**body, "default": parameter.default}


def _roles(tree: n.Tree, old: Mapping[str, object], drawer: _Drawer) -> dict[str, object]:
    by_name = {snake_case(str(mapping(item).get("name", key))): key for key, item in sorted(old.items())}
    roles: dict[str, object] = dict(old)
    for role in tree.roles:
        key = role.id or by_name.get(role.name, role.name)
        drawer.role_ids[role.name] = key
        binding = {"can": list(role.can)} if role.device is None else {"device": role.device}
        roles[key] = {"name": str(mapping(old.get(key)).get("name", role.name)), **binding}
    return roles

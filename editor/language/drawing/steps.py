"""Nodes of the tree → steps of the document; one small function for each kind of node."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from editor.language.document.outline import mapping
from editor.language.document.references import with_role_ids
from editor.language.expressions.declarations import answer_to_json
from editor.language.expressions.nodes import PlaceRef
from editor.language.expressions.values import write_argument, write_place, write_value
from editor.language.tree import nodes as n

EncodedStep = tuple[str, dict[str, object], tuple[tuple[str, n.Block], ...]]
"""Kind, parameters and branches of one step."""


@dataclass(frozen=True, slots=True)
class StepEncoder:
    """The ids of roles and functions by their names in a tree."""

    role_ids: Mapping[str, str]
    function_ids: Mapping[str, str]

    def draw(self, nodes: Sequence[Drawable]) -> EncodedStep:
        """Return the step that some nodes are."""
        loads = [node for node in nodes if isinstance(node, n.Pick | n.Drop)]
        if len(loads) == 2:
            return _pick_and_drop(self, tuple(node for node in nodes if not isinstance(node, n.Event)))
        node = loads[0] if loads else nodes[0]
        drawn = _event(self, node) if isinstance(node, n.Event) else ENCODERS[type(node)](self, node)
        return drawn[0], dict(mapping(with_role_ids(drawn[1], self.role_ids))), drawn[2]


def _present(**params: object) -> dict[str, object]:
    """Return the parameters that have a value."""
    return {name: value for name, value in params.items() if value not in (None, [], {})}


def _pick_and_drop(encoder: StepEncoder, nodes: n.Block) -> EncodedStep:
    pick, drop = (node for node in nodes if isinstance(node, n.Pick | n.Drop))
    moves = [node for node in nodes[nodes.index(pick) :] if isinstance(node, n.Move)]
    params = _present(
        role=encoder.role_ids[pick.role],
        source=write_place(pick.at),
        target=write_place(drop.at),
        object=write_value(pick.object),
        quantity=write_value(pick.quantity),
        route=[list(point) for point in (moves[0].route if moves else drop.route)],
    )
    return "pick_and_drop", params, ()


def _move(encoder: StepEncoder, node: n.Move) -> EncodedStep:
    route = [list(point) for point in node.route]
    return "move", _present(role=encoder.role_ids[node.role], to=write_place(node.to), route=route), ()


def _pick_or_drop(encoder: StepEncoder, node: n.Pick | n.Drop) -> EncodedStep:
    thing, quantity = write_value(node.object), write_value(node.quantity)
    params = _present(role=encoder.role_ids[node.role], at=write_place(node.at), object=thing, quantity=quantity)
    return "pick" if isinstance(node, n.Pick) else "drop", params, ()


def _operate(encoder: StepEncoder, node: n.Operate) -> EncodedStep:
    arguments = {name: write_value(value) for name, value in node.arguments}
    return "operate", _present(device=write_place(node.device), method=node.method or None, args=arguments), ()


def _wait(encoder: StepEncoder, node: n.Wait) -> EncodedStep:
    return "wait", _present(duration=write_value(node.seconds)), ()


def _wait_until(encoder: StepEncoder, node: n.WaitUntil) -> EncodedStep:
    until = write_value(node.condition)
    missing = {} if until is None else until
    return "wait", {"until": missing, **_present(timeout=write_value(node.timeout_s))}, ()


def _if(encoder: StepEncoder, node: n.If) -> EncodedStep:
    return "if", _present(condition=write_value(node.condition)), (("then", node.then), ("else", node.otherwise))


def _while(encoder: StepEncoder, node: n.While) -> EncodedStep:
    return "while", _present(condition=write_value(node.condition)), (("body", node.body),)


def _parallel(encoder: StepEncoder, node: n.Parallel) -> EncodedStep:
    letters = [chr(97 + index) for index in range(len(node.branches))]
    return "parallel", {"branches": letters}, tuple(zip(letters, node.branches, strict=True))


def _try(encoder: StepEncoder, node: n.Try) -> EncodedStep:
    branches = (("body", node.body), ("catch", node.catch), ("finally", node.final))
    if not node.catches:
        return "try", {"catch": False}, (branches[0], branches[2])
    return "try", {"kinds": list(node.kinds)}, branches


def _call(encoder: StepEncoder, node: n.Call) -> EncodedStep:
    arguments = {name: write_argument(value) for name, value in node.arguments}
    function, result = encoder.function_ids.get(node.function), node.result or None
    return "call", _present(function=function, args=arguments, result=result), ()


def _repeat(encoder: StepEncoder, node: n.Repeat) -> EncodedStep:
    return "repeat", _present(times=write_value(node.times)), (("body", node.body),)


def _for_each(encoder: StepEncoder, node: n.ForEach) -> EncodedStep:
    items = [write_value(item) for item in node.items]
    return "for_each", _present(variable=node.variable or None, items=items), (("body", node.body),)


def _set(encoder: StepEncoder, node: n.Set) -> EncodedStep:
    return "set", _present(variable=node.variable or None, value=write_value(node.value)), ()


def _ask(encoder: StepEncoder, node: n.Ask) -> EncodedStep:
    question, timeout = write_value(node.question), write_value(node.timeout_s)
    variable, answer = node.variable or None, answer_to_json(node.answer)
    return "ask", _present(question=question, answer=answer, variable=variable, timeout=timeout), ()


def _notify(encoder: StepEncoder, node: n.Notify) -> EncodedStep:
    return "notify", _present(message=write_value(node.message), level=node.level), ()


def _end(encoder: StepEncoder, node: n.End) -> EncodedStep:
    return "end", {}, ()


def _return(encoder: StepEncoder, node: n.Return) -> EncodedStep:
    return "return", _present(value=write_value(node.value)), ()


def _break(encoder: StepEncoder, node: n.Break) -> EncodedStep:
    return "break", {}, ()


def _event(encoder: StepEncoder, node: n.Event) -> EncodedStep:
    return "on_event", _present(condition=write_value(node.condition), starts=node.starts), (("body", node.body),)


ENCODERS: Mapping[type[n.Node], Callable[..., EncodedStep]] = {
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
    n.Repeat: _repeat,
    n.ForEach: _for_each,
    n.Set: _set,
    n.Ask: _ask,
    n.Notify: _notify,
    n.End: _end,
    n.Return: _return,
    n.Break: _break,
}


Drawable = n.Node | n.Event


def grouped(block: Sequence[Drawable]) -> Iterator[tuple[Drawable, ...]]:
    """Yield the nodes of each step; nodes that bear a step's id stand together as long as they make one step."""
    index = 0
    while index < len(block):
        length = _length_by_id(block[index:]) or natural_length(block[index:])
        yield tuple(block[index : index + length])
        index += length


def _length_by_id(rest: Sequence[Drawable]) -> int:
    """Return how many nodes have the first one's id; 0 when it has none, or when they are no step together."""
    step = rest[0].step
    if not step:
        return 0
    length = next((index for index, node in enumerate(rest) if node.step != step), len(rest))
    return length if length == 1 or natural_length(rest[:length]) == length else 0


def natural_length(rest: Sequence[Drawable]) -> int:
    """Return how many nodes the first step has, going by what they say."""
    start = 1 if isinstance(rest[0], n.Move) and not rest[0].route and _leads_to(rest[0], rest[1:]) else 0
    first, behind = rest[start], rest[start + 1 :]
    if not isinstance(first, n.Pick):
        return start + 1
    if behind and _unloads(first, behind[0], first.at):
        return start + 2
    if len(behind) > 1 and isinstance(behind[0], n.Move) and _leads_to(behind[0], behind[1:]):
        return start + (3 if _unloads(first, behind[1], behind[0].to) else 1)
    return start + 1


def _unloads(pick: n.Pick, drop: Drawable, at: PlaceRef) -> bool:
    if not isinstance(drop, n.Drop) or drop.at != at:
        return False
    return (drop.role, drop.object, drop.quantity) == (pick.role, pick.object, pick.quantity)


def _leads_to(move: n.Move, rest: Sequence[Drawable]) -> bool:
    following = rest[0] if rest else None
    return isinstance(following, n.Pick | n.Drop) and (following.role, following.at) == (move.role, move.to)

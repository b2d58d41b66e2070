"""Nodes of the tree → steps of the document, by the records of constructs."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from operator import attrgetter
from typing import Any, Final

from editor.language.constructs.record import Construct, FieldType, Form
from editor.language.constructs.table import FORMS
from editor.language.document.catches import branches_for, params_of_catches
from editor.language.document.outline import mapping
from editor.language.document.references import with_role_ids
from editor.language.expressions.declarations import answer_to_json
from editor.language.expressions.nodes import PlaceRef
from editor.language.expressions.values import write_argument, write_place, write_value
from editor.language.tree import nodes as n

_NOTHING: Final[tuple[object, ...]] = (None, [], {})
Drawable = n.Node | n.Event
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
            drawn = _pick_and_drop(self, tuple(node for node in nodes if not isinstance(node, n.Event)))
        else:
            node = loads[0] if loads else nodes[0]
            drawn = ENCODERS[type(node)](self, node)
        return drawn[0], dict(mapping(with_role_ids(drawn[1], self.role_ids))), drawn[2]


def _present(**params: object) -> dict[str, object]:
    """Return the parameters that have a value."""
    return {name: value for name, value in params.items() if value not in _NOTHING}


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


def _operate(encoder: StepEncoder, node: n.Operate) -> EncodedStep:
    arguments = {name: write_value(value) for name, value in node.arguments}
    return "operate", _present(device=write_place(node.device), method=node.method or None, args=arguments), ()


def _perform(encoder: StepEncoder, node: n.Perform) -> EncodedStep:
    arguments = {name: write_value(value) for name, value in node.arguments}
    device = {"role": encoder.role_ids[node.role]}
    return "operate", _present(device=device, method=node.method or None, args=arguments), ()


def _parallel(encoder: StepEncoder, node: n.Parallel) -> EncodedStep:
    letters = [chr(97 + index) for index in range(len(node.branches))]
    params = {"branches": letters, **_present(needed=node.needed)}
    return "parallel", params, tuple(zip(letters, node.branches, strict=True))


def _try(encoder: StepEncoder, node: n.Try) -> EncodedStep:
    names = branches_for((), len(node.handlers))
    caught = params_of_catches(dict(zip(names, node.kinds, strict=True)))
    branches = zip(names, node.catches, strict=True)
    return "try", caught, (("body", node.body), *branches, ("finally", node.final))


def _call(encoder: StepEncoder, node: n.Call) -> EncodedStep:
    arguments = {name: write_argument(value) for name, value in node.arguments}
    function, result = encoder.function_ids.get(node.function), node.result or None
    return "call", _present(function=function, args=arguments, result=result), ()


def _for_each(encoder: StepEncoder, node: n.ForEach) -> EncodedStep:
    items = [write_value(item) for item in node.items]
    names = {"variable": node.variable or None, "index": node.index or None}
    return "for_each", _present(**names, items=items, list=write_value(node.over)), (("body", node.body),)


Encode = Callable[[StepEncoder, Any], EncodedStep]

_WRITERS: Mapping[FieldType, Callable[[StepEncoder, Any], object]] = {
    "role": lambda encoder, role: encoder.role_ids[role],
    "place": lambda encoder, place: write_place(place),
    "value": lambda encoder, value: write_value(value),
    "variable": lambda encoder, name: name or None,
    "choice": lambda encoder, word: word,
    "route": lambda encoder, route: [list(point) for point in route],
    "zone": lambda encoder, zone: zone or None,
    "answer": lambda encoder, answer: answer_to_json(answer),
}
"""How each type of field is written."""
_OWN: Mapping[str, Encode] = {
    "Operate": _operate,
    "Perform": _perform,
    "Parallel": _parallel,
    "Try": _try,
    "Call": _call,
    "ForEach": _for_each,
}
"""The nodes whose steps have more than their fields say."""


def _encoder_of(construct: Construct, form: Form) -> Encode:
    """Return what draws a node: the parameters that have a value, and the branches; a form's mark is always there."""
    kind, mark = construct.kind, form.marked_by
    fields = tuple((field.name, attrgetter(field.attribute), _WRITERS[field.type]) for field in form.fields)
    branches = tuple((name, attrgetter(attribute)) for name, attribute in construct.branches)

    def encode(encoder: StepEncoder, node: Any) -> EncodedStep:
        given = {name: write(encoder, get(node)) for name, get, write in fields}
        params = {name: value for name, value in given.items() if value not in _NOTHING}
        if mark and mark not in params:
            params[mark] = {}
        return kind, params, tuple((name, get(node)) for name, get in branches)

    return encode


ENCODERS: Mapping[type[Drawable], Encode] = {
    n.NODES[name]: _OWN.get(name) or _encoder_of(*record) for name, record in FORMS.items()
}


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

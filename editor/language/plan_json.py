"""The plan as plain JSON and back; a run keeps it beside its state."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from editor.language import plan as p


class UnreadablePlan(ValueError):
    """The JSON is no plan of this format; the message says where it is wrong."""


def plan_to_json(plan: p.Plan) -> dict[str, Any]:
    """Return the plan as plain JSON."""
    return {
        "format": plan.format,
        "instructions": [_instruction_to_json(instruction) for instruction in plan.instructions],
        "roles": {name: {"device": r.device, "can": list(r.can)} for name, r in plan.roles.items()},
        "parameters": dict(plan.parameters),
        "reads": [list(pair) for pair in plan.reads],
    }


def plan_from_json(body: Mapping[str, Any]) -> p.Plan:
    """Return the plan in the JSON.

    Raises:
        UnreadablePlan: the JSON is not what `plan_to_json` writes.
    """
    if not isinstance(body, Mapping) or body.get("format") != p.PLAN_FORMAT:
        raise UnreadablePlan(f"This is not a plan of format {p.PLAN_FORMAT}. Compile the program again.")
    try:
        instructions = tuple(_instruction_from_json(item) for item in body["instructions"])
        roles = {name: p.RoleBinding(name, r["device"], tuple(r["can"])) for name, r in body["roles"].items()}
        reads = tuple((str(device), str(name)) for device, name in body["reads"])
        return p.Plan(instructions, roles, dict(body["parameters"]), reads)
    except (KeyError, TypeError, AttributeError, ValueError) as error:
        raise UnreadablePlan(f"The plan cannot be read: {error!r}. Compile the program again.") from error


def expression_to_json(expression: p.Expression | None) -> Any:
    """Return an expression as plain JSON."""
    match expression:
        case None:
            return None
        case p.Constant(value=value):
            return {"const": list(value) if isinstance(value, tuple) else value}
        case p.Variable(name=name):
            return {"var": name}
        case p.Reading(device=device, property=name):
            return {"read": [expression_to_json(device), name]}
        case p.Operation(operator=operator, arguments=arguments):
            return {"op": operator, "args": [expression_to_json(argument) for argument in arguments]}


def expression_from_json(body: Any) -> p.Expression:
    """Return the expression in the JSON."""
    if "const" in body:
        value = body["const"]
        return p.Constant(tuple(value) if isinstance(value, list) else value)
    if "var" in body:
        return p.Variable(body["var"])
    if "read" in body:
        device, name = body["read"]
        return p.Reading(expression_from_json(device), name)
    return p.Operation(body["op"], tuple(expression_from_json(argument) for argument in body["args"]))


def _maybe(body: Any) -> p.Expression | None:
    return None if body is None else expression_from_json(body)


def _named(body: Mapping[str, Any]) -> dict[str, p.Expression]:
    return {name: expression_from_json(value) for name, value in body.items()}


def _place_to_json(place: p.PlaceRef) -> dict[str, Any]:
    if place.device is not None:
        return {"device": place.device}
    if place.place is not None:
        return {"place": place.place}
    if place.point is not None:
        return {"point": list(place.point)}
    return {"value": expression_to_json(place.value)}


def _place_from_json(body: Mapping[str, Any]) -> p.PlaceRef:
    point = body.get("point")
    value = _maybe(body.get("value"))
    return p.PlaceRef(body.get("device"), body.get("place"), None if point is None else _point(point), value)


def _point(body: Any) -> tuple[float, float]:
    x, y = body
    return x, y


def _value_to_json(value: Any) -> Any:
    """Return a field of an instruction as plain JSON."""
    match value:
        case p.PlaceRef():
            return _place_to_json(value)
        case p.Constant() | p.Variable() | p.Reading() | p.Operation():
            return expression_to_json(value)
        case Mapping():
            return {name: expression_to_json(item) for name, item in value.items()}
        case tuple():
            return [list(item) if isinstance(item, tuple) else item for item in value]
    return value


def _instruction_to_json(instruction: p.Instruction) -> dict[str, Any]:
    do = instruction.do
    fields = {name: _value_to_json(getattr(do, name)) for name in type(do).__dataclass_fields__}
    body: dict[str, Any] = {"do": type(do).__name__, **fields}
    body |= {"step": instruction.step, "line": instruction.line}
    return body | {"enters": list(instruction.enters), "leaves": list(instruction.leaves)}


def _load(kind: type[p.Pick] | type[p.Drop], b: Mapping[str, Any]) -> p.Pick | p.Drop:
    thing, quantity = expression_from_json(b["object"]), expression_from_json(b["quantity"])
    return kind(b["role"], _place_from_json(b["at"]), thing, quantity)


_ACTIONS: Mapping[str, Callable[[Mapping[str, Any]], p.Action]] = {
    "Move": lambda b: p.Move(b["role"], _place_from_json(b["to"]), tuple(_point(point) for point in b["route"])),
    "Pick": lambda b: _load(p.Pick, b),
    "Drop": lambda b: _load(p.Drop, b),
    "Call": lambda b: p.Call(_place_from_json(b["device"]), b["method"], _named(b["arguments"]), b["serves"]),
    "Wait": lambda b: p.Wait(expression_from_json(b["seconds"])),
    "WaitUntil": lambda b: p.WaitUntil(expression_from_json(b["condition"]), _maybe(b["timeout_s"])),
    "Branch": lambda b: p.Branch(expression_from_json(b["condition"]), int(b["otherwise"])),
    "Jump": lambda b: p.Jump(int(b["to"])),
    "Fork": lambda b: p.Fork(tuple(map(int, b["branches"])), int(b["join"])),
    "Join": lambda b: p.Join(),
    "TryBegin": lambda b: p.TryBegin(int(b["handler"]), tuple(b["kinds"])),
    "TryEnd": lambda b: p.TryEnd(),
    "Invoke": lambda b: p.Invoke(int(b["entry"]), b["function"], _named(b["arguments"]), b["result"]),
    "Return": lambda b: p.Return(_maybe(b["value"])),
    "Assign": lambda b: p.Assign(b["name"], expression_from_json(b["value"])),
    "End": lambda b: p.End(),
}


def _instruction_from_json(body: Mapping[str, Any]) -> p.Instruction:
    do = _ACTIONS[body["do"]](body)
    return p.Instruction(do, body["step"], int(body["line"]), tuple(body["enters"]), tuple(body["leaves"]))

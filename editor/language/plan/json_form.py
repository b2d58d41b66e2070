"""The plan as plain JSON and back; a run keeps it beside its state."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from editor.language.expressions import nodes as e
from editor.language.plan import instructions as p

_READABLE_FORMATS = (1, p.PLAN_FORMAT)


class UnreadablePlan(ValueError):
    """The JSON is no plan of this format; the message says where it is wrong."""


_LEFT_OUT_WHEN_UNSET = frozenset({"early", "final", "shared", "needed"})
"""Marks that format 1 did not have; they are written only where they are set."""


def plan_to_json(plan: p.Plan) -> dict[str, Any]:
    """Return the plan as plain JSON."""
    return {
        "format": plan.format,
        "instructions": [_instruction_to_json(instruction) for instruction in plan.instructions],
        "roles": {name: _role_to_json(role) for name, role in plan.roles.items()},
        "parameters": dict(plan.parameters),
        "reads": [list(pair) for pair in plan.reads],
        "events": [_event_to_json(event) for event in plan.events],
        "zones": [_zone_to_json(zone) for zone in plan.zones],
    }


def plan_from_json(body: Mapping[str, Any]) -> p.Plan:
    """Return the plan in the JSON; one of format 1 says nothing of what came later, and means the same.

    Raises:
        UnreadablePlan: the JSON is not what `plan_to_json` writes.
    """
    if not isinstance(body, Mapping) or body.get("format") not in _READABLE_FORMATS:
        raise UnreadablePlan(f"This is not a plan of format {p.PLAN_FORMAT}. Compile the program again.")
    try:
        instructions = tuple(_instruction_from_json(item) for item in body["instructions"])
        roles = {name: _role_from_json(name, role) for name, role in body["roles"].items()}
        reads = tuple((str(device), str(name)) for device, name in body["reads"])
        events = tuple(_event_from_json(item) for item in body.get("events", ()))
        zones = tuple(_zone_from_json(item) for item in body.get("zones", ()))
        return p.Plan(instructions, roles, dict(body["parameters"]), reads, events=events, zones=zones)
    except (KeyError, TypeError, AttributeError, ValueError) as error:
        raise UnreadablePlan(f"The plan cannot be read: {error!r}. Compile the program again.") from error


def _role_to_json(role: p.RoleBinding) -> dict[str, Any]:
    body: dict[str, Any] = {"device": role.device, "can": list(role.can)}
    if role.where is not None:
        body |= {"where": expression_to_json(role.where), "said": role.said}
    return {**body, "holds": role.holds} if role.holds else body


def _role_from_json(name: str, body: Mapping[str, Any]) -> p.RoleBinding:
    where = _maybe(body.get("where"))
    return p.RoleBinding(
        name, body["device"], tuple(body["can"]), where, str(body.get("said", "")), int(body.get("holds", 0))
    )


def expression_to_json(expression: e.Expression | None) -> Any:
    """Return an expression as plain JSON."""
    match expression:
        case None:
            return None
        case e.Constant(value=value):
            return {"const": list(value) if isinstance(value, tuple) else value}
        case e.Variable(name=name):
            return {"var": name}
        case e.Reading(device=device, property=name):
            return {"read": [expression_to_json(device), name]}
        case e.Operation(operator=operator, arguments=arguments):
            return {"op": operator, "args": [expression_to_json(argument) for argument in arguments]}
        case e.Located():
            return {"at": _located_to_json(expression)}
    raise TypeError(f"A plan has no {type(expression).__name__}.")


def _located_to_json(located: e.Located) -> dict[str, Any]:
    if located.point is not None:
        return {"point": list(located.point)}
    named = {name: getattr(located, name) for name in ("device", "place", "role", "zone")}
    return {name: value for name, value in named.items() if value is not None}


def _located_from_json(body: Mapping[str, Any]) -> e.Located:
    point = body.get("point")
    given = {name: body.get(name) for name in ("device", "place", "role", "zone")}
    return e.Located(point=None if point is None else _point(point), **given)


def expression_from_json(body: Any) -> e.Expression:
    """Return the expression in the JSON."""
    if "const" in body:
        value = body["const"]
        return e.Constant(tuple(value) if isinstance(value, list) else value)
    if "var" in body:
        return e.Variable(body["var"])
    if "read" in body:
        device, name = body["read"]
        return e.Reading(expression_from_json(device), name)
    if "at" in body:
        return _located_from_json(body["at"])
    return e.Operation(body["op"], tuple(expression_from_json(argument) for argument in body["args"]))


def _maybe(body: Any) -> e.Expression | None:
    return None if body is None else expression_from_json(body)


def _named(body: Mapping[str, Any]) -> dict[str, e.Expression]:
    return {name: expression_from_json(value) for name, value in body.items()}


def _place_to_json(place: e.PlaceRef) -> dict[str, Any]:
    if place.device is not None:
        return {"device": place.device}
    if place.place is not None:
        return {"place": place.place}
    if place.point is not None:
        return {"point": list(place.point)}
    return {"value": expression_to_json(place.value)}


def _place_from_json(body: Mapping[str, Any]) -> e.PlaceRef:
    point = body.get("point")
    value = _maybe(body.get("value"))
    return e.PlaceRef(body.get("device"), body.get("place"), None if point is None else _point(point), value)


def _point(body: Any) -> tuple[float, float]:
    x, y = body
    return x, y


def _value_to_json(value: Any) -> Any:
    """Return a field of an instruction as plain JSON."""
    match value:
        case e.PlaceRef():
            return _place_to_json(value)
        case e.Constant() | e.Variable() | e.Reading() | e.Operation() | e.Located():
            return expression_to_json(value)
        case e.AnswerSpec():
            return _answer_to_json(value)
        case Mapping():
            return {name: expression_to_json(item) for name, item in value.items()}
        case tuple():
            return [list(item) if isinstance(item, tuple) else item for item in value]
    return value


def _instruction_to_json(instruction: p.Instruction) -> dict[str, Any]:
    do = instruction.do
    fields = {name: getattr(do, name) for name in type(do).__dataclass_fields__}
    body: dict[str, Any] = {"do": type(do).__name__}
    body |= {k: _value_to_json(value) for k, value in fields.items() if value or k not in _LEFT_OUT_WHEN_UNSET}
    body |= {"step": instruction.step, "line": instruction.line}
    return body | {"enters": list(instruction.enters), "leaves": list(instruction.leaves)}


def _answer_to_json(answer: e.AnswerSpec) -> dict[str, Any]:
    limits = {"minimum": answer.minimum, "maximum": answer.maximum}
    return {"type": answer.type, "unit": answer.unit, **limits, "options": list(answer.options)}


def _answer_from_json(b: Mapping[str, Any]) -> e.AnswerSpec:
    return e.AnswerSpec(b["type"], b["unit"], b["minimum"], b["maximum"], tuple(b["options"]))


def _ask(b: Mapping[str, Any]) -> p.AskPerson:
    question, answer = expression_from_json(b["question"]), _answer_from_json(b["answer"])
    return p.AskPerson(question, answer, b["result"], b.get("shared", False), _maybe(b["timeout_s"]))


def _event_to_json(event: p.EventEntry) -> dict[str, Any]:
    condition = expression_to_json(event.condition)
    return {"step": event.step, "entry": event.entry, "condition": condition, "starts": event.starts}


def _event_from_json(body: Mapping[str, Any]) -> p.EventEntry:
    return p.EventEntry(body["step"], int(body["entry"]), expression_from_json(body["condition"]), body["starts"])


def _zone_to_json(zone: e.Zone) -> dict[str, Any]:
    points = [list(point) for point in zone.points]
    body = {"id": zone.id, "name": zone.name, "rule": zone.rule, "points": points, "speed_m_s": zone.speed_m_s}
    return {**body, "door": zone.door} if zone.door else body


def _zone_from_json(body: Mapping[str, Any]) -> e.Zone:
    points = tuple(_point(point) for point in body["points"])
    return e.Zone(body["id"], body["name"], body["rule"], points, body["speed_m_s"], body.get("door", ""))


def _load(kind: type[p.Pick] | type[p.Drop], b: Mapping[str, Any]) -> p.Pick | p.Drop:
    thing, quantity = expression_from_json(b["object"]), expression_from_json(b["quantity"])
    return kind(b["role"], _place_from_json(b["at"]), thing, quantity)


ACTIONS: Mapping[str, Callable[[Mapping[str, Any]], p.Action]] = {
    "Move": lambda b: p.Move(b["role"], _place_from_json(b["to"]), tuple(_point(point) for point in b["route"])),
    "Pick": lambda b: _load(p.Pick, b),
    "Drop": lambda b: _load(p.Drop, b),
    "Call": lambda b: p.Call(_place_from_json(b["device"]), b["method"], _named(b["arguments"]), b["serves"]),
    "Perform": lambda b: p.Perform(b["role"], b["method"], _named(b["arguments"])),
    "Cover": lambda b: p.Cover(b["role"], b["zone"], _maybe(b["lane_m"])),
    "Release": lambda b: p.Release(b["role"]),
    "Wait": lambda b: p.Wait(expression_from_json(b["seconds"])),
    "WaitUntil": lambda b: p.WaitUntil(expression_from_json(b["condition"]), _maybe(b["timeout_s"])),
    "Branch": lambda b: p.Branch(expression_from_json(b["condition"]), int(b["otherwise"])),
    "Jump": lambda b: p.Jump(int(b["to"])),
    "Fork": lambda b: p.Fork(tuple(map(int, b["branches"])), int(b["join"]), int(b.get("needed", 0))),
    "Join": lambda b: p.Join(),
    "TryBegin": lambda b: p.TryBegin(int(b["handler"]), tuple(b["kinds"]), b.get("final", False)),
    "Caught": lambda b: p.Caught(b["text"], b["kind"]),
    "TryEnd": lambda b: p.TryEnd(),
    "LimitBegin": lambda b: p.LimitBegin(expression_from_json(b["seconds"])),
    "Rethrow": lambda b: p.Rethrow(),
    "Invoke": lambda b: p.Invoke(
        int(b["entry"]), b["function"], _named(b["arguments"]), b["result"], b.get("shared", False)
    ),
    "Return": lambda b: p.Return(_maybe(b["value"])),
    "Assign": lambda b: p.Assign(b["name"], expression_from_json(b["value"]), b.get("shared", False)),
    "AskPerson": _ask,
    "Notify": lambda b: p.Notify(expression_from_json(b["message"]), b["level"]),
    "Fail": lambda b: p.Fail(expression_from_json(b["message"])),
    "End": lambda b: p.End(b.get("early", False)),
    "EventEnd": lambda b: p.EventEnd(),
}


def _instruction_from_json(body: Mapping[str, Any]) -> p.Instruction:
    do = ACTIONS[body["do"]](body)
    return p.Instruction(do, body["step"], int(body["line"]), tuple(body["enters"]), tuple(body["leaves"]))

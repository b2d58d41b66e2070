"""What a plan's expressions need to know besides devices' properties: positions, roles, the time of day; pure."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from editor.language.expressions.nodes import Constant, Expression, Located, Operation, Reading
from editor.language.plan.instructions import Plan
from execution.machine.evaluation import bound_roles, located_things, needs_the_clock, parts_of_plan, watched_properties
from execution.machine.places import CLOCK, ROLE, X, Y
from vipo_device.protocol.description import Scalar

MEASURES = frozenset({"distance", "nearest"})
Facts = dict[tuple[str, str], Scalar]
Position = tuple[str, float, float]
"""Id, x and y in metres."""


@dataclass(frozen=True, slots=True)
class Needs:
    """Which readings, positions, roles a plan asks for, and whether it looks at the clock.

    `things` are the devices and places that are spoken of, beside the robots that roles find; None where only the run
    tells.
    """

    properties: frozenset[str]
    positions: bool
    roles: frozenset[str]
    clock: bool
    things: frozenset[str] | None


def needs_of(plan: Plan) -> Needs:
    """Return what the expressions of a plan need."""
    located = located_things(plan)
    measures = any(isinstance(part, Operation) and part.operator in MEASURES for part in parts_of_plan(plan))
    return Needs(
        properties=watched_properties(plan),
        positions=measures or any(thing.zone is not None for thing in located),
        roles=frozenset(_role(thing) for thing in located if thing.role is not None),
        clock=needs_the_clock(plan),
        things=_things(plan),
    )


def _role(thing: Located) -> str:
    return thing.role or ""


def _things(plan: Plan) -> frozenset[str] | None:
    """Return the ids of what is read or located, beside roles; None where one is known only when it is asked for."""
    found = {device for device, _ in plan.reads} | {str(robot) for robot in bound_roles(plan).values()}
    for asked in (expression for part in parts_of_plan(plan) for expression in _asked(part)):
        ids = _ids(asked)
        if ids is None:
            return None
        found |= ids
    return frozenset(found)


def _asked(part: Expression) -> tuple[Expression, ...]:
    """Return the things of which an expression asks a reading or a position."""
    match part:
        case Reading(device=device):
            return (device,)
        case Operation(operator=name, arguments=arguments) if name in MEASURES:
            return arguments
        case Operation(operator="in" | "not in", arguments=(thing, Located(zone=str()))):
            return (thing,)
    return ()


def _ids(thing: Expression) -> frozenset[str] | None:
    """Return the ids that an expression may yield, beside robots of roles; None where that cannot be told."""
    match thing:
        case Constant(value=str(name)) | Located(device=str(name)) | Located(place=str(name)):
            return frozenset({name})
        case Located():
            return frozenset()
        case Operation(operator="nearest", arguments=(_, *candidates)):
            ids = [_ids(candidate) for candidate in candidates]
            known = [some for some in ids if some is not None]
            return frozenset().union(*known) if len(known) == len(ids) else None
    return None


def position_facts(positions: Iterable[Position]) -> Facts:
    """Return where things are, to the centimetre, as facts."""
    facts: Facts = {}
    for thing, x, y in positions:
        facts[thing, X], facts[thing, Y] = round(x, 2), round(y, 2)
    return facts


def role_facts(needs: Needs, roles: Mapping[str, str]) -> Facts:
    """Return which robots have the roles that expressions speak of."""
    return {(ROLE, role): robot for role, robot in roles.items() if role in needs.roles}


def clock_fact(seconds: float) -> Facts:
    """Return the time of day, in whole seconds since midnight."""
    return {(CLOCK, "now"): int(seconds) % 86_400}

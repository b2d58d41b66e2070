"""The condition by which a robot is chosen for a role: it looks only at what that robot itself reports."""

from __future__ import annotations

from editor.language.expressions.nodes import Constant, Expression, Located, Operation, Quantity, Reading
from editor.language.expressions.values import parts_of, rename_roles

ITSELF = Located(role="")
"""The robot that may be chosen, whatever the role is called; no role has an empty name."""
_LOOK_ELSEWHERE = frozenset({"now", "distance", "nearest", "text"})


def foreign_part(where: Expression) -> Expression | None:
    """Return the first part of a condition that is no reading of the robot itself, nor worked out from some."""
    readings = {id(part.device) for part in parts_of(where) if isinstance(part, Reading) and part.device == ITSELF}
    return next((part for part in parts_of(where) if id(part) not in readings and not _is_own(part)), None)


def _is_own(part: Expression) -> bool:
    if isinstance(part, Operation):
        return part.operator not in _LOOK_ELSEWHERE
    return isinstance(part, Constant | Quantity) or (isinstance(part, Reading) and part.device == ITSELF)


def of_role(where: Expression, role: str) -> Expression:
    """Return a condition on the robot that has a role."""
    return rename_roles(where, {"": role})


def surely_read(where: Expression | None) -> frozenset[str]:
    """Return the readings that a robot must report to be chosen: those without which the condition has no value."""
    match where:
        case Reading(property=name):
            return frozenset({name})
        case Operation(operator="or", arguments=(first, *_)):
            return surely_read(first)
        case Operation(arguments=arguments):
            return frozenset().union(*map(surely_read, arguments))
    return frozenset()

"""The condition by which a role's robot is chosen, as a plan has it: converted, and in words for who waits for it."""

from __future__ import annotations

from dataclasses import replace

from editor.language.expressions.nodes import Constant, Expression, Located, Operation, Quantity
from editor.language.expressions.printing import quantity_text, quote, scalar_text, write_expression
from editor.language.expressions.temperatures import base_unit
from editor.language.expressions.unit_conversion import convert_units
from editor.language.expressions.value_types import TypeChecker
from editor.language.expressions.values import COMPARISONS, is_number, rename_roles
from editor.language.plan.instructions import RoleBinding
from editor.language.site.surroundings import Surroundings
from editor.language.tree.choice import of_role
from editor.language.tree.program import Role
from vipo_device.protocol.units import UNITS, is_measure, unit_symbol


def binding_of(role: Role, surroundings: Surroundings) -> RoleBinding:
    """Return how a role finds its robot; the plan knows it by its id in the document."""
    key = role.id or role.name
    binding = RoleBinding(key, role.device, role.can, holds=role.holds)
    if role.where is None:
        return binding
    checker = TypeChecker(surroundings, {}, [])
    where = of_role(role.where, role.name)
    said = write_expression(_with_units(where, checker), _Words())
    return replace(binding, where=rename_roles(convert_units(where, "", checker), {role.name: key}), said=said)


def _with_units(where: Expression, checker: TypeChecker) -> Expression:
    """Return a condition in which numbers say the unit that they take from what they are compared with."""
    if not isinstance(where, Operation):
        return where
    arguments = tuple(_with_units(argument, checker) for argument in where.arguments)
    if where.operator in COMPARISONS:
        unit = next((u for a in where.arguments if is_measure(u := base_unit(checker.type_of(a).unit))), "")
        arguments = tuple(_in_unit(argument, unit) for argument in arguments)
    return Operation(where.operator, arguments)


def _in_unit(argument: Expression, unit: str) -> Expression:
    written = isinstance(argument, Constant) and is_number(argument.value)
    return Quantity(argument.value, unit) if unit and written and isinstance(argument, Constant) else argument  # type: ignore[arg-type]  # a number


class _Words:
    """How the parts of such a condition are said; it speaks of nothing but the robot's own readings."""

    def variable(self, name: str) -> str:
        return name

    def reading(self, device: str, property_name: str) -> str:
        return property_name

    def robot_reading(self, role: str, property_name: str) -> str:
        return property_name if property_name.isidentifier() else quote(property_name)

    def located(self, located: Located) -> str:
        return located.role or ""

    def quantity(self, quantity: Quantity) -> str:
        if quantity.unit not in UNITS:
            return quantity_text(quantity)
        return f"{scalar_text(quantity.value)} {unit_symbol(quantity.unit)}"

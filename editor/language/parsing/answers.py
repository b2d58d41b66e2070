"""What is told of a name that stands where it cannot: what it is, which one was meant, or where to give it."""

from __future__ import annotations

import ast
from collections.abc import Iterable
from difflib import get_close_matches
from functools import partial
from typing import Final

from editor.language.constructs.script_form import CALLS
from editor.language.constructs.table import FORMS
from editor.language.expressions.names import CLOSED_FUNCTIONS, ROBOT_METHODS, member_name, snake_case
from editor.language.messages.syntax_errors import ATTRIBUTE_ALONE, LIMIT, LIMITING, NAMES, OTHER_WORDS
from editor.language.parsing.scope import Binding, Refused, Scope, attribute_of_self, quoted, written
from editor.language.tree.robots import own_methods, readings_of, short_name

_MOST_NAMES: Final = 12
_EXAMPLES: Final = {call.method: FORMS[name][1].example for name, call in CALLS.items() if call.role is None}
"""How the task's own steps are written, by their methods."""
_GIVE_DEVICE: Final = 'Give it in run: self.{0} = ctx.get("curingOven01").'
_GIVE_ROBOT: Final = 'Give it in run: self.{0} = ctx.any("pick", "drop").'
_GIVE_VALUE: Final = 'Give it in run: self.{0} = ctx.parameter("{0}", 0, Number).'


def unknown_device(node: ast.expr, name: str, scope: Scope) -> Refused:
    """Return the refusal of `self.name` where a machine or a place is wanted."""
    return Refused(node, quoted(node), _about(name, scope, _GIVE_DEVICE))


def unknown_robot(node: ast.expr, name: str, scope: Scope) -> Refused:
    """Return the refusal of `self.name` where a robot is wanted."""
    return Refused(node, quoted(node), _about(name, scope, _GIVE_ROBOT))


def unplaced_load(node: ast.AST, role: str, scope: Scope) -> Refused:
    """Return the refusal of a pick or drop by what stands nowhere that is known."""
    binding = scope.bindings.get(role)
    description = scope.description(binding.id) if binding is not None else None
    if description is None or description.kind == "robot":
        return Refused(node, "A pick or drop at an unknown place", f"Put self.{role}.move(…) before it.")
    able = _joined(_members(method.name for method in description.methods)) or "do nothing"
    return Refused(node, quoted(node), f"self.{role} is a machine; it can {able}. Only robots pick and drop.")


def unknown_value(node: ast.expr, name: str, scope: Scope) -> Refused:
    """Return the refusal of `self.name` where a value is wanted."""
    return Refused(node, quoted(node), _about(name, scope, _GIVE_VALUE))


def unknown_function(call: ast.Call, name: str, scope: Scope) -> Refused:
    """Return the refusal of `self.name(…)`."""
    functions = [each for each in scope.methods if each not in {"new_task", "run"}]
    known = f"There is no such function. Functions of this task: {_listed(functions) or 'none yet'}."
    known = LIMIT if name in LIMITING else known
    return Refused(call, quoted(call), _about(name, scope, known))


def taken_name(node: ast.expr, name: str, scope: Scope) -> Refused:
    """Return the refusal to set a variable whose name stands for something else."""
    known = what_it_is(name, scope, frozenset())
    return Refused(node, f"A change of {quoted(node)}", f"{known} Choose another name for the variable.")


def alone(node: ast.Attribute, scope: Scope) -> Refused:
    """Return the refusal of `self.oven.temperature` or `self.end` as a statement."""
    own, thing = attribute_of_self(node), attribute_of_self(node.value)
    instead = what_it_is(own, scope, scope.locals) if own is not None else ""
    if thing is not None and scope.bindings.get(thing, Binding("place")).kind in {"get", "any"}:
        able, readings = abilities(thing, scope), _readings(thing, scope)
        if node.attr in able:
            instead = f"Write brackets behind it: {written(node)}(…)."
        elif node.attr in readings:
            instead = f"A reading alone does nothing. Use it, as in if {written(node)} > 60:."
        else:
            return Refused(node, quoted(node), partial(_method, node.attr, written(node), able, readings))
    return Refused(node, quoted(node), instead or ATTRIBUTE_ALONE)


def unknown_name(node: ast.Name, scope: Scope) -> Refused:
    """Return the refusal of a name without `self.` before it."""
    return Refused(node, quoted(node), partial(_bare, node.id, scope, scope.locals))


def _about(name: str, scope: Scope, unknown: str) -> partial[str]:
    return partial(_attribute, name, scope, scope.locals, unknown)


def _attribute(name: str, scope: Scope, own: frozenset[str], unknown: str) -> str:
    return what_it_is(name, scope, own) or _near(name, scope, own) or unknown.format(name)


def what_it_is(name: str, scope: Scope, own: frozenset[str]) -> str:
    """Return what `self.name` is and what can be done with it; empty where nobody knows."""
    binding = scope.bindings.get(name)
    if binding is not None:
        return _bound(name, binding, scope)
    if name == "new_task" or name == "run":
        return f"{name} begins by itself. To repeat steps, write while True: or for _ in range(3):."
    if name in scope.methods:
        return f"self.{name} is a function: it is called on a line of its own, self.{name}()."
    if name in scope.variables:
        return f"self.{name} is a variable: a value, as in self.wait(self.{name})."
    if name in own:
        return f"Write {name}: it belongs to this function or loop alone."
    return _EXAMPLES.get(name) or _EXAMPLES.get(OTHER_WORDS.get(name, ""), "")


def _bound(name: str, binding: Binding, scope: Scope) -> str:
    """Return what something is that run gives."""
    match binding.kind:
        case "parameter":
            return f"self.{name} is a parameter: a value, as in self.wait(self.{name})."
        case "place":
            return f"self.{name} is a place; a robot goes there by self.robot.move(self.{name}.location)."
        case "zone":
            return f"self.{name} is a zone; it can be asked whether self.robot in self.{name}."
    description = scope.description(binding.id)
    if binding.kind == "any" or name in scope.robots() or (description is not None and description.kind == "robot"):
        return f"self.{name} is given; it can {_joined(abilities(name, scope))}."
    if description is None:
        return f"The site has no device {binding.id}, which run gives to self.{name}."
    read = _listed(_readings(name, scope))
    can = _joined(abilities(name, scope)) or "do nothing"
    return f"self.{name} is a machine; it can {can}." + (f" What can be read of it: {read}." if read else "")


def abilities(name: str, scope: Scope) -> list[str]:
    """Return what a robot or a machine that run gives can do, as the script calls it."""
    binding = scope.bindings[name]
    description = scope.description(binding.id)
    if binding.kind == "any" or name in scope.robots() or (description is not None and description.kind == "robot"):
        robots = scope.robots_of(name)
        return [*ROBOT_METHODS, *filter(None, (short_name(robots, method) for method in own_methods(robots)))]
    return [] if description is None else _members(method.name for method in description.methods)


def _readings(name: str, scope: Scope) -> list[str]:
    """Return what can be read of a machine or robot that run gives, as the script calls it."""
    description = scope.description(scope.bindings[name].id)
    if scope.bindings[name].kind == "any" or name in scope.robots():
        return readings_of(scope.robots_of(name))
    return [] if description is None else _members(each.name for each in description.properties)


def _members(names: Iterable[str]) -> list[str]:
    known = list(names)
    return [name for name in (member_name(each, known) for each in known) if name]


def unknown_method(call: ast.Call, wanted: str, able: Iterable[str], readings: Iterable[str] = ()) -> Refused:
    """Return the refusal of a method that a machine or a robot does not have, which can do and be asked this much."""
    method = written(call.func)
    return Refused(call, quoted(call), partial(_method, wanted, method, list(able), list(readings)))


def _method(wanted: str, written: str, able: list[str], readings: list[str]) -> str:
    if wanted in readings:
        return f"{wanted} is read without brackets, as in if {written} > 60:."
    if wanted in _EXAMPLES:
        return _EXAMPLES[wanted]
    known = f"What it can do: {_listed(able) or 'nothing'}."
    near = next((other for other in (OTHER_WORDS.get(wanted), snake_case(wanted)) if other in able), None)
    near = near or closest(wanted, able)
    return f"Did you mean {near}? {known}" if near else known


def unknown_reading(node: ast.Attribute, known: list[str], able: Iterable[str]) -> Refused:
    """Return the refusal of a property that a device does not have."""
    return Refused(node, quoted(node), partial(_reading, node, known, list(able)))


def _reading(node: ast.Attribute, known: list[str], able: list[str]) -> str:
    if node.attr in able:
        return f"This is something that it does. Write it on a line of its own: {written(node)}(…)."
    if node.attr == "location":
        return f"Where it is stands only in move. Elsewhere write {written(node.value)}."
    near = closest(node.attr, known)
    listed = f"What can be read here: {_listed(known) or 'nothing'}."
    return f"Did you mean {near}? {listed}" if near else listed


def what_is_called(call: ast.Call, function: ast.Attribute, scope: Scope) -> str:
    """Return what is told of `self.oven.cure_paint(5)` where a value is wanted."""
    if function.attr in _readings(getattr(function.value, "attr", ""), scope):
        return f"Write it without brackets: {written(function)}."
    return f"This gives no value. Write it on a line of its own: {_shortened(call)}."


def _shortened(node: ast.AST) -> str:
    text = written(node)
    return text if len(text) < 60 else f"{text[:60]}…"


def _bare(name: str, scope: Scope, own: frozenset[str]) -> str:
    """Return what is told of a name without `self.` before it."""
    if name in scope.variables or name in scope.bindings:
        return f"Write self.{name}."
    if name in NAMES:
        return NAMES[name]
    if name in scope.methods or name in _EXAMPLES:
        return what_it_is(name, scope, frozenset())
    if name in CLOSED_FUNCTIONS:
        return f"{name} needs its values in brackets: {name}(…). A variable has self. before it: self.{name}."
    return _near(name, scope, own) or (
        f'A text stands in quotation marks: "{name}". Devices and variables have self. before them: self.{name}.'
    )


def _near(name: str, scope: Scope, own: frozenset[str]) -> str:
    """Return which of the known names was meant; empty where none is alike."""
    given = [*scope.bindings, *sorted(scope.variables)]
    near = closest(name, [*given, *scope.methods, *_EXAMPLES]) or _with_this_word(name, given)
    if near:
        return f"Did you mean self.{near}?"
    near = closest(name, sorted(own))
    return f"Did you mean {near}?" if near else ""


def closest(name: str, known: list[str]) -> str:
    """Return the name that differs from this one by little, or in capitals only; empty where there is none."""
    small = name.lower()
    alike = [other for other in known if other.lower() == small]
    if alike or len(name) < 3:
        return alike[0] if alike else ""
    return next(iter(get_close_matches(name, known, 1, 0.75)), "")


def _with_this_word(name: str, known: list[str]) -> str:
    """Return the one name of which this is a word: `curing_oven` for `oven`."""
    found = [other for other in known if name in other.split("_")]
    return found[0] if len(found) == 1 else ""


def _listed(names: list[str]) -> str:
    return ", ".join(names[:_MOST_NAMES]) + (", …" if len(names) > _MOST_NAMES else "")


def _joined(names: list[str]) -> str:
    return " and ".join(filter(None, (", ".join(names[:-1]), *names[-1:])))

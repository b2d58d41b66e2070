"""Devices that a run gives a program's parameters, and that cannot do what the program does with them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from editor.language.compiler import look_at
from editor.language.messages.diagnostics import Diagnostic, Problem, put_into_words
from editor.language.site.surroundings import Surroundings
from editor.language.tree import nodes as n
from editor.language.tree.numbering import numbers_in_script
from editor.language.tree.program import Tree
from vipo_device.protocol.description import Description, Scalar


@dataclass(frozen=True, slots=True)
class Misfit:
    """A device that was chosen for a parameter, by its name in the script, and what the checks say of it."""

    parameter: str
    device: Description
    diagnostic: Diagnostic


def find_misfit(document: object, surroundings: Surroundings, given: Mapping[str, Scalar]) -> Misfit | None:
    """Return the first parameter whose device cannot do what the program does with it; None where all can.

    `given` is what a run gives the parameters, by their names in the script; the program is one without errors. Those
    steps count that the run may come to with what it is given: what is asked of a device only where something else is
    chosen keeps nobody from choosing it.
    """
    chosen = {name: value for name, value in given.items() if isinstance(value, str) and value in surroundings.devices}
    if not chosen or _first_wrong(document, surroundings, given, frozenset(chosen.values())) is None:
        return None
    for name, device in chosen.items():
        others = {each: value for each, value in given.items() if value != device}
        wrong = _first_wrong(document, surroundings, {**others, name: device}, frozenset({device}))
        if wrong is not None and _first_wrong(document, surroundings, others, frozenset({device})) is None:
            return Misfit(name, surroundings.devices[device].description, wrong)
    return None  # whatever is wrong, it is not what was chosen


def _first_wrong(
    document: object, surroundings: Surroundings, given: Mapping[str, Scalar], devices: frozenset[str]
) -> Diagnostic | None:
    """Return the first error, in reading order, that is told of one of the devices because a variable holds it.

    What the program catches, it reckons with: that is none.
    """
    look = look_at(document, surroundings, given=given)
    places = {step: index for index, step in enumerate(numbers_in_script(look.tree))}
    told = [problem for problem, _ in look.found if problem.held in devices]
    if told:
        limits = _limits_of_waits(look.tree)
        uncaught = {kind: _uncaught(look.tree, kind) for kind in _KINDS}
        told = [each for each in told if each.step not in places or each.step in uncaught[_kind_of(each, limits)]]
    words = (put_into_words(each, None) for each in sorted(told, key=lambda each: places.get(each.step, len(places))))
    return next((each for each in words if each.severity == "error"), None)


_ENDLESS: Final = "endless"
_KINDS: Final = ("refused", "failed", "blocked", "timed_out", _ENDLESS)
_BLOCKED: Final = frozenset({"robot_as_goal", "robot_as_place"})


def _kind_of(problem: Problem, limits: Mapping[str, bool]) -> str:
    """Return how a step fails that asks so much of a device: what it cannot tell has no value, and never gets one.

    `limits` says of each step that waits whether it does so for a limited time; without one it fails in no way.
    """
    if problem.code == "unknown_property":
        return "failed" if problem.step not in limits else "timed_out" if limits[problem.step] else _ENDLESS
    return "blocked" if problem.code in _BLOCKED else "refused"


def _limits_of_waits(tree: Tree) -> dict[str, bool]:
    blocks = (tree.body, *(each.body for each in tree.functions), *(each.body for each in tree.events))
    waits = (node for block in blocks for node in n.walk(block) if isinstance(node, n.WaitUntil))
    return {wait.step: wait.timeout_s is not None for wait in waits}


def _uncaught(tree: Tree, kind: str) -> set[str]:
    """Return the steps of which a failure of a kind is caught by no step around, also not around the call."""
    functions = {function.method: function.body for function in tree.functions}
    left, found = [tree.body, *(event.body for event in tree.events)], {event.step for event in tree.events}
    while left:
        for node in left.pop():
            found.add(node.step)
            if isinstance(node, n.Try) and kind != _ENDLESS and any(handler.takes(kind) for handler in node.handlers):
                left.extend((*node.catches, node.final))
            else:
                left.extend(n.blocks_of(node))
            if isinstance(node, n.Call):
                left.append(functions.pop(node.function, ()))
    return found

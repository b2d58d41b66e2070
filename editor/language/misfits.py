"""Devices that a run gives a program's parameters, and that cannot do what the program does with them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from editor.language.compiler import look_at
from editor.language.messages.diagnostics import Diagnostic, put_into_words
from editor.language.site.surroundings import Surroundings
from editor.language.tree.numbering import numbers_in_script
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
    """Return the first error, in reading order, that is told of one of the devices because a variable holds it."""
    look = look_at(document, surroundings, given=given)
    places = {step: index for index, step in enumerate(numbers_in_script(look.tree))}
    told = [problem for problem, _ in look.found if problem.held in devices]
    words = (put_into_words(each, None) for each in sorted(told, key=lambda each: places.get(each.step, len(places))))
    return next((each for each in words if each.severity == "error"), None)

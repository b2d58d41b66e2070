"""What a run is given for its program's parameters, held against what the program declares of them; pure."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from editor.language.tree.program import Parameter
from execution.errors import NotReady
from vipo_device.protocol.arguments import is_number
from vipo_device.protocol.description import Scalar
from vipo_device.protocol.texts import find_unfit
from vipo_device.protocol.units import unit_symbol

LARGEST = 1e15
LONGEST_TEXT = 500
_MUST = {
    "missing": "needs a value",
    "number": f"must be a number, at most {LARGEST:g}",
    "unit": f"must be a number in {{unit}}, at most {LARGEST:g}",
    "boolean": "must be true or false",
    "text": f"must be a text of at most {LONGEST_TEXT} characters",
    "object": f"must name a kind of object, in one line of 1 to {LONGEST_TEXT} characters",
    "device": "must be the id of a device that takes part at this site",
    "place": "must be the id of a place or device of this site",
    "scalar": "must be a number, a text, or true or false",
}
"""What is said of a parameter that does not fit; the screens have the same by `why`, which is `parameter_` and this."""


@dataclass(frozen=True, slots=True)
class Surrounding:
    """The ids that a parameter may name: of devices that take part, and of places."""

    devices: frozenset[str]
    places: Collection[str]


def fit_parameters(
    declared: Iterable[Parameter], names: Mapping[str, str], given: Mapping[str, Any], around: Surrounding
) -> dict[str, Scalar]:
    """Return a value for each parameter, by its name in the script: what is given, or else its default.

    `names` has the script's name for the document's; either may be given. Raises NotReady, naming the parameter.
    """
    by_name = {parameter.name: parameter for parameter in declared}
    found = {name: parameter.default for name, parameter in by_name.items()}
    for said, value in given.items():
        name = said if said in by_name else names.get(said, "")
        if name not in by_name:
            raise _unknown(said, names)
        if value is not None:
            found[name] = value
    titles = {script: title for title, script in names.items()}
    for name, value in found.items():
        if misfit := _misfit(by_name[name], value, around):
            raise _refusal(titles.get(name, name), misfit, by_name[name].unit)
    return found


def _unknown(said: str, names: Collection[str]) -> NotReady:
    name = said[:64]
    known = f" It has: {', '.join(names)}." if names else " It has none."
    return NotReady(f"The program has no parameter called “{name}”.{known}", {"why": "parameter", "name": name})


def _refusal(name: str, misfit: str, unit: str) -> NotReady:
    symbol = unit_symbol(unit) if unit else ""
    must = _MUST[misfit].format(unit=symbol)
    return NotReady(f"The parameter “{name}” {must}.", {"why": f"parameter_{misfit}", "name": name, "unit": symbol})


def _misfit(parameter: Parameter, value: object, around: Surrounding) -> str:
    """Return which of `_MUST` does not hold; empty when the value fits."""
    if value is None:
        return "missing"
    match parameter.type:
        case "number":
            fits = is_number(value) and abs(value) <= LARGEST
            return "" if fits else ("unit" if parameter.unit else "number")
        case "boolean":
            return "" if isinstance(value, bool) else "boolean"
        case "text":
            return "" if _is_text(value) else "text"
        case "object":
            return "" if _is_text(value, is_line=True) and str(value).strip() else "object"
        case "device":
            return "" if isinstance(value, str) and value in around.devices else "device"
        case "place":
            return "" if isinstance(value, str) and (value in around.places or value in around.devices) else "place"
    fits = isinstance(value, bool) or _is_text(value) or (is_number(value) and abs(value) <= LARGEST)
    return "" if fits else "scalar"


def _is_text(value: object, *, is_line: bool = False) -> bool:
    return isinstance(value, str) and len(value) <= LONGEST_TEXT and not find_unfit(value, is_line=is_line)

"""Whether calls of one version of a function hold for another, and why not. Pure.

Breaking is what calls that stand, or the devices that they were drawn for, may not fit any more: a value that is asked
for anew, is of another type or unit, is taken no more; a result that is another or gone; a robot or machine that must
be able to do more. What calls may leave as they are is compatible, and told all the same.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from editor.language.site.signature import Need, Port, Signature

Code = Literal[
    "parameter_added",
    "parameter_wanted",
    "parameter_gone",
    "parameter_type",
    "parameter_unit",
    "default_gone",
    "default_added",
    "default_changed",
    "result_added",
    "result_gone",
    "result_type",
    "result_unit",
    "needs_new",
    "needs_more",
    "needs_less",
    "needs_instead",
    "needs_gone",
]
BREAKING: frozenset[Code] = frozenset(
    {
        "parameter_wanted",
        "parameter_gone",
        "parameter_type",
        "parameter_unit",
        "default_gone",
        "result_gone",
        "result_type",
        "result_unit",
        "needs_new",
        "needs_more",
    }
)
_WIDER = frozenset({("integer", "number")})
"""Types of which each value is one of the other."""


@dataclass(frozen=True, slots=True)
class Reason:
    """Something that is otherwise in a newer version; `name` is the value's or device's, `of` of whom it is a need.

    `old` and `new` are types, units, defaults as JSON, or abilities set apart by commas; empty where there is none.
    """

    code: Code
    name: str = ""
    old: str = ""
    new: str = ""
    of: str = ""

    @property
    def breaks(self) -> bool:
        """Tell whether calls that stand may not hold."""
        return self.code in BREAKING


def find_reasons(old: Signature, new: Signature) -> tuple[Reason, ...]:
    """Return what is otherwise for who calls the newer version, what breaks first."""
    found = [*_of_parameters(old, new), *_of_result(old.result, new.result), *_of_needs(old.needs, new.needs)]
    return tuple(sorted(found, key=lambda reason: not reason.breaks))


def breaks(old: Signature, new: Signature) -> bool:
    """Tell whether calls of the older version may not hold for the newer one."""
    return old != new and any(reason.breaks for reason in find_reasons(old, new))


def _of_parameters(old: Signature, new: Signature) -> Iterator[Reason]:
    before = {port.name: port for port in old.parameters}
    after = {port.name: port for port in new.parameters}
    for name, port in after.items():
        known = before.get(name)
        if known is None:
            wanted = port.default is None
            yield Reason("parameter_wanted" if wanted else "parameter_added", name, "", port.default or port.type)
        else:
            yield from _of_parameter(known, port)
    yield from (Reason("parameter_gone", name, port.type) for name, port in before.items() if name not in after)


def _of_parameter(old: Port, new: Port) -> Iterator[Reason]:
    if old.type != new.type and (old.type, new.type) not in _WIDER:
        yield Reason("parameter_type", new.name, old.type, new.type)
    elif old.unit != new.unit:
        yield Reason("parameter_unit", new.name, old.unit, new.unit)
    if old.default is not None and new.default is None:
        yield Reason("default_gone", new.name, old.default)
    elif old.default is None and new.default is not None:
        yield Reason("default_added", new.name, "", new.default)
    elif old.default != new.default:
        yield Reason("default_changed", new.name, old.default or "", new.default or "")


def _of_result(old: Port | None, new: Port | None) -> Iterator[Reason]:
    if old is None and new is not None:
        yield Reason("result_added", "", "", new.type)
    elif old is not None and new is None:
        yield Reason("result_gone", "", old.type)
    elif old is not None and new is not None:
        if old.type != new.type and (new.type, old.type) not in _WIDER:
            yield Reason("result_type", "", old.type, new.type)
        elif old.unit != new.unit:
            yield Reason("result_unit", "", old.unit, new.unit)


def _of_needs(old: tuple[Need, ...], new: tuple[Need, ...]) -> Iterator[Reason]:
    """Compare by who is named; who is named on one side alone may stand for another who can as much."""
    before = {_who(need): need for need in old}
    after = {_who(need): need for need in new}
    left = [need for who, need in before.items() if who not in after]
    for who, need in after.items():
        if who in before:
            yield from _of_need(before[who], need)
            continue
        stood_for = next((each for each in left if each.of == need.of and need.abilities <= each.abilities), None)
        if stood_for is None:
            yield Reason("needs_new", need.name, "", _listed(need.abilities), need.of)
        else:
            left.remove(stood_for)
            if need.of != "robot":
                yield Reason("needs_instead", need.name, stood_for.name, need.name, need.of)
    yield from (Reason("needs_gone", need.name, _listed(need.abilities), "", need.of) for need in left)


def _who(need: Need) -> tuple[str, str]:
    return need.of, need.name if need.of != "machine" else need.device or need.name


def _of_need(old: Need, new: Need) -> Iterator[Reason]:
    more, less = new.abilities - old.abilities, old.abilities - new.abilities
    if more:
        yield Reason("needs_more", new.name, "", _listed(more), new.of)
    if less:
        yield Reason("needs_less", new.name, _listed(less), "", new.of)


def _listed(abilities: frozenset[tuple[str, str]]) -> str:
    return ", ".join(sorted(dict.fromkeys(name for _, name in abilities)))

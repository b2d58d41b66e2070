"""What a library function is to who calls it: what it is given, what it gives back, what it needs of devices."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final, Literal

NeedOf = Literal["robot", "machine", "parameter"]
ABILITIES: Final = ("methods", "gives", "takes", "readings")


@dataclass(frozen=True, slots=True)
class Port:
    """A value that goes in or out: its type, its unit's code or none, and as JSON what stands for it if left out."""

    name: str
    type: str
    unit: str = ""
    default: str | None = None


@dataclass(frozen=True, slots=True)
class Need:
    """What a robot, a machine, or whatever device is given as a parameter must be able to do.

    `name` is the role's, the machine's or the parameter's; `device` the id of a device that is named, or empty.
    """

    of: NeedOf
    name: str
    device: str = ""
    methods: tuple[str, ...] = ()
    gives: tuple[str, ...] = ()
    takes: tuple[str, ...] = ()
    readings: tuple[str, ...] = ()

    @property
    def abilities(self) -> frozenset[tuple[str, str]]:
        """Return all that it must be able to do, each with what kind of ability that is."""
        return frozenset((kind, name) for kind in ABILITIES for name in getattr(self, kind))


@dataclass(frozen=True, slots=True)
class Signature:
    """What a version of a function is to who calls it."""

    parameters: tuple[Port, ...] = ()
    result: Port | None = None
    needs: tuple[Need, ...] = ()


def signature_to_json(signature: Signature) -> dict[str, Any]:
    """Return a signature as plain JSON; what is empty is left out, but for a type that is none."""
    body: dict[str, Any] = {"parameters": [_filled(port) for port in signature.parameters]}
    if signature.result is not None:
        body["result"] = _filled(signature.result)
    if signature.needs:
        body["needs"] = [need_to_json(need) for need in signature.needs]
    return body


def need_to_json(need: Need) -> dict[str, Any]:
    """Return a need as plain JSON; what is empty is left out."""
    return {key: list(value) if isinstance(value, tuple) else value for key, value in _filled(need).items()}


def _filled(record: Port | Need) -> dict[str, Any]:
    fields = {name: getattr(record, name) for name in record.__slots__}
    return {key: value for key, value in fields.items() if key == "type" or value not in (None, "", ())}


def signature_from_json(body: Mapping[str, Any]) -> Signature:
    """Return the signature that signature_to_json wrote. Raises KeyError, TypeError, ValueError."""
    result = body.get("result")
    return Signature(
        tuple(_port(each) for each in body["parameters"]),
        None if result is None else _port(result),
        tuple(_need(each) for each in body.get("needs", ())),
    )


def _port(body: Mapping[str, Any]) -> Port:
    default = body.get("default")
    if not (default is None or isinstance(default, str)):
        default = json.dumps(default)
    return Port(str(body.get("name", "")), str(body["type"]), str(body.get("unit") or ""), default)


def _need(body: Mapping[str, Any]) -> Need:
    of = body["of"]
    if of not in ("robot", "machine", "parameter"):
        raise ValueError(f"a need is of a robot, a machine or a parameter, not of {of}")
    lists = {kind: tuple(str(name) for name in body.get(kind, ())) for kind in ABILITIES}
    return Need(of, str(body.get("name", "")), str(body.get("device", "")), **lists)

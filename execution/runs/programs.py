"""Programs made ready to be carried out: pinned, checked and compiled by the editor."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal
from uuid import UUID

from editor import services as editor
from editor.language import Diagnostic, Misfit
from editor.language.reading.names import by_id, read_parameters
from execution.errors import NotReady
from execution.runs.parameters import Surrounding, fit_parameters
from registry import services as registry
from vipo_device.protocol.description import Scalar

Cause = Literal["run", "rehearsal"]
"""What a program is pinned for."""


@dataclass(frozen=True, slots=True)
class Prepared:
    """A program's version with all that a run or a rehearsal keeps of it; document, compiled and plan are JSON."""

    program: UUID
    site: str
    name: str
    version: int
    document: Mapping[str, Any]
    compiled: Mapping[str, Any]
    plan: Mapping[str, Any]
    parameters: Mapping[str, Scalar] = field(default_factory=dict)


def site_of_program(*, program_id: UUID) -> str:
    """Return the site of a program; raises the editor's NoSuchProgram."""
    return editor.get_program(program_id=program_id).site


def prepare(
    *, program_id: UUID, user: Any, parameters: Mapping[str, Any], version: int | None = None, cause: Cause = "run"
) -> Prepared:
    """Pin the program as it is drawn now, or take one of its versions, and compile it for the site as it is now.

    Raises:
        NotReady: the program has errors, or a parameter does not exist, is missing or does not fit, or is given a
            device that cannot do what the program does with it.
        editor.NoSuchProgram: there is no such version.
    """
    program = editor.get_program(program_id=program_id)
    pinned = _version(program_id, user, version, cause)
    compiled = editor.compile_version(version=pinned)
    if compiled.plan is None:
        raise not_ready(compiled.errors)
    _, names = read_parameters(by_id(pinned.document.get("parameters")).items())
    around = _around(program.site)
    fitting = fit_parameters(compiled.parameters, names, parameters, around)
    if not around.devices.isdisjoint(map(str, fitting.values())):
        misfit = editor.find_misfit(version=pinned, given=fitting)
        if misfit is not None:
            raise _cannot(misfit, names)
    return Prepared(
        program=program_id,
        site=program.site,
        name=program.name,
        version=pinned.number,
        document=pinned.document,
        compiled=compiled.compiled(),
        plan=json.loads(compiled.plan),
        parameters=fitting,
    )


def _version(program_id: UUID, user: Any, number: int | None, cause: Cause) -> editor.WholeVersionView:
    if number is not None:
        return editor.find_version(program_id=program_id, number=number)
    return editor.pin_version(program_id=program_id, user=user, cause=cause)


def _around(site: str) -> Surrounding:
    places = frozenset(place.id for place in registry.list_places(site=site))
    return Surrounding(frozenset(registry.list_device_ids(site=site, lifecycle="approved")), places)


def _cannot(misfit: Misfit, names: Mapping[str, str]) -> NotReady:
    """Return the refusal for a device that cannot do all that it is to; `names` has the script's for the document's."""
    title = next((title for title, script in names.items() if script == misfit.parameter), misfit.parameter)
    device, first = misfit.device.name, misfit.diagnostic.messages
    detail = f"The device “{device}” does not fit the parameter “{title}”. {first['en']}"
    return NotReady(detail, {"why": "parameter_cannot", "name": title, "device": device, "first": first})


def not_ready(errors: Sequence[Diagnostic]) -> NotReady:
    """Return the refusal for a program with errors; it names the first of them."""
    count = f"{len(errors)} errors" if len(errors) != 1 else "one error"
    first = errors[0].messages if errors else {}
    detail = f"The program has {count} and cannot be carried out. {first.get('en', '')}".strip()
    return NotReady(detail, {"why": "errors", "count": len(errors), "first": first})

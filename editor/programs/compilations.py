"""A program compiled for its site, off the web process's event loop where it is large."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from editor.documents import work
from editor.language import (
    Diagnostic,
    Misfit,
    Surroundings,
    compile_document,
    compiled_to_json,
    find_misfit,
    plan_to_json,
)
from editor.language.allocation import paused_collector
from editor.language.compiler import look_at
from editor.language.tree.program import Parameter
from editor.programs.summary import Summary, summary_of
from vipo_device.protocol.description import Scalar


@dataclass(frozen=True, slots=True)
class Compilation:
    """What came of a program: its form (docs/shapes/compiled.md) and its plan as JSON text.

    There is no plan while there are errors, or where none was wanted. `errors` are what keeps the program from being
    carried out, `parameters` what it is to be given.
    """

    form: str
    plan: str | None
    summary: Summary
    parameters: tuple[Parameter, ...]
    errors: tuple[Diagnostic, ...]

    def compiled(self) -> dict[str, Any]:
        """Return the form."""
        read: dict[str, Any] = json.loads(self.form)
        return read


@dataclass(frozen=True, slots=True)
class _Compiling:
    document: Mapping[str, Any]
    surroundings: Surroundings
    revision: int
    with_plan: bool

    def done(self) -> Compilation:
        with paused_collector():
            compiled = look_at(self.document, self.surroundings).compiled(with_plan=self.with_plan)
        return Compilation(
            form=json.dumps(compiled_to_json(compiled, self.revision)),
            plan=None if compiled.plan is None else json.dumps(plan_to_json(compiled.plan)),
            summary=summary_of(self.document, compiled),
            parameters=tuple(compiled.tree.parameters),
            errors=tuple(each for each in compiled.diagnostics if each.severity == "error"),
        )


@dataclass(frozen=True, slots=True)
class _Fitting:
    document: Mapping[str, Any]
    surroundings: Surroundings
    given: Mapping[str, Scalar]

    def done(self) -> tuple[Misfit, ...]:
        with paused_collector():
            misfit = find_misfit(self.document, self.surroundings, self.given)
        return () if misfit is None else (misfit,)


@dataclass(frozen=True, slots=True)
class _Printing:
    document: Mapping[str, Any]
    surroundings: Surroundings

    def done(self) -> str:
        return compile_document(self.document, self.surroundings).script


def compile_program(
    document: Mapping[str, Any], surroundings: Surroundings, *, revision: int = 0, with_plan: bool = False
) -> Compilation:
    """Compile a document for a site; `revision` is the number of the look."""
    return work.do(_Compiling(document, surroundings, revision, with_plan), work.size_of(document))


def find_misfit_of_program(
    document: Mapping[str, Any], surroundings: Surroundings, given: Mapping[str, Scalar]
) -> Misfit | None:
    """Return the first parameter whose device cannot do what the program does with it; None where all can."""
    return next(iter(work.do(_Fitting(document, surroundings, given), work.size_of(document))), None)


def print_program(document: Mapping[str, Any], surroundings: Surroundings) -> str:
    """Return a document's script."""
    return work.do(_Printing(document, surroundings), work.size_of(document))

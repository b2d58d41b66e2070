"""What is compared: two sides, each a version of a program or the program as it is drawn now."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal
from uuid import UUID

from editor import services
from editor.errors import DocumentHole, NoSuchProgram, UnreadableVersion
from editor.language.comparison.difference import Difference, compare
from editor.library.queries import get_function
from editor.library.updates import body_as_program
from editor.programs.compilations import compile_program
from editor.programs.views import VersionView

Problem = Literal["", "missing", "unreadable"]


@dataclass(frozen=True, slots=True)
class Side:
    """One side of a comparison; `version` is None for what is drawn now.

    The compiled form is without diagnostics, of which `errors` is the number. Where there is a `problem` there is
    neither a document nor its compiled form.
    """

    version: VersionView | None
    document: Mapping[str, Any] | None
    compiled: Mapping[str, Any] | None
    problem: Problem
    errors: int = 0


@dataclass(frozen=True, slots=True)
class Content:
    """A version of a program, or without `number` what is drawn now."""

    program: UUID
    number: int | None


@dataclass(frozen=True, slots=True)
class Comparison:
    """Two sides, and how they differ where both can be read."""

    old: Side
    new: Side
    difference: Difference | None


def compare_sides(*, site: str, old: Content, new: Content) -> Comparison:
    """Compare two contents, both as programs of one site. Raises NoSuchProgram."""
    surroundings = services.build_surroundings(site=site)
    first = _side(old.program, old.number, surroundings)
    sides = [first, first if new == old else _side(new.program, new.number, surroundings)]
    documents = [side.document for side in sides]
    readable = None not in documents
    found = compare(documents[0] or {}, documents[1] or {}) if readable else None
    return Comparison(sides[0], sides[1], found)


def compare_functions(*, function_id: UUID, site: str, user: Any, old: int, new: int | None) -> Comparison:
    """Compare the bodies of two versions of a library function, as programs of a site; without `new` with the newest.

    Raises NoSuchProgram.
    """
    surroundings = services.build_surroundings(site=site)
    views = [get_function(function_id=function_id, user=user, version=number) for number in (old, new)]
    documents = [body_as_program(view.definition) for view in views]
    sides = [_compiled_side(None, document, surroundings) for document in documents]
    return Comparison(sides[0], sides[1], compare(documents[0], documents[1]))


def _side(program_id: UUID, number: int | None, surroundings: Any) -> Side:
    try:
        version = None if number is None else services.find_version(program_id=program_id, number=number)
        document = services.get_document(program_id=program_id) if version is None else version.document
    except (UnreadableVersion, DocumentHole):
        return Side(None, None, None, "unreadable")
    except NoSuchProgram:
        services.get_program(program_id=program_id)  # of a program that is gone there is nothing to compare
        return Side(None, None, None, "missing")
    return _compiled_side(version, document, surroundings)


def _compiled_side(version: VersionView | None, document: Mapping[str, Any], surroundings: Any) -> Side:
    compilation = compile_program(document, surroundings)
    form = {**compilation.compiled(), "diagnostics": []}
    return Side(version, document, form, "", len(compilation.errors))

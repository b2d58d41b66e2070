"""The library over HTTP: found, shown, saved, made anew, compared, and who holds what."""

from __future__ import annotations

from typing import Any
from uuid import UUID

from django.http import HttpRequest, HttpResponse
from ninja import Query, Router
from ninja.responses import Status

from editor.library import functions, queries, uses
from editor.library.shapes import (
    MOST_VERSION,
    FitAsked,
    FunctionChange,
    FunctionComparisonShape,
    FunctionToFork,
    FunctionToSave,
    LibraryAsked,
    LibraryShape,
    LibraryVersionShape,
    UsesShape,
    compared_to_json,
    function_to_json,
    uses_to_json,
    version_to_json,
)
from editor.programs.access import require_here
from registry.requests import refuses, signed_in, tell_rest
from registry.services import Listed, require

router = Router(tags=["editor"])


@router.get("/library", response=list[LibraryShape])
def search_library(request: HttpRequest, response: HttpResponse, asked: Query[LibraryAsked]) -> list[dict[str, Any]]:
    """Search the functions that the asker sees by name, description and what they do: those of one site, or all.

    The header `Link` names the next part.
    """
    for site in (asked.site, asked.fits):
        if site:
            require(request.user, site, "viewer")
    found = queries.search_library(
        user=signed_in(request),
        site=asked.site,
        query=asked.q,
        fits=asked.fits,
        only_fitting=asked.only_fitting,
        page=asked.page(),
    )
    shown: Listed[dict[str, Any]] = Listed(function_to_json(view) for view in found)
    shown.rest = found.rest
    return tell_rest(request, response, shown)


@router.post("/sites/{slug}/library", response={201: LibraryShape}, openapi_extra=refuses(409))
def save_function(request: HttpRequest, slug: str, body: FunctionToSave) -> Status[dict[str, Any]]:
    """Save a program's function into the library; under a name of the asker's own, as its next version."""
    require(request.user, slug, "author")
    saved = functions.save_function(
        site=slug,
        program_id=body.program,
        function=body.function,
        said=functions.Said(body.name, body.description, body.visibility),
        user=request.user,
    )
    return Status(201, function_to_json(saved))


@router.post("/sites/{slug}/library/forks", response={201: LibraryShape}, openapi_extra=refuses(409))
def fork_function(request: HttpRequest, slug: str, body: FunctionToFork) -> Status[dict[str, Any]]:
    """Make a function that the asker sees anew at a site; it keeps which one it was made from."""
    require(request.user, slug, "author")
    made = functions.fork_function(
        site=slug,
        function_id=body.function,
        version=body.version,
        said=functions.Said(body.name, body.description, body.visibility),
        user=signed_in(request),
    )
    return Status(201, function_to_json(made))


@router.get("/library/{function}", response=LibraryShape)
def show_function(request: HttpRequest, function: UUID, asked: Query[FitAsked]) -> dict[str, Any]:
    """Show the newest version of a library function."""
    if asked.fits:
        require(request.user, asked.fits, "viewer")
    return function_to_json(queries.get_function(function_id=function, user=signed_in(request), fits=asked.fits))


@router.patch("/library/{function}", response=LibraryShape, openapi_extra=refuses(409))
def change_function(request: HttpRequest, function: UUID, body: FunctionChange) -> dict[str, Any]:
    """Change who sees a library function, or what is said of it; its author does so, or an admin of its site."""
    user = signed_in(request)
    found = queries.get_function(function_id=function, user=user)
    require_here(user, found.site, "author")
    changed = functions.change_function(
        function_id=function, user=user, visibility=body.visibility, description=body.description
    )
    return function_to_json(changed)


@router.get("/library/{function}/versions", response=list[LibraryVersionShape])
def list_function_versions(request: HttpRequest, function: UUID) -> list[dict[str, Any]]:
    """List the last 200 versions of a library function, the newest first, each with what it changed for callers."""
    return [
        version_to_json(each) for each in queries.list_function_versions(function_id=function, user=signed_in(request))
    ]


@router.get("/library/{function}/versions/{number}", response=LibraryShape)
def show_function_version(request: HttpRequest, function: UUID, number: int) -> dict[str, Any]:
    """Show a library function as it was saved under a number."""
    return function_to_json(queries.get_function(function_id=function, user=signed_in(request), version=_sound(number)))


@router.get("/library/{function}/comparison", response=FunctionComparisonShape)
def compare_function(request: HttpRequest, function: UUID, old: int, new: int | None = None) -> dict[str, Any]:
    """Compare two versions of a library function, without `new` with the newest: compatible or breaking, and why."""
    numbers = _sound(old), None if new is None else _sound(new)
    return compared_to_json(
        queries.compare_function(function_id=function, user=signed_in(request), old=numbers[0], new=numbers[1])
    )


@router.get("/library/{function}/uses", response=UsesShape)
def list_function_uses(request: HttpRequest, function: UUID) -> dict[str, Any]:
    """List the programs and functions that hold a library function, as far as the asker sees them."""
    return uses_to_json(uses.list_uses(function_id=function, user=signed_in(request)))


def _sound(number: int) -> int:
    """Return a version's number, 0 for what is none: the database knows only such as fit."""
    return number if 0 < number < MOST_VERSION else 0

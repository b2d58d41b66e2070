"""Promotions over HTTP: who can stand for whom at another site, a program made there, and where one came from."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any
from uuid import UUID

from django.http import HttpRequest
from ninja import Router
from ninja.responses import Status

from editor.programs.access import program_for
from editor.programs.views import ProgramView
from editor.promotions import promotion
from editor.promotions.shapes import MaybeOriginShape, ProgramToPromote, PromotionLookShape, SiteAsked
from editor.shapes import ProgramShape
from registry.requests import refuses, signed_in
from registry.services import list_sites, require

router = Router(tags=["editor"])


@router.post("/programs/{program}/promotion/look", response=PromotionLookShape)
def look_at_promotion(request: HttpRequest, program: UUID, body: SiteAsked) -> promotion.Look:
    """Tell who at another site can stand for the devices and places of a program; nothing is made."""
    found = program_for(request.user, program, "author")
    require(request.user, body.site, "author")
    return promotion.look_at_promotion(program=found, site=body.site)


@router.post("/programs/{program}/promotion", response={201: ProgramShape}, openapi_extra=refuses(409))
def promote_program(request: HttpRequest, program: UUID, body: ProgramToPromote) -> Status[ProgramView]:
    """Make a program anew at another site where the asker draws, as it is now; what has no match becomes a hole."""
    found = program_for(request.user, program, "author")
    require(request.user, body.site, "author")
    made = promotion.promote_program(
        program=found, site=body.site, name=body.name, chosen=body.chosen, user=signed_in(request)
    )
    return Status(201, made)


@router.get("/programs/{program}/origin", response=MaybeOriginShape)
def show_program_origin(request: HttpRequest, program: UUID) -> dict[str, Any]:
    """Show which program of another site a program was made from, and which were made from it."""
    program_for(request.user, program, "viewer")
    sees = frozenset(site.slug for site in list_sites(user=signed_in(request)))
    found = promotion.find_origin(program_id=program, sees=sees)
    copies = [asdict(each) for each in promotion.list_copies(program_id=program, sees=sees)]
    if found is None:
        return {"origin": None, "copies": copies}
    source, version, newest = found
    return {
        "origin": {
            "id": source.id,
            "name": source.name,
            "site": source.site,
            "version": version,
            "newest": newest,
        },
        "copies": copies,
    }

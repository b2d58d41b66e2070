"""Reviews over HTTP: what a site demands, how a content stands, asking and approving."""

from __future__ import annotations

from uuid import UUID

from django.http import HttpRequest
from ninja import Query, Router

from editor.errors import NeedsPerson
from editor.programs.access import program_for
from editor.reviews import reviews, rules
from editor.reviews.shapes import (
    AskedReviewShape,
    ReviewRuleShape,
    ReviewShape,
    ReviewToAsk,
    SetReviewRule,
    VerdictToGive,
    VersionAsked,
    review_to_shape,
)
from registry.requests import refuses, signed_in
from registry.services import require

router = Router(tags=["editor"])
_MAY_REFUSE = refuses(409)


@router.get("/sites/{slug}/review-rule", response=ReviewRuleShape)
def show_review_rule(request: HttpRequest, slug: str) -> rules.Rule:
    """Show how many approvals the site demands before a program may run on its devices, and of whom."""
    require(request.user, slug, "viewer")
    return rules.get_rule(site=slug)


@router.put("/sites/{slug}/review-rule", response=ReviewRuleShape)
def set_review_rule(request: HttpRequest, slug: str, body: SetReviewRule) -> rules.Rule:
    """Choose what the site demands from now on, or a part of it; runs that are under way go on."""
    require(request.user, slug, "admin")
    return rules.set_rule(site=slug, approvals=body.approvals, least_role=body.least_role)


@router.get("/sites/{slug}/reviews", response=list[AskedReviewShape])
def list_asked_reviews(request: HttpRequest, slug: str) -> list[reviews.AskedReview]:
    """List the versions of the site that wait for the asker's review; none for who may not approve here."""
    require(request.user, slug, "viewer")
    return reviews.list_asked(site=slug, user=signed_in(request))


@router.get("/programs/{program}/review", response=ReviewShape, openapi_extra=_MAY_REFUSE)
def show_review(request: HttpRequest, program: UUID, asked: Query[VersionAsked]) -> ReviewShape:
    """Show how a version stands, or the program as it is drawn now: who approved it, what is missing for a run."""
    program_for(request.user, program, "viewer")
    return _show(request, program, asked.version)


@router.post("/programs/{program}/review/ask", response=ReviewShape, openapi_extra=_MAY_REFUSE)
def ask_for_review(request: HttpRequest, program: UUID, body: ReviewToAsk) -> ReviewShape:
    """Ask for a review of a version, or of the program as it is drawn now, which becomes a version."""
    program_for(request.user, program, "operator", "run")
    number = reviews.ask_for_review(program_id=program, user=signed_in(request), number=body.version, note=body.note)
    return _show(request, program, number)


@router.post("/programs/{program}/review", response=ReviewShape, openapi_extra=_MAY_REFUSE)
def give_verdict(request: HttpRequest, program: UUID, body: VerdictToGive) -> ReviewShape:
    """Approve a version's content, ask for changes of it, or withdraw what one has said of it."""
    person = signed_in(request)
    if person.grant is not None:
        raise NeedsPerson("A person reviews, and no token. Sign in to say what you think of this version.")
    program_for(person, program, "operator")
    reviews.give_verdict(program_id=program, user=person, number=body.version, verdict=body.verdict, note=body.note)
    return _show(request, program, body.version)


def _show(request: HttpRequest, program: UUID, number: int | None) -> ReviewShape:
    person = signed_in(request)
    return review_to_shape(reviews.show_review(program_id=program, user=person, number=number), person.pk)

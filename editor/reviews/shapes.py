"""The shapes of what is asked and answered about reviews."""

from __future__ import annotations

from datetime import datetime
from typing import Annotated, Literal
from uuid import UUID

from ninja import Field, Schema
from pydantic import Strict

from editor.reviews.reviews import MOST_NOTE, Review
from editor.reviews.rules import MOST_APPROVALS
from editor.reviews.standing import Word
from registry.requests import Asked

LeastRole = Literal["operator", "author", "admin"]
Number = Annotated[int, Strict(), Field(ge=1, lt=2**31)]
Count = Annotated[int, Strict(), Field(ge=0, le=MOST_APPROVALS)]


class ReviewRuleShape(Schema):
    """How many approvals a site demands before a run on its devices (0: none), and the least role that may approve."""

    approvals: int
    least_role: LeastRole


class SetReviewRule(Asked):
    """What a site shall demand from now on; what is not named stays as it is."""

    approvals: Count | None = None
    least_role: LeastRole | None = None


class VersionAsked(Asked):
    """Which version is asked about; without one, the program as it is drawn now."""

    version: int | None = Field(None, ge=1, lt=2**31)


class WordShape(Schema):
    """What somebody said about this content; `counts` says whether it still does."""

    name: str
    kind: Literal["asked", "approved", "changes", "withdrawn"]
    note: str
    number: int
    at: datetime
    counts: bool
    mine: bool


class ReviewShape(Schema):
    """How a program's content stands; `may_run` is what the gate would say now.

    `number` is the version that holds it, `compare_with` the one that was approved last before it. `why_not` says why
    the asker cannot approve it. `errors` and `warnings` are what the checker finds; null where nothing is reviewed.
    """

    needed: int
    least_role: LeastRole
    may_run: bool
    number: int | None
    compare_with: int | None
    why_not: Literal["", "role", "own"]
    errors: int | None
    warnings: int | None
    history: list[WordShape]


class AskedReviewShape(Schema):
    """A version that waits for the asker's review; `compare_with` is the one before it that was approved last."""

    program: UUID = Field(validation_alias="program_id")
    program_name: str = Field(validation_alias="program")
    number: int
    compare_with: int | None
    by: str
    note: str
    at: datetime


class ReviewToAsk(Asked):
    """Which version is to be reviewed (as it is drawn now if none), and what the reviewer should know."""

    version: Number | None = None
    note: str = Field("", max_length=MOST_NOTE)


class VerdictToGive(Asked):
    """What a reviewer says about a version; changes are asked for with a sentence."""

    version: Number
    verdict: Literal["approved", "changes", "withdrawn"]
    note: str = Field("", max_length=MOST_NOTE)


def review_to_shape(review: Review, person: int) -> ReviewShape:
    """Return a review as who asks for it sees it."""
    return ReviewShape(
        needed=review.rule.approvals,
        least_role=review.rule.least_role,
        may_run=review.standing.may_run,
        number=review.number,
        compare_with=review.compare_with,
        why_not=review.why_not,
        errors=review.errors,
        warnings=review.warnings,
        history=[_word(word, person) for word in review.standing.history],
    )


def _word(word: Word, person: int) -> WordShape:
    told = {name: getattr(word, name) for name in ("name", "kind", "note", "number", "at", "counts")}
    return WordShape(**told, mine=word.person == person)

"""The shapes of what is asked and answered about promotions."""

from __future__ import annotations

from typing import Annotated, Literal
from uuid import UUID

from ninja import Field, Schema

from editor.library.shapes import NeedShape
from registry.requests import Asked, Line

MOST_CHOSEN = 2_000


class SiteAsked(Asked):
    """To which site a program shall go."""

    site: Line = Field(max_length=100)


class ProgramToPromote(SiteAsked):
    """A program for another site: its name there, and who stands for whom; null leaves a hole."""

    name: Line = Field(max_length=200)
    chosen: Annotated[dict[str, Line | None], Field(max_length=MOST_CHOSEN)] = {}


class CandidateShape(Schema):
    """A device or place of the other site; `fits`: it can all that the steps want."""

    id: str
    name: str
    fits: bool


class BindingShape(Schema):
    """A device or place that a program names, with who may stand for it, the best first; null: nobody fits."""

    kind: Literal["device", "place"]
    id: str
    name: str
    need: NeedShape | None
    candidates: list[CandidateShape]
    proposed: str | None


class PromotionLookShape(Schema):
    """What has to be bound; points are left open and zones left out, as they are of this site's map."""

    bindings: list[BindingShape]
    points: int
    zones: int


class ProgramOriginShape(Schema):
    """What a program was made from, at which version of it, and which is its newest now."""

    id: UUID
    name: str
    site: str
    version: int
    newest: int


class ProgramCopyShape(Schema):
    """A program of another site that was made from a program, at which version of it, and its own newest version."""

    id: UUID
    name: str
    site: str
    version: int
    newest: int


class MaybeOriginShape(Schema):
    """What a program was made from; null if from nothing, or from what the asker does not see.

    `copies` are the programs of other sites that were made from it, as far as the asker sees them, at most 20.
    """

    origin: ProgramOriginShape | None
    copies: list[ProgramCopyShape]

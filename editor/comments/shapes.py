"""The shapes of what is asked and answered about comments."""

from __future__ import annotations

from datetime import datetime
from typing import Annotated
from uuid import UUID

from ninja import Field, Schema

from editor.comments.anchors import Anchor, Kind, Root
from editor.comments.anchors import Asked as AskedKind
from editor.comments.threads import Words
from editor.shapes import MOST_COMMENT, MOST_MENTIONS, Author
from registry.requests import Asked, Flag, Line, Number

Id = Annotated[Line, Field(min_length=1, max_length=120)]
Metres = Annotated[Number, Field(ge=-100_000, le=100_000)]


class AnchorShape(Schema):
    """What a thread is about: the program, a construct by root and id, an arrow, a place, or a moment of a run.

    An arrow leads from `id` to `to`. `x` and `y` are where its pin stood on the map, metres. A moment is `t_s` seconds
    after the start of the run `run`, the site's run `number`.
    """

    kind: Kind
    root: Root | None
    id: str | None
    to: str | None
    x: float | None
    y: float | None
    run: UUID | None
    number: int | None
    t_s: float | None


class CommentShape(Schema):
    """A comment; `mentions` are those whom it calls by `@` and their names."""

    id: UUID
    author: Author | None
    text: str
    mentions: list[Author]
    written_at: datetime
    edited_at: datetime | None


class ThreadShape(Schema):
    """A thread with its comments, the oldest first; `unread` counts those that the asker has not read."""

    id: UUID
    anchor: AnchorShape
    label: str
    stands: bool = Field(description="False once what it is about has been deleted from the program.")
    started_at: datetime
    resolved_at: datetime | None
    resolved_by: Author | None
    comments: list[CommentShape]
    unread: int


class WordsToWrite(Asked):
    """A comment to write; whom it mentions by their ids."""

    text: str = Field(min_length=1, max_length=MOST_COMMENT, pattern=r"\S")
    mentions: list[int] = Field([], max_length=MOST_MENTIONS)

    def words(self, origin: str) -> Words:
        """Return what is written, by somebody who reached VIPO at an address."""
        return Words(self.text, tuple(self.mentions), origin)


class AnchorAsked(Asked):
    """What a thread shall be about; see AnchorShape. A moment of a run is asked for at the run."""

    kind: AskedKind
    root: Root | None = None
    id: Id | None = None
    to: Id | None = None
    x: Metres | None = None
    y: Metres | None = None

    def anchor(self) -> Anchor:
        """Return what the thread is about."""
        return Anchor(kind=self.kind, root=self.root, id=self.id, to=self.to, x=self.x, y=self.y)


class ThreadToStart(WordsToWrite):
    """The first comment of a thread; `label` is what people call the thing that it is about."""

    anchor: AnchorAsked
    label: Line = Field("", max_length=120)


class ThreadChange(Asked):
    """Whether a thread is resolved."""

    resolved: Flag

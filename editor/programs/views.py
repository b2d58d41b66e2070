"""What the editor's services hand out: frozen, and free of the database."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any
from uuid import UUID


@dataclass(frozen=True, slots=True)
class AuthorView:
    """A person as the author of something."""

    id: int
    name: str
    initials: str


@dataclass(frozen=True, slots=True)
class ProgramView:
    """A program as lists show it; `kinds` are the kinds of its steps, `site` is a slug.

    `devices` and `places` are the ids that it names.
    """

    id: UUID
    site: str
    name: str
    kinds: tuple[str, ...]
    devices: tuple[str, ...]
    places: tuple[str, ...]
    edited_at: datetime
    edited_by: AuthorView | None
    errors: int
    warnings: int


@dataclass(frozen=True, slots=True, kw_only=True)
class VersionView:
    """A version as lists show it: `author` made it, `authors` had drawn since the one before.

    `cause` is what it was made before by itself: run, rehearsal, import, restore; empty where somebody made it. `made`
    is True in the answer to who pinned just this one.
    """

    id: UUID
    program: UUID
    site: str
    number: int
    author: AuthorView | None
    authors: tuple[AuthorView, ...]
    name: str
    message: str
    cause: str
    created_at: datetime
    made: bool = field(default=False, compare=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class WholeVersionView(VersionView):
    """A version with its document, in today's format, and the script as it was printed then."""

    document: Mapping[str, Any]
    script: str


def view_author(user: Any) -> AuthorView | None:
    """Return the view of a user's row, or None."""
    return AuthorView(user.pk, user.display_name, user.initials) if user is not None else None

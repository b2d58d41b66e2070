"""What the API says of times of keeping, of what takes how many bytes, and of the archive."""

from __future__ import annotations

from typing import Annotated, Literal

from ninja import Field, Schema
from pydantic import Strict

from execution.retention.periods import MOST_DAYS
from registry.requests import Asked

Days = Annotated[int, Strict(), Field(ge=0, le=MOST_DAYS)]
Kind = Literal["runs", "rehearsals", "calls"]


class SetKeeping(Asked):
    """For how many days a site keeps what has ended; 0: for ever, null: as the server's settings say.

    What is not named stays as it is.
    """

    runs: Days | None = None
    rehearsals: Days | None = None
    calls: Days | None = None


class KeepingShape(Schema):
    """A kind's time of keeping in days (0: for ever): what holds, what the site has chosen, and the server's."""

    kind: Kind
    days: int
    chosen: int | None
    server: int


class ProgramBytesShape(Schema):
    """How many bytes the histories of a program take: as rows, by what they are, and in files of the archive."""

    program: str
    name: str
    runs: int
    journals: int
    commands: int
    rehearsals: int
    archived: int


class ArchiveShape(Schema):
    """A file of the archive: how many histories are in it, when they ended, and how many bytes it has."""

    id: str
    kind: Kind
    file: str
    count: int
    bytes: int
    first_at: str
    last_at: str
    made_at: str


class RetentionShape(Schema):
    """Times of keeping, what takes how much, the newest 50 files of the archive, and what keeps it from growing.

    `calls` are the bytes of what was told devices outside of runs, as rows and in files.
    """

    keeping: list[KeepingShape]
    trouble: str
    trouble_at: str | None
    programs: list[ProgramBytesShape]
    calls: int
    calls_archived: int
    archives: list[ArchiveShape]
    archive_count: int
    archive_bytes: int

"""The shapes of what is asked and answered about the library."""

from __future__ import annotations

from datetime import datetime
from typing import Any, Literal, Self, get_args
from uuid import UUID

from ninja import Field, Schema
from pydantic import model_validator

from editor.language.signatures.compatibility import Code, Reason
from editor.library.queries import LibraryView, VersionLine, VersionsCompared
from editor.library.uses import FunctionUses
from editor.shapes import Author, Definition, Parameters
from registry.requests import Asked, Line, PartAsked

Visibility = Literal["me", "site", "everyone"]
MOST_VERSION = 1_000_000_000


class LibraryAsked(PartAsked):
    """Which functions are asked for: those that all words of `q` fit, by name or by what they do; of one site if named.

    With `fits`, the name of a site, each tells what the devices there cannot do of it; with `only_fitting` those are
    left out of which they lack anything.
    """

    q: Line = Field("", max_length=200)
    site: Line = Field("", max_length=100)
    fits: Line = Field("", max_length=100)
    only_fitting: bool = False

    @model_validator(mode="after")
    def _fits_somewhere(self) -> Self:
        if self.only_fitting and not self.fits:
            raise ValueError("Name with fits the site whose devices shall lack nothing.")
        return self


class FitAsked(Asked):
    """For which site's devices it is worked out what they cannot do."""

    fits: Line = Field("", max_length=100)


class FunctionToSave(Asked):
    """A function of a program that shall go into the library."""

    program: UUID
    function: Line = Field(max_length=100)
    name: Line = Field(max_length=200)
    description: str = Field("", max_length=500)
    visibility: Visibility | None = Field(None, description="Who sees it; as it was, if left out: the site at first.")


class FunctionToFork(Asked):
    """A function of the library that shall be made anew at a site, as it is at a version, or the newest."""

    function: UUID
    version: int | None = Field(None, ge=1, le=MOST_VERSION)
    name: Line = Field(max_length=200)
    description: str = Field("", max_length=500)
    visibility: Visibility | None = Field(None, description="Who sees it; the site, if left out.")


class FunctionChange(Asked):
    """What of a library function shall be otherwise; what is left out stays."""

    visibility: Visibility | None = None
    description: str | None = Field(None, max_length=500)


class ReasonShape(Schema):
    """Something that is otherwise for who calls a newer version; `breaks`: calls that stand may not hold.

    `name` is the value's, role's or device's; `old` and `new` are types, units, defaults as JSON, or abilities.
    """

    code: Literal[get_args(Code)]  # type: ignore[valid-type]
    breaks: bool
    name: str
    old: str
    new: str
    of: Literal["", "robot", "machine", "parameter"]


class NeedShape(Schema):
    """What no device of a site can: `of` says whether a robot, a machine or a device that is given must."""

    of: Literal["robot", "machine", "parameter"]
    name: str
    methods: list[str]
    gives: list[str]
    takes: list[str]
    readings: list[str]


class OriginShape(Schema):
    """What a function was made from, at which version of it, and which is its newest now."""

    id: UUID
    name: str
    site: str
    version: int
    newest: int


class LibraryShape(Schema):
    """A library function at one of its versions; `mine` is whether who asks may change it."""

    id: UUID
    site: str
    name: str
    description: str
    version: int
    author: Author | None
    parameters: Parameters
    used_in: int
    updated_at: datetime
    script: str
    definition: Definition
    visibility: Visibility
    mine: bool
    lacks: list[NeedShape] | None = Field(
        description="What no device of the site named by `fits` can do of it; null where none is named."
    )
    origin: OriginShape | None = Field(description="What it was made from, if the asker sees that.")
    reasons: list[ReasonShape] | None = Field(
        description="What is otherwise since the version before; null for the first version, and in lists."
    )


class LibraryVersionShape(Schema):
    """A version of a function; `reasons` is what is otherwise since the one before it, null for the first."""

    number: int
    author: Author | None
    created_at: datetime
    reasons: list[ReasonShape] | None


class FunctionComparisonShape(Schema):
    """Two versions of a function, and what is otherwise for who calls it."""

    old: LibraryShape
    new: LibraryShape
    reasons: list[ReasonShape]


class ProgramUseShape(Schema):
    """A program that holds a function, and at which versions."""

    id: UUID
    name: str
    site: str
    versions: list[int]


class FunctionUseShape(Schema):
    """A function of the library whose newest version holds another, and at which versions of that."""

    id: UUID
    name: str
    site: str
    version: int
    versions: list[int]


class UsesShape(Schema):
    """Who holds a function, as far as the asker sees them; `hidden` is how many more programs there are."""

    programs: list[ProgramUseShape]
    functions: list[FunctionUseShape]
    hidden: int


def function_to_json(view: LibraryView) -> dict[str, Any]:
    """Return a library function in its shape."""
    fields = {name: getattr(view, name) for name in view.__slots__}
    return {**fields, "reasons": reasons_to_json(view.reasons)}


def version_to_json(line: VersionLine) -> dict[str, Any]:
    """Return a version's line in its shape."""
    return {
        "number": line.number,
        "author": line.author,
        "created_at": line.created_at,
        "reasons": reasons_to_json(line.reasons),
    }


def compared_to_json(compared: VersionsCompared) -> dict[str, Any]:
    """Return two versions in their shape."""
    sides = {name: function_to_json(getattr(compared, name)) for name in ("old", "new")}
    return {**sides, "reasons": reasons_to_json(compared.reasons)}


def uses_to_json(uses: FunctionUses) -> dict[str, Any]:
    """Return who holds a function in its shape."""
    return {"programs": uses.programs, "functions": uses.functions, "hidden": uses.hidden}


def reasons_to_json(reasons: tuple[Reason, ...] | None) -> list[dict[str, Any]] | None:
    """Return reasons in their shape."""
    if reasons is None:
        return None
    return [{**{name: getattr(each, name) for name in each.__slots__}, "breaks": each.breaks} for each in reasons]

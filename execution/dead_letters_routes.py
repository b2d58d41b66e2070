"""What was set aside over HTTP: admins of a site look at it, try it again, or drop it."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from django.http import HttpRequest
from ninja import Query, Router, Schema

from execution import services
from execution.errors import NotFound
from registry.requests import Asked, Unchecked
from registry.services import NotAMember, require

router = Router(tags=["execution"])
LetterState = Literal["open", "retried", "dropped"]


class DeadLetterShape(Schema):
    """Something that `target` could not take in: which run it concerns, what it says, and how it failed."""

    id: int
    site: str
    run: str | None
    run_number: int | None
    run_status: Literal["pending", "running", "paused", "finished", "failed", "cancelled"] | None
    target: Literal["run", "floor"]
    event: Annotated[Any, Unchecked(dict[str, Any])]
    error: str
    at: str
    state: LetterState
    settled_by: str
    settled_at: str | None


class DeadLettersAsked(Asked):
    """Which are asked for: all of the site, or those in one `state`; `settled` is all that is not open any more."""

    state: LetterState | Literal["settled"] | None = None


@router.get("/sites/{slug:site}/dead-letters", response=list[DeadLetterShape])
def list_dead_letters(request: HttpRequest, site: str, asked: Query[DeadLettersAsked]) -> list[dict[str, Any]]:
    """Return what was set aside at a site because it raised, at most 200, the newest or what was settled last first."""
    require(request.user, site, "admin")
    return [_to_json(letter) for letter in services.list_dead_letters(site=site, state=asked.state)]


@router.post("/dead-letters/{int:letter}/retry", response=DeadLetterShape)
def retry_dead_letter(request: HttpRequest, letter: int) -> dict[str, Any]:
    """Give something that was set aside to its run once more, and let the run go on."""
    _require_here(request, letter)
    return _to_json(services.retry_dead_letter(letter_id=letter, by=_who(request)))


@router.post("/dead-letters/{int:letter}/drop", response=DeadLetterShape)
def drop_dead_letter(request: HttpRequest, letter: int) -> dict[str, Any]:
    """Say that something that was set aside is not wanted any more; its run stays as it is."""
    _require_here(request, letter)
    return _to_json(services.drop_dead_letter(letter_id=letter, by=_who(request)))


def _require_here(request: HttpRequest, letter: int) -> None:
    """Let admins through; a stranger gets the very answer that they get for what does not exist."""
    try:
        require(request.user, services.site_of_dead_letter(letter_id=letter), "admin")
    except NotAMember as error:
        raise NotFound("Nothing of that number was set aside.") from error


def _who(request: HttpRequest) -> str:
    return str(getattr(request.user, "display_name", "") or request.user)


def _to_json(letter: services.DeadLetterView) -> dict[str, Any]:
    return {
        "id": letter.id,
        "site": letter.site,
        "run": str(letter.run) if letter.run else None,
        "run_number": letter.run_number,
        "run_status": letter.run_status,
        "target": letter.target,
        "event": letter.event,
        "error": letter.error,
        "at": letter.at.isoformat(),
        "state": letter.state,
        "settled_by": letter.settled_by,
        "settled_at": letter.settled_at.isoformat() if letter.settled_at else None,
    }

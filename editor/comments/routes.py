"""The comments of a program over HTTP."""

from __future__ import annotations

from uuid import UUID

from django.http import HttpRequest
from django.utils import timezone
from ninja import Router
from ninja.responses import Status

from editor.comments import threads
from editor.comments.shapes import ThreadChange, ThreadShape, ThreadToStart, WordsToWrite
from editor.comments.threads import ThreadView
from editor.programs.access import program_for
from editor.shapes import Author
from registry import services as registry
from registry.requests import origin_of, refuses, signed_in
from registry.services import PersonView

router = Router(tags=["editor"])
_BOUNDED, _MAY_BE_ANOTHERS = refuses(409, 429), refuses(409)


@router.get("/programs/{program}/threads", response=list[ThreadShape])
def list_threads(request: HttpRequest, program: UUID) -> list[ThreadView]:
    """List a program's threads of comments, the last written in first."""
    program_for(request.user, program, "viewer")
    return list(threads.list_threads(program=program, user=signed_in(request)))


@router.get("/programs/{program}/threads/{thread}", response=ThreadShape)
def show_thread(request: HttpRequest, program: UUID, thread: UUID) -> ThreadView:
    """Return a thread with its comments."""
    program_for(request.user, program, "viewer")
    return threads.get_thread(program=program, thread=thread, user=signed_in(request))


@router.post("/programs/{program}/threads", response={201: ThreadShape}, openapi_extra=_BOUNDED)
def start_thread(request: HttpRequest, program: UUID, body: ThreadToStart) -> Status[ThreadView]:
    """Begin a thread with its first comment; at most 20 comments of a person within a minute."""
    program_for(request.user, program, "commenter")
    made = threads.start_thread(
        program=program,
        user=signed_in(request),
        anchor=body.anchor.anchor(),
        label=body.label,
        words=body.words(origin_of(request)),
        now=timezone.now(),
    )
    return Status(201, made)


@router.post("/programs/{program}/threads/{thread}/comments", response={201: ThreadShape}, openapi_extra=_BOUNDED)
def answer_thread(request: HttpRequest, program: UUID, thread: UUID, body: WordsToWrite) -> Status[ThreadView]:
    """Write an answer into a thread; the answer is the whole thread."""
    program_for(request.user, program, "commenter")
    user, now = signed_in(request), timezone.now()
    return Status(
        201,
        threads.answer_thread(program=program, thread=thread, user=user, words=body.words(origin_of(request)), now=now),
    )


@router.patch("/programs/{program}/threads/{thread}", response=ThreadShape)
def change_thread(request: HttpRequest, program: UUID, thread: UUID, body: ThreadChange) -> ThreadView:
    """Mark a thread as resolved, or open it again."""
    program_for(request.user, program, "commenter")
    user, now = signed_in(request), timezone.now()
    return threads.resolve_thread(program=program, thread=thread, user=user, resolved=body.resolved, now=now)


@router.post("/programs/{program}/threads/{thread}/read", response={204: None})
def mark_thread_read(request: HttpRequest, program: UUID, thread: UUID) -> Status[None]:
    """Note that the asker has read a thread up to now."""
    program_for(request.user, program, "viewer")
    threads.mark_read(program=program, thread=thread, user=signed_in(request), to=timezone.now())
    return Status(204, None)


@router.patch("/programs/{program}/comments/{comment}", response=ThreadShape, openapi_extra=_MAY_BE_ANOTHERS)
def change_comment(request: HttpRequest, program: UUID, comment: UUID, body: WordsToWrite) -> ThreadView:
    """Write one's own comment anew; the answer is its thread."""
    program_for(request.user, program, "commenter")
    user, now = signed_in(request), timezone.now()
    return threads.change_comment(
        program=program, comment=comment, user=user, words=body.words(origin_of(request)), now=now
    )


@router.delete("/programs/{program}/comments/{comment}", response={204: None}, openapi_extra=_MAY_BE_ANOTHERS)
def delete_comment(request: HttpRequest, program: UUID, comment: UUID) -> Status[None]:
    """Delete one's own comment; admins delete any. A thread goes with its last comment."""
    found = program_for(request.user, program, "commenter")
    user = signed_in(request)
    access = registry.require(user, found.site, "commenter")
    threads.delete_comment(program=program, comment=comment, user=user, is_admin=access.allows("admin"))
    return Status(204, None)


@router.get("/programs/{program}/people", response=list[Author])
def list_people_to_mention(request: HttpRequest, program: UUID) -> list[PersonView]:
    """List whom a comment may mention: the members of the site by name, without their addresses."""
    found = program_for(request.user, program, "commenter")
    return list(registry.list_people(site=found.site))

"""MTConnect documents one after another over one answer: `interval` and `heartbeat`, bounded in time, bytes, number."""

from __future__ import annotations

import asyncio
import threading
import time
from collections import Counter
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace

from asgiref.sync import sync_to_async
from django.utils import timezone

from registry.mtconnect.agent import AgentError, Answer, Question, agent_of, next_number, whole
from registry.mtconnect.documents import Agent, write_error
from registry.people.sessions import Session
from registry.people.watch import Seat, seated

BOUNDARY = "vipo-mtconnect-part"
MEDIA_TYPE = f"multipart/x-mixed-replace;boundary={BOUNDARY}"
LEAST_PAUSE_S = 1.0
MOST_INTERVAL_MS, MOST_HEARTBEAT_MS = 3_600_000, 60_000
HEARTBEAT_MS = 10_000
REST = 20.0
"""So many times as long as a document took there is a pause before the next: a large site's cost no core."""
MOST_BYTES = 4_000_000
"""A listener that does not read leaves at most so much in memory; one that reads asks again with its next number."""
MOST_SECONDS = 900.0
MOST_OF_PERSON, MOST_OF_SITE, MOST_IN_PROCESS = 4, 16, 32
_open: Counter[str] = Counter()
_lock = threading.Lock()


@dataclass(frozen=True, slots=True)
class Listener:
    """Whose session listens to which documents of a site; a sample goes on with its number, `current` comes whole."""

    session: Session
    site: str
    write: Callable[[Agent, Question], Answer]
    question: Question
    is_sample: bool


@dataclass(frozen=True, slots=True)
class Rhythm:
    """How long to wait at least between two documents, and how long at most when nothing happens."""

    pause_s: float
    heartbeat_s: float


def read_rhythm(question: Question, interval: str, heartbeat: str | None) -> Rhythm:
    """Read both, in milliseconds. Raises AgentError."""
    if question.at is not None:
        raise AgentError("INVALID_REQUEST", "`at` and `interval` cannot be asked together: what was does not change.")
    pause_s = whole("interval", interval, 0, 0, MOST_INTERVAL_MS) / 1000
    heartbeat_s = whole("heartbeat", heartbeat, HEARTBEAT_MS, 1, MOST_HEARTBEAT_MS) / 1000
    return Rhythm(max(LEAST_PAUSE_S, pause_s), max(LEAST_PAUSE_S, heartbeat_s))


def check_room(listener: Listener) -> None:
    """Raise AgentError when this person, this site or this process has as many streams as it may."""
    for key, most, whose in _places(listener):
        if _open[key] >= most:
            raise AgentError("TOO_MANY", f"{most} streams are open {whose}. Close one, or ask without `interval`.")


def _places(listener: Listener) -> tuple[tuple[str, int, str], ...]:
    return (
        (f"person {listener.session.person}", MOST_OF_PERSON, "for you"),
        (f"site {listener.site}", MOST_OF_SITE, "at this site"),
        ("all", MOST_IN_PROCESS, "at this server"),
    )


@contextmanager
def _counted(listener: Listener) -> Iterator[None]:
    keys = [key for key, _, _ in _places(listener)]
    with _lock:
        check_room(listener)
        _open.update(keys)
    try:
        yield
    finally:
        with _lock:
            _open.subtract(keys)
            for key in keys:
                if not _open[key]:
                    del _open[key]


async def stream_documents(listener: Listener, rhythm: Rhythm, first: Answer) -> AsyncIterator[bytes]:
    """Give a first document, then each when it is due, as parts of one answer.

    It ends when the listener is signed out or no member any more, when what is asked of has gone (an error is the
    last part), and after MOST_SECONDS or MOST_BYTES.
    """
    until, left, answer, took_s = time.monotonic() + MOST_SECONDS, MOST_BYTES, first, 0.0
    with suppress(AgentError), _counted(listener):
        async with seated(listener.session, _nothing) as seat:
            while True:
                part = _part(answer.document)
                left -= len(part)
                yield part
                pause_s = max(rhythm.pause_s, REST * took_s)
                if left <= 0 or not await _wait(listener, seat, replace(rhythm, pause_s=pause_s), answer, until):
                    break
                begun = time.monotonic()
                answer, is_last = await sync_to_async(_next_answer)(listener, answer)
                took_s = time.monotonic() - begun
                if is_last:
                    yield _part(answer.document)
                    break
            yield f"--{BOUNDARY}--\r\n".encode()


def _nothing() -> None:
    """A change of the session's standing is seen before the next document."""


async def _wait(listener: Listener, seat: Seat, rhythm: Rhythm, last: Answer, until: float) -> bool:
    """Wait until the next document is due; False when there is to be none."""
    begun = time.monotonic()
    while time.monotonic() < until:
        await asyncio.sleep(LEAST_PAUSE_S)
        if seat.standing is None or not seat.standing.allows(listener.site, "viewer"):
            return False
        following = await sync_to_async(next_number)()
        waited_s = time.monotonic() - begun
        has_news = not listener.is_sample or following > last.next or waited_s >= rhythm.heartbeat_s
        if has_news and waited_s >= rhythm.pause_s:
            return True
    return False


def _next_answer(listener: Listener, last: Answer) -> tuple[Answer, bool]:
    """Return the next document, and whether it is the last one, which says what is wrong."""
    agent = agent_of(site=listener.site, now=timezone.now())
    question = replace(listener.question, begin=str(last.next)) if listener.is_sample else listener.question
    try:
        return listener.write(agent, question), False
    except AgentError as error:
        return Answer(write_error(agent, error.code, error.sentence), last.next), True


def _part(document: bytes) -> bytes:
    head = f"--{BOUNDARY}\r\nContent-type: text/xml\r\nContent-length: {len(document)}\r\n\r\n"
    return head.encode() + document + b"\r\n"

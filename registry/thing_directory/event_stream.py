"""Server-sent events of a directory of Things: one stream for each listener, bounded in time, bytes and number."""

from __future__ import annotations

import asyncio
import json
import threading
import time
from collections import Counter
from collections.abc import AsyncIterator, Callable, Collection, Iterator
from contextlib import asynccontextmanager, contextmanager, suppress
from dataclasses import dataclass
from typing import Any

from asgiref.sync import sync_to_async

from registry.devices.things import THINGS, ThingNews, is_kept_since, newest_news, read_news
from registry.errors import RegistryError
from registry.live.fanout import Message, listen
from registry.people.sessions import Session
from registry.people.watch import Seat, seated
from vipo_device.descriptions.thing_description import DEVICE_URN

MOST_AT_ONCE = 50
MOST_BYTES = 1_000_000
MOST_SECONDS = 900.0
MOST_STREAMS, MOST_FOR_PERSON = 50, 10
HEARTBEAT_S = 15.0
RETRY_MS = 2000
RIGHTS = ("members", "hello")
"""Messages after which somebody may have lost the right to hear more."""
_open: Counter[int] = Counter()
_lock = threading.Lock()


class TooManyStreams(RegistryError):
    """This process serves as many streams as it may, in all or to this person."""

    code = "too_many_streams"
    status = 429


@dataclass(frozen=True, slots=True)
class Listener:
    """Who hears what: the sites that the session's person may see, or one of them; `diff` asks for the changes.

    `root` is where VIPO is served, the base of new Things.
    """

    session: Session
    site: str | None
    kinds: Collection[str]
    diff: bool
    root: str = ""


@dataclass(frozen=True, slots=True)
class Heard:
    """What a listener is to be told next: the sites it may see, the news, and the id up to which it has heard all."""

    sites: frozenset[str]
    news: tuple[ThingNews, ...]
    until: int
    is_whole: bool


def check_room(person: int) -> None:
    """Raise TooManyStreams when no stream can be opened for this person."""
    if _open[person] >= MOST_FOR_PERSON or _open.total() >= MOST_STREAMS:
        raise TooManyStreams(
            f"{_open[person]} streams of events are open for you and {_open.total()} in all; "
            f"{MOST_FOR_PERSON} and {MOST_STREAMS} are the most. Close one, or try again later."
        )


@contextmanager
def counted(person: int) -> Iterator[None]:
    """Hold one of the places for streams. Raises TooManyStreams."""
    with _lock:
        check_room(person)
        _open[person] += 1
    try:
        yield
    finally:
        with _lock:
            _open[person] -= 1


async def stream_events(listener: Listener, last_id: str) -> AsyncIterator[bytes]:
    """Give events as text until the listener has got enough or may not hear them any more.

    A stream that ends is opened anew by its listener, who names the last event it heard and misses nothing.
    """
    until, left = time.monotonic() + MOST_SECONDS, MOST_BYTES
    with suppress(TooManyStreams), counted(listener.session.person):
        async with bell(_may_be_news) as rung, seated(listener.session, rung.set) as seat:
            heard = await _begin(listener, seat, last_id)
            if heard is not None:
                yield _opening(heard)
            while heard is not None and left > 0 and time.monotonic() < until:
                heard = await _look(listener, seat, heard)
                for told in _in_words(listener, heard):
                    left -= len(told)
                    yield told
                if heard is not None and not heard.news and not await wait_for(rung, until - time.monotonic()):
                    yield b":\n\n"


def _may_be_news(slug: str, message: Message) -> bool:
    return slug == THINGS or message["type"] in RIGHTS


@asynccontextmanager
async def bell(is_wanted: Callable[[str, Message], bool]) -> AsyncIterator[asyncio.Event]:
    """Give an event that is set whenever a message is called out that is wanted: it tells of a site, and says what."""
    loop, rung = asyncio.get_running_loop(), asyncio.Event()

    def hear(slug: str, message: Message) -> None:
        if is_wanted(slug, message):
            with suppress(RuntimeError):  # the loop has just ended: nobody is left to hear it
                loop.call_soon_threadsafe(rung.set)

    stop = await asyncio.to_thread(listen, hear)
    try:
        yield rung
    finally:
        stop()


async def wait_for(rung: asyncio.Event, most_s: float) -> bool:
    """Wait for the bell; tell whether it rang within a while."""
    with suppress(TimeoutError):
        await asyncio.wait_for(rung.wait(), max(0.0, min(HEARTBEAT_S, most_s)))
    was_rung = rung.is_set()
    rung.clear()
    return was_rung


@sync_to_async
def _begin(listener: Listener, seat: Seat, last_id: str) -> Heard | None:
    """Return where the listener begins: after the event it heard last, if all that came since is kept, else now."""
    sites, newest = _visible(listener, seat), newest_news()
    if sites is None:
        return None
    if not last_id:
        return Heard(sites, (), newest, is_whole=True)
    is_kept = last_id.isdecimal() and len(last_id) < 19 and is_kept_since(int(last_id))
    return Heard(sites, (), int(last_id) if is_kept else newest, is_whole=is_kept)


@sync_to_async
def _look(listener: Listener, seat: Seat, before: Heard) -> Heard | None:
    """Return what has come since; None when the listener may hear no more."""
    sites = _visible(listener, seat)
    if sites is None:
        return None
    if sites != before.sites or not is_kept_since(before.until):
        return Heard(sites, (), newest_news(), is_whole=False)
    news = read_news(after=before.until, sites=sites, most=MOST_AT_ONCE)
    return Heard(sites, news, news[-1].id if news else before.until, is_whole=True)


def _visible(listener: Listener, seat: Seat) -> frozenset[str] | None:
    """Return the sites whose Things the listener may see; None when it is signed out, or no member of its one site."""
    if seat.standing is None:
        return None
    sites = frozenset(seat.standing.roles)
    if listener.site is None:
        return sites
    return frozenset({listener.site}) if listener.site in sites else None


def _opening(heard: Heard) -> bytes:
    begin = f"id: {heard.until}\nretry: {RETRY_MS}\n\n".encode()
    return begin if heard.is_whole else begin + _reset(heard)


def _reset(heard: Heard) -> bytes:
    """Return the event that tells a listener to list the Things anew: more has come than is kept, or may be seen."""
    return f"id: {heard.until}\nevent: reset\ndata: {{}}\n\n".encode()


def _in_words(listener: Listener, heard: Heard | None) -> Iterator[bytes]:
    if heard is None:
        return
    if not heard.is_whole:
        yield _reset(heard)
    for news in heard.news:
        if news.kind in listener.kinds:
            body = json.dumps(_body(news, listener), ensure_ascii=False)
            yield f"id: {news.id}\nevent: {news.kind}\ndata: {body}\n\n".encode()


def _body(news: ThingNews, listener: Listener) -> dict[str, Any]:
    change = news.change if listener.diff else {}
    base = {"base": listener.root} if change and news.kind == "thing_created" else {}
    return {**change, **base, "id": f"{DEVICE_URN}{news.device_id}"}

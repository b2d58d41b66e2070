"""Server-sent events of a directory of Things: one stream for each listener, bounded in time, bytes and number."""

from __future__ import annotations

import asyncio
import json
import threading
import time
from collections.abc import AsyncIterator, Collection
from contextlib import contextmanager
from typing import Any

from asgiref.sync import sync_to_async
from django.conf import settings

from registry.access import find_access
from registry.device_rows import NoSuchDevice
from registry.errors import RegistryError
from registry.joining import get_device, list_devices
from registry.live import Message, subscribe
from registry.models import User
from registry.thing import DEVICE_URN
from registry.things import ThingWatch, thing_to_json
from registry.views import device_to_json

EVENTS = ("thing_created", "thing_updated", "thing_deleted")
MOST_WAITING = 1000
MOST_BYTES = 1_000_000
MOST_SECONDS = 900.0
MOST_STREAMS = 50
HEARTBEAT_S = 15.0
RETRY_MS = 2000
_open = 0
_lock = threading.Lock()


class TooManyStreams(RegistryError):
    """This process serves as many streams as it may."""

    code = "too_many_streams"
    status = 429


def check_room() -> None:
    """Raise TooManyStreams when no stream can be opened."""
    if _open >= MOST_STREAMS:
        raise TooManyStreams(f"{MOST_STREAMS} streams of events are open. Close one, or try again later.")


@contextmanager
def _counted() -> Any:
    global _open
    with _lock:
        _open += 1
    try:
        yield
    finally:
        with _lock:
            _open -= 1


async def stream_events(*, site: str, user: User, types: Collection[str], diff: bool) -> AsyncIterator[bytes]:
    """Give a site's events as text until the listener reads too slowly, has got enough, or is no member any more.

    A stream that ends is opened anew by its listener, who then asks for the Things that there are.
    """
    watch, until, left = ThingWatch(), time.monotonic() + MOST_SECONDS, MOST_BYTES
    with _counted():
        async with subscribe(site, limit=MOST_WAITING) as messages:
            await _begin(watch, site)
            yield f"retry: {RETRY_MS}\n: events of {site}\n\n".encode()
            while left > 0 and time.monotonic() < until and not messages.full():
                message = await _next(messages)
                if message is not None and not await _may_go_on(message, user, site):
                    return
                told = await _in_words(watch, message, site, types, diff=diff)
                left -= len(told)
                if told:
                    yield told


async def _next(messages: asyncio.Queue[Message]) -> Message | None:
    """Return the next message, or None when there was none for a while."""
    try:
        return await asyncio.wait_for(messages.get(), HEARTBEAT_S)
    except TimeoutError:
        return None


async def _may_go_on(message: Message, user: User, site: str) -> bool:
    """Tell whether the listener may hear on; a stream whose messages were lost ends, so that it begins anew."""
    if message["type"] == "hello":
        return False
    return message["type"] != "members" or await sync_to_async(find_access)(user, site) is not None


@sync_to_async
def _begin(watch: ThingWatch, site: str) -> None:
    watch.begin([device_to_json(view) for view in list_devices(site=site)])


async def _in_words(
    watch: ThingWatch, message: Message | None, site: str, types: Collection[str], *, diff: bool
) -> bytes:
    """Return an event's text, a heartbeat's, or nothing."""
    if message is None:
        return b":\n\n"
    found = watch.take(message)
    if found is None or found[0] not in types:
        return b""
    name, device_id = found
    body: dict[str, Any] = {"id": f"{DEVICE_URN}{device_id}"}
    if diff and name != "thing_deleted":
        body = await sync_to_async(_thing)(site, device_id) or body
    return f"event: {name}\ndata: {json.dumps(body, ensure_ascii=False)}\n\n".encode()


def _thing(site: str, device_id: str) -> dict[str, Any] | None:
    """Return a Thing as it is now, or None when it has gone meanwhile."""
    try:
        return thing_to_json(get_device(site=site, device_id=device_id), settings.VIPO_BROKER_URL)
    except NoSuchDevice:
        return None

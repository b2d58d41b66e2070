"""Live fan-out: messages to everybody who watches a site, and hints that wake waiting threads.

Nothing here is kept: a message that nobody hears is gone, and what was lost is healed by `hello`, upon which a watcher
fetches the state anew. Two implementations, chosen by `settings.VIPO_LIVE_URL`: in the process, and Redis pub/sub.
"""

from __future__ import annotations

import asyncio
import json
import logging
import threading
import time
from collections.abc import AsyncIterator, Callable, Mapping, Sequence
from contextlib import asynccontextmanager, suppress
from functools import lru_cache
from typing import Any, Protocol

from django.conf import settings
from redis import ConnectionPool, Redis
from redis.exceptions import RedisError

log = logging.getLogger(__name__)
Message = Mapping[str, Any]
Listener = Callable[[str, Message], None]
EVERY_SITE = ""
REST_S = 0.5
_LIVE, _WAKE = "vipo:live:", "vipo:wake:"


class Outage:
    """Knows whether a server answers; may be told by several threads. `count` is how often it was away so far."""

    def __init__(self, server: str, meanwhile: str) -> None:
        self._server, self._meanwhile = server, meanwhile
        self._lock = threading.Lock()
        self._since: float | None = None
        self.count = 0

    def begin(self, error: BaseException) -> None:
        """Take in that the server did not answer."""
        with self._lock:
            if self._since is not None:
                return
            self._since, self.count = time.monotonic(), self.count + 1
        why = str(error).strip().partition("\n")[0].rstrip(".")
        log.warning("%s does not answer: %s. %s", self._server, why, self._meanwhile)

    def end(self) -> None:
        """Take in that the server answers."""
        if self._since is None:
            return
        with self._lock:
            since, self._since = self._since, None
        if since is not None:
            log.warning("%s answers again after %.1f s.", self._server, time.monotonic() - since)


class Live(Protocol):
    """What both implementations offer; every method may be called from any thread."""

    def publish(self, site_slug: str, message: Message) -> None:
        """Send a JSON-able message to all who watch the site."""

    def publish_all(self, messages: Sequence[tuple[str, Message]], wakes: Sequence[str] = ()) -> None:
        """Give hints on channels, then send several messages, each to its site, in their order."""

    def listen(self, callback: Listener) -> Callable[[], None]:
        """Call `callback(site_slug, message)` for each message of every site, on a foreign thread; returns the end.

        A message for all sites at once (`hello` after a gap) comes with an empty slug.
        """

    def wake(self, channel: str) -> None:
        """Hint to all who wait on the channel that there may be work."""

    def wait_wake(self, channel: str, timeout_s: float) -> bool:
        """Wait for a hint given since this thread last waited here; tell whether there was one."""

    def close(self) -> None:
        """Give back threads and connections."""


class MemoryLive:
    """Within one process."""

    def __init__(self) -> None:
        self._listeners: dict[int, Listener] = {}
        self._next = 0
        self._changed = threading.Condition()
        self._wakes: dict[str, int] = {}
        self._seen = threading.local()

    def publish(self, site_slug: str, message: Message) -> None:
        """Send a message; it is passed through JSON so that both implementations hand out the same."""
        self.deliver(site_slug, json.dumps(message))

    def publish_all(self, messages: Sequence[tuple[str, Message]], wakes: Sequence[str] = ()) -> None:
        """See Live."""
        for channel in wakes:
            self.wake(channel)
        for slug, message in messages:
            self.publish(slug, message)

    def deliver(self, site_slug: str, text: str) -> None:
        """Hand a message's text to every listener; one that fails does not keep it from the others."""
        with self._changed:
            listeners = list(self._listeners.values())
        for callback in listeners:
            try:
                callback(site_slug, json.loads(text))
            except Exception:
                log.exception("A listener failed on a live message of site %r.", site_slug)

    def listen(self, callback: Listener) -> Callable[[], None]:
        """See Live."""
        with self._changed:
            key = self._next = self._next + 1
            self._listeners[key] = callback

        def stop() -> None:
            with self._changed:
                self._listeners.pop(key, None)

        return stop

    def wake(self, channel: str) -> None:
        """See Live."""
        with self._changed:
            self._wakes[channel] = self._wakes.get(channel, 0) + 1
            self._changed.notify_all()

    def wait_wake(self, channel: str, timeout_s: float) -> bool:
        """See Live."""
        seen: dict[str, int] = self._seen.__dict__.setdefault("counts", {})
        with self._changed:
            woken = self._changed.wait_for(lambda: self._wakes.get(channel, 0) != seen.get(channel, 0), timeout_s)
            seen[channel] = self._wakes.get(channel, 0)
        return woken

    def close(self) -> None:
        """Forget the listeners."""
        with self._changed:
            self._listeners.clear()


class RedisLive:
    """Between processes, over Redis pub/sub.

    One thread listens for news and one for each kind of hint, each from the first need on: who waits for hints alone,
    as workers do, does not take in what every browser is told, nor hints that are for gateways, and no hint stands
    behind another kind.
    """

    def __init__(self, url: str) -> None:
        self._redis: Any = Redis(
            connection_pool=ConnectionPool.from_url(url, socket_timeout=5, socket_connect_timeout=5)
        )
        self._here = MemoryLive()
        self._lock = threading.Lock()
        self._threads: dict[str, threading.Thread] = {}
        self._ready: dict[str, threading.Event] = {}
        self._closed = threading.Event()
        self._missed: set[str] = set()
        self._outage = Outage("Redis", "There is no live news, and what waits is found a little later.")
        self._rests_until = 0.0

    def publish(self, site_slug: str, message: Message) -> None:
        """Send a message; while Redis is away it is dropped, and healed by a `hello` later."""
        self.publish_all([(site_slug, message)])

    def publish_all(self, messages: Sequence[tuple[str, Message]], wakes: Sequence[str] = ()) -> None:
        """Give hints and send several messages in one exchange with Redis."""
        texts = [(slug, json.dumps(message)) for slug, message in messages]
        if self._rests():
            self._missed |= {slug for slug, _ in texts}
            return
        try:
            with self._redis.pipeline(transaction=False) as pipe:
                for channel in wakes:
                    pipe.publish(_WAKE + channel, "")
                for missed in (again := list(self._missed)):
                    pipe.publish(_LIVE + missed, json.dumps({"type": "hello", "site": missed}))
                for slug, text in texts:
                    pipe.publish(_LIVE + slug, text)
                pipe.execute()
            self._missed.difference_update(again)
            self._outage.end()
        except RedisError as error:
            self._missed |= {slug for slug, _ in texts}
            self._rest(error)

    def listen(self, callback: Listener) -> Callable[[], None]:
        """See Live."""
        stop = self._here.listen(callback)
        self._start(f"{_LIVE}*")
        return stop

    def wake(self, channel: str) -> None:
        """Hint; one that Redis does not take is dropped, since waiters also look by themselves."""
        if self._rests():
            return
        try:
            self._redis.publish(_WAKE + channel, "")
            self._outage.end()
        except RedisError as error:
            self._rest(error)

    def wait_wake(self, channel: str, timeout_s: float) -> bool:
        """See Live."""
        kind, colon, _ = channel.partition(":")
        self._start(f"{_WAKE}{kind}:*" if colon else _WAKE + kind)
        return self._here.wait_wake(channel, timeout_s)

    def close(self) -> None:
        """End the listening threads and the connections."""
        self._closed.set()
        for thread in self._threads.values():
            thread.join(5)
        self._here.close()
        self._redis.close()

    def _rests(self) -> bool:
        """Tell whether Redis failed just now: who publishes must not wait for it with each message anew."""
        return time.monotonic() < self._rests_until

    def _rest(self, error: RedisError) -> None:
        self._rests_until = time.monotonic() + REST_S
        self._outage.begin(error)

    def _start(self, pattern: str) -> None:
        """Begin to listen at the first need; only the first caller waits, and not for ever, until Redis has heard."""
        with self._lock:
            if pattern not in self._threads:
                self._ready[pattern] = threading.Event()
                name = pattern.strip(":*").replace(":", "-")
                self._threads[pattern] = threading.Thread(target=self._hear, args=(pattern,), name=name, daemon=True)
                self._threads[pattern].start()
                self._ready[pattern].wait(5)

    def _hear(self, pattern: str) -> None:
        """Listen until closed; after each gap tell every watcher to fetch the state anew."""
        connected_before = False
        while not self._closed.is_set():
            try:
                with self._redis.pubsub(ignore_subscribe_messages=False) as channel:
                    channel.psubscribe(pattern)
                    say_hello = connected_before and pattern.startswith(_LIVE)
                    self._hear_from(channel, pattern, say_hello=say_hello)
            except RedisError as error:
                self._outage.begin(error)
                self._closed.wait(REST_S)
            connected_before = True

    def _hear_from(self, channel: Any, pattern: str, *, say_hello: bool) -> None:
        while not self._closed.is_set():
            message = channel.get_message(timeout=0.2)
            if message is None:
                continue
            if message["type"] == "psubscribe":
                self._ready[pattern].set()
                self._outage.end()
                if say_hello:
                    self._here.deliver(EVERY_SITE, json.dumps({"type": "hello"}))
                    say_hello = False
            elif message["type"] == "pmessage":
                self._take(message["channel"].decode(), message["data"].decode())

    def _take(self, name: str, text: str) -> None:
        if name.startswith(_WAKE):
            self._here.wake(name.removeprefix(_WAKE))
        else:
            self._here.deliver(name.removeprefix(_LIVE), text)


def make_live(url: str) -> Live:
    """Return the implementation for a URL: `memory://` or `redis://…`."""
    return MemoryLive() if url.startswith("memory:") else RedisLive(url)


@lru_cache(maxsize=1)
def live() -> Live:
    """Return this process's port."""
    return make_live(settings.VIPO_LIVE_URL)


def publish(site_slug: str, message: Message) -> None:
    """Send a JSON-able message to all who watch the site; call it after the transaction (`on_commit`)."""
    live().publish(site_slug, message)


def publish_all(messages: Sequence[tuple[str, Message]], wakes: Sequence[str] = ()) -> None:
    """Give hints, then send several JSON-able messages, each to its site; call it after the transaction."""
    if messages or wakes:
        live().publish_all(messages, wakes)


def listen(callback: Listener) -> Callable[[], None]:
    """Call `callback(site_slug, message)` on a foreign thread for each message; returns the function that ends it."""
    return live().listen(callback)


def wake(channel: str) -> None:
    """Hint to all who wait on the channel that there may be work."""
    live().wake(channel)


def wait_wake(channel: str, timeout_s: float) -> bool:
    """Wait for a hint given since this thread last waited here; tell whether there was one."""
    return live().wait_wake(channel, timeout_s)


@asynccontextmanager
async def subscribe(site_slug: str, *, limit: int = 1000) -> AsyncIterator[asyncio.Queue[Message]]:
    """Give a queue of the site's messages in this event loop; when `limit` wait unread, the oldest is dropped."""
    loop = asyncio.get_running_loop()
    queue: asyncio.Queue[Message] = asyncio.Queue(limit)

    def put(message: Message) -> None:
        if queue.full():
            queue.get_nowait()
        queue.put_nowait(message)

    def hear(slug: str, message: Message) -> None:
        if slug in (site_slug, EVERY_SITE):
            with suppress(RuntimeError):  # the loop has just ended: nobody is left to hear it
                loop.call_soon_threadsafe(put, message)

    stop = await asyncio.to_thread(listen, hear)
    try:
        yield queue
    finally:
        stop()

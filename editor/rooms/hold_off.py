"""Who was closed for what they sent, over all web processes: kept in Redis, where there is one, till it is forgiven."""

from __future__ import annotations

from typing import Any, Protocol

from redis.asyncio import Redis
from redis.exceptions import RedisError

from editor.rooms.member import FORGIVEN_AFTER_S, held_off_for_s

REDIS_LIMIT_S = 1.0


class HoldOffs(Protocol):
    """What the web processes tell each other of who is held off."""

    async def note(self, person: int, points: int) -> None:
        """Add to what a person was closed for."""

    async def left_s(self, person: int) -> float:
        """Return for how long no new connection of a person is let in."""

    async def close(self) -> None:
        """Give back connections."""


class NoOthers:
    """Where there is one process, which knows by itself."""

    async def note(self, person: int, points: int) -> None:
        """See HoldOffs."""

    async def left_s(self, person: int) -> float:
        """See HoldOffs."""
        return 0.0

    async def close(self) -> None:
        """See HoldOffs."""


class RedisHoldOffs:
    """Two keys for each person: the points, and one that is there while nobody is let in.

    Without Redis each process goes by what it knows itself.
    """

    def __init__(self, url: str) -> None:
        self._redis: Any = Redis.from_url(url, socket_connect_timeout=REDIS_LIMIT_S, socket_timeout=REDIS_LIMIT_S)

    async def note(self, person: int, points: int) -> None:
        """See HoldOffs."""
        counted, held = _keys(person)
        try:
            async with self._redis.pipeline(transaction=True) as pipe:
                pipe.incrby(counted, points)
                pipe.expire(counted, int(FORGIVEN_AFTER_S))
                now, _ = await pipe.execute()
            if wait_s := held_off_for_s(now):
                await self._redis.set(held, "1", px=int(wait_s * 1000))
        except (RedisError, OSError):
            return

    async def left_s(self, person: int) -> float:
        """See HoldOffs."""
        try:
            return max(0.0, int(await self._redis.pttl(_keys(person)[1])) / 1000)
        except (RedisError, OSError):
            return 0.0

    async def close(self) -> None:
        """See HoldOffs."""
        await self._redis.aclose()


def _keys(person: int) -> tuple[str, str]:
    return f"vipo:abuse:{person}", f"vipo:held:{person}"


def make_hold_offs(url: str) -> HoldOffs:
    """Return the implementation for a URL: `memory://` or `redis://…`."""
    return NoOthers() if url.startswith("memory:") else RedisHoldOffs(url)

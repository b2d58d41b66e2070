"""`/ws/wall`: what one wall screen shows, told as it happens; opened by the cookie of a link and by nothing else."""

from __future__ import annotations

import asyncio
import json
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any, TypeVar

from channels.db import database_sync_to_async
from channels.generic.websocket import AsyncWebsocketConsumer
from django.db import Error

from execution.wall import queries
from execution.wall.picture import device_to_wall, is_anew
from registry import services as registry

NOT_OPEN, TOO_MANY, COME_AGAIN = 4401, 4429, 4503
_slots = registry.Slots(in_all=500, of_site=50, of_person=10)
"""Sockets of this process; a wall screen counts as a person of its own."""
registry.watch_amount(name="wall_sockets", read=lambda: _slots.taken)
ANEW = frozenset({"run", "question", "alert", "alerts", "stop", "device_removed", "hello"})
"""Messages of the site upon which the picture is made anew."""
REDRAWN = frozenset({"map", "hello"})
BREATH_S = 0.2
PICTURE_EVERY_S = 1.0
BEAT_S = 5.0
BEAT = json.dumps({"type": "beat"})
SEEN_EVERY_S = 60.0
T = TypeVar("T")


async def _in_database(function: Callable[..., T], *arguments: Any) -> T:
    found: T = await database_sync_to_async(function, thread_sensitive=False)(*arguments)
    return found


class WallSocket(AsyncWebsocketConsumer):  # type: ignore[misc] # Channels has no types
    """Sends what a site looks like; what the browser says is not listened to.

    Closes with 4401 (no wall screen, or none any more), 4429 (10 of this one are open here, or 50 of the site) and 4503
    (the database is away); always after accepting, since a browser learns no code otherwise.
    """

    _claim: registry.Claim | None = None
    _seat: registry.Seat | None = None
    _closing: asyncio.Task[None] | None = None
    _tasks: tuple[asyncio.Task[None], ...] = ()

    async def connect(self) -> None:
        """Let a wall screen in and begin to send."""
        self._devices: dict[str, dict[str, Any]] = {}
        self._known: frozenset[str] = frozenset()
        self._wants_picture = self._wants_map = True
        self._something, self._listens = asyncio.Event(), asyncio.Event()
        await self.accept()
        try:
            wall = await _in_database(queries.find_wall, self.scope["cookies"].get(registry.WALL_COOKIE, ""))
            if wall:
                session = registry.Session("", 0, wall=wall.id)
                self._seat = await registry.watch_of_this_loop().join(session, self._review)
        except Error:
            await self.close(COME_AGAIN)
            return
        if wall is None or not self._stands():
            await self.close(NOT_OPEN)
            return
        claim = registry.Claim(wall.id, wall.site)
        if not _slots.take(claim):
            await self.close(TOO_MANY)
            return
        self._claim, self._wall = claim, wall
        self._tasks = (asyncio.create_task(self._read()), asyncio.create_task(self._write()))

    async def disconnect(self, code: int) -> None:
        """Leave the watch, give the slot back and end both tasks."""
        if self._seat:
            registry.watch_of_this_loop().leave(self._seat)
        if self._claim:
            _slots.give_back(self._claim)
            self._claim = None
        for task in self._tasks:
            if task is not asyncio.current_task():
                task.cancel()
                with suppress(asyncio.CancelledError):
                    await task

    async def receive(self, text_data: str | None = None, bytes_data: bytes | None = None) -> None:
        """Leave aside what a browser sends: a wall screen asks for nothing."""

    def _stands(self) -> bool:
        standing = self._seat and self._seat.standing
        return bool(standing and standing.shows)

    def _review(self) -> None:
        """Called when the wall screen has ended: nothing more is sent."""
        if not self._stands() and self._closing is None:
            for task in self._tasks:
                task.cancel()
            self._closing = asyncio.create_task(self.close(NOT_OPEN))

    async def _read(self) -> None:
        """Take in what happens at the site: of devices what changed, of all else that there is a new picture."""
        async with registry.subscribe(self._wall.site) as messages:
            self._listens.set()
            while True:
                self._take(await messages.get())

    def _take(self, message: Mapping[str, Any]) -> None:
        kind = message["type"]
        self._wants_map |= kind in REDRAWN
        if kind == "device":
            change = message["device"]
            if is_anew(change, self._known):
                self._wants_picture = True
            elif told := device_to_wall(change):
                self._devices[change["id"]] = {**self._devices.get(change["id"], {}), **told}
        elif kind in ANEW:
            self._wants_picture = True
        elif kind not in REDRAWN:
            return
        self._something.set()

    async def _write(self) -> None:
        """Send what is new, then take a breath; the picture is made anew once a second at most.

        When nothing has been new for 5 s a beat is sent: a screen that hears nothing for long is not live.
        """
        await self._listens.wait()  # what happens after the first picture is heard
        pictured_at = seen_at = float("-inf")
        while True:
            now = time.monotonic()
            if now - seen_at >= SEEN_EVERY_S:
                seen_at = now
                await _in_database(queries.note_seen, self._wall.id)
            if self._wants_map or (self._wants_picture and now - pictured_at >= PICTURE_EVERY_S):
                pictured_at = now
                if not await self._send_anew():
                    await self.close(COME_AGAIN)
                    return
            elif not self._wants_picture:
                self._something.clear()
            await self._send_devices()
            await asyncio.sleep(BREATH_S)
            with suppress(TimeoutError):
                await asyncio.wait_for(self._something.wait(), BEAT_S)
            if not self._something.is_set():
                await self.send(text_data=BEAT)

    async def _send_anew(self) -> bool:
        """Send the map, if it is another one, and the picture; False where the database does not answer."""
        wants_map, self._wants_map, self._wants_picture = self._wants_map, False, False
        try:
            drawn = await _in_database(queries.read_map, self._wall.site) if wants_map else None
            picture = await _in_database(queries.read_picture, self._wall.site)
        except (Error, registry.NotAMember):
            return False
        self._known = frozenset(device["id"] for device in picture["devices"])
        if drawn:
            await self.send(text_data=json.dumps(drawn))
        await self.send(text_data=json.dumps(picture))
        return True

    async def _send_devices(self) -> None:
        devices, self._devices = self._devices, {}
        told = [device for name, device in devices.items() if name in self._known]
        if told:
            await self.send(text_data=json.dumps({"type": "devices", "devices": told}))

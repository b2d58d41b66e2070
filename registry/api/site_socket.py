"""`/ws/site/<slug>`: a site's live messages to one browser, thinned out and bounded."""

from __future__ import annotations

import asyncio
import json
from collections import deque
from contextlib import suppress
from typing import Any

from channels.db import database_sync_to_async
from channels.generic.websocket import AsyncWebsocketConsumer

from registry.bounds.places import Claim, Places
from registry.live.fanout import Message, subscribe
from registry.people.access import Access, find_access
from registry.people.sessions import has_ended, session_of_socket

SIGNED_OUT, NOT_ALLOWED, NOT_FOUND, TOO_MANY, TOO_SLOW = 4401, 4403, 4404, 4429, 4503
_places = Places(in_all=5_000, of_site=500, of_person=30)
"""Sockets of this process."""
BREATH_S = 0.1
BEAT_S = 5.0
BEAT = json.dumps({"type": "beat"})
MOST_WAITING = 1000


class SiteSocket(AsyncWebsocketConsumer):  # type: ignore[misc] # Channels has no types
    """Sends what happens at a site; what the browser says is not listened to.

    Closes with 4401 (not signed in, or not any more), 4404 (no such site, or not a member), 4403 (no member any more),
    4429 (30 of this person are open here, or 500 of the site) and 4503 (the browser reads too slowly); always after
    accepting, since a browser learns no code otherwise.
    """

    _access: Access | None = None
    _claim: Claim | None = None
    _reader: asyncio.Task[None] | None = None
    _writer: asyncio.Task[None] | None = None

    async def connect(self) -> None:
        """Let members in and begin to send."""
        self.site: str = self.scope["url_route"]["kwargs"]["slug"]
        self._waiting: deque[Message] = deque()
        self._devices: dict[str, dict[str, Any]] = {}
        self._something = asyncio.Event()
        await self.accept()
        if code := await self._refusal():
            await self.close(code)
            return
        claim = Claim(self.scope["user"].pk, self.site)
        if not _places.take(claim):
            await self.close(TOO_MANY)
            return
        self._claim = claim
        self._reader = asyncio.create_task(self._read())
        self._writer = asyncio.create_task(self._write())

    async def disconnect(self, code: int) -> None:
        """Give the place back and end both tasks."""
        if self._claim:
            _places.give_back(self._claim)
            self._claim = None
        for task in (self._reader, self._writer):
            if task and task is not asyncio.current_task():
                task.cancel()
                with suppress(asyncio.CancelledError):
                    await task

    async def receive(self, text_data: str | None = None, bytes_data: bytes | None = None) -> None:
        """Leave aside what a browser sends: all that it asks for goes over HTTP."""

    @database_sync_to_async  # type: ignore[untyped-decorator] # Channels has no types
    def _refusal(self) -> int:
        user = self.scope["user"]
        if not user.is_authenticated or has_ended(session_of_socket(self.scope)):
            return SIGNED_OUT
        self._access = find_access(user, self.site)
        return 0 if self._access else NOT_FOUND

    async def _read(self) -> None:
        async with subscribe(self.site, limit=10 * MOST_WAITING) as messages:
            self._put({"type": "hello", "site": self.site})
            while True:
                message = await messages.get()
                if message["type"] == "members":
                    if code := await self._refusal():
                        await self.close(SIGNED_OUT if code == SIGNED_OUT else NOT_ALLOWED)
                        return
                elif self._concerns(message) and not self._put(message):
                    await self.close(TOO_SLOW)
                    return

    def _concerns(self, message: Message) -> bool:
        """Tell whether whoever watches may know; some alerts are for admins alone."""
        return message["type"] != "alert" or bool(self._access and self._access.allows(message["alert"]["role"]))

    def _put(self, message: Message) -> bool:
        """Keep a message for the writer; a device's changes are put on top of those that still wait."""
        if message["type"] == "hello":
            message = {"type": "hello", "site": self.site}
        if message["type"] == "device":
            device = message["device"]
            self._devices[device["id"]] = {**self._devices.get(device["id"], {}), **device}
        else:
            if message["type"] == "device_removed":
                self._devices.pop(message["id"], None)
            self._waiting.append(message)
        self._something.set()
        return len(self._waiting) <= MOST_WAITING

    async def _write(self) -> None:
        """Send what waits, then take a breath: so no device is sent more than ten times a second.

        When nothing has waited for 5 s a beat is sent: a browser that hears nothing for long knows its line is dead.
        """
        while True:
            try:
                await asyncio.wait_for(self._something.wait(), BEAT_S)
            except TimeoutError:
                await self.send(text_data=BEAT)
                continue
            self._something.clear()
            while self._waiting:
                await self.send(text_data=json.dumps(self._waiting.popleft()))
            devices, self._devices = self._devices, {}
            for device in devices.values():
                await self.send(text_data=json.dumps({"type": "device", "device": device}))
            await asyncio.sleep(BREATH_S)

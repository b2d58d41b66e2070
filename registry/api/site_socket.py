"""`/ws/site/<slug>`: a site's live messages to one browser, thinned out and bounded."""

from __future__ import annotations

import asyncio
import json
from collections import deque
from contextlib import suppress
from typing import Any

from channels.generic.websocket import AsyncWebsocketConsumer
from django.db import Error

from registry.bounds.slots import Claim, Slots
from registry.live.fanout import Message, subscribe
from registry.people.sessions import session_of_socket
from registry.people.watch import Seat, watch_of_this_loop
from registry.processes.counters import watch_amount

SIGNED_OUT, NOT_ALLOWED, NOT_FOUND, TOO_MANY, COME_AGAIN = 4401, 4403, 4404, 4429, 4503
_slots = Slots(in_all=5_000, of_site=500, of_person=30)
"""Sockets of this process."""
watch_amount(name="site_sockets", read=lambda: _slots.taken)
BREATH_S = 0.1
BEAT_S = 5.0
BEAT = json.dumps({"type": "beat"})
MOST_WAITING = 1000


class SiteSocket(AsyncWebsocketConsumer):  # type: ignore[misc] # Channels has no types
    """Sends what happens at a site; what the browser says is not listened to.

    Closes with 4401 (not signed in, or not any more), 4404 (no such site, or not a member), 4403 (no member any more),
    4429 (30 of this person are open here, or 500 of the site) and 4503 (the browser reads too slowly, or the database
    is away); always after accepting, since a browser learns no code otherwise.
    """

    _claim: Claim | None = None
    _role = ""
    _seat: Seat | None = None
    _closing: asyncio.Task[None] | None = None
    _reader: asyncio.Task[None] | None = None
    _writer: asyncio.Task[None] | None = None

    async def connect(self) -> None:
        """Let members in and begin to send."""
        self.site: str = self.scope["url_route"]["kwargs"]["slug"]
        self._waiting: deque[Message] = deque()
        self._devices: dict[str, dict[str, Any]] = {}
        self._copies: Message | None = None
        self._something = asyncio.Event()
        await self.accept()
        try:
            if session := session_of_socket(self.scope):
                self._seat = await watch_of_this_loop().join(session, self._review, self.site)
        except Error:
            await self.close(COME_AGAIN)
            return
        if code := self._refusal(NOT_FOUND):
            await self.close(code)
            return
        claim = Claim(self.scope["user"].pk, self.site)
        if not _slots.take(claim):
            await self.close(TOO_MANY)
            return
        self._claim = claim
        self._role = self._role_now()
        self._reader = asyncio.create_task(self._read())
        self._writer = asyncio.create_task(self._write())

    async def disconnect(self, code: int) -> None:
        """Leave the watch, give the slot back and end both tasks."""
        if self._seat:
            watch_of_this_loop().leave(self._seat)
        if self._claim:
            _slots.give_back(self._claim)
            self._claim = None
        for task in (self._reader, self._writer):
            if task and task is not asyncio.current_task():
                task.cancel()
                with suppress(asyncio.CancelledError):
                    await task

    async def receive(self, text_data: str | None = None, bytes_data: bytes | None = None) -> None:
        """Leave aside what a browser sends: all that it asks for goes over HTTP."""

    def _refusal(self, no_member: int) -> int:
        """Return the code to close with; 0 for members."""
        if self._seat is None or self._seat.standing is None:
            return SIGNED_OUT
        return 0 if self._seat.standing.allows(self.site, "viewer") else no_member

    def _review(self) -> None:
        """Called when what the session is good for has changed: nothing more is sent to who may hear no more."""
        if (code := self._refusal(NOT_ALLOWED)) and self._closing is None:
            for task in (self._reader, self._writer):
                if task:
                    task.cancel()
            self._closing = asyncio.create_task(self.close(code))
        elif self._claim and (role := self._role_now()) != self._role:
            self._role = role
            self._put({"type": "role", "role": role})

    def _role_now(self) -> str:
        standing = self._seat and self._seat.standing
        return standing.roles.get(self.site, "") if standing else ""

    async def _read(self) -> None:
        async with subscribe(self.site, limit=10 * MOST_WAITING) as messages:
            self._put({"type": "hello", "site": self.site})
            while True:
                message = await messages.get()
                if self._concerns(message) and not self._put(message):
                    await self.close(COME_AGAIN)
                    return

    def _concerns(self, message: Message) -> bool:
        """Tell whether whoever watches is told; some alerts are for admins alone, and the watch heeds members."""
        if message["type"] == "alert":
            standing = self._seat and self._seat.standing
            return bool(standing and standing.allows(self.site, message["alert"]["role"]))
        return bool(message["type"] != "members")

    def _put(self, message: Message) -> bool:
        """Keep a message for the writer; a device's changes are put on top of those that still wait.

        Of where copies are, only the newest counts.
        """
        if message["type"] == "hello":
            message = {"type": "hello", "site": self.site}
        if message["type"] == "device":
            device = message["device"]
            self._devices[device["id"]] = {**self._devices.get(device["id"], {}), **device}
        elif message["type"] == "copies":
            self._copies = message
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
            copies, self._copies = self._copies, None
            if copies is not None:
                await self.send(text_data=json.dumps(copies))
            await asyncio.sleep(BREATH_S)

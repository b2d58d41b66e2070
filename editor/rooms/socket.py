"""/ws/program/<id>: plain y-websocket clients."""

from __future__ import annotations

import asyncio
import time
from contextlib import suppress
from typing import Any

from channels.generic.websocket import AsyncWebsocketConsumer
from django.db import Error

from editor.rooms import yjs_protocol
from editor.rooms.hub import Hub, Permission, find_permission, hub_of_this_loop, review
from editor.rooms.hub import close_hub as close_hub
from editor.rooms.inbox import Inbox
from editor.rooms.member import Close, Member
from editor.rooms.refusals import INTERRUPTED
from editor.rooms.room import Room
from editor.rooms.threads import in_database
from registry.services import Seat, session_of_socket, time_spent, watch_of_this_loop


class ProgramSocket(AsyncWebsocketConsumer):  # type: ignore[misc]
    """One connection. It is accepted first and then refused, so that the client is told a code it can act on."""

    room: Room | None = None
    member: Member | None = None
    seat: Seat | None = None
    hub: Hub
    inbox: Inbox
    _sender: asyncio.Task[None] | None = None

    async def dispatch(self, message: dict[str, Any]) -> None:
        """Act on a message; a frame uses no database, so it does not wait on a thread until connections are closed."""
        if message["type"] == "websocket.receive":
            await self.websocket_receive(message)
        else:
            await super().dispatch(message)

    async def connect(self) -> None:
        """Accept, see who it is, and enter the room."""
        await self.accept()
        try:
            permission = await self._permission()
            await self._enter(permission)
        except Close as close:
            self._leave()
            await self._refuse(close)
        except Error:
            self._leave()
            await self._refuse(Close(Close.COME_AGAIN, INTERRUPTED))

    async def _permission(self) -> Permission:
        session = session_of_socket(self.scope)
        if session is None:
            raise Close(Close.SIGNED_OUT, "You are signed out. Sign in again.")
        self.seat = await watch_of_this_loop().join(session, self._review)
        permission = await in_database(find_permission)(
            session.person, str(self.scope["url_route"]["kwargs"]["program"])
        )
        if permission is None:
            raise Close(Close.NOT_FOUND, "There is no such program, or you are not one of its site.")
        return permission

    async def _enter(self, permission: Permission) -> None:
        self._waiting, self._woken_s = asyncio.Event(), 0.0
        self.hub = hub_of_this_loop()
        member = Member(
            permission.person,
            can_write=permission.can_write,
            wake=self._wake,
            is_sure=self._is_sure,
        )
        program = str(self.scope["url_route"]["kwargs"]["program"])
        self.room = await self.hub.enter(program, member)
        self.inbox = self.hub.inbox(self.room, member)
        self.member = member
        self._review()
        self._sender = asyncio.create_task(self._send_all(member))

    def _wake(self) -> None:
        if not self._waiting.is_set():
            self._woken_s = time.monotonic()
            self._waiting.set()

    def _is_sure(self) -> bool:
        return self.seat is not None and self.seat.is_fresh

    def _review(self) -> None:
        """Called when what the session is good for has changed."""
        if self.room is not None and self.member is not None and self.seat is not None:
            review(self.room, self.member, self.seat.standing)

    async def receive(self, text_data: str | None = None, bytes_data: bytes | None = None) -> None:
        """Hand a frame to the room."""
        if self.room is None or self.member is None or self.member.closing is not None:
            return
        if bytes_data is None:
            self.member.close(Close(Close.MALFORMED, "The protocol has no text messages."))
            return
        self.inbox.take(bytes_data)

    async def _send_all(self, member: Member) -> None:
        """Send what is queued, until the connection is to be closed."""
        while member.closing is None:
            await self._waiting.wait()
            self._waiting.clear()
            woken_s = self._woken_s
            while member.outbox:
                await self.send(bytes_data=member.outbox.popleft())
            time_spent(name="room_send_seconds", seconds=time.monotonic() - woken_s)
        self._leave()
        await self._refuse(member.closing)

    async def _refuse(self, close: Close) -> None:
        """Say why, then close; Daphne does not pass the reason of a close on."""
        await self.send(bytes_data=yjs_protocol.encode_refusal(close.reason))
        await self.close(code=close.code, reason=close.reason)

    async def disconnect(self, code: int) -> None:
        """Leave the room, once what came before has been acted on."""
        if self.room is not None and self.inbox.is_busy:
            self.hub.leave_later(self._leave, self.inbox)
        else:
            self._leave()
        if self._sender is not None:
            self._sender.cancel()
            with suppress(asyncio.CancelledError):
                await self._sender

    def _leave(self) -> None:
        if self.seat is not None:
            watch_of_this_loop().leave(self.seat)
            self.seat = None
        if self.room is not None and self.member is not None:
            self.hub.leave(self.room, self.member)
            self.room = None

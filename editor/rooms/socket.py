"""/ws/program/<id>: plain y-websocket clients."""

from __future__ import annotations

import asyncio
import time
from contextlib import suppress

from channels.generic.websocket import AsyncWebsocketConsumer

from editor.rooms import yjs_protocol
from editor.rooms.hub import Hub, Permission, find_permission, hub_of_this_loop
from editor.rooms.member import Close, Member
from editor.rooms.room import Room
from editor.rooms.runner import in_database
from registry.services import session_of_socket


class ProgramSocket(AsyncWebsocketConsumer):  # type: ignore[misc]
    """One connection. It is accepted first and then refused, so that the client is told a code it can act on."""

    room: Room | None = None
    member: Member | None = None
    hub: Hub
    _sender: asyncio.Task[None] | None = None

    async def connect(self) -> None:
        """Accept, see who it is, and enter the room."""
        await self.accept()
        try:
            permission = await self._permission()
            await self._enter(permission)
        except Close as close:
            await self._refuse(close)

    async def _permission(self) -> Permission:
        user = self.scope.get("user")
        if user is None or not user.is_authenticated:
            raise Close(Close.SIGNED_OUT, "You are signed out. Sign in again.")
        permission = await in_database(find_permission)(user.pk, str(self.scope["url_route"]["kwargs"]["program"]))
        if permission is None:
            raise Close(Close.NOT_FOUND, "There is no such program, or you are not one of its site.")
        return permission

    async def _enter(self, permission: Permission) -> None:
        self._waiting = asyncio.Event()
        self.hub = hub_of_this_loop()
        member = Member(
            permission.person,
            can_write=permission.can_write,
            wake=self._waiting.set,
            session=session_of_socket(self.scope),
        )
        program = str(self.scope["url_route"]["kwargs"]["program"])
        self.room = await self.hub.enter(program, member)
        self.member = member
        self._sender = asyncio.create_task(self._send_all(member))

    async def receive(self, text_data: str | None = None, bytes_data: bytes | None = None) -> None:
        """Hand a frame to the room."""
        if self.room is None or self.member is None or self.member.closing is not None:
            return
        if bytes_data is None:
            self.member.close(Close(Close.MALFORMED, "The protocol has no text messages."))
            return
        try:
            self.room.receive(self.member, bytes_data, time.monotonic())
        except Close as close:
            self.member.close(close)

    async def _send_all(self, member: Member) -> None:
        """Send what is queued, until the connection is to be closed."""
        while member.closing is None:
            await self._waiting.wait()
            self._waiting.clear()
            while member.outbox:
                await self.send(bytes_data=member.outbox.popleft())
        self._leave()
        await self._refuse(member.closing)

    async def _refuse(self, close: Close) -> None:
        """Say why, then close; Daphne does not pass the reason of a close on."""
        await self.send(bytes_data=yjs_protocol.encode_refusal(close.reason))
        await self.close(code=close.code, reason=close.reason)

    async def disconnect(self, code: int) -> None:
        """Leave the room."""
        self._leave()
        if self._sender is not None:
            self._sender.cancel()
            with suppress(asyncio.CancelledError):
                await self._sender

    def _leave(self) -> None:
        if self.room is not None and self.member is not None:
            self.hub.leave(self.room, self.member)
            self.room = None

"""Which room of a program a process has, when people come and go at the same moment."""

from __future__ import annotations

import asyncio
from typing import Any
from uuid import UUID

import pytest

from editor import services as editor
from editor.rooms import hub as hubs
from editor.rooms.hold_off import NoOthers
from editor.rooms.hub import Hub
from editor.rooms.member import Member, Person
from editor.rooms.runner import OpenRoom
from editor.rooms.stream import MemoryStream
from registry import services as registry
from tests.kit.programs import document, step

pytestmark = pytest.mark.django_db(transaction=True)


@pytest.fixture
def program() -> UUID:
    registry.create_site(name="Hall", slug="hall")
    return editor.create_program(site="hall", name="Wait", document=document({"a": step("wait", duration=1)})).id


def person(number: int) -> Member:
    return Member(Person(number, f"Person {number}", "P"), can_write=True, wake=lambda: None)


async def test_who_comes_while_an_empty_room_closes_and_who_comes_just_after_are_in_one_room(
    program: UUID, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(hubs, "CLOSE_EMPTY_AFTER_S", 0.0)
    closing, may_close, may_open = asyncio.Event(), asyncio.Event(), asyncio.Event()
    stop, open_room = OpenRoom.stop, hubs.open_room
    opened: list[OpenRoom] = []

    async def stop_later(room: OpenRoom) -> None:
        closing.set()
        await may_close.wait()
        await stop(room)

    async def open_later(*args: Any) -> OpenRoom:
        if opened:
            await may_open.wait()
        opened.append(await open_room(*args))
        return opened[-1]

    monkeypatch.setattr(OpenRoom, "stop", stop_later)
    monkeypatch.setattr(hubs, "open_room", open_later)
    hub = Hub(MemoryStream(), NoOthers())
    try:
        first, second, third = (person(number) for number in (1, 2, 3))
        hub.leave(await hub.enter(str(program), first), first)
        await closing.wait()
        while_it_closes = asyncio.create_task(hub.enter(str(program), second))
        await asyncio.sleep(0.05)
        may_close.set()
        await asyncio.sleep(0.3)  # the old room has ended, and the new one is being opened
        just_after = asyncio.create_task(hub.enter(str(program), third))
        await asyncio.sleep(0.05)
        may_open.set()
        assert await while_it_closes is await just_after
        assert len(opened) == 2
    finally:
        await hub.close()

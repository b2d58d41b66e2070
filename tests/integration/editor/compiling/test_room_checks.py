"""A room's checks, with real child processes: what is heard of the site in the midst of a check is not lost."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any
from uuid import UUID

import pytest
from asgiref.sync import sync_to_async

from editor import services as editor
from editor.compiling.compilers import Compilers
from editor.documents.shared_document import SharedDocument
from editor.documents.store import load_document
from editor.rooms.checks import Checks
from editor.rooms.room import Room
from registry import services as registry
from tests.kit.programs import document, step

pytestmark = pytest.mark.django_db(transaction=True)


@pytest.fixture
def program() -> UUID:
    registry.create_site(name="Hall", slug="hall")
    drawn = document({"a": step("wait", duration=1)})
    return editor.create_program(site="hall", name="Wait", document=drawn).id


@asynccontextmanager
async def open_checks(program: UUID, heard_to: list[Any]) -> AsyncIterator[tuple[Room, Checks]]:
    """Give a room's checks; before each check begins, the next of `heard_to` is called."""
    stored = await sync_to_async(load_document)(program)
    room, compilers = Room(str(program), "hall", "here", SharedDocument(stored.updates)), Compilers()

    def heard() -> str:
        if heard_to:
            heard_to.pop(0)()
        return "0"

    async def publish() -> None:
        room.to_publish.clear()

    try:
        yield room, Checks(room, compilers, heard_to=heard, others=dict, publish=publish)
    finally:
        await compilers.close()


@pytest.mark.parametrize("when", ["before its process has read the document", "while it reads it"])
async def test_news_of_the_site_in_the_midst_of_a_check_lead_to_another_one(program: UUID, when: str) -> None:
    calls: list[Any] = [] if when.startswith("before") else [lambda: None]
    async with open_checks(program, calls) as (room, checks):
        calls.append(checks.take_in_surroundings)
        room.touched = True
        await checks.check()
        assert room.touched, "the look around was older than the news"
        await checks.check()
        assert not room.touched

"""Two web processes over PostgreSQL and Redis hold the same program."""

from __future__ import annotations

import asyncio
import signal
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress

import psycopg
import pytest
import redis
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed

from editor.rooms.hold_off import RedisHoldOffs
from editor.rooms.stream import FORMAT, KEPT_BYTES
from tests.integration.editor.node_clients import node_clients
from tests.integration.editor.web_pairs import Pair, running_pair
from tests.kit.files import ROOT
from tests.kit.processes.forked import run_forked
from tests.kit.servers import Redis, free_port
from tests.kit.waiting import wait_for
from tests.kit.web import Web, environment


@pytest.fixture(scope="module")
def pair(tmp_path_factory: pytest.TempPathFactory, module_database_url: str, shared_redis: Redis) -> Iterator[Pair]:
    with running_pair(tmp_path_factory.mktemp("pair"), module_database_url, shared_redis) as running:
        yield running


@pytest.mark.servers
def test_people_at_two_processes_converge_and_see_each_other(pair: Pair) -> None:
    program = pair.one.new_program()
    with node_clients(pair.one, program) as clients:
        clients.open("ada", "author", pair.one)
        clients.open("bob", "second", pair.two)
        clients.open("eve", "viewer", pair.two)
        clients.tell("storm", steps=30)
        clients.tell("destroy", name="eve")
        clients.tell("converged")
        clients.tell("saved", name="ada")
        clients.tell("saved", name="bob")
        clients.tell("show", name="ada", state={"cursor": [1, 1]})
        assert "Ada author" in clients.tell("seen", name="bob", count=2)["states"]
        steps = clients.tell("steps", name="bob")["steps"]
    assert len(steps) > 5
    pair.two.wait_for_document(program, steps)


@pytest.mark.servers
def test_a_process_that_dies_leaves_nothing_behind_that_was_saved(pair: Pair) -> None:
    program = pair.one.new_program()
    with node_clients(pair.one, program) as clients:
        clients.open("ada", "author", pair.one)
        clients.open("bob", "second", pair.two)
        clients.tell("add", name="ada", id="s1")
        clients.tell("saved", name="ada")
        clients.tell("converged")
        pair.one.kill()
        clients.tell("add", name="bob", id="s2")
        clients.tell("saved", name="bob")
        pair.one.start()
        clients.tell("converged")
        assert sorted(clients.tell("steps", name="ada")["steps"]) == ["s1", "s2"]


@pytest.mark.servers
def test_a_room_gives_the_database_what_its_rows_build_on_and_nobody_is_sent_away(pair: Pair) -> None:
    """Who made the first row was killed before it was stored, after the other room had heard of it."""
    program = pair.one.new_program()
    with node_clients(pair.one, program) as clients, psycopg.connect(pair.database_url, autocommit=True) as database:
        clients.open("ada", "author", pair.one)
        for step in ("s1", "s2"):
            clients.tell("add", name="ada", id=step)
            clients.tell("saved", name="ada")
        database.execute(
            "DELETE FROM editor_documentupdate WHERE program_id = %s AND seq ="
            " (SELECT min(seq) FROM editor_documentupdate WHERE program_id = %s)",
            (program, program),
        )
        database.execute("UPDATE editor_program SET last_seq = last_seq + 1 WHERE id = %s", (program,))
        with pair.one.client("viewer") as viewer:
            path = f"/programs/{program}/document"
            wait_for("whole rows", lambda: sorted(viewer.get(path).json().get("steps", ())) == ["s1", "s2"])
        clients.tell("add", name="ada", id="s3")
        clients.tell("saved", name="ada")
        assert clients.tell("closed_for_good", name="ada")["closed"] is None
        clients.open("bob", "second", pair.two)
        assert sorted(clients.tell("steps", name="bob")["steps"]) == ["s1", "s2", "s3"]


@contextmanager
def frozen(server: Redis) -> Iterator[None]:
    """Let Redis answer nobody for a while."""
    server.process.send_signal(signal.SIGSTOP)
    try:
        yield
    finally:
        server.process.send_signal(signal.SIGCONT)


def set_role(pair: Pair, person: str, role: str) -> None:
    command = [sys.executable, "-m", "tests.integration.editor.set_role", person, role]
    run_forked(command, cwd=ROOT, env=environment(pair.one.folder, pair.one.extra), check=True)


@pytest.mark.servers
def test_a_change_of_role_acts_on_open_connections(pair: Pair) -> None:
    program = pair.one.new_program()
    with node_clients(pair.one, program) as clients:
        clients.open("ada", "author", pair.one)
        clients.open("oda", "operator", pair.two)
        clients.tell("add", name="oda", id="before")
        set_role(pair, "operator", "author")
        clients.tell("saved", name="oda")
        clients.tell("add", name="ada", id="after")
        clients.tell("converged")
        assert sorted(clients.tell("steps", name="ada")["steps"]) == ["after", "before"]
        set_role(pair, "operator", "none")
        assert clients.tell("closed", name="oda")["closed"] == 4404


@pytest.mark.servers
def test_without_redis_nobody_edits_and_afterwards_all_is_there(pair: Pair) -> None:
    program = pair.one.new_program()
    with node_clients(pair.one, program) as clients:
        clients.open("ada", "author", pair.one)
        clients.open("bob", "second", pair.two)
        clients.tell("add", name="ada", id="before")
        clients.tell("converged")
        with frozen(pair.redis):
            time.sleep(0.2)
            clients.tell("add", name="ada", id="meanwhile")
            time.sleep(1)
        clients.tell("add", name="bob", id="after")
        clients.tell("converged")
        clients.tell("saved", name="ada")
        assert sorted(clients.tell("steps", name="bob")["steps"]) == ["after", "before", "meanwhile"]


def kept_in_redis(pair: Pair, program: str) -> tuple[int, int]:
    """Return of how many entries what the processes have told each other is, and of how many bytes."""
    key = f"vipo:room:{FORMAT}:{program}"
    with redis.Redis.from_url(pair.redis.url) as connection:
        return int(connection.xlen(key)), int(connection.memory_usage(key, samples=0) or 0)


@pytest.mark.servers
def test_who_sends_megabytes_fills_neither_redis_nor_keeps_anything_there_after_leaving(pair: Pair) -> None:
    program, people = pair.one.new_program(), {"ada": "author", "bob": "second", "cem": "admin"}
    with node_clients(pair.one, program) as clients:
        for name, person in people.items():
            clients.open(name, person, pair.one)
        for number in range(10):
            for name in people:
                clients.tell("fill", name=name, bytes=1_000_000 + number)
        for name in people:
            clients.tell("add", name=name, id=name)
            clients.tell("saved", name=name)
        assert kept_in_redis(pair, program)[1] < 2 * KEPT_BYTES
    wait_for("the room to be closed", lambda: kept_in_redis(pair, program)[0] <= 1)
    with node_clients(pair.two, program) as clients:
        clients.open("eve", "viewer", pair.two)
        assert sorted(clients.tell("steps", name="eve")["steps"]) == sorted(people)


def press(web: Web, program: str, snapshot: str) -> int:
    """Make a version of what is seen, as the browser does; return its number."""
    with web.client("second") as client:
        stored = client.post(f"/programs/{program}/stored", json={"seen": snapshot})
        assert stored.status_code == 204, stored.text
        made = client.post(f"/programs/{program}/versions", json={})
        assert made.status_code in (200, 201), made.text
        return int(made.json()["number"])


@pytest.mark.servers
def test_what_is_pinned_in_one_process_has_what_was_drawn_and_deleted_in_the_other(pair: Pair) -> None:
    program = pair.one.new_program()
    with node_clients(pair.one, program) as clients, pair.two.client("second") as reader:
        clients.open("ada", "author", pair.one)
        clients.open("bob", "second", pair.two)
        for number in range(20):
            clients.tell("add", name="ada", id=f"s{number}")
            if number % 2:
                clients.tell("remove", name="ada", id=f"s{number - 1}")
            clients.tell("converged")
            seen = clients.tell("steps", name="bob")["steps"]
            version = press(pair.two, program, clients.tell("snapshot", name="bob")["snapshot"])
            pinned = reader.get(f"/programs/{program}/versions/{version}").json()["document"]["steps"]
            assert pinned == seen


@pytest.mark.servers
def test_what_a_frozen_process_has_told_is_stored_by_the_other_one(pair: Pair) -> None:
    program, process = pair.one.new_program(), pair.one.process
    assert process is not None
    with node_clients(pair.one, program) as clients:
        clients.open("ada", "author", pair.one)
        clients.open("bob", "second", pair.two)
        clients.tell("add", name="ada", id="s1")
        clients.tell("converged")
        process.send_signal(signal.SIGSTOP)
        try:
            press(pair.two, program, clients.tell("snapshot", name="bob")["snapshot"])
            clients.tell("move", name="bob", id="s1", pos=[7, 7])
            clients.tell("saved", name="bob")
        finally:
            process.send_signal(signal.SIGCONT)
        clients.tell("converged")
        clients.tell("saved", name="ada")


@pytest.mark.servers
def test_what_was_never_told_is_not_pinned_and_that_is_said(pair: Pair) -> None:
    program = pair.one.new_program()
    with node_clients(pair.one, program) as clients, pair.two.client("second") as client:
        clients.open("ada", "author", pair.one)
        clients.tell("disconnect", name="ada")
        clients.tell("add", name="ada", id="only-here")
        seen = clients.tell("snapshot", name="ada")["snapshot"]
        refused = client.post(f"/programs/{program}/stored", json={"seen": seen})
        assert (refused.status_code, refused.json()["code"]) == (409, "not_stored")
        assert client.post(f"/programs/{program}/stored", json={"seen": "%%%"}).status_code == 422


async def _close_of(web: Web, frames: int) -> tuple[int | None, bytes]:
    """Send so many questions; return with what the connection was closed, and the last frame before."""
    last = b""
    async with connect(web.socket_url(), additional_headers=web.headers("admin"), max_size=None) as socket:
        with suppress(ConnectionClosed):
            for _ in range(frames):
                await socket.send(b"\x03")
            async with asyncio.timeout(20):
                while True:
                    frame = await socket.recv()
                    last = frame if isinstance(frame, bytes) else b""
        return socket.close_code, last


@pytest.mark.servers
async def test_who_was_closed_for_abuse_at_one_process_is_held_off_at_the_other_one_too(pair: Pair) -> None:
    assert (await _close_of(pair.one, 2000))[0] == 4429
    for web in (pair.two, pair.one, pair.two):
        code, said = await _close_of(web, 0)
        assert (code, b"try again in" in said) == (4429, True)
    with node_clients(pair.two, pair.two.new_program()) as clients:
        assert clients.open("ada", "author", pair.two)["closed"] is None


@pytest.mark.servers
async def test_without_redis_each_process_holds_off_by_itself() -> None:
    nowhere = RedisHoldOffs(f"redis://127.0.0.1:{free_port()}/0")
    await nowhere.note(1, 3)
    assert await nowhere.left_s(1) == 0.0
    await nowhere.close()

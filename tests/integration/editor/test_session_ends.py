"""A session that ends, ends: every socket and stream knows within 3 s, in both forms, whatever process ended it."""

from __future__ import annotations

import asyncio
import json
import sys
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass

import httpx
import pytest
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed

from editor.documents.shared_document import empty_document, encode_document
from editor.rooms import yjs_protocol
from tests.kit.files import ROOT
from tests.kit.processes.forked import run_forked
from tests.kit.served import served_without_broker
from tests.kit.servers import Redis
from tests.kit.waiting import PATIENCE_S, wait_for
from tests.kit.web import Web, environment, prepare

WITHIN = 3
"""Beats of the same server: 3 s where nothing else is at work, and as much longer as the server itself is slowed."""
PASSWORD = "a long password"
MAKE_PEOPLE = """
import json, sys
import django
django.setup()
from tests.kit.sites import make_mixers
from tests.kit.web_process import make_person
make_mixers("a")
print(json.dumps({name: make_person(name, "hall", "author") for name in sys.argv[1:]}))
"""
EXPIRE = """
import sys
import django
django.setup()
from django.contrib.sessions.models import Session
from django.utils import timezone
assert Session.objects.filter(session_key=sys.argv[1]).update(expire_date=timezone.now()) == 1
"""


@dataclass(frozen=True)
class Form:
    """Where sockets are open, and where a person who does something by HTTP does it."""

    web: Web
    other: Web

    def run(self, *arguments: str) -> str:
        """Do something in a process of its own, which shares nothing with the server but the database."""
        done = run_forked(
            [sys.executable, *arguments],
            cwd=ROOT, env=environment(self.web.folder, self.web.extra), capture_output=True, text=True,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        return done.stdout

    def account(self, person: str, *options: str) -> None:
        self.run("-m", "vipo_site.cli.main", "account", f"{person}@vipo.example", *options)

    def post(self, session: str, path: str, body: object = None) -> None:
        """Do something by HTTP, in the other web process where there is one."""
        address, cookies = f"http://127.0.0.1:{self.other.port}/api", {"sessionid": session}
        with httpx.Client(base_url=address, cookies=cookies, timeout=60) as client:
            client.headers["X-CSRFToken"] = client.get("/me").json()["csrf"]
            answer = client.post(path, json=body)
            assert answer.status_code == 200, answer.text

    def second_session(self, person: str) -> str:
        with self.other.client(None) as client:
            client.post("/sign-in", json={"email": f"{person}@vipo.example", "password": PASSWORD}).raise_for_status()
            return str(client.cookies["sessionid"])


@pytest.fixture(scope="module", params=["embedded", "served"])
def form(
    request: pytest.FixtureRequest,
    tmp_path_factory: pytest.TempPathFactory,
    module_database_url: str,
    shared_redis: Redis,
) -> Iterator[Form]:
    folder = tmp_path_factory.mktemp(request.param)
    extra: dict[str, str] = {}
    if request.param == "served":
        told = served_without_broker(folder, module_database_url, shared_redis.url)
        extra = {name: value for name, value in told.items() if name.startswith("VIPO_")}
    made = prepare(folder, extra)
    webs = [Web(folder, **made, extra=extra) for _ in range(2 if extra else 1)]
    for web in webs:
        web.start()
    try:
        yield Form(webs[0], webs[-1])
    finally:
        for web in webs:
            web.kill()


@pytest.fixture(scope="module")
def people(form: Form) -> dict[str, str]:
    """An author for each test, with a session."""
    names = [name.replace(" ", "-") for name in (*WAYS, "lowered", "left")]
    made: dict[str, str] = json.loads(form.run("-c", MAKE_PEOPLE, *names))
    form.web.sessions.update(made)
    return made


def by_cookie(action: str, body: object = None) -> Callable[[Form, str], None]:
    """Return what the person does themselves in another browser."""
    return lambda form, person: form.post(form.second_session(person), action, body)


WAYS: dict[str, Callable[[Form, str], None]] = {
    "another password": lambda form, person: form.account(person, "--new-password"),
    "a closed account": lambda form, person: form.account(person, "--close"),
    "an expiry": lambda form, person: void(form.run("-c", EXPIRE, form.web.sessions[person])),
    "signing out": lambda form, person: form.post(form.web.sessions[person], "/sign-out"),
    "signing out everywhere": by_cookie("/me/sign-out-everywhere"),
    "an own new password": by_cookie("/me/password", {"old": PASSWORD, "new": "another long password"}),
    "leaving the site": lambda form, person: form.account(person, "--site", "hall", "--role", "none"),
}
CODES = {"leaving the site": {"program": 4404, "site": 4403}}


def void(_answer: str) -> None:
    """Nothing is made of the answer."""


class Beat:
    """How often the server has told somebody else, whose stream stays open, that time goes on."""

    def __init__(self) -> None:
        self.count = 0
        self._told = asyncio.Condition()

    async def follow(self, web: Web) -> None:
        async with stream(web, "admin", "/sites/hall/mtconnect/current?interval=1000") as answer:
            async for chunk in answer.aiter_raw():
                async with self._told:
                    self.count += chunk.count(b"Content-type")
                    self._told.notify_all()

    async def wait(self, beats: int) -> None:
        """Wait for so many more."""
        until = self.count + beats
        async with asyncio.timeout(PATIENCE_S), self._told:
            await self._told.wait_for(lambda: self.count >= until)


@asynccontextmanager
async def beats_of(web: Web) -> AsyncIterator[Beat]:
    """Give the beat of a server, which has begun."""
    beat = Beat()
    following = asyncio.create_task(beat.follow(web))
    try:
        await beat.wait(1)
        yield beat
    finally:
        following.cancel()


@dataclass
class End:
    """At which beat something was closed, and with which code."""

    at: int
    code: int | None = None


def step(name: str) -> bytes:
    return encode_document({**empty_document(), "steps": {name: {"kind": "wait", "place": None, "params": {}}}})


async def read_socket(socket: ClientConnection, beat: Beat) -> End:
    with suppress(ConnectionClosed):
        while True:
            await socket.recv()
    return End(beat.count, socket.close_code)


@asynccontextmanager
async def stream(web: Web, person: str, path: str) -> AsyncIterator[httpx.Response]:
    async with (
        httpx.AsyncClient(base_url=f"http://127.0.0.1:{web.port}/api", headers=web.headers(person)) as client,
        client.stream("GET", path, timeout=60) as answer,
    ):
        assert answer.status_code == 200, (await answer.aread()).decode()
        yield answer


async def read_stream(web: Web, person: str, path: str, opened: asyncio.Event, beat: Beat) -> End:
    async with stream(web, person, path) as answer:
        async for _ in answer.aiter_raw():
            opened.set()
    return End(beat.count)


async def edit_on(socket: ClientConnection, sent: dict[str, int], beat: Beat) -> None:
    """Draw a step every 0.1 s until the server closes."""
    await socket.send(yjs_protocol.encode_step_2(step("before")))
    with suppress(ConnectionClosed):
        for number in range(1000):
            sent[f"s{number}"] = beat.count
            await socket.send(yjs_protocol.encode_update(step(f"s{number}")))
            await asyncio.sleep(0.1)


def kept_steps(web: Web, program: str) -> set[str]:
    with web.client("admin") as client:
        return set(client.get(f"/programs/{program}/document").json()["steps"])


@pytest.mark.servers
@pytest.mark.parametrize("way", WAYS)
async def test_all_that_is_open_ends_within_3_s_and_later_edits_are_not_kept(
    form: Form, people: dict[str, str], way: str
) -> None:
    web, person, sent = form.web, way.replace(" ", "-"), dict[str, int]()
    program = await asyncio.to_thread(web.new_program, way)
    headers = web.headers(person)
    opened = [asyncio.Event(), asyncio.Event()]
    async with (
        beats_of(web) as beat,
        connect(web.socket_url(program), additional_headers=headers) as drawing,
        connect(f"ws://127.0.0.1:{web.port}/ws/site/hall", additional_headers=headers) as site,
        asyncio.timeout(60),
    ):
        await site.recv()
        ends = {
            "program": asyncio.create_task(read_socket(drawing, beat)),
            "site": asyncio.create_task(read_socket(site, beat)),
            "things": asyncio.create_task(read_stream(web, person, "/sites/hall/things/events", opened[0], beat)),
            "mtconnect": asyncio.create_task(
                read_stream(web, person, "/sites/hall/mtconnect/current?interval=1000", opened[1], beat)
            ),
        }
        editing = asyncio.create_task(edit_on(drawing, sent, beat))
        await asyncio.gather(*(each.wait() for each in opened))
        assert not any(end.done() for end in ends.values())
        await asyncio.to_thread(WAYS[way], form, person)
        ended_at = beat.count
        found = {name: await end for name, end in ends.items()}
        await editing
    codes = {"program": 4401, "site": 4401, "things": None, "mtconnect": None, **CODES.get(way, {})}
    assert {name: end.code for name, end in found.items()} == codes
    late = {name: end.at - ended_at for name, end in found.items() if end.at - ended_at > WITHIN}
    assert late == {}
    kept = await asyncio.to_thread(kept_steps, web, program)
    assert "before" in kept
    assert [name for name in kept - {"before"} if sent[name] > ended_at + WITHIN] == []
    async with connect(web.socket_url(program), additional_headers=headers) as again:
        with suppress(ConnectionClosed):
            await again.send(yjs_protocol.encode_step_2(step("afterwards")))
        assert (await read_socket(again, beat)).code == codes["program"]
    assert "afterwards" not in await asyncio.to_thread(kept_steps, web, program)


@pytest.mark.servers
async def test_a_wall_screen_that_is_turned_off_in_another_process_goes_dark(form: Form) -> None:
    made = await asyncio.to_thread(make_wall_screen, form)
    address = f"ws://127.0.0.1:{form.web.port}/ws/wall"
    headers = {**form.web.headers(None), "Cookie": f"vipo_wall={made['key']}"}
    async with connect(address, additional_headers=headers) as wall, beats_of(form.web) as beat, asyncio.timeout(60):
        assert json.loads(await wall.recv())["site"] == "Hall"
        showing = asyncio.create_task(read_socket(wall, beat))
        await asyncio.to_thread(turn_off, form, made["id"])
        ended_at = beat.count
        end = await showing
    assert end.code == 4401
    assert end.at - ended_at <= WITHIN
    async with connect(address, additional_headers=headers) as again:
        assert (await read_socket(again, beat)).code == 4401


def make_wall_screen(form: Form) -> dict[str, str]:
    """Make a wall screen, and exchange its link for its key."""
    with form.other.client("admin") as client:
        made = client.post("/sites/hall/wall-screens", json={"name": "East wall"}).json()
    with form.web.client(None) as screen:
        screen.post("/wall/open", json={"code": made["link"].partition("#")[2]}).raise_for_status()
        return {"id": made["id"], "key": screen.cookies["vipo_wall"]}


def turn_off(form: Form, wall_screen: str) -> None:
    with form.other.client("admin") as client:
        client.delete(f"/sites/hall/wall-screens/{wall_screen}").raise_for_status()


@pytest.mark.servers
async def test_an_author_who_becomes_a_viewer_reads_on_and_draws_no_more(form: Form, people: dict[str, str]) -> None:
    web = form.web
    program = await asyncio.to_thread(web.new_program, "Lowered")
    async with (
        beats_of(web) as beat,
        connect(web.socket_url(program), additional_headers=web.headers("lowered")) as drawing,
    ):
        reading = asyncio.create_task(read_socket(drawing, beat))
        await drawing.send(yjs_protocol.encode_step_2(step("before")))
        await asyncio.to_thread(wait_for, "the author's step", lambda: kept_steps(web, program))
        await asyncio.to_thread(form.account, "lowered", "--site", "hall", "--role", "viewer")
        await beat.wait(WITHIN)
        await drawing.send(yjs_protocol.encode_update(step("after")))
        await beat.wait(1)
        assert await asyncio.to_thread(kept_steps, web, program) == {"before"}
        assert not reading.done()
        await asyncio.to_thread(form.account, "lowered", "--site", "hall", "--role", "author")
        await beat.wait(WITHIN)
        await drawing.send(yjs_protocol.encode_update(step("again")))
        await beat.wait(1)
        assert {"before", "again"} <= await asyncio.to_thread(kept_steps, web, program)
        assert not reading.done()
        reading.cancel()

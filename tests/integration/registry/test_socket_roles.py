"""Every socket, stream and address of the directory, opened by everybody and a wall screen, at two sites."""

from __future__ import annotations

import asyncio
import json
import sys
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from typing import Any
from uuid import uuid4

import httpx
import pytest
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed

from editor.documents.shared_document import empty_document, encode_document
from editor.rooms import yjs_protocol
from registry.people.access import ROLES
from registry.people.wall_screens import COOKIE, key_of
from tests.kit.api_rights import DIRECTORY, DRAWS, OPERATIONS, RIGHTS, SOCKETS, STREAMED, STREAMS, Right
from tests.kit.files import ROOT, copy_migrated
from tests.kit.processes.forked import run_forked
from tests.kit.waiting import wait_for
from tests.kit.web import Web, environment

ASKERS = {
    "nobody": ("", ""),
    "wall": ("", ""),
    "shed-viewer": ("shed", "viewer"),
    "shed-admin": ("shed", "admin"),
    **{role: ("hall", role) for role in ROLES},
}
"""Who asks: their site and role; nobody, and a wall screen of the hall, have none."""
NO_SESSION = ("nobody", "wall")
SITES = ("hall", "shed")
MAKE = """
import json, sys
import django
django.setup()
from datetime import UTC, datetime
from registry import services
from registry.floorplan.plan import Grid
from registry.models import User
from tests.kit.api_calls import make_one_of_each
from tests.kit.web_process import make_person
for slug in ("hall", "shed"):
    services.create_site(name=slug.title(), slug=slug)
    services.save_map(site=slug, grid=Grid(4, 3, 1.0, 0.0, 0.0, bytes(12)))
people = {name: make_person(name, *place) for name, place in json.loads(sys.argv[1]).items() if place[0]}
admin = User.objects.get(email="admin@vipo.example")
_, token = services.create_token(
    user=admin, site="hall", name="All", scopes=["admin"], days=1, now=datetime.now(UTC)
)
ids = {slug: make_one_of_each(slug) for slug in ("hall", "shed")}
print(json.dumps({"sessions": people, "ids": ids, "token": token}))
"""


@dataclass(frozen=True)
class Plant:
    """A running server with two sites, the ids of one of each thing at each, and a token of the hall's admin."""

    web: Web
    ids: dict[str, dict[str, str]]
    token: str

    def headers(self, person: str) -> dict[str, str]:
        if person == "wall":
            cookie = f"{COOKIE}={key_of(self.ids['hall']['wall_code'])}"
            return {**self.web.headers(None), "Cookie": cookie}
        return self.web.headers(None if person == "nobody" else person)


@pytest.fixture(scope="module")
def plant(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Plant]:
    folder = tmp_path_factory.mktemp("roles")
    copy_migrated(folder / "vipo.sqlite3")
    done = run_forked(
        [sys.executable, "-c", MAKE, json.dumps(ASKERS)],
        cwd=ROOT, env=environment(folder, {}), capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    made = json.loads(done.stdout)
    web = Web(folder, made["sessions"], "")
    web.start()
    try:
        yield Plant(web, made["ids"], made["token"])
    finally:
        web.kill()


def expected(right: Right, person: str, site: str) -> int:
    """Return the status with which somebody is refused; 0 if they get through."""
    home, role = ASKERS[person]
    if right.role == "anybody":
        return 0
    if right.role == "wall":
        return 0 if person == "wall" else 401
    if person in NO_SESSION:
        return 401
    if not right.is_of_site:
        return 0
    if home != site:
        return 404
    return 0 if ROLES.index(role) >= ROLES.index(right.role) else 403


def find_routes() -> list[str]:
    """Return the routes of the sockets, but for the last, which refuses whatever nobody serves."""
    from vipo_site.asgi import routes

    found = routes.application_mapping["websocket"]
    while not hasattr(found, "routes"):
        found = getattr(found, "inner", None) or found._application
    named = [str(route.pattern) for route in found.routes]
    assert named[-1] == ""
    return named[:-1]


def test_every_socket_stands_in_the_table(db: None) -> None:
    assert sorted(find_routes()) == sorted(SOCKETS)


def test_every_stream_stands_in_the_table() -> None:
    found = {
        call["operationId"]
        for calls in OPERATIONS.values()
        for call in calls.values()
        if any(kind in call["responses"].get("200", {}).get("content", {}) for kind in STREAMED)
    }
    assert found == set(STREAMS)


def test_every_address_of_the_directory_stands_in_the_table() -> None:
    from vipo_site.http.thing_directory import directory

    found = {
        f"{method} {path}"
        for _, router in directory._routers
        for path, view in router.path_operations.items()
        for operation in view.operations
        for method in operation.methods
        if method != "HEAD"
    }
    assert found == set(DIRECTORY)


def address_of(route: str, names: dict[str, str]) -> str:
    return route.replace("<slug:slug>", names["slug"]).replace("<uuid:program>", names["program"])


async def first_word(plant: Plant, address: str, headers: dict[str, str]) -> int:
    """Open a socket and return the code that it is closed with; 0 where it greets instead."""
    url = f"ws://127.0.0.1:{plant.web.port}/{address}"
    async with connect(url, additional_headers=headers) as socket, asyncio.timeout(20):
        try:
            while (heard := await socket.recv())[:1] == b"\x02":
                pass
        except ConnectionClosed as closed:
            return closed.rcvd.code if closed.rcvd else -1
        assert heard[:2] == b"\x00\x00" or json.loads(heard)["type"] in ("hello", "map"), heard[:100]
        return 0


CODES = {401: 4401, 404: 4404, 0: 0}


@pytest.mark.parametrize("person", ASKERS)
async def test_each_person_opens_the_sockets_of_their_site_and_no_other(plant: Plant, person: str) -> None:
    odd = {}
    nowhere = {"slug": "nowhere", "program": str(uuid4())}
    for route, right in SOCKETS.items():
        for site, names in {**plant.ids, "nowhere": nowhere}.items():
            wanted = CODES[expected(right, person, site)]
            found = await first_word(plant, address_of(route, names), plant.headers(person))
            if found != wanted:
                odd[route, site] = (wanted, found)
    assert odd == {}


async def test_no_token_opens_a_socket(plant: Plant) -> None:
    shown = {**plant.web.headers(None), "Authorization": f"Bearer {plant.token}"}
    codes = {await first_word(plant, address_of(route, plant.ids["hall"]), shown) for route in SOCKETS}
    assert codes == {4401}


def step(name: str) -> bytes:
    return encode_document({**empty_document(), "steps": {name: {"kind": "wait", "place": None, "params": {}}}})


async def read_all(socket: ClientConnection) -> None:
    with suppress(ConnectionClosed):
        async for _ in socket:
            pass


@pytest.mark.parametrize("person", ROLES)
async def test_what_is_drawn_is_taken_of_authors_alone(plant: Plant, person: str) -> None:
    url = plant.web.socket_url(plant.ids["hall"]["program"])
    async with connect(url, additional_headers=plant.headers(person)) as socket:
        reading = asyncio.create_task(read_all(socket))
        await socket.send(yjs_protocol.encode_step_2(step(f"of-{person}")))
        if ROLES.index(person) >= ROLES.index(DRAWS.role):
            await asyncio.to_thread(wait_for, "what was drawn", lambda: f"of-{person}" in drawn(plant), every_s=0.1)
        else:
            await asyncio.sleep(1.0)
            assert f"of-{person}" not in await asyncio.to_thread(drawn, plant)
        reading.cancel()


def drawn(plant: Plant) -> set[str]:
    with plant.web.client("viewer") as client:
        answer = client.get(f"/programs/{plant.ids['hall']['program']}/document")
    return set(answer.json()["steps"])


def opened(client: httpx.Client, path: str) -> int:
    """Open a stream and read the first of it; return the status of a refusal, or 0."""
    with client.stream("GET", path) as answer:
        if answer.status_code != 200:
            return answer.status_code
        assert answer.headers["Content-Type"].split(";")[0] in STREAMED, path
        assert next(answer.iter_raw())
        return 0


@pytest.mark.parametrize("person", ASKERS)
def test_each_person_opens_the_streams_of_their_site_and_no_other(plant: Plant, person: str) -> None:
    odd = {}
    paths = {call["operationId"]: path for path, calls in OPERATIONS.items() for call in calls.values()}
    root = f"http://127.0.0.1:{plant.web.port}"
    with httpx.Client(base_url=root, headers=plant.headers(person), timeout=20) as client:
        for name, query in STREAMS.items():
            for site in SITES:
                wanted = expected(RIGHTS[name], person, site)
                found = opened(client, paths[name].format(**plant.ids[site]) + query)
                if found != wanted:
                    odd[name, site] = (wanted, found)
        for path in ("/events", "/events/thing_updated"):
            if (found := opened(client, path)) != expected(DIRECTORY["GET /events"], person, ""):
                odd[path, ""] = (0, found)
    assert odd == {}


@pytest.mark.parametrize("person", ASKERS)
def test_each_person_asks_the_directory_as_the_table_says(plant: Plant, person: str) -> None:
    odd = {}
    root = f"http://127.0.0.1:{plant.web.port}"
    session = {} if person in NO_SESSION else {"sessionid": plant.web.sessions[person]}
    if person == "wall":
        session = {COOKIE: key_of(plant.ids["hall"]["wall_code"])}
    with httpx.Client(base_url=root, cookies=session, timeout=20) as client:
        client.headers["X-CSRFToken"] = client.get("/api/me").json()["csrf"]
        for call, right in DIRECTORY.items():
            method, path = call.split()
            for site in SITES:
                where = path.format(thing=plant.ids[site]["thing"], kind="thing_updated")
                with client.stream(method, where) as answer:
                    found = answer.status_code if answer.status_code in (401, 403, 404) else 0
                if found != expected(right, person, site) or answer.status_code == 500:
                    odd[call, site] = (expected(right, person, site), answer.status_code)
    assert odd == {}


def hear(client: httpx.Client, path: str, rename: Any, last: str) -> list[str]:
    """Return the ids of the Things of which a stream tells until it tells of the last one."""
    heard = []
    with client.stream("GET", path) as answer:
        lines = answer.iter_lines()
        assert next(lines).startswith("id:")
        rename()
        for line in lines:
            if line.startswith("data:"):
                heard.append(json.loads(line[5:])["id"].removeprefix("urn:vipo:device:"))
                if heard[-1] == last:
                    break
    return heard


@pytest.mark.parametrize(("person", "home"), [("viewer", "hall"), ("shed-viewer", "shed")])
def test_the_stream_of_all_things_tells_of_the_own_sites_alone(plant: Plant, person: str, home: str) -> None:
    other = next(site for site in SITES if site != home)

    def rename_both() -> None:
        for site, admin in ((other, keeper[other]), (home, keeper[home])):
            with plant.web.client(admin) as client:
                path = f"/sites/{site}/devices/{plant.ids[site]['device']}"
                assert client.patch(path, json={"name": f"As {person} hears"}).status_code == 200

    keeper = {"hall": "admin", "shed": "shed-admin"}
    root = f"http://127.0.0.1:{plant.web.port}"
    with httpx.Client(base_url=root, headers=plant.headers(person), timeout=20) as client:
        heard = hear(client, "/events", rename_both, plant.ids[home]["device"])
    assert heard == [plant.ids[home]["device"]]

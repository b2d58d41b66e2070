"""A program's content is read and written over HTTP, beside people who have it open at the same moment."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.integration.editor.node_clients import node_clients
from tests.kit.served import served_without_broker
from tests.kit.servers import Redis
from tests.kit.web import Web, prepare

WAIT = {"kind": "wait", "place": ["program", "body", "1V"], "pos": [1, -1], "params": {"duration": 5}}


@pytest.fixture(scope="module")
def pair(
    tmp_path_factory: pytest.TempPathFactory, module_database_url: str, shared_redis: Redis
) -> Iterator[tuple[Web, Web]]:
    folder = tmp_path_factory.mktemp("pair")
    extra = served_without_broker(folder, module_database_url, shared_redis.url)
    extra = {name: value for name, value in extra.items() if name.startswith("VIPO_")}
    made = prepare(folder, extra)
    one, two = (Web(folder, **made, extra=extra) for _ in range(2))
    one.start()
    two.start()
    try:
        yield one, two
    finally:
        one.kill()
        two.kill()


def test_what_was_read_is_written_once_and_a_second_writer_is_told(web: Web) -> None:
    program = web.new_program()
    address = f"/programs/{program}/document"
    with web.client("author") as client:
        read = client.get(address)
        document = {**read.json(), "steps": {"s1": WAIT}}
        tag = {"If-Match": read.headers["ETag"]}
        written = client.put(address, json=document, headers=tag)
        assert (written.status_code, written.content) == (204, b"")
        now = client.get(address)
        assert now.json()["steps"] == {"s1": WAIT}
        assert now.headers["ETag"] == written.headers["ETag"] != read.headers["ETag"]
        late = client.put(address, json={**document, "steps": {}}, headers=tag)
        assert (late.status_code, late.json()["code"]) == (412, "changed")
        blind = client.put(address, json=document)
        assert (blind.status_code, blind.json()["code"]) == (428, "if_match_needed")
        again = client.put(address, json=document, headers={"If-Match": now.headers["ETag"]})
        assert (again.status_code, again.headers["ETag"]) == (204, now.headers["ETag"]), "nothing to change"
        assert client.get(address, headers={"If-None-Match": now.headers["ETag"]}).status_code == 304
        assert client.get(address).json()["steps"] == {"s1": WAIT}


def test_a_script_is_read_changed_and_written_and_steps_keep_their_ids(web: Web) -> None:
    program = web.new_program()
    with web.client("author") as client:
        document = client.get(f"/programs/{program}/document")
        wanted = {**document.json(), "steps": {"s1": WAIT}}
        tag = {"If-Match": document.headers["ETag"]}
        assert client.put(f"/programs/{program}/document", json=wanted, headers=tag).status_code == 204
        script = client.get(f"/programs/{program}/script")
        assert script.headers["Content-Type"] == "text/plain; charset=utf-8"
        tag = {"If-Match": script.headers["ETag"], "Content-Type": "text/plain"}
        bad = client.put(f"/programs/{program}/script", content=script.text + "        import os\n", headers=tag)
        assert (bad.status_code, bad.json()["code"]) == (422, "bad_script")
        assert bad.json()["args"]["diagnostics"][0]["line"] == script.text.count("\n") + 1
        assert bad.json()["detail"].count("Line ") == 1
        assert client.get(f"/programs/{program}/script").text == script.text
        longer = script.text.replace("5", "7")
        assert client.put(f"/programs/{program}/script", content=longer, headers=tag).status_code == 204
        assert client.get(f"/programs/{program}/document").json()["steps"]["s1"]["params"] == {"duration": 7}
        assert client.get(f"/programs/{program}/script").text == longer


@pytest.mark.parametrize(
    "body", [b"[]", b"{}", b"{", b'{"format": 2, "steps": {"s": 1}}', b"\xff", b"[" * 5000, b'{"format": NaN}']
)
def test_what_is_no_document_is_refused_and_nothing_changes(web: Web, body: bytes) -> None:
    address = f"/programs/{web.program}/document"
    with web.client("author") as client:
        before = client.get(address)
        tag = {"If-Match": before.headers["ETag"], "Content-Type": "application/json"}
        answer = client.put(address, content=body, headers=tag)
        assert (answer.status_code, answer.json()["code"]) == (422, "bad_request")
        assert client.get(address).content == before.content


def test_who_may_only_look_writes_nothing(web: Web) -> None:
    for person, status in (("viewer", 403), ("operator", 403), ("stranger", 404)):
        with web.client(person) as client:
            assert client.put(f"/programs/{web.program}/document", json={}).status_code == status
            assert client.put(f"/programs/{web.program}/script", content=b"").status_code == status


@pytest.mark.servers
def test_what_people_draw_meanwhile_stays_and_they_see_what_was_written(pair: tuple[Web, Web]) -> None:
    one, two = pair
    program = one.new_program()
    with node_clients(one, program) as clients, two.client("author") as writer:
        clients.open("ada", "author", one)
        clients.tell("storm", steps=20)
        clients.tell("saved", name="ada")
        read = writer.get(f"/programs/{program}/document")
        drawn = read.json()["steps"]
        assert drawn
        document = {**read.json(), "steps": {**drawn, "written": WAIT}}
        answer = writer.put(f"/programs/{program}/document", json=document, headers={"If-Match": read.headers["ETag"]})
        assert answer.status_code == 204, answer.text
        clients.open("bob", "second", two)
        clients.tell("storm", steps=20)
        clients.tell("converged")
        for name in ("ada", "bob"):
            clients.tell("saved", name=name)
        now = writer.get(f"/programs/{program}/document").json()["steps"]
        assert "written" in now

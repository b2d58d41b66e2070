"""Comments over two web processes: what is said at one is heard and read at the other."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from websockets.sync.client import ClientConnection, connect

from tests.integration.editor.web_pairs import Pair, running_pair
from tests.kit.servers import Redis
from tests.kit.waiting import PATIENCE_S
from tests.kit.web import Web


@pytest.fixture(scope="module")
def pair(tmp_path_factory: pytest.TempPathFactory, module_database_url: str, shared_redis: Redis) -> Iterator[Pair]:
    with running_pair(tmp_path_factory.mktemp("pair"), module_database_url, shared_redis) as running:
        yield running


@contextmanager
def watching(web: Web, person: str) -> Iterator[ClientConnection]:
    """Watch the site at a process, from when it has told how the site stands."""
    address = f"ws://127.0.0.1:{web.port}/ws/site/hall"
    with connect(address, additional_headers=web.headers(person)) as socket:
        socket.recv(timeout=PATIENCE_S)
        yield socket


def news_of_comments(socket: ClientConnection) -> dict[str, Any]:
    """Return the next news of comments, as it comes."""
    while True:
        message: dict[str, Any] = json.loads(socket.recv(timeout=PATIENCE_S))
        if message["type"] == "comments":
            return message


def read_threads(web: Web, person: str, program: str) -> list[dict[str, Any]]:
    with web.client(person) as client:
        found: list[dict[str, Any]] = client.get(f"/programs/{program}/threads").json()
    return found


@pytest.mark.servers
def test_what_is_said_at_one_process_is_told_at_the_other_and_read_there(pair: Pair) -> None:
    program = pair.one.new_program()
    threads = f"/programs/{program}/threads"
    told = {"type": "comments", "program": program}
    with watching(pair.one, "author") as author, watching(pair.two, "viewer") as viewer:
        with pair.one.client("author") as client:
            begun = client.post(threads, json={"text": "Why wait?", "anchor": {"kind": "program"}})
        assert begun.status_code == 201, begun.text
        assert news_of_comments(viewer) == told
        (thread,) = read_threads(pair.two, "viewer", program)
        assert ([each["text"] for each in thread["comments"]], thread["unread"]) == (["Why wait?"], 1)
        assert news_of_comments(author) == told
        with pair.two.client("second") as client:
            client.post(f"{threads}/{thread['id']}/comments", json={"text": "For the paint."}).raise_for_status()
        assert news_of_comments(author) == told
        assert [each["text"] for each in read_threads(pair.one, "author", program)[0]["comments"]] == [
            "Why wait?",
            "For the paint.",
        ]

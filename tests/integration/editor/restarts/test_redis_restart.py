"""Redis ends and starts again with nothing in it while people draw at two web processes."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.integration.editor.node_clients import node_clients
from tests.integration.editor.web_pairs import Pair, running_pair
from tests.kit.servers import run_redis

PEOPLE = ("ada", "bob")


@pytest.fixture
def pair(tmp_path: Path, module_database_url: str) -> Iterator[Pair]:
    with run_redis(tmp_path) as own, running_pair(tmp_path, module_database_url, own) as running:
        yield running


@pytest.mark.servers
def test_nobody_is_sent_away_by_a_redis_that_begins_anew_and_all_see_what_was_drawn_meanwhile(pair: Pair) -> None:
    program = pair.one.new_program()
    with node_clients(pair.one, program) as clients:
        clients.open("ada", "author", pair.one)
        clients.open("bob", "second", pair.two)
        for name in PEOPLE:
            clients.tell("add", name=name, id=f"{name}-before")
            clients.tell("saved", name=name)
        clients.tell("converged")
        pair.redis.process.kill()
        pair.redis.process.wait()
        for name in PEOPLE:
            clients.tell("add", name=name, id=f"{name}-meanwhile")
        clients.tell("remove", name="ada", id="bob-before")
        pair.redis.start()
        for name in PEOPLE:
            clients.tell("saved", name=name)
        clients.tell("converged")
        steps = clients.tell("steps", name="bob")["steps"]
        assert sorted(steps) == ["ada-before", "ada-meanwhile", "bob-meanwhile"]
        clients.tell("add", name="bob", id="after")
        clients.tell("converged")
        assert "after" in clients.tell("steps", name="ada")["steps"]
        assert [clients.tell("acknowledged", name=name)["opened"] for name in PEOPLE] == [1, 1]

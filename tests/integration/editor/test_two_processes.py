"""Two web processes over PostgreSQL and Redis hold the same program."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass

import pytest

from tests.integration.editor.conftest import Web, environment, prepare
from tests.integration.editor.node_clients import node_clients
from tests.servers import ROOT, Redis, run_postgres, run_redis


@dataclass(frozen=True)
class Pair:
    """Two web processes that share a database and a Redis."""

    one: Web
    two: Web
    redis: Redis


@pytest.fixture(scope="module")
def pair(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Pair]:
    folder = tmp_path_factory.mktemp("pair")
    with run_postgres(folder) as postgres, run_redis(folder) as redis:
        extra = {
            "VIPO_MODE": "served",
            "VIPO_SECRET_KEY": "a key for this test alone, long enough to be taken",
            "VIPO_HOSTS": "127.0.0.1",
            "VIPO_DATABASE_URL": postgres.url,
            "VIPO_REDIS_URL": redis.url,
            "VIPO_MQTT_HOST": "127.0.0.1",
            "VIPO_MQTT_PASSWORD": "not used here",
        }
        made = prepare(folder, extra)
        one, two = (Web(folder, **made, extra=extra) for _ in range(2))
        one.start()
        two.start()
        try:
            yield Pair(one, two, redis)
        finally:
            one.kill()
            two.kill()


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


def set_role(pair: Pair, person: str, role: str) -> None:
    command = [sys.executable, "-m", "tests.integration.editor.set_role", person, role]
    subprocess.run(command, cwd=ROOT, env=environment(pair.one.folder, pair.one.extra), check=True)


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
        pair.redis.process.send_signal(19)
        time.sleep(0.2)
        clients.tell("add", name="ada", id="meanwhile")
        time.sleep(1)
        pair.redis.process.send_signal(18)
        clients.tell("add", name="bob", id="after")
        clients.tell("converged")
        clients.tell("saved", name="ada")
        assert sorted(clients.tell("steps", name="bob")["steps"]) == ["after", "before", "meanwhile"]

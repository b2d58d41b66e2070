"""Two web processes over PostgreSQL and Redis hold the same program."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import pytest

from tests.integration.editor.node_clients import node_clients
from tests.kit.files import ROOT
from tests.kit.served import served_without_broker
from tests.kit.servers import Redis
from tests.kit.web import Web, environment, prepare


@dataclass(frozen=True)
class Pair:
    """Two web processes that share a database and a Redis."""

    one: Web
    two: Web
    redis: Redis


@pytest.fixture(scope="module")
def pair(tmp_path_factory: pytest.TempPathFactory, module_database_url: str, shared_redis: Redis) -> Iterator[Pair]:
    folder = tmp_path_factory.mktemp("pair")
    extra = served_without_broker(folder, module_database_url, shared_redis.url)
    extra = {name: value for name, value in extra.items() if name.startswith("VIPO_")}
    made = prepare(folder, extra)
    one, two = (Web(folder, **made, extra=extra) for _ in range(2))
    one.start()
    two.start()
    try:
        yield Pair(one, two, shared_redis)
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


@contextmanager
def frozen(redis: Redis) -> Iterator[None]:
    """Let Redis answer nobody for a while."""
    redis.process.send_signal(signal.SIGSTOP)
    try:
        yield
    finally:
        redis.process.send_signal(signal.SIGCONT)


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
        with frozen(pair.redis):
            time.sleep(0.2)
            clients.tell("add", name="ada", id="meanwhile")
            time.sleep(1)
        clients.tell("add", name="bob", id="after")
        clients.tell("converged")
        clients.tell("saved", name="ada")
        assert sorted(clients.tell("steps", name="bob")["steps"]) == ["after", "before", "meanwhile"]

"""PostgreSQL ends as in a crash and starts again while people draw at two web processes."""

from __future__ import annotations

import sys
from collections.abc import Iterator

import pytest

from tests.integration.editor.node_clients import NodeClients, node_clients
from tests.integration.editor.web_pairs import Pair, running_pair
from tests.kit.files import ROOT
from tests.kit.processes.forked import run_forked
from tests.kit.served import served_without_broker
from tests.kit.servers import Postgres, Redis, run_postgres
from tests.kit.web import environment

PEOPLE = ("ada", "bob")


@pytest.fixture(scope="module")
def postgres(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Postgres]:
    with run_postgres(tmp_path_factory.mktemp("postgres"), keep_durable=True) as running:
        yield running


@pytest.fixture(scope="module")
def pair(tmp_path_factory: pytest.TempPathFactory, postgres: Postgres, shared_redis: Redis) -> Iterator[Pair]:
    folder = tmp_path_factory.mktemp("pair")
    told = served_without_broker(folder, postgres.url, shared_redis.url)
    extra = {name: value for name, value in told.items() if name.startswith("VIPO_")}
    migrate = [sys.executable, "manage.py", "migrate", "-v0", "--skip-checks"]
    run_forked(migrate, check=True, cwd=ROOT, env=environment(folder, extra))
    with running_pair(folder, postgres.url, shared_redis) as running:
        yield running


def not_called_saved(clients: NodeClients, name: str) -> int:
    told = clients.tell("acknowledged", name=name)
    return int(told["made"]) - int(told["savedAt"])


@pytest.mark.servers
def test_what_is_drawn_while_postgres_is_away_is_not_called_saved_and_is_there_afterwards(
    pair: Pair, postgres: Postgres
) -> None:
    program = pair.one.new_program()
    with node_clients(pair.one, program) as clients:
        clients.open("ada", "author", pair.one)
        clients.open("bob", "second", pair.two)
        wanted = set()
        for restart in range(1):
            for name in PEOPLE:
                clients.tell("add", name=name, id=f"{name}-before-{restart}")
                clients.tell("saved", name=name)
            postgres.stop()
            for number in range(5):
                for name in PEOPLE:
                    clients.tell("add", name=name, id=f"{name}-meanwhile-{restart}-{number}")
            clients.tell("remove", name="ada", id=f"bob-before-{restart}")
            assert [not_called_saved(clients, name) for name in PEOPLE] == [6, 5]
            postgres.start()
            for name in PEOPLE:
                clients.tell("saved", name=name)
            clients.tell("converged")
            wanted |= {f"{name}-meanwhile-{restart}-{number}" for name in PEOPLE for number in range(5)}
            wanted |= {f"ada-before-{restart}"}
        steps = clients.tell("steps", name="ada")["steps"]
        assert set(steps) == wanted
        assert [clients.tell("acknowledged", name=name)["opened"] for name in PEOPLE] == [1, 1]
    pair.two.wait_for_document(program, steps)

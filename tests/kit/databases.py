"""One PostgreSQL and one Redis for all tests of a process: databases of their own, copied from a migrated one.

A test that kills, stops, restarts or sets up a server starts its own, with tests.kit.servers.

With VIPO_TEST_DATABASE=postgres all tests that touch the database do so on PostgreSQL instead of SQLite; what they
start as processes of its own keeps to what it is told. The URL of a database that has the product's tables, instead of
the word, lets them copy that one and needs no server more.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from itertools import count
from pathlib import Path
from typing import Any

import psycopg
import pytest
import redis
from django.contrib.contenttypes.management import create_contenttypes
from django.db import connection, connections
from django.db.backends.postgresql.operations import DatabaseOperations as PostgresOperations
from django.db.models.signals import post_migrate
from psycopg import sql

from tests.kit.files import ROOT, copy_migrated
from tests.kit.processes.forked import run_forked
from tests.kit.served import served_without_broker
from tests.kit.servers import Postgres, Redis, run_postgres, run_redis
from vipo_site.settings import postgres

_NUMBERS = count(1)


@pytest.fixture(scope="session")
def _postgres(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Postgres]:
    with run_postgres(tmp_path_factory.mktemp("postgres")) as server:
        migrate(server.url, tmp_path_factory.mktemp("migrated"))
        yield server


@pytest.fixture(scope="session")
def django_db_keepdb() -> bool:
    """Let Django take the database that is there, with its tables; it goes with the folder or the server."""
    return True


@pytest.fixture(scope="session")
def django_db_modify_db_settings(request: pytest.FixtureRequest) -> None:
    """Choose the database on which pytest-django makes the one of the tests."""
    _empty_quickly()
    chosen = os.environ.get("VIPO_TEST_DATABASE", "")
    if not chosen.startswith("postgres"):
        request.getfixturevalue("django_db_modify_db_settings_parallel_suffix")
        copy_migrated(Path(connections.databases["default"]["TEST"]["NAME"]))
        return
    there = postgres(request.getfixturevalue("_postgres").url if chosen == "postgres" else chosen)
    described = connections.databases["default"]
    test = {**described["TEST"], "NAME": None, "TEMPLATE": there["NAME"]}
    connections.databases["default"] = {**described, **there, "TEST": test}
    del connections["default"]


def _empty_quickly() -> None:
    """Empty the tables behind a test that commits without making anew what this product never reads, Django's own
    permissions and content types; on PostgreSQL by deleting, since TRUNCATE makes new files of each of 90 tables.
    """
    post_migrate.disconnect(dispatch_uid="django.contrib.auth.management.create_permissions")
    post_migrate.disconnect(create_contenttypes)
    PostgresOperations.sql_flush = _deletes  # type: ignore[method-assign,assignment]


def _deletes(operations: PostgresOperations, style: Any, tables: list[str], **_: Any) -> list[str]:
    """Return what empties tables that are nearly empty, in any order."""
    deletes = "; ".join(f"DELETE FROM {operations.quote_name(table)}" for table in tables)
    return [f"SET LOCAL session_replication_role = replica; {deletes}; SET LOCAL session_replication_role = DEFAULT"]


@pytest.fixture(scope="session")
def _redis(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Redis]:
    with run_redis(tmp_path_factory.mktemp("redis")) as server:
        yield server


def migrate(url: str, folder: Path) -> None:
    """Bring a database to the product's tables, which later ones are copied from."""
    command = [sys.executable, "manage.py", "migrate", "-v0", "--skip-checks"]
    environment = served_without_broker(folder, url, "redis://127.0.0.1:1/0")
    done = run_forked(command, cwd=ROOT, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@pytest.fixture(scope="session")
def new_database(_postgres: Postgres) -> Callable[[], str]:
    """Make an empty database with the product's tables; returns its URL."""

    def make() -> str:
        name = f"copy{next(_NUMBERS)}"
        with psycopg.connect(_postgres.url.removesuffix("vipo") + "postgres", autocommit=True) as connection:
            connection.execute(sql.SQL("CREATE DATABASE {} TEMPLATE vipo").format(sql.Identifier(name)))
        return _postgres.url.removesuffix("vipo") + name

    return make


@pytest.fixture
def database_url(new_database: Callable[[], str]) -> str:
    return new_database()


@pytest.fixture(scope="module")
def module_database_url(new_database: Callable[[], str]) -> str:
    return new_database()


@pytest.fixture(scope="module")
def shared_redis(_redis: Redis) -> Redis:
    """Give the Redis of this process, emptied for this file."""
    with redis.Redis.from_url(_redis.url) as connection:
        connection.flushall()
    return _redis


@contextmanager
def on_database(**changes: Any) -> Iterator[None]:
    """Use a database that differs in these settings, and afterwards the one from before."""
    kept, described = connections["default"], connections.databases["default"]
    connections.databases["default"] = {**described, **changes}
    del connections["default"]
    try:
        yield
    finally:
        connections["default"].close()
        connections.databases["default"] = described
        connections["default"] = kept


Aside = Callable[..., Future[Any]]


@pytest.fixture
def aside() -> Iterator[Aside]:
    """Do something in a database session of its own: a function with what it is given; up to four at once."""
    with ThreadPoolExecutor(4) as pool:

        def do(work: Callable[..., Any], *given: Any) -> Future[Any]:
            def work_and_close() -> Any:
                try:
                    return work(*given)
                finally:
                    connections.close_all()

            return pool.submit(work_and_close)

        yield do


def one_waits() -> bool:
    """Tell whether a session waits for what another one holds; PostgreSQL alone."""
    with connection.cursor() as cursor:
        # Not pg_stat_activity, which a transaction reads once.
        cursor.execute("SELECT count(*) FROM pg_locks WHERE NOT granted")
        return bool(cursor.fetchone()[0])

"""A database that goes away in the middle of a tick ends that tick: nothing behind it is tried in vain."""

from __future__ import annotations

import logging
import threading
from collections.abc import Iterator

import psycopg
import pytest
from pytest_django import DjangoDbBlocker

from execution.ticker.ticker import run_ticker
from tests.kit.databases import on_database
from tests.kit.waiting import wait_for
from vipo_site.settings import postgres

pytestmark = pytest.mark.servers
WAITING = "FROM pg_stat_activity WHERE datname = current_database() AND wait_event_type = 'Lock'"


@pytest.fixture
def url(database_url: str, django_db_blocker: DjangoDbBlocker) -> Iterator[str]:
    with django_db_blocker.unblock(), on_database(**postgres(database_url)):
        yield database_url


def test_a_tick_in_which_the_database_goes_away_tries_nothing_more_and_writes_one_line(
    url: str, caplog: pytest.LogCaptureFixture
) -> None:
    stopping = threading.Event()
    ticker = threading.Thread(target=run_ticker, kwargs={"stopping": stopping})
    with psycopg.connect(url) as holding, psycopg.connect(url, autocommit=True) as looking:
        holding.execute("LOCK TABLE execution_timer")  # the ticker looks there before all that comes twice a second
        ticker.start()
        wait_for("the ticker", lambda: looking.execute(f"SELECT count(*) {WAITING}").fetchone() == (1,))
        stopping.set()
        looking.execute(f"SELECT pg_terminate_backend(pid) {WAITING}")
        ticker.join(30)
    assert not ticker.is_alive()
    lines = [line for line in caplog.records if line.levelno >= logging.WARNING]
    assert [line.name for line in lines] == ["execution.ticker.ticker"]
    assert lines[0].getMessage().startswith("The ticker's database does not answer: ")

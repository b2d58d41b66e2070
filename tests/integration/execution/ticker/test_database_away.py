"""A database that goes away in the middle of a tick ends that tick: nothing behind it is tried in vain.

The ticker goes on with the next one, over a connection of its own that is new.
"""

from __future__ import annotations

import logging
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import psycopg
import pytest
from django.db import InterfaceError, connection
from pytest_django import DjangoDbBlocker

from execution.ticker import ticker as tickers
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


@contextmanager
def ticking() -> Iterator[None]:
    stopping = threading.Event()
    ticker = threading.Thread(target=run_ticker, kwargs={"stopping": stopping})
    ticker.start()
    try:
        yield
    finally:
        stopping.set()
        ticker.join(30)
    assert not ticker.is_alive()


def test_a_ticker_whose_connection_is_ended_between_two_ticks_goes_on_with_a_new_one(
    url: str, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    over: list[int] = []
    tick = tickers.tick

    def ended_behind_the_first(now: Any) -> bool:
        leads = tick(now)
        with connection.cursor() as cursor:
            cursor.execute("SELECT pg_backend_pid()")
            over.append(cursor.fetchone()[0])
        if len(over) == 1:
            looking.execute("SELECT pg_terminate_backend(%s, 10000)", over)
        return leads

    monkeypatch.setattr(tickers, "tick", ended_behind_the_first)
    with psycopg.connect(url, autocommit=True) as looking, ticking():
        wait_for("the next ticks", lambda: len(over) > 2)
    assert over[0] not in over[1:]
    lines = [line for line in caplog.records if line.levelno >= logging.WARNING]
    assert [line.getMessage().partition(":")[0] for line in lines] == ["The ticker's database does not answer"]


def test_a_connection_that_is_closed_under_a_tick_ends_that_tick_alone(
    url: str, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    ticks: list[bool] = []
    tick = tickers.tick

    def closed_once(now: Any) -> bool:
        ticks.append(tick(now))
        if len(ticks) == 1:
            raise InterfaceError("the connection is closed")  # as drivers say it of what they noticed themselves
        return ticks[-1]

    monkeypatch.setattr(tickers, "tick", closed_once)
    with ticking():
        wait_for("the next ticks", lambda: len(ticks) > 2)
    assert set(ticks) == {True}
    lines = [line for line in caplog.records if line.levelno >= logging.WARNING]
    assert [line.getMessage() for line in lines] == ["The ticker's database does not answer: the connection is closed"]

"""A site on PostgreSQL, which other threads reach, too."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from pytest_django import DjangoDbBlocker, Settings

from registry import services
from registry.broker.accounts import accounts
from tests.kit.databases import on_database
from tests.kit.servers import Mosquitto, run_mosquitto
from tests.kit.sign_in import add_person
from tests.kit.sites import make_hall
from vipo_site.settings import postgres


@pytest.fixture
def url(database_url: str, django_db_blocker: DjangoDbBlocker) -> Iterator[str]:
    """A site of which there are two admins, on a PostgreSQL that other threads reach, too."""
    with django_db_blocker.unblock(), on_database(**postgres(database_url)):
        make_hall()
        services.set_member(site="hall", email=add_person("chief").email, role="admin")
        yield database_url


@pytest.fixture
def mosquitto(url: str, tmp_path: Path, settings: Settings, monkeypatch: pytest.MonkeyPatch) -> Iterator[Mosquitto]:
    """A broker that keeps accounts of its own, for which people wait as long as a test holds it up."""
    settings.VIPO_BROKER_ACCOUNTS = "registry.broker.accounts.DynamicSecurity"
    monkeypatch.setattr("registry.broker.accounts.ANSWER_LIMIT_S", 60.0)
    accounts.cache_clear()
    with run_mosquitto(tmp_path, {"server": "the server's word"}) as broker:
        told = {"host": "127.0.0.1", "username": "server", "password": "the server's word", "tls": False}
        settings.VIPO_MQTT = {**told, "port": broker.port}
        yield broker
    accounts.cache_clear()

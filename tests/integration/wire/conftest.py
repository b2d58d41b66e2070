"""A database in a file, as the embedded mode has it: the one in memory locks out a second thread instead of waiting."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from django.conf import LazySettings
from pytest_django import DjangoDbBlocker

from execution.gateway.gateway import Gateway
from registry import services
from registry.broker import accounts
from tests.integration.wire.bus import JOIN, SERVER_WORD, SITE, Bus
from tests.kit.databases import on_database
from tests.kit.files import copy_migrated
from tests.kit.mqtt import Ear
from tests.kit.servers import run_mosquitto
from vipo_site.embedded_broker.server import start_broker


@pytest.fixture
def database(tmp_path: Path, django_db_setup: None, django_db_blocker: DjangoDbBlocker) -> Iterator[Path]:
    file = tmp_path / "vipo.sqlite3"
    copy_migrated(file)
    with django_db_blocker.unblock(), on_database(NAME=str(file)):
        yield file


@pytest.fixture(params=["mosquitto", "amqtt"])
def bus(request: pytest.FixtureRequest, database: Path, tmp_path: Path, settings: LazySettings) -> Iterator[Bus]:
    services.create_site(name="Hall", slug=SITE)
    services.set_enrolment_key(site=SITE, key=JOIN)
    settings.VIPO_DEFAULT_SITE = SITE
    accounts.accounts.cache_clear()
    told = {"host": "127.0.0.1", "username": "server", "password": SERVER_WORD, "tls": False}
    if request.param == "mosquitto":
        settings.VIPO_BROKER_ACCOUNTS = "registry.broker.accounts.DynamicSecurity"
        with run_mosquitto(tmp_path, {"server": SERVER_WORD, f"join:{SITE}": JOIN}) as mosquitto:
            settings.VIPO_MQTT = {**told, "port": mosquitto.port}
            yield Bus("mosquitto", mosquitto.port, mosquitto.device_port, mosquitto)
    else:
        broker = start_broker(port=0, server_password=SERVER_WORD)
        settings.VIPO_MQTT = {**told, "port": broker.port}
        yield Bus("amqtt", broker.port, broker.port)
        broker.stop()
    accounts.accounts.cache_clear()


@pytest.fixture
def gateway(bus: Bus, settings: LazySettings) -> Iterator[Gateway]:
    made, stopping = Gateway(settings), threading.Event()
    thread = threading.Thread(target=made.run_forever, args=(stopping,))
    thread.start()
    with Ear(bus.server_port, SERVER_WORD, "vipo/v1/srv/status") as ear:
        ear.wait(lambda heard: True)
    yield made
    stopping.set()
    thread.join(20)

"""node-wot against the embedded form, with a token: it finds the Things, reads, observes (by MQTT, too), invokes."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

import httpx
import pytest

from tests.integration.web_of_things.node_wot import check_observer, check_story, make_token, run_client, wait_for_mixer
from tests.kit.demo import running_demo
from tests.kit.sign_in import open_page, sign_in

SPEED = 20


@dataclass(frozen=True)
class Running:
    """Where VIPO answers, and its admin's browser."""

    url: str
    admin: httpx.Client


@pytest.fixture(scope="module")
def running(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    with running_demo(tmp_path_factory.mktemp("state"), speed=SPEED) as demo, closing(open_page(demo.url)) as admin:
        account = demo.account("admin")
        sign_in(admin, account.email, account.password)
        wait_for_mixer(admin)
        yield Running(demo.url, admin)


@pytest.mark.parametrize("sse", [False, True])
def test_a_client_that_knows_only_the_standard_finds_reads_observes_and_invokes(running: Running, sse: bool) -> None:
    check_story(run_client(running.url, make_token(running.admin, "operate"), sse=sse))


def test_a_token_for_reading_reads_and_invokes_nothing(running: Running) -> None:
    with pytest.raises(AssertionError, match="Client error: Forbidden"):
        run_client(running.url, make_token(running.admin, "read"), sse=False)
    calls = running.admin.get("/api/sites/painting-factory/devices/paintMixer01").json()
    assert calls["status"] == "idle"


def test_it_observes_over_mqtt_with_a_token_for_the_broker_and_may_do_nothing_else_there(
    running: Running, tmp_path: Path
) -> None:
    check_observer(running.admin, running.url, tmp_path)

"""Two people, or two processes, do the same to an alert at the same moment."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime, timedelta
from pathlib import Path
from threading import Barrier
from typing import Any

from django.conf import LazySettings
from django.db import connection

from registry import services
from tests.kit.files import MIXER_TEXT

TEXT = MIXER_TEXT.encode()
NOW = datetime.now(UTC)


def at_once(*deeds: Callable[[], Any]) -> list[Any]:
    together = Barrier(len(deeds))

    def do(deed: Callable[[], Any]) -> Any:
        together.wait(20)
        try:
            return deed()
        finally:
            connection.close()

    with ThreadPoolExecutor(len(deeds)) as pool:
        return list(pool.map(do, deeds))


def test_an_alert_is_raised_once_and_seen_by_one(database: Path, settings: LazySettings) -> None:
    services.create_site(name="Hall", slug="hall")
    settings.VIPO_DEFAULT_SITE = "hall"
    services.ingest_description(device_id="paintMixer03", payload=TEXT, at=NOW)
    people = [
        services.create_user(email=f"{name}@x.example", password="a-long-password", display_name=name)
        for name in ("Ada", "Ben")
    ]
    moments = [NOW, NOW + timedelta(seconds=1), NOW + timedelta(seconds=2)]
    raising = [lambda at=at: services.raise_alert(device_id="paintMixer03", code="error", at=at) for at in moments]
    at_once(*raising)
    (alert,) = services.list_alerts(site="hall")
    assert 1 <= alert.count <= 3
    seeing = [lambda by=by: services.mark_alert_seen(alert_id=alert.id, by=by, at=NOW).seen_by for by in people]
    named = at_once(*seeing)
    assert named[0] == named[1] == services.find_alert(alert_id=alert.id).seen_by

"""Two people who press at once, on PostgreSQL, and what each is told."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import psycopg
from django.db import connection

from tests.kit.sites import MIXER
from tests.kit.waiting import wait_for

SITE = "/api/sites/hall"
MIXER_PATH = f"{SITE}/devices/{MIXER.id}"
OF_DEVICE = f"SELECT 1 FROM registry_device WHERE id = '{MIXER.id}' FOR UPDATE"
OF_MEMBER = "SELECT 1 FROM registry_membership FOR UPDATE"
OF_INVITATION = "SELECT 1 FROM registry_invitation FOR UPDATE"
OF_SITE = "SELECT 1 FROM registry_site FOR UPDATE"
OF_PERSON = "SELECT 1 FROM registry_user FOR UPDATE"
ANY_DEVICE = "LOCK TABLE registry_device IN EXCLUSIVE MODE"
WAITING = "SELECT count(*) FROM pg_stat_activity WHERE datname = current_database() AND wait_event_type = 'Lock'"
Press = Callable[[], Any]


def press_together(url: str, held: str, *presses: Press) -> list[Any]:
    """Let all press while this is held, one after the other; return what each is told, or the exception."""
    with (
        psycopg.connect(url) as holder,
        psycopg.connect(url, autocommit=True) as looking,
        ThreadPoolExecutor(len(presses)) as pool,
    ):
        holder.execute(held)
        pressed = []
        for number, press in enumerate(presses, 1):
            pressed.append(pool.submit(run_in_thread, press))
            wait_for("who waits", lambda wanted=number: looking.execute(WAITING).fetchone() == (wanted,))
        holder.commit()
        return [each.result(60) for each in pressed]


def run_in_thread(press: Press) -> Any:
    try:
        return press()
    finally:
        connection.close()


def told(answers: list[Any]) -> list[Any]:
    """Return the status of each that was done, and of the others what they were told."""
    return [
        answer.status_code if answer.status_code < 300 else (answer.status_code, answer.json()["code"])
        for answer in answers
    ]

"""Causes of alerts that come with messages: gathered in the process, written some seconds later, many as one.

A flood costs a dictionary's entry and a statement every `AGAIN_S`. What a process that is killed had gathered is lost.
That a cause has ended is looked up in the database, for another process may have raised the alert, or this one before
it was started anew.
"""

from __future__ import annotations

import logging
import threading
import time
from collections import OrderedDict
from collections.abc import Collection, Mapping
from dataclasses import replace
from datetime import datetime
from typing import Any

from django.db import DatabaseError, InterfaceError
from django.utils import timezone

from registry.alerts.alerts import Raised, end_alerts_before, raise_alerts
from registry.alerts.causes import AlertCode

log = logging.getLogger(__name__)
AGAIN_S = 10.0
ASK_EVERY_S = 3.0
ASKED_FOR_S = 2 * AGAIN_S
"""So long it is asked again whether an alert is open: another process may be about to write that it had cause."""
MOST_WAITING = 2000
MOST_REMEMBERED = 5000
Key = tuple[str, AlertCode]


class NoteBuffer:
    """Gathers causes until they are written; may be used from several threads. `now` is a clock's seconds."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._waiting: dict[Key, Raised] = {}
        self._mended: dict[Key, tuple[datetime, float]] = {}
        self._asked_at = -ASK_EVERY_S
        self._written_at: OrderedDict[Key, float] = OrderedDict()

    def add(self, raised: Raised) -> None:
        """Take in a cause, on top of the same that still waits."""
        key = (raised.device_id, raised.code)
        with self._lock:
            self._mended.pop(key, None)
            before = self._waiting.get(key)
            if before is not None:
                self._waiting[key] = replace(raised, count=before.count + raised.count)
            elif len(self._waiting) < MOST_WAITING:
                self._waiting[key] = raised

    def mend(self, devices: Collection[str], code: AlertCode, at: datetime, now: float) -> None:
        """Take in that a cause has ended at these devices by `at`; where this process has raised it, that is news."""
        with self._lock:
            for key in [(device, code) for device in devices]:
                self._mended[key] = (at, now + ASKED_FOR_S)
                if self._waiting.pop(key, None) or self._written_at.pop(key, None) is not None:
                    self._asked_at = now - ASK_EVERY_S

    def take(self, now: float) -> tuple[list[Raised], dict[Key, datetime]]:
        """Return what is due to be written, and forget it, and what has ended by when; that is settled by `settle`."""
        with self._lock:
            due = [key for key in self._waiting if now - self._written_at.get(key, -AGAIN_S) >= AGAIN_S]
            for key in due:
                self._written_at[key] = now
                self._written_at.move_to_end(key)
            while len(self._written_at) > MOST_REMEMBERED:
                self._written_at.popitem(last=False)
            is_asked = now - self._asked_at >= ASK_EVERY_S
            mended = {key: at for key, (at, _) in self._mended.items()} if is_asked else {}
            return [self._waiting.pop(key) for key in due], mended

    def settle(self, now: float) -> None:
        """Take in that alerts whose causes had ended were looked up, and ended."""
        with self._lock:
            self._asked_at = now
            self._mended = {key: ended for key, ended in self._mended.items() if now < ended[1]}


_buffer = NoteBuffer()


def note_alert(*, device_id: str, code: AlertCode, args: Mapping[str, Any] | None = None) -> None:
    """Take in a cause for an alert; `flush_alerts` writes it. Touches no database and may be called on any thread."""
    _buffer.add(Raised(device_id, code, timezone.now(), args or {}))


def note_mended(*, devices: Collection[str], code: AlertCode) -> None:
    """Take in that the cause of alerts has ended at these devices, whichever process has raised them."""
    _buffer.mend(devices, code, timezone.now(), time.monotonic())


def flush_alerts() -> None:
    """Write what has been gathered; each alert at most every 10 s, and look every 3 s for those that are over."""
    now = time.monotonic()
    raised, mended = _buffer.take(now)
    try:
        raise_alerts(raised=raised)
        raised = []
        if mended:
            end_alerts_before(times=mended, at=timezone.now())
            _buffer.settle(now)
    except (DatabaseError, InterfaceError) as error:
        log.warning("Alerts wait: the database does not take them now: %s", error)
        for each in raised:
            _buffer.add(each)

"""Causes of alerts that come with messages: gathered in the process, written some seconds later, many as one.

A flood costs a dictionary's entry and a statement every `AGAIN_S`. What a process that is killed had gathered is lost.
"""

from __future__ import annotations

import logging
import threading
import time
from collections import OrderedDict
from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import Any

from django.db import DatabaseError
from django.utils import timezone

from registry.alerts.alerts import Raised, end_alert, raise_alerts
from registry.alerts.causes import AlertCode

log = logging.getLogger(__name__)
AGAIN_S = 10.0
MOST_WAITING = 2000
MOST_REMEMBERED = 5000
Key = tuple[str, AlertCode]


class NoteBuffer:
    """Gathers causes until they are written; may be used from several threads. `now` is a clock's seconds."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._waiting: dict[Key, Raised] = {}
        self._mended: set[Key] = set()
        self._written_at: OrderedDict[Key, float] = OrderedDict()

    def add(self, raised: Raised) -> None:
        """Take in a cause, on top of the same that still waits."""
        key = (raised.device_id, raised.code)
        with self._lock:
            self._mended.discard(key)
            before = self._waiting.get(key)
            if before is not None:
                self._waiting[key] = replace(raised, count=before.count + raised.count)
            elif len(self._waiting) < MOST_WAITING:
                self._waiting[key] = raised

    def mend(self, devices: Collection[str], code: AlertCode) -> None:
        """Take in that a cause has ended at these devices, where this process has raised it."""
        with self._lock:
            for key in [(device, code) for device in devices]:
                if self._waiting.pop(key, None) or key in self._written_at:
                    self._mended.add(key)

    def take(self, now: float) -> tuple[list[Raised], set[Key]]:
        """Return what is due to be written and what is to be ended, and forget both."""
        with self._lock:
            due = [key for key in self._waiting if now - self._written_at.get(key, -AGAIN_S) >= AGAIN_S]
            for key in due:
                self._written_at[key] = now
                self._written_at.move_to_end(key)
            while len(self._written_at) > MOST_REMEMBERED:
                self._written_at.popitem(last=False)
            mended, self._mended = self._mended, set()
            for key in mended:
                self._written_at.pop(key, None)
            return [self._waiting.pop(key) for key in due], mended


_buffer = NoteBuffer()


def note_alert(*, device_id: str, code: AlertCode, args: Mapping[str, Any] | None = None) -> None:
    """Take in a cause for an alert; `flush_alerts` writes it. Touches no database and may be called on any thread."""
    _buffer.add(Raised(device_id, code, timezone.now(), args or {}))


def note_mended(*, devices: Collection[str], code: AlertCode) -> None:
    """Take in that the cause of alerts that this process has raised has ended at these devices."""
    _buffer.mend(devices, code)


def flush_alerts() -> None:
    """Write what has been gathered; each alert at most every 10 s."""
    raised, mended = _buffer.take(time.monotonic())
    try:
        raise_alerts(raised=raised)
        for device, code in mended:
            end_alert(device_id=device, code=code, at=timezone.now())
    except DatabaseError as error:
        log.warning("Alerts wait: the database does not take them now: %s", error)
        for each in raised:
            _buffer.add(each)

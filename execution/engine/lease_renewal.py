"""Renews the leases of a process once a second, also while a turn takes long; one that hangs is given up in the end."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import timedelta

from django.db import DatabaseError, InterfaceError, connection

from execution import database
from execution.engine import lease as leases
from execution.engine.lease import Lease
from execution.models import InboxEvent, SiteLease
from execution.runs.before_start import due_runs

log = logging.getLogger(__name__)
EVERY_S = 1.0
HANGS_AFTER_S = 30.0
"""A turn that takes longer is taken for one that never ends: another process may try."""
WAITS_S = 1.0


class LeaseRenewal:
    """One thread for all sites of this process, with a connection of its own; it ends when there is nothing to keep."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._changed = threading.Condition(self._lock)
        self._kept: dict[Lease, float] = {}
        self._thread: threading.Thread | None = None
        self._others_wait = False

    @contextmanager
    def keeping(self, lease: Lease) -> Iterator[None]:
        """Renew a lease for as long as the block takes."""
        with self._lock:
            self._kept[lease] = time.monotonic()
            if self._thread is None:
                self._thread = threading.Thread(target=self._run, name="lease-renewal", daemon=True)
                self._thread.start()
        try:
            yield
        finally:
            with self._lock:
                self._kept.pop(lease, None)
                self._changed.notify_all()

    def note_turn(self, lease: Lease) -> None:
        """Take in that a turn begins."""
        with self._lock:
            self._kept[lease] = time.monotonic()

    def others_wait(self, since: float) -> bool:
        """Tell whether an owner that has had nothing to do since then should make room for sites without an owner."""
        return self._others_wait and time.monotonic() - since >= WAITS_S / 4

    def _run(self) -> None:
        try:
            while True:
                with self._lock:
                    if not self._kept:
                        self._thread = None
                        return
                    self._changed.wait(EVERY_S)
                    limit = time.monotonic() - HANGS_AFTER_S
                    kept = [lease for lease, turned_at in self._kept.items() if turned_at > limit]
                self._renew(kept)
        finally:
            connection.close()

    def _renew(self, kept: list[Lease]) -> None:
        try:
            leases.renew(kept)
            self._others_wait = bool(kept) and self._is_somebody_waiting()
        except (DatabaseError, InterfaceError) as error:
            log.warning("Leases were not renewed: %s", error)
            connection.close()

    def _is_somebody_waiting(self) -> bool:
        owned = SiteLease.objects.filter(leases.holds()).values("site__slug")
        before = database.now() - timedelta(seconds=WAITS_S)
        left = InboxEvent.objects.filter(taken_at=None, created_at__lt=before).exclude(site="")
        begin = due_runs(created_before=before, due_by=before).exclude(site__slug__in=owned)
        return left.exclude(site__in=owned).exists() or begin.exists()


renewal = LeaseRenewal()

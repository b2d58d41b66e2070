"""What execution does when a device has said something: wake the floor and the runs that care, and nobody else."""

from __future__ import annotations

import threading
import time

from execution import mailbox
from execution.models import FloorState, Run

AT_MOST_EVERY_S = 0.1
_lock = threading.Lock()
_hinted_at: dict[str, float] = {}


def record_device_change(*, site: str, device_id: str) -> None:
    """Wake what depends on a device's pose, presence or readings; the registry has the values already.

    Cheap when no run cares, and at most ten times a second for a site: what comes between is seen by the next.
    """
    if not _is_due(site):
        return
    if FloorState.objects.filter(site__slug=site, active=True).exists():
        mailbox.send_hint(mailbox.ADVANCE_SITE, site)
    for run in Run.objects.filter(site__slug=site, watches=True, status=Run.Status.RUNNING).values_list(
        "id", flat=True
    ):
        mailbox.send_hint(mailbox.ADVANCE_RUN, str(run))


def _is_due(site: str) -> bool:
    now = time.monotonic()
    with _lock:
        if now - _hinted_at.get(site, -1.0) < AT_MOST_EVERY_S:
            return False
        _hinted_at[site] = now
        return True

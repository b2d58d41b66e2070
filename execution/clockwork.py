"""The ticker's loop, in a thread of the embedded mode or in a process of its own."""

from __future__ import annotations

import logging
import threading
from datetime import UTC, datetime

from django.db import DatabaseError, connection

from execution.ticking import tick

log = logging.getLogger(__name__)
TICK_S = 0.1
IDLE_S = 1.0


def run_ticker(stopping: threading.Event) -> None:
    """Tick until `stopping` is set; a database that is away is waited for."""
    while not stopping.is_set():
        try:
            leads = tick(datetime.now(UTC))
        except DatabaseError as error:
            log.warning("The ticker's database does not answer: %s", error)
            connection.close()
            leads = False
        except Exception:  # the edge of the process: without the ticker no timer would ever fire
            log.exception("The ticker failed; it goes on.")
            leads = False
        stopping.wait(TICK_S if leads else IDLE_S)
    connection.close()

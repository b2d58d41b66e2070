"""The heartbeat of a process: a thread that writes, every two seconds, that the process works.

It beats only while the process's own loop goes round (`beat`), so a loop that stands still falls silent, too; one that
is busy for a moment does not, since it does not write itself. All times in the row are of the database's clock.
"""

from __future__ import annotations

import os
import socket
import threading
import time
from collections.abc import Callable, Mapping
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from typing import Any, Literal

from django.db import DatabaseError, InterfaceError, connection
from django.db.models.functions import Now

from registry.live.fanout import Outage
from registry.models import Heartbeat
from registry.processes.counters import counters_to_json
from registry.processes.heartbeats import forget_predecessors
from vipo_device.kit.liveness_file import LivenessFile

BEAT_S = 2.0
WHOLE_EVERY = 5
"""Each so many beats also carry the counts and the distance of the clocks."""
LOOP_LIMIT_S = 30.0
"""A loop that has not come round for so long stands still."""
UNSURE_S = 1.0
"""An answer that took longer says nothing exact of how far clocks are apart."""
GOODBYE_S = 3.0
_telling = threading.Lock()
"""Held by the writer that tells what this process has counted: nothing is told twice."""
ProcessKind = Literal["web", "gateway", "worker", "ticker", "mirror", "stand-ins", "twin"]


def installed_version() -> str:
    """Return the version of VIPO that runs here."""
    try:
        return version("vipo")
    except PackageNotFoundError:
        return "unknown"


class HeartbeatWriter:
    """Beats for one part of this process, from `start` until `stop`.

    `clock` is the process's own, `liveness_file` the file that a container's check of health looks at
    (vipo_device/kit/liveness_file.py), empty for none. Where several parts share a process, as in the demo, the one
    that began first tells what the process has counted.
    """

    def __init__(
        self,
        kind: ProcessKind,
        name: str = "",
        *,
        liveness_file: str = "",
        clock: Callable[[], datetime] = lambda: datetime.now(UTC),
    ) -> None:
        machine = socket.gethostname()
        self._row = Heartbeat(kind=kind, name=(name or f"{kind}-{machine}")[:120], machine=machine[:120])
        self._row.process, self._row.version = os.getpid(), installed_version()
        self._liveness_file, self._clock, self._tells = LivenessFile(liveness_file), clock, False
        self._activity = ""
        self._turned_s = time.monotonic()
        self._beats = 0
        self._stopping = threading.Event()
        self._thread: threading.Thread | None = None
        self._outage = Outage("The database of heartbeats", "Nobody sees that this process works.")

    def beat(self, activity: str = "") -> None:
        """Say that the loop has come round once more, and what it is at; costs no question to the database."""
        self._turned_s, self._activity = time.monotonic(), activity
        self._liveness_file.touch()

    def start(self) -> HeartbeatWriter:
        """Begin to beat."""
        self._turned_s = time.monotonic()
        self._tells = _telling.acquire(blocking=False)
        self._thread = threading.Thread(target=self._run, name=f"heartbeat-{self._row.kind}", daemon=True)
        self._thread.start()
        return self

    def stop(self) -> None:
        """Say goodbye, and wait for that a little: who ends in order is not missed."""
        self._stopping.set()
        if self._thread is not None:
            self._thread.join(GOODBYE_S)
        if self._tells:
            self._tells = False
            _telling.release()

    def _counters(self) -> Mapping[str, Any]:
        return counters_to_json() if self._tells else {}

    def _run(self) -> None:
        try:
            while not self._stopping.is_set():
                self._try(self._beat_once)
                self._stopping.wait(BEAT_S)
            self._try(self._say_goodbye)
        finally:
            connection.close()

    def _try(self, act: Callable[[], None]) -> None:
        try:
            act()
            self._outage.end()
        except (DatabaseError, InterfaceError) as error:
            self._outage.begin(error)
            connection.close()

    def _beat_once(self) -> None:
        if time.monotonic() - self._turned_s > LOOP_LIMIT_S:
            return
        more: dict[str, Any] = {}
        if self._beats % WHOLE_EVERY == 0:
            more = {"counters": self._counters(), **self._measure_clock()}
        if not self._write(at=Now(), activity=self._activity, ended_at=None, **more):
            self._begin()
        else:
            self._beats += 1

    def _begin(self) -> None:
        """Write the first beat, also of a process that was frozen for so long that it was forgotten."""
        row = self._row
        forget_predecessors(kind=row.kind, name=row.name)
        Heartbeat.objects.create(
            id=row.id, kind=row.kind, name=row.name, machine=row.machine, process=row.process, version=row.version,
            activity=self._activity, since=Now(), at=Now(),
        )  # fmt: skip
        self._write(counters=self._counters(), **self._measure_clock())
        self._beats = 1

    def _write(self, **values: Any) -> bool:
        return bool(Heartbeat.objects.filter(pk=self._row.pk).update(**values))

    def _measure_clock(self) -> dict[str, float]:
        """Ask the database for its time; ours at that moment lies between the question and the answer."""
        here, began_s = self._clock(), time.monotonic()
        there = Heartbeat.objects.filter(pk=self._row.pk).annotate(now=Now()).values_list("now", flat=True).first()
        took_s = time.monotonic() - began_s
        if there is None or took_s > UNSURE_S:
            return {}
        return {"clock_apart_s": round((here - there).total_seconds() + took_s / 2, 3)}

    def _say_goodbye(self) -> None:
        self._write(at=Now(), ended_at=Now(), counters=self._counters())

"""What about the processes people must know; pure, made anew of the heartbeats each time that somebody asks.

So nobody has to raise it or to end it: it is said while it holds, also when the ticker is the one that is silent, and
by whichever web process is asked.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import timedelta
from typing import Any, Literal

from registry.processes.heartbeats import ProcessView, kinds_of

NEEDED = ("gateway", "worker", "ticker")
"""Without one of each nothing goes on; a web process is there where somebody is answered."""
START_GRACE = timedelta(minutes=1)
"""So long after a clean end, or the start of the first process, another may come: an update takes its time."""
CLOCKS_APART_S = 2.0
FindingCode = Literal[
    "no_gateway", "no_worker", "no_ticker", "process_silent", "clock_apart", "archive_failed", "set_aside"
]
_NONE: Mapping[str, FindingCode] = {"gateway": "no_gateway", "worker": "no_worker", "ticker": "no_ticker"}
TEXTS: Mapping[FindingCode, str] = {
    "no_gateway": "No gateway is running: commands and what devices say wait.",
    "no_worker": "No worker is running: runs and rehearsals stand still.",
    "no_ticker": "No ticker is running: timers do not fire, and work that was lost is not found.",
    "process_silent": "A process has fallen silent: {kind} {name}.",
    "archive_failed": "Old histories cannot be archived, and stay in the database: {why}",
    "set_aside": "Messages that could not be processed wait for an admin: {count}.",
    "clock_apart": "The clock of {kind} {name} is {seconds} s apart from the database's.",
}


@dataclass(frozen=True, slots=True)
class Finding:
    """Something that is wrong with the processes now; `args` are what its sentence is made of."""

    code: FindingCode
    severity: Literal["warning", "error"]
    args: Mapping[str, Any] = field(default_factory=dict)

    @property
    def text(self) -> str:
        """The English sentence."""
        return TEXTS[self.code].format_map(self.args)


def find_trouble(*, processes: Sequence[ProcessView]) -> tuple[Finding, ...]:
    """Return what is wrong with processes that were read together, the gravest first."""
    found = [*_find_missing(processes), *_find_silent(processes), *_find_apart(processes)]
    return tuple(sorted(found, key=lambda finding: finding.severity != "error"))


def _find_missing(processes: Sequence[ProcessView]) -> Iterator[Finding]:
    beating = kinds_of(processes, "beats")
    for kind in NEEDED:
        if kind not in beating and _is_missed(kind, processes):
            yield Finding(_NONE[kind], "error")


def _is_missed(kind: str, processes: Sequence[ProcessView]) -> bool:
    """Tell whether it is time for one to be there: at once after a death, a while after a goodbye or a start."""
    own = [process for process in processes if process.kind == kind]
    if any(process.state == "silent" for process in own):
        return True
    began = [process.ended_at or process.since for process in own or processes]
    return bool(processes) and processes[0].now - (max(began) if own else min(began)) > START_GRACE


def _find_silent(processes: Sequence[ProcessView]) -> Iterator[Finding]:
    for process in processes:
        if process.state == "silent" and not _is_replaced(process, processes):
            yield Finding("process_silent", "warning", _named(process) | {"seconds": round(process.age_s)})


def _is_replaced(silent: ProcessView, processes: Sequence[ProcessView]) -> bool:
    """Tell whether one of its name has begun since its last beat: who was killed and started again is not missed.

    Where that one is silent, too, it is missed in its place.
    """
    return any(
        other is not silent and (other.kind, other.name) == (silent.kind, silent.name) and other.since > silent.at
        for other in processes
    )


def _find_apart(processes: Sequence[ProcessView]) -> Iterator[Finding]:
    for process in processes:
        apart_s = process.clock_apart_s
        if process.state == "beats" and apart_s is not None and abs(apart_s) > CLOCKS_APART_S:
            yield Finding("clock_apart", "error", _named(process) | {"seconds": round(apart_s, 1)})


def _named(process: ProcessView) -> dict[str, Any]:
    return {"kind": process.kind, "name": process.name, "machine": process.machine}

"""What a process counts of its own work; it goes out with its heartbeat. Bounded, whatever strangers send.

Every measurement stands in `MEASURES` with its labels. A label's values are few and ours (a route, a status, a kind of
message), never a person's, a device's or a program's name; those beyond `MOST_SERIES` are counted together as `other`.
"""

from __future__ import annotations

import threading
from bisect import bisect_left
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

MOST_SERIES = 300
MOST_CHARACTERS = 80
OTHER = "other"
BOUNDS_S = (0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 10.0)
"""Upper bounds of the classes into which durations are sorted; longer ones are in a class of their own."""
Labels = tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Measure:
    """What is measured: a count that only grows, how much there is now, or durations in seconds."""

    kind: Literal["count", "amount", "duration"]
    text: str
    labels: Labels = ()


MEASURES: Mapping[str, Measure] = {
    "http_requests": Measure("count", "Answers to HTTP requests", ("method", "route", "status")),
    "http_request_seconds": Measure("duration", "How long answers to HTTP requests took", ("route",)),
    "http_database_queries": Measure("count", "Questions to the database within HTTP requests", ("route",)),
    "loop_lag_seconds": Measure("duration", "How long the loop of a web process let a call wait"),
    "site_sockets": Measure("amount", "Open sockets that follow a site"),
    "wall_sockets": Measure("amount", "Open sockets of wall screens"),
    "program_sockets": Measure("amount", "Open sockets to shared programs"),
    "rooms": Measure("amount", "Programs that are open for drawing"),
    "room_send_seconds": Measure("duration", "From a frame's queueing in a room to its sending"),
    "mqtt_messages_in": Measure("count", "MQTT messages that came, by kind", ("message",)),
    "mqtt_messages_refused": Measure("count", "MQTT messages that were not taken, by kind of reason", ("reason",)),
    "mqtt_messages_out": Measure("count", "MQTT messages that went out, by kind", ("message",)),
    "gateway_inbox": Measure("amount", "MQTT messages that a gateway has yet to take in"),
    "command_answers": Measure("count", "Answers of devices to commands, by status", ("status",)),
    "run_steps": Measure("count", "Steps of runs, by what became of them", ("event",)),
    "tasks": Measure("count", "Tasks that a worker has finished", ("task", "state")),
}


class Counters:
    """The counts of one process; may be used from all of its threads."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._counts: dict[str, dict[Labels, float]] = {}
        self._durations: dict[str, dict[Labels, list[float]]] = {}
        self._amounts: dict[str, Callable[[], float]] = {}

    def count(self, name: str, labels: Sequence[str] = (), by: float = 1) -> None:
        """Count something on."""
        with self._lock:
            series = self._counts.setdefault(name, {})
            key = _bounded(series, labels)
            series[key] = series.get(key, 0) + by

    def time(self, name: str, seconds: float, labels: Sequence[str] = ()) -> None:
        """Sort a duration into its class; the first number of a series is the sum."""
        with self._lock:
            series = self._durations.setdefault(name, {})
            classes = series.setdefault(_bounded(series, labels), [0.0] * (len(BOUNDS_S) + 2))
            classes[0] += seconds
            classes[1 + bisect_left(BOUNDS_S, seconds)] += 1

    def watch(self, name: str, read: Callable[[], float]) -> None:
        """Have an amount read at each beat, from a foreign thread."""
        with self._lock:
            self._amounts[name] = read

    def to_json(self) -> dict[str, list[Any]]:
        """Return all series by the names of their measures: pairs of labels and value, or labels and classes."""
        with self._lock:
            amounts = dict(self._amounts)
            told: dict[str, list[Any]] = {
                name: [[list(labels), value] for labels, value in series.items()]
                for name, series in self._counts.items()
            }
            for name, timed in self._durations.items():
                told[name] = [[list(labels), _rounded(classes)] for labels, classes in timed.items()]
        return told | {name: [[[], read()]] for name, read in amounts.items()}


def _rounded(classes: Sequence[float]) -> list[float]:
    return [round(classes[0], 6), *map(int, classes[1:])]


def _bounded(series: Mapping[Labels, Any], labels: Sequence[str]) -> Labels:
    """Return the series that something is counted in: its own, or that of all for which there is no room."""
    key = tuple(label[:MOST_CHARACTERS] for label in labels)
    return key if key in series or len(series) < MOST_SERIES else (OTHER,) * len(key)


_of_this_process = Counters()


def count(*, name: str, labels: Sequence[str] = (), by: float = 1) -> None:
    """Count something on that this process has done; `name` and the number of labels are those of `MEASURES`."""
    _of_this_process.count(name, labels, by)


def time_spent(*, name: str, seconds: float, labels: Sequence[str] = ()) -> None:
    """Take in how long something took in this process."""
    _of_this_process.time(name, seconds, labels)


def watch_amount(*, name: str, read: Callable[[], float]) -> None:
    """Have an amount of this process read at each beat; `read` is called on a foreign thread and must not wait."""
    _of_this_process.watch(name, read)


def counters_to_json() -> dict[str, list[Any]]:
    """Return what this process has counted."""
    return _of_this_process.to_json()

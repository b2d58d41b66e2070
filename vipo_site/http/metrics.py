"""`/metrics`: how VIPO fares, in the form that Prometheus reads. One web process tells of all processes.

Gateways, workers and the ticker have no HTTP server: what they count comes with their heartbeats
(docs/adr/0027-processes-are-seen-by-their-heartbeats.md).
"""

from __future__ import annotations

import hmac
from collections.abc import Iterable, Iterator, Mapping, Sequence
from ipaddress import ip_address
from itertools import accumulate
from typing import Any

from django.conf import settings
from django.http import HttpRequest, HttpResponse
from prometheus_client import CONTENT_TYPE_LATEST, CollectorRegistry, generate_latest
from prometheus_client.core import (
    CounterMetricFamily,
    GaugeMetricFamily,
    HistogramMetricFamily,
    Metric,
)
from prometheus_client.registry import Collector

from execution import services as execution
from registry import services as registry
from vipo_site.http.api import problem

WHOSE = ("kind", "process")
Series = dict[tuple[str, ...], list[float]]


def metrics(request: HttpRequest) -> HttpResponse:
    """Tell who may know it how VIPO fares: with a token, where one is set, else from this machine alone."""
    if request.method not in {"GET", "HEAD"}:
        return problem(405, "no_such_method", "Measurements are read with GET.")
    if refusal := _refusal(request):
        return refusal
    told = CollectorRegistry()
    told.register(_Collected())
    return HttpResponse(generate_latest(told), content_type=CONTENT_TYPE_LATEST, headers={"Cache-Control": "no-store"})


def _refusal(request: HttpRequest) -> HttpResponse | None:
    token = settings.VIPO_METRICS_TOKEN
    if not token:
        is_here = ip_address(request.META.get("REMOTE_ADDR") or "::").is_loopback
        # A proxy on this machine that nobody has named asks for others, too.
        if is_here and "X-Forwarded-For" not in request.headers:
            return None
        return problem(404, "not_found", "There is no such call. See docs/api.md.")
    scheme, _, shown = request.headers.get("Authorization", "").partition(" ")
    if scheme.lower() == "bearer" and hmac.compare_digest(shown.encode(), token.encode()):
        return None
    refused = problem(401, "signed_out", "Measurements are for who shows the token of VIPO_METRICS_TOKEN.")
    refused["WWW-Authenticate"] = "Bearer"
    return refused


class _Collected(Collector):
    """Everything that is measured, asked of the database when it is to be told."""

    def collect(self) -> Iterator[Metric]:
        processes = registry.list_processes(with_counters=True)
        yield from _of_processes(processes)
        yield from _of_counters(processes)
        yield from _of_queues()

    def describe(self) -> Iterable[Metric]:
        return ()


def _of_processes(processes: Sequence[registry.ProcessView]) -> Iterator[Metric]:
    ages = GaugeMetricFamily("vipo_process_beat_age_seconds", "Since the last heartbeat", labels=[*WHOSE, "state"])
    clocks = GaugeMetricFamily(
        "vipo_process_clock_apart_seconds", "A process's clock less the database's", labels=WHOSE
    )
    least: dict[tuple[str, str, str], float] = {}
    apart: dict[tuple[str, str], float] = {}
    for process in processes:
        key = (process.kind, process.name, process.state)
        least[key] = min(process.age_s, least.get(key, process.age_s))
        if process.clock_apart_s is not None and process.state == "beats":
            known = apart.get(key[:2], 0.0)
            apart[key[:2]] = max(known, process.clock_apart_s, key=abs)
    for labels, age_s in least.items():
        ages.add_metric(labels, age_s)
    for whose, seconds in apart.items():
        clocks.add_metric(whose, seconds)
    found = GaugeMetricFamily(
        "vipo_findings", "What is wrong with processes or sites, by code", labels=["code", "severity"]
    )
    wrong = (*registry.find_trouble(processes=processes), *execution.find_trouble_of_sites())
    codes = [(finding.code, finding.severity) for finding in wrong]
    for code in sorted(set(codes)):
        found.add_metric(code, codes.count(code))
    yield from (ages, clocks, found)


def _of_counters(processes: Sequence[registry.ProcessView]) -> Iterator[Metric]:
    for name, measure in registry.MEASURES.items():
        series: Series = {}
        for process in processes:
            _add(series, process, measure, process.counters.get(name, ()))
        labels = (*WHOSE, *measure.labels)
        if measure.kind == "duration":
            yield _histogram(name, measure.text, labels, series)
            continue
        family = CounterMetricFamily if measure.kind == "count" else GaugeMetricFamily
        told = family(f"vipo_{name}", measure.text, labels=labels)
        for key, (value,) in series.items():
            told.add_metric(key, value)
        yield told


def _add(series: Series, process: registry.ProcessView, measure: registry.Measure, told: Iterable[Any]) -> None:
    """Add a process's series to those of its name; what another version told in another form is left out."""
    width = len(registry.BOUNDS_S) + 2 if measure.kind == "duration" else 1
    for labels, value in told:
        numbers = value if isinstance(value, list) else [value]
        is_known = len(labels) == len(measure.labels) and len(numbers) == width
        if is_known and all(isinstance(number, int | float) for number in numbers):
            key = (process.kind, process.name, *map(str, labels))
            series[key] = [a + b for a, b in zip(series.get(key, [0] * width), numbers, strict=True)]


def _histogram(name: str, text: str, labels: Sequence[str], series: Mapping[tuple[str, ...], list[float]]) -> Metric:
    timed = HistogramMetricFamily(f"vipo_{name}", text, labels=labels)
    bounds = [*map(str, registry.BOUNDS_S), "+Inf"]
    for key, (total, *classes) in series.items():
        timed.add_metric(key, buckets=list(zip(bounds, accumulate(classes), strict=True)), sum_value=total)
    return timed


def _of_queues() -> Iterator[Metric]:
    now = registry.read_time()
    found = execution.read_overview(now=now)
    lengths = GaugeMetricFamily("vipo_queue_length", "How many wait", labels=["queue"])
    ages = GaugeMetricFamily("vipo_queue_oldest_seconds", "How long the first of a queue has waited", labels=["queue"])
    for queue in found.queues:
        lengths.add_metric([queue.name], queue.waiting)
        age_s = (now - queue.oldest_at).total_seconds() if queue.oldest_at else 0.0
        ages.add_metric([queue.name], max(0.0, age_s))
    for name, length in execution.read_task_queues().items():
        lengths.add_metric([f"tasks:{name}"], length)
    runs = GaugeMetricFamily("vipo_runs_open", "Runs that are not over", labels=["state"])
    commands = GaugeMetricFamily("vipo_commands_open", "Commands that are not over", labels=["status"])
    for family, counts in ((runs, found.runs), (commands, found.commands)):
        for state, count in counts.items():
            family.add_metric([state], count)
    yield from (lengths, ages, runs, commands)

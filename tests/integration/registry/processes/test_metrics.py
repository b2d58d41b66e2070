"""/metrics: what it tells of all processes, who may read it, and what strangers cannot put into it."""

from __future__ import annotations

from collections import Counter
from datetime import timedelta
from typing import Any

import pytest
from django.db import connection
from django.test import Client
from django.test.utils import CaptureQueriesContext
from django.utils import timezone
from prometheus_client.parser import text_string_to_metric_families

from execution.gateway.gateway import KINDS, REASONS, _count
from execution.models import DeadLetter, Keeping
from registry import services
from registry.models import Heartbeat, Site
from registry.processes import counters
from registry.processes.counters import BOUNDS_S, MOST_SERIES, OTHER, Counters
from tests.kit.sign_in import signed_in

pytestmark = pytest.mark.django_db
TOKEN = "a-token-for-measurements"


def read(**told: Any) -> dict[str, dict[tuple[tuple[str, str], ...], float]]:
    """Return the samples by name and labels, as Prometheus reads them."""
    answer = Client().get("/metrics", **told)
    assert answer.status_code == 200
    found: dict[str, dict[tuple[tuple[str, str], ...], float]] = {}
    for family in text_string_to_metric_families(answer.content.decode()):
        for sample in family.samples:
            key = tuple(sorted(sample.labels.items()))
            assert key not in found.setdefault(sample.name, {}), f"{sample.name}{key} is told twice"
            found[sample.name][key] = sample.value
    return found


def make_process(kind: str, name: str, *, age: timedelta = timedelta(), **counters: Any) -> None:
    at = timezone.now() - age
    Heartbeat.objects.create(
        kind=kind, name=name, machine="m1", process=1, version="1", since=at, at=at, counters=counters
    )


def of(kind: str, name: str, **more: str) -> tuple[tuple[str, str], ...]:
    return tuple(sorted({"kind": kind, "process": name, **more}.items()))


def test_what_all_processes_count_is_told_by_one_and_those_of_a_name_are_added_up() -> None:
    make_process("gateway", "g1", mqtt_messages_in=[[["state"], 7]])
    timed = [0.3, 1, *[0] * (len(BOUNDS_S) - 1), 2]
    for _ in range(2):
        counted = [[["GET", "api/me", "200"], 3]]
        make_process("web", "w1", http_requests=counted, http_request_seconds=[[["api/me"], timed]])
    found = read()
    assert found["vipo_mqtt_messages_in_total"] == {of("gateway", "g1", message="state"): 7}
    assert found["vipo_http_requests_total"] == {of("web", "w1", method="GET", route="api/me", status="200"): 6}
    buckets = found["vipo_http_request_seconds_bucket"]
    assert buckets[of("web", "w1", route="api/me", le="0.005")] == 2
    assert buckets[of("web", "w1", route="api/me", le="10.0")] == 2
    assert buckets[of("web", "w1", route="api/me", le="+Inf")] == 6
    assert found["vipo_http_request_seconds_sum"] == {of("web", "w1", route="api/me"): 0.6}


def test_a_silent_process_and_what_is_missing_are_told() -> None:
    make_process("ticker", "t1", age=timedelta(seconds=30))
    make_process("gateway", "g1")
    make_process("worker", "w1")
    found = read()
    assert 29 < found["vipo_process_beat_age_seconds"][of("ticker", "t1", state="silent")] < 40
    assert found["vipo_findings"] == {
        (("code", "no_ticker"), ("severity", "error")): 1,
        (("code", "process_silent"), ("severity", "warning")): 1,
    }
    assert found["vipo_queue_length"][(("queue", "inbox"),)] == 0
    assert found["vipo_queue_length"][(("queue", "tasks:runs"),)] >= 0
    assert set(found["vipo_runs_open"]) == {(("state", each),) for each in ("pending", "running", "paused")}


def test_what_is_wrong_with_sites_and_waits_for_admins_is_told_without_their_names() -> None:
    for number, (errors, trouble) in enumerate([(2, ""), (1, "No space left"), (0, "No such folder")]):
        slug = f"site-{number}"
        services.create_site(name=slug, slug=slug)
        place = Site.objects.get(slug=slug)
        Keeping.objects.create(site=place, trouble=trouble)
        for _ in range(errors):
            at = timezone.now() - timedelta(seconds=30)
            DeadLetter.objects.create(site=place, target=f"site:{slug}", event={}, error="Broken.", at=at)
    found = read()
    assert found["vipo_queue_length"][(("queue", "set_aside"),)] == 3
    assert 29 < found["vipo_queue_oldest_seconds"][(("queue", "set_aside"),)] < 40
    assert found["vipo_findings"] == {
        (("code", "archive_failed"), ("severity", "warning")): 2,
        (("code", "set_aside"), ("severity", "error")): 2,
    }


def test_a_hostile_name_stays_one_label_and_what_another_version_told_is_left_out() -> None:
    hostile = 'g" 1\nvipo_findings{code="x"} 7\n\\'
    make_process(
        "gateway", hostile, mqtt_messages_in=[[["ack"], 1], [["ack", "more"], 2], [["state"], [1, 2]]], gone=[[[], 1]]
    )
    found = read()
    assert found["vipo_mqtt_messages_in_total"] == {of("gateway", hostile, message="ack"): 1}
    assert "vipo_findings" not in found


def test_strangers_cannot_make_series() -> None:
    counters = Counters()
    for number in range(MOST_SERIES + 50):
        counters.count("http_requests", ("GET", f"made/up/{number}" * 50, "404"))
    told = counters.to_json()["http_requests"]
    assert (len(told), told[-1]) == (MOST_SERIES + 1, [[OTHER] * 3, 50])
    assert max(len(label) for labels, _ in told for label in labels) == 80
    assert KINDS < REASONS
    before = Counter(kinds_in())
    _count("mqtt_messages_in", "made/up\n", KINDS)
    assert Counter(kinds_in()) - before == Counter({OTHER: 1})


def kinds_in() -> dict[str, int]:
    return {labels[0]: int(value) for labels, value in services.counters_to_json().get("mqtt_messages_in", ())}


def test_addresses_are_counted_by_their_route_and_never_as_they_were_asked(
    hall: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(counters, "_of_this_process", Counters())  # there is room for so many addresses in a process
    client = signed_in("viewer")
    asked = ("/api/sites/hall/alerts", "/api/sites/nowhere/alerts", "/api/made/up/7", "/any/page", "/metrics")
    for path in asked:
        client.generic("GET", path)
    client.generic("BREW", "/api/sites/hall/alerts")
    told = {tuple(labels) for labels, _ in services.counters_to_json()["http_requests"]}
    route = "api/sites/<slug>/alerts"
    assert {("GET", route, "200"), ("GET", route, "404"), ("other", route, "405")} <= told
    assert not [labels for labels in told if "hall" in labels[1] or "made" in labels[1] or "any" in labels[1]]
    assert {labels[1] for labels in told} >= {"page", "metrics"}


@pytest.mark.parametrize(
    ("token", "told", "status"),
    [
        ("", {}, 200),
        ("", {"REMOTE_ADDR": "::1"}, 200),
        ("", {"REMOTE_ADDR": "192.0.2.7"}, 404),
        ("", {"REMOTE_ADDR": ""}, 404),
        ("", {"HTTP_X_FORWARDED_FOR": "192.0.2.7"}, 404),
        (TOKEN, {}, 401),
        (TOKEN, {"HTTP_AUTHORIZATION": "Bearer another"}, 401),
        (TOKEN, {"HTTP_AUTHORIZATION": f"Basic {TOKEN}"}, 401),
        (TOKEN, {"HTTP_AUTHORIZATION": "Bearer "}, 401),
        (TOKEN, {"HTTP_AUTHORIZATION": f"Bearer {TOKEN}", "REMOTE_ADDR": "192.0.2.7"}, 200),
    ],
)
def test_measurements_are_for_who_has_the_token_or_sits_at_this_machine(
    settings: Any, token: str, told: dict[str, str], status: int
) -> None:
    settings.VIPO_METRICS_TOKEN = token
    answer = Client().get("/metrics", **told)
    assert answer.status_code == status
    assert (b"vipo_queue_length" in answer.content) == (status == 200)
    assert answer.headers.get("WWW-Authenticate") == ("Bearer" if status == 401 else None)


def test_nothing_is_written_at_measurements() -> None:
    assert Client().post("/metrics").status_code == 405


def test_five_hundred_processes_and_a_hundred_sites_cost_no_question_more() -> None:
    def questions() -> int:
        with CaptureQueriesContext(connection) as asked:
            read()
        return len(asked)

    make_process("web", "w0")
    few = questions()
    for number in range(100):
        services.create_site(name=f"Site {number}", slug=f"site-{number}")
    for number in range(500):
        make_process("worker", f"w{number}", tasks=[[["t", "SUCCESS"], number]])
    assert questions() == few <= 9

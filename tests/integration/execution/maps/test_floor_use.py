"""How a floor was used in runs, over HTTP: what of their journals is counted, who may ask, and how much is read."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from itertools import count
from typing import Any
from uuid import uuid4

import pytest
from django.db import connection
from django.test import Client
from django.test.utils import CaptureQueriesContext

from execution.floor import floor_use_routes as routes
from execution.models import Archive, Run, RunEvent
from registry import services as registry
from registry.floorplan.plan import Grid
from registry.models import Site, SiteMap
from tests.kit.sign_in import from_role, join_and_sign_in

pytestmark = pytest.mark.django_db(transaction=True)
USE = "/api/sites/hall/floor-use"
NOON = datetime(2026, 11, 23, 12, 0, tzinfo=UTC)
GATE = ((0.0, 0.0), (2.0, 0.0), (2.0, 2.0))
PATH = [[0.1, 0.1], [0.6, 0.1]]
SQUARES = [[0, 0, 1], [1, 0, 1], [2, 0, 1]]


@pytest.fixture(autouse=True)
def _at_noon(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let it be noon of a Monday, and nothing be counted yet."""
    routes._kept.clear()
    monkeypatch.setattr(routes.database, "now", lambda: NOON)


def save_map(grid: Grid, *, days_ago: float) -> None:
    before = SiteMap.objects.order_by("-version").first()
    version = registry.save_map(site="hall", grid=grid).version
    saved = SiteMap.objects.filter(version=version)
    if before is None or saved.get().frame_since != before.frame_since:
        saved.update(frame_since=NOON - timedelta(days=days_ago))


@pytest.fixture
def gate(db: None) -> str:
    """Make a hall with a zone for one robot at a time; return its id."""
    registry.create_site(name="Hall", slug="hall")
    save_map(Grid(8, 8, 0.5, 0.0, 0.0, bytes(64)), days_ago=40)
    zone = registry.ZoneChange(name="Gate", rule="one_at_a_time", points=GATE, robots=1)
    return str(registry.add_zone(site="hall", zone=zone).id)


@pytest.fixture
def viewer(gate: str) -> Client:
    return join_and_sign_in("viewer", "hall")


class Written:
    """A run that began so many hours before noon, with its journal."""

    _numbers = count(1)

    def __init__(self, *, hours: float, ended: float | None = None, slug: str = "hall", **more: Any) -> None:
        """`ended` is how many hours before noon it ended; None: it goes on."""
        self.begun_at = NOON - timedelta(hours=hours)
        ended_at = None if ended is None else NOON - timedelta(hours=ended)
        told: dict[str, Any] = {"program": uuid4(), "program_name": "Mix", "status": "running"} | more
        self.run = Run.objects.create(
            site=Site.objects.get(slug=slug), number=next(self._numbers), created_at=self.begun_at,
            started_at=self.begun_at, ended_at=ended_at, **told,
        )  # fmt: skip
        self._seqs = count(1)

    def say(self, seconds: float, kind: str, code: str, **args: Any) -> Written:
        line = {"step": "a" if kind != "way" else "", "robot": "robot1", "t_s": seconds, "text": code}
        at = self.begun_at + timedelta(seconds=seconds)
        RunEvent.objects.create(run=self.run, seq=next(self._seqs), at=at, kind=kind, code=code, args=args, **line)
        return self

    def drive(self, seconds: float = 1, path: list[list[float]] = PATH) -> Written:
        return self.say(seconds, "way", "way", path=path)

    def wait(self, begun_s: float, ended_s: float, zone: str) -> Written:
        self.say(begun_s, "wait", "zone_taken", zone_key=zone, zone="Gate", others="robot2")
        return self.say(ended_s, "wait", "wait_over")


def test_drives_and_waits_of_all_runs_are_counted_together(viewer: Client, gate: str) -> None:
    Written(hours=6, ended=5).drive().wait(10, 40, f"site/{gate}").drive(60, [[0.6, 0.1], [0.6, 0.4]])
    Written(hours=30).drive().wait(600, 615, f"site/{gate}")
    assert viewer.get(USE).json() == {
        "days": 7,
        "utc_offset_min": 0,
        "runs": 2,
        "is_cut": False,
        "square_m": 0.25,
        "heat": [[0, 0, 2], [1, 0, 2], [2, 0, 3], [2, 1, 1]],
        "zones": [{"zone": gate, "waits": 2, "waited_s": 45.0, "busiest_min": 350}],
    }


def test_the_half_hour_is_of_the_days_of_who_asks(viewer: Client, gate: str) -> None:
    Written(hours=6, ended=5).wait(10, 40, f"site/{gate}")
    found = viewer.get(f"{USE}?days=7&utc_offset_min=60").json()
    assert (found["utc_offset_min"], found["zones"][0]["busiest_min"]) == (60, 410)


def test_a_zone_before_which_nobody_waited_has_no_busiest_half_hour(viewer: Client, gate: str) -> None:
    assert viewer.get(USE).json()["zones"] == [{"zone": gate, "waits": 0, "waited_s": 0.0, "busiest_min": None}]
    assert (viewer.get(USE).json()["runs"], viewer.get(USE).json()["heat"]) == (0, [])


def test_only_zones_for_so_many_robots_that_there_are_now_are_told(viewer: Client, gate: str) -> None:
    slow = registry.add_zone(site="hall", zone=registry.ZoneChange(name="Slow", rule="slow", points=GATE, speed_m_s=1))
    run = Written(hours=6, ended=5).wait(1, 2, f"site/{slow.id}").wait(3, 4, "site/gone").wait(5, 6, "of-a-program")
    run.wait(7, 9, f"site/{gate}")
    assert [(each["zone"], each["waited_s"]) for each in viewer.get(USE).json()["zones"]] == [(gate, 2.0)]
    registry.remove_zone(site="hall", zone_id=gate)
    assert viewer.get(USE).json()["zones"] == []


def test_waits_of_former_versions_which_do_not_name_their_zone_are_not_counted(viewer: Client, gate: str) -> None:
    Written(hours=6, ended=5).say(1, "wait", "zone_taken", zone="Gate").say(5, "wait", "wait_over")
    assert viewer.get(USE).json()["zones"][0]["waits"] == 0


def test_a_wait_ends_where_its_step_was_not_done_or_with_the_run(viewer: Client, gate: str) -> None:
    taken = {"zone_key": f"site/{gate}"}
    failed = Written(hours=6, ended=5).say(0, "wait", "zone_taken", **taken).say(20, "step", "step_blocked")
    failed.say(90, "step", "step_entered")
    Written(hours=4, ended=3.5).say(1740, "wait", "zone_taken", **taken)
    Written(hours=0.5).say(1795, "wait", "zone_taken", **taken).say(1797, "step", "step_entered")
    assert viewer.get(USE).json()["zones"][0] == {"zone": gate, "waits": 3, "waited_s": 85.0, "busiest_min": 490}


def test_what_is_archived_of_another_site_or_too_long_ago_is_not_counted(viewer: Client) -> None:
    registry.create_site(name="Shed", slug="shed")
    hall = Site.objects.get(slug="hall")
    archive = Archive.objects.create(site=hall, kind="runs", file="hall/runs/1.gz", state="whole", made_at=NOON)
    Written(hours=6, ended=5, archive=archive).drive()
    Written(hours=6, ended=5, slug="shed").drive()
    Written(hours=8 * 24, ended=7 * 24 + 1).drive()
    Written(hours=8 * 24).drive().drive(2 * 24 * 3600, [[5.1, 5.1], [5.2, 5.1]])
    found = viewer.get(USE).json()
    assert (found["runs"], found["heat"]) == (1, [[20, 20, 1]])
    assert viewer.get(f"{USE}?days=1").json()["heat"] == []
    assert viewer.get(f"{USE}?days=9").json()["runs"] == 2


def test_a_run_that_has_not_begun_is_none(viewer: Client) -> None:
    run = Written(hours=1).run
    Run.objects.filter(pk=run.pk).update(started_at=None, status="pending")
    assert viewer.get(USE).json()["runs"] == 0


def test_the_newest_runs_and_lines_are_read_and_the_answer_says_that_there_were_more(
    viewer: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    for hours in (6, 5, 4):
        Written(hours=hours, ended=hours - 0.5).drive().drive(5, [[9.1, 9.1], [9.2, 9.1]])
    monkeypatch.setattr(routes, "MOST_RUNS", 2)
    found = viewer.get(USE).json()
    assert (found["runs"], found["is_cut"], found["heat"]) == (2, True, [[0, 0, 2], [1, 0, 2], [2, 0, 2], [36, 36, 2]])
    routes._kept.clear()
    monkeypatch.setattr(routes, "MOST_RUNS", 3)
    monkeypatch.setattr(routes, "MOST_LINES", 3)
    found = viewer.get(USE).json()
    assert (found["runs"], found["is_cut"], found["heat"]) == (2, True, [*SQUARES, [36, 36, 2]])
    routes._kept.clear()
    monkeypatch.setattr(routes, "MOST_LINES", 6)
    found = viewer.get(USE).json()
    assert (found["runs"], found["is_cut"]) == (3, False)


def test_it_takes_as_many_statements_for_many_runs_as_for_one(gate: str) -> None:
    Written(hours=6, ended=5).drive()
    with CaptureQueriesContext(connection) as one:
        assert routes._count("hall", 7).runs == 1
    for _ in range(20):
        Written(hours=6, ended=5).drive().wait(10, 40, f"site/{gate}")
    routes._kept.clear()
    with CaptureQueriesContext(connection) as many:
        assert routes._count("hall", 7).runs == 21
    assert (len(one), len(many)) == (3, 3)  # how the map lies, runs, lines


def test_what_was_counted_is_told_again_for_a_minute(viewer: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    clock = [1000.0]
    monkeypatch.setattr(routes, "monotonic", lambda: clock[0])
    Written(hours=6, ended=5).drive()
    assert viewer.get(USE).json()["heat"] == SQUARES
    Written(hours=6, ended=5).drive()
    clock[0] += 59
    assert viewer.get(USE).json()["heat"] == SQUARES
    assert viewer.get(f"{USE}?days=6").json()["heat"][0] == [0, 0, 2]
    clock[0] += 2
    assert viewer.get(USE).json()["heat"][0] == [0, 0, 2]


def test_what_is_known_is_told_also_while_others_are_counted_and_at_every_offset(
    viewer: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    Written(hours=6, ended=5).drive()
    assert viewer.get(USE).status_code == 200
    monkeypatch.setattr(routes, "PATIENCE_S", 0.01)
    others = [registry.Claim(-1), registry.Claim(-2)]
    assert all(routes.count_slots.take(other) for other in others)
    try:
        assert [viewer.get(f"{USE}?utc_offset_min={offset}").json()["heat"] for offset in (0, 60, -45)] == [SQUARES] * 3
        assert viewer.get(f"{USE}?days=3").status_code == 429
    finally:
        for other in others:
            routes.count_slots.give_back(other)


def test_what_was_driven_before_the_map_lay_as_it_does_is_not_drawn_on_it(viewer: Client) -> None:
    Written(hours=6, ended=5).drive()
    save_map(Grid(8, 8, 0.5, 0.0, 0.0, bytes([100]) + bytes(63)), days_ago=0.1)
    assert viewer.get(USE).json()["heat"] == SQUARES  # a wall more changes nothing of where things are
    routes._kept.clear()
    save_map(Grid(8, 8, 0.5, 1.0, 0.0, bytes(64)), days_ago=0.05)
    assert viewer.get(USE).json()["heat"] == []


def test_a_site_without_a_map_says_so(db: None) -> None:
    registry.create_site(name="Bare", slug="bare")
    answer = join_and_sign_in("viewer", "bare").get("/api/sites/bare/floor-use")
    assert (answer.status_code, answer.json()["code"]) == (404, "no_map")


def test_no_more_answers_are_kept_than_so_many(viewer: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(routes, "KEPT", 3)
    for days in range(1, 10):
        assert viewer.get(f"{USE}?days={days}").status_code == 200
        assert len(routes._kept) <= 3


@pytest.mark.parametrize(
    ("asked", "wrong"),
    [
        ("days=0", "days"),
        ("days=31", "days"),
        ("days=1.5", "days"),
        ("days=", "days"),
        ("utc_offset_min=-721", "utc_offset_min"),
        ("utc_offset_min=841", "utc_offset_min"),
        ("utc_offset_min=nan", "utc_offset_min"),
    ],
)
def test_what_is_out_of_bounds_is_refused_by_its_name(viewer: Client, asked: str, wrong: str) -> None:
    answer = viewer.get(f"{USE}?{asked}")
    assert answer.status_code == 422
    assert wrong in answer.content.decode()
    assert routes._kept == {}


@pytest.mark.parametrize("role", from_role("viewer"))
def test_every_role_may_ask(gate: str, role: str) -> None:
    assert join_and_sign_in(role, "hall").get(USE).status_code == 200


def test_a_stranger_learns_nothing_nor_does_who_is_not_signed_in(gate: str, client: Client) -> None:
    assert join_and_sign_in("stranger", "hall").get(USE).status_code == 404
    assert client.get(USE).status_code == 401
    assert routes._kept == {}


def test_who_has_a_count_under_way_waits_for_a_moment_and_is_told(
    viewer: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(routes, "PATIENCE_S", 0.05)
    person = registry.Claim(int(viewer.session["_auth_user_id"]))
    assert routes.count_slots.take(person)
    try:
        answer = viewer.get(USE)
        assert (answer.status_code, answer.json()["code"]) == (429, "too_many_floor_counts")
    finally:
        routes.count_slots.give_back(person)
    assert viewer.get(USE).status_code == 200

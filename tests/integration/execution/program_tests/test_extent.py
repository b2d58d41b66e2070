"""Tests carried out with many seeds, changes of the program that no test notices, and results of a site of before."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Any

import pytest
from django.db import connection
from django.test import Client

from editor import services as editor
from editor.documents import store
from execution.models import MeantChange, Rehearsal, TrialRun
from execution.program_tests.site_digests import MOST_NAMED, what_changed
from execution.rehearsals import worker
from registry import services as registry
from registry.models import Device, SiteMap
from tests.integration.execution.program_tests.conftest import FAILS, PASSES, UNUSABLE, add, put
from tests.kit.programs import SITE, document, step
from tests.kit.sign_in import add_person, join_and_sign_in, post_json, signed_in

pytestmark = pytest.mark.django_db(transaction=True)
NOTICES = "name: It waits\nthen:\n  - ends: well\n  - step: {step: pause, times: 1}\n"


@pytest.fixture
def client(program: Any) -> Client:
    return join_and_sign_in("author", SITE)


def shown(client: Client, program: Any) -> dict[str, Any]:
    return dict(client.get(f"/api/programs/{program}/tests").json())


def carry_out(client: Client, program: Any, **asked: Any) -> dict[str, Any]:
    started = post_json(client, f"/api/programs/{program}/test-runs", asked)
    assert started.status_code == 202, started.content
    assert worker.carry_out_waiting() == 1
    return shown(client, program)


def test_each_test_is_carried_out_with_many_seeds_and_its_odds_are_told(client: Client, program: Any) -> None:
    for text in (PASSES, FAILS, UNUSABLE):
        add(client, program, text)
    told = carry_out(client, program, seeds=3)
    assert (told["last"]["seeds"], told["last"]["tries_changes"], told["changes"]) == (3, False, None)
    passed, failed, unusable = (test["result"]["odds"] for test in told["tests"])
    assert (passed["asked"], passed["seeds"], passed["failed"], passed["failing"]) == (3, 3, 0, [])
    assert passed["low"] == 0
    assert 0 < passed["high"] < 1
    assert passed["took_s"] == {"least": 5.0, "median": 5.0, "p95": 5.0, "most": 5.0}
    assert (failed["failed"], failed["failing"], failed["took_s"]) == (3, [1, 2, 3], None)
    assert failed["figures"][0]["least"] == 5.0
    assert unusable is None
    assert carry_out(client, program)["tests"][0]["result"]["odds"] is None


def test_changes_that_no_test_notices_are_named_until_something_is_changed(client: Client, program: Any) -> None:
    made = add(client, program, "name: It ends\nthen:\n  - ends: well\n")
    changes = carry_out(client, program, changes=True)["changes"]
    assert (changes["stale"], changes["why"], changes["out_of_time"], changes["noticed"]) == (False, "", False, 0)
    assert changes["tried"] == changes["there_are"] == 3
    assert [(each["step"], each["code"], each["reached"]) for each in changes["unnoticed"]] == [
        ("choice", "turned", True),
        ("choice", "always", True),
        ("choice", "never", True),
    ]
    put(client, f"/api/programs/{program}/tests/{made['id']}", NOTICES, '"1"')
    assert shown(client, program)["changes"]["stale"] is True
    again = carry_out(client, program, changes=True)["changes"]
    assert (again["stale"], again["noticed"]) == (False, 2)
    assert [each["code"] for each in again["unnoticed"]] == ["always"], "it always holds anyway"


def test_a_test_that_fails_notices_everything_so_nothing_is_tried(client: Client, program: Any) -> None:
    add(client, program, FAILS)
    changes = carry_out(client, program, changes=True)["changes"]
    assert (changes["why"], changes["tried"], changes["unnoticed"]) == ("failing", 0, [])


def test_what_there_is_no_time_for_is_told(client: Client, factory: Any, settings: Any) -> None:
    """A program that takes the processor long is cut off by the limit that holds for one rehearsal."""
    settings.VIPO_REHEARSAL_LIMIT_S = 3
    rounds = step("repeat", times=20_000)
    busy = document({"repeat": rounds, "pause": step("wait", ("repeat", "body"), duration=0.1)})
    program = editor.create_program(site=SITE, name="Busy", document=busy).id
    add(client, program, "name: It ends\nthen:\n  - ends: well\n")
    told = carry_out(client, program, seeds=100, changes=True)
    result = told["tests"][0]["result"]
    assert result["status"] == "stopped" or result["odds"]["seeds"] < result["odds"]["asked"]


@pytest.mark.parametrize("asked", [{"seeds": -1}, {"seeds": 101}, {"seeds": "many"}, {"changes": "perhaps"}])
def test_what_cannot_be_asked_is_refused(client: Client, program: Any, asked: dict[str, Any]) -> None:
    add(client, program, PASSES)
    assert post_json(client, f"/api/programs/{program}/test-runs", asked).status_code == 422
    assert TrialRun.objects.count() == 0


def test_a_result_is_stale_once_the_site_has_changed(client: Client, program: Any) -> None:
    add(client, program, PASSES)
    assert carry_out(client, program)["tests"][0]["result"]["stale"] is None
    now = datetime.now(UTC)
    registry.update_device(site=SITE, device_id="paintMixer02", name="Renamed", by=None, at=now)
    assert shown(client, program)["tests"][0]["result"]["stale"] is None
    registry.retire_device(site=SITE, device_id="curingOven01", by=None, at=now)
    result = shown(client, program)["tests"][0]["result"]
    assert (result["stale"], result["site_change"]) == ("site", {"what": "devices", "devices": ["curingOven01"]})
    grid = registry.get_map(site=SITE).grid
    lost = registry.save_map(site=SITE, grid=grid)
    result = shown(client, program)["tests"][0]["result"]
    assert (result["stale"], result["site_change"]["what"]) == ("site", "map")
    assert carry_out(client, program)["tests"][0]["result"]["stale"] is None
    SiteMap.objects.get(site__slug=SITE, version=lost.version).delete()
    assert registry.save_map(site=SITE, grid=grid).version == lost.version
    result = shown(client, program)["tests"][0]["result"]
    assert (result["stale"], result["site_change"]["what"]) == ("site", "map"), "as after a backup came back"


def test_where_robots_stand_at_the_moment_changes_nothing_for_tests(client: Client, program: Any) -> None:
    add(client, program, PASSES)
    assert carry_out(client, program)["tests"][0]["result"]["stale"] is None
    post_json(client, f"/api/programs/{program}/test-runs", {})
    Device.objects.filter(pk="robot01").update(pose={"x": 5.0, "y": -8.0, "z": 0.0, "theta": 1.0})
    assert shown(client, program)["tests"][0]["result"]["stale"] is None
    post_json(client, f"/api/programs/{program}/test-runs", {})
    before, after = (row.job["scene"] for row in Rehearsal.objects.filter(status="queued"))
    assert before == after


def test_what_nobody_knows_of_a_site_is_no_change() -> None:
    now = {"map": 1, "places": "a", "zones": "b", "devices": {f"d{n}": "x" for n in range(40)}}
    assert what_changed({}, now) is None
    assert what_changed(now, now) is None
    assert what_changed(now, {**now, "map_tag": "t"}) is None
    assert what_changed({**now, "map_tag": "s"}, {**now, "map_tag": "t"}) == {"what": "map", "devices": []}
    assert what_changed(now, {**now, "zones": "c", "devices": {}}) == {"what": "zones", "devices": []}
    assert len((what_changed(now, {**now, "devices": {}}) or {})["devices"]) == MOST_NAMED


def say(client: Client, program: Any, change: dict[str, Any], *, meant: bool = True) -> Any:
    said = {key: change[key] for key in ("step", "code", "name", "mark")}
    return post_json(client, f"/api/programs/{program}/tests/meant-changes", {**said, "meant": meant})


def change_step(client: Client, program: Any, **said: Any) -> None:
    """Change the step that decides; without anything said take it out."""
    path = f"/api/programs/{program}/document"
    document = client.get(path)
    changed = document.json()
    if said:
        changed["steps"]["choice"] |= said
    else:
        del changed["steps"]["choice"]
    tag = {"If-Match": document.headers["ETag"]}
    assert client.put(path, changed, content_type="application/json", headers=tag).status_code == 204


def test_a_change_is_meant_so_while_its_step_stays_as_it_is(client: Client, program: Any) -> None:
    add(client, program, "name: It ends\nthen:\n  - ends: well\n")
    turned, always, _ = carry_out(client, program, changes=True)["changes"]["unnoticed"]
    assert (turned["code"], turned["meant_at"], turned["meant_by"]) == ("turned", None, "")
    for _ in range(2):
        assert say(client, program, turned).status_code == 204
    assert MeantChange.objects.count() == 1
    first, second, third = shown(client, program)["changes"]["unnoticed"]
    assert (first["meant_by"] != "", first["meant_at"] is not None) == (True, True)
    assert (second["meant_at"], third["meant_at"]) == (None, None)
    again = carry_out(client, program, changes=True)["changes"]["unnoticed"]
    assert [each["meant_at"] is not None for each in again] == [True, False, False]

    change_step(client, program, pos=[3, 3])
    assert shown(client, program)["changes"]["unnoticed"][0]["meant_at"] is not None, "it was only drawn elsewhere"
    change_step(client, program, params={"condition": {"op": ">", "args": [3, 1]}})
    first, *_ = shown(client, program)["changes"]["unnoticed"]
    assert first["meant_at"] is None
    assert first["mark"] != turned["mark"]
    late = say(client, program, always)
    assert (late.status_code, late.json()["code"]) == (409, "not_possible_now")
    assert say(client, program, first).status_code == 204
    assert say(client, program, first, meant=False).status_code == 204
    assert shown(client, program)["changes"]["unnoticed"][0]["meant_at"] is None


def test_what_is_being_drawn_is_stored_before_the_program_is_held(
    client: Client, program: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Storing takes the program's row from another connection: whoever held it would wait for themselves."""
    add(client, program, "name: It ends\nthen:\n  - ends: well\n")
    turned, *_ = carry_out(client, program, changes=True)["changes"]["unnoticed"]
    depths: list[tuple[bool, int]] = []

    def depth() -> tuple[bool, int]:
        return connection.in_atomic_block, len(connection.savepoint_ids)

    monkeypatch.setattr(store, "_flushes", [lambda _: depths.append(depth())])
    assert say(client, program, turned).status_code == 204
    assert depths == [depth()]


def test_only_what_tests_have_missed_can_be_meant_so_and_only_authors_say_it(client: Client, program: Any) -> None:
    add(client, program, "name: It ends\nthen:\n  - ends: well\n")
    unknown = {"step": "choice", "code": "turned", "name": "", "mark": ""}
    assert say(client, program, unknown).status_code == 404
    turned, *_ = carry_out(client, program, changes=True)["changes"]["unnoticed"]
    for role in ("operator", "viewer"):
        assert say(join_and_sign_in(role, SITE), program, turned).status_code == 403
    add_person("stranger")
    assert say(signed_in("stranger"), program, turned).status_code == 404
    assert say(Client(), program, turned).status_code == 401
    assert say(client, program, {**turned, "step": "elsewhere"}).status_code == 404
    assert say(client, program, {**turned, "code": "x" * 41}).status_code == 422
    change_step(client, program)
    for mark in (turned["mark"], ""):
        assert say(client, program, {**turned, "mark": mark}).status_code == 409
    assert shown(client, program)["changes"]["unnoticed"][0]["mark"] == ""
    assert MeantChange.objects.count() == 0

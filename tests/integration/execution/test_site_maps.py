"""A site's map is changed by what a robot has sent, and back: only at rest, in versions, and programs go on."""

import gzip
import json
from dataclasses import replace

import pytest

from editor import services as editor
from editor.language.expressions.nodes import PlaceRef
from editor.language.plan.instructions import End, Instruction, Move, Plan
from execution import services
from execution.models import Command, FloorState, Run
from execution.reasons import cause_of
from registry import services as registry
from registry.floorplan.map_server import BadMap
from registry.floorplan.plan import Grid
from registry.live import fanout
from registry.maps import uploads
from registry.models import Device, SiteMap
from tests.integration.execution.maps.brought_maps import (
    MARGIN,
    PLAN,
    bring,
    packed,
    say_map,
    tag_of,
    use,
    walled,
    widened,
)
from tests.kit import demo_floor
from tests.kit.programs import ANY, CARRY, SITE, TASK, run_status
from tests.kit.sign_in import ROLES, join_and_sign_in, post_json

pytestmark = pytest.mark.django_db(transaction=True)


def test_a_robots_map_becomes_the_sites_and_the_one_before_can_be_chosen_again(factory):
    say_map(widened())
    client, news = join_and_sign_in("admin", SITE), []
    before = client.get(f"/api/sites/{SITE}/map").json()
    devices = client.get(f"/api/sites/{SITE}/devices").json()
    stop = fanout.listen(lambda _, message: news.append(message))
    assert use(client).json() == {"version": 2}
    after = client.get(f"/api/sites/{SITE}/map").json()
    assert (after["version"], after["width"]) == (2, PLAN.width + 2 * MARGIN)
    assert after["places"] == before["places"]
    assert after["walls"] == before["walls"]
    assert client.get(f"/api/sites/{SITE}/devices").json() == devices
    assert registry.get_map(site=SITE).grid == widened()
    body = {"version": 1, "replaces": 2}
    assert post_json(client, f"/api/sites/{SITE}/map/restore", body).json() == {"version": 3}
    stop()
    assert registry.get_map(site=SITE).grid == PLAN
    assert [m for m in news if m["type"] == "map"] == [{"type": "map", "version": 2}, {"type": "map", "version": 3}]
    listed = client.get(f"/api/sites/{SITE}/map/versions").json()
    assert [(v["version"], v["source"], v["by"]) for v in listed] == [
        (3, "version:1", "Admin Person"),
        (2, "robot:robot01", "Admin Person"),
        (1, "test", ""),
    ]


def test_runs_go_on_over_the_new_map(factory):
    first = factory.start(drive_to("itemInventory01"))
    factory.go(lambda: run_status(first) == "finished")
    factory.go(lambda: not Command.objects.filter(status__in=Command.OPEN).exists())
    commands = set(Command.objects.values_list("id", flat=True))
    say_map(widened())
    assert use(join_and_sign_in("admin", SITE)).json() == {"version": 2}
    second = factory.start(drive_to("paintInventory01"))
    factory.go(lambda: run_status(second) == "finished")
    assert Command.objects.exclude(id__in=commands).exists()


def drive_to(device):
    return Plan((Instruction(Move("robot", PlaceRef(device=device)), "s1", 1), Instruction(End())), ANY)


def test_a_stop_goes_on_over_the_new_map(factory):
    services.press_stop(site=SITE, by="Ada")
    factory.work()
    say_map(widened())
    assert use(join_and_sign_in("admin", SITE)).status_code == 201
    factory.work()
    state = FloorState.objects.get(site__slug=SITE).state
    assert (state["stopped"], services.is_stopped(site=SITE)) == (True, True)


def test_nothing_changes_while_a_run_is_open_or_a_device_is_at_work(factory):
    say_map(widened())
    client = join_and_sign_in("admin", SITE)
    run = factory.start(CARRY)
    refused = use(client)
    assert (refused.status_code, refused.json()["code"]) == (409, "not_possible_now")
    assert refused.json()["args"] == {"why": "map_runs", "runs": "1", "count": 1}
    Run.objects.filter(id=run).update(status="cancelled")
    factory.offline.add("paintMixer02")
    call = services.call_method(site=SITE, device_id="paintMixer02", method="mixPaint", arguments={"time": 1}, by="A")
    refused = post_json(client, f"/api/sites/{SITE}/map/restore", {"version": 1, "replaces": 1})
    assert refused.json()["args"] == {"why": "map_busy", "device": "paintMixer02"}
    assert SiteMap.objects.count() == 1
    Command.objects.filter(id=call.id).update(status="done")
    assert use(client).status_code == 201


def test_what_was_not_looked_at_is_not_taken(factory):
    say_map(widened())
    say_map(widened(), 2)
    client = join_and_sign_in("admin", SITE)
    for answer in (use(client, version=1), use(client, version=2, replaces=0)):
        assert (answer.status_code, answer.json()["code"]) == (409, "map_changed")
    assert use(client, version=2, replaces=7).json()["detail"].startswith("Somebody has changed the site's map")
    assert (use(client, robot="robot02").status_code, use(client, robot="no\0body").status_code) == (404, 422)
    lost = post_json(client, f"/api/sites/{SITE}/map/restore", {"version": 9, "replaces": 1})
    assert (lost.status_code, lost.json()["code"]) == (404, "no_map")
    assert use(client, version=10**30).status_code == 400
    assert SiteMap.objects.count() == 1


def test_a_map_that_is_too_long_for_planning_is_refused(factory):
    say_map(Grid(5000, 2, 0.05, 0.0, 0.0, bytes(10_000)))
    answer = use(join_and_sign_in("admin", SITE))
    assert (answer.status_code, answer.json()["code"]) == (422, "bad_map")
    assert SiteMap.objects.count() == 1


def test_a_floor_of_square_kilometres_is_refused_and_one_from_before_is_no_floor_to_plan_on(factory):
    with pytest.raises(BadMap, match="Check its resolution"):
        registry.save_map(site=SITE, grid=replace(PLAN, resolution_m=10.0))
    SiteMap.objects.filter(site__slug=SITE).update(resolution_m=10.0)
    client, program = join_and_sign_in("admin", SITE), editor.create_program(site=SITE, name="Task", document=TASK).id
    assert client.get(f"/api/sites/{SITE}/map").status_code == 200
    assert errors(client, program) == 0
    run = factory.start(drive_to("itemInventory01"))
    factory.work()
    assert run_status(run) == "failed"
    assert cause_of(Run.objects.get(id=run).reason)["code"] == "map_too_large"
    check = client.get(f"/api/sites/{SITE}/floor-check")
    assert (check.status_code, check.json()["code"]) == (422, "bad_map")
    body = {"version": 1, "replaces": 1}
    assert post_json(client, f"/api/sites/{SITE}/map/restore", body).json()["code"] == "bad_map"
    assert bring(client, PLAN, tag_of(client)).status_code == 201
    again = factory.start(drive_to("itemInventory01"))
    factory.go(lambda: run_status(again) == "finished")


def test_programs_are_checked_anew_on_the_new_map(factory):
    program = editor.create_program(site=SITE, name="Task", document=TASK).id
    client = join_and_sign_in("admin", SITE)
    assert errors(client, program) == 0
    x, y = next((d.pose.x, d.pose.y) for d in demo_floor.devices() if d.id == "paintMachine01")
    say_map(walled(x - 3.0, y - 3.0, x + 3.0, y + 3.0))
    assert use(client).status_code == 201
    assert errors(client, program) > 0
    assert post_json(client, f"/api/sites/{SITE}/map/restore", {"version": 1, "replaces": 2}).status_code == 201
    assert errors(client, program) == 0


def errors(client, program):
    listed = client.get(f"/api/sites/{SITE}/programs").json()
    return next(p["errors"] for p in listed if p["id"] == str(program))


def test_the_difference_says_what_would_change_and_whom_it_would_trouble(factory):
    x, y = next((d.pose.x, d.pose.y) for d in demo_floor.devices() if d.id == "paintMachine01")
    say_map(walled(x - 1.0, y - 1.0, x + 1.0, y + 1.0))
    told = join_and_sign_in("viewer", SITE).get(f"/api/sites/{SITE}/devices/robot01/map/difference").json()
    assert (told["version"], told["replaces"]) == (1, 1)
    assert told["floor_lost_m2"] == told["walls_gained_m2"] > 3
    assert (told["floor_gained_m2"], told["walls_lost_m2"]) == (0, 0)
    assert {"id": "paintMachine01", "name": "Painting Booth", "kind": "machine", "why": "walled", "is_new": True} in [
        {**trouble, "name": "Painting Booth"} for trouble in told["troubles"]
    ]


@pytest.mark.parametrize("role", ["nobody", "stranger", *ROLES])
def test_each_call_is_open_to_its_role_and_above(factory, role):
    say_map(PLAN)
    client = join_and_sign_in(role, SITE)
    robot = f"/api/sites/{SITE}/devices/robot01/map"
    shown = [robot, f"{robot}/cells", f"{robot}.yaml", f"{robot}.pgm", f"{robot}/difference"]
    seen = [client.get(path).status_code for path in (*shown, f"/api/sites/{SITE}/map/versions")]
    assert set(seen) == {{"nobody": 401, "stranger": 404}.get(role, 200)}
    changed = [use(client), post_json(client, f"/api/sites/{SITE}/map/restore", {"version": 1, "replaces": 2})]
    wanted = {"nobody": 401, "stranger": 404, "admin": 201}.get(role, 403)
    assert [answer.status_code for answer in changed] == [wanted] * 2
    assert SiteMap.objects.count() == (3 if role == "admin" else 1)


def test_a_robots_map_is_shown_as_the_sites_is(factory):
    say_map(PLAN)
    client = join_and_sign_in("viewer", SITE)
    robot = f"/api/sites/{SITE}/devices/robot01/map"
    told = client.get(robot).json()
    assert (told["device"], told["version"], told["width"], told["resolution_m"]) == ("robot01", 1, PLAN.width, 0.05)
    assert told["origin"] == {"x": PLAN.origin_x_m, "y": PLAN.origin_y_m, "yaw": 0.0}
    cells = client.get(f"{robot}/cells")
    again = client.get(f"{robot}/cells", headers={"If-None-Match": cells["ETag"]})
    assert (cells["Content-Encoding"], again.status_code) == ("gzip", 304)
    for form in ("yaml", "pgm"):
        of_robot, of_site = client.get(f"{robot}.{form}"), client.get(f"/api/sites/{SITE}/map.{form}")
        assert of_robot["Content-Disposition"] == f'attachment; filename="robot01.{form}"'
        assert of_robot.content.replace(b"robot01", SITE.encode()) == of_site.content
    Device.objects.filter(pk="robot02").update(lifecycle="retired")
    for other in ("robot02", "robot03", "paintMachine01"):
        assert client.get(f"/api/sites/{SITE}/devices/{other}/map").status_code == 404


def test_only_the_newest_fifty_versions_are_kept(factory, monkeypatch):
    monkeypatch.setattr("registry.maps.site_maps.MOST_VERSIONS", 3)
    for _ in range(4):
        registry.save_map(site=SITE, grid=PLAN)
    assert list(SiteMap.objects.order_by("version").values_list("version", flat=True)) == [3, 4, 5]


def test_the_body_of_a_change_is_checked(factory):
    client = join_and_sign_in("admin", SITE)
    for body in ({}, {"device": 3}, {"device": "x" * 65, "version": 1, "replaces": 0}):
        assert post_json(client, f"/api/sites/{SITE}/map/from-device", body).status_code == 422
    assert json.loads(use(client).content)["code"] == "no_robot_map"


def test_a_map_that_somebody_has_changed_becomes_the_sites_and_is_exact_to_the_cell(factory):
    client = join_and_sign_in("admin", SITE)
    assert client.get(f"/api/sites/{SITE}/map").json()["tag"] == tag_of(client)
    changed = walled(7, -8, 7.5, -7.5)
    assert bring(client, changed).json() == {"version": 2}
    assert registry.get_map(site=SITE).grid == changed
    newest = client.get(f"/api/sites/{SITE}/map/versions").json()[0]
    assert (newest["source"], newest["by"]) == ("edit", "Admin Person")


def test_of_two_who_change_the_map_the_second_is_told_and_nothing_is_lost(factory):
    client = join_and_sign_in("admin", SITE)
    known, theirs = tag_of(client), walled(7, -8, 7.5, -7.5)
    assert bring(client, theirs, known).status_code == 201
    second = bring(client, widened(), known)
    assert (second.status_code, second.json()["code"]) == (412, "map_overtaken")
    assert registry.get_map(site=SITE).grid == theirs
    assert bring(client, widened(), tag=tag_of(client)).json() == {"version": 3}


def test_who_changes_the_map_must_say_which(factory):
    client = join_and_sign_in("admin", SITE)
    missing = bring(client, widened(), tag="")
    assert (missing.status_code, missing.json()["code"]) == (428, "map_tag_needed")
    none = client.post(f"/api/sites/{SITE}/map/upload", packed(widened()), headers={"If-None-Match": "*"})
    assert (none.status_code, SiteMap.objects.count()) == (412, 1)


def test_a_page_of_the_version_before_names_the_map_by_its_number(factory):
    client = join_and_sign_in("admin", SITE)
    assert bring(client, widened(), tag=f'"{SITE}-2"').status_code == 412
    assert bring(client, widened(), tag=f'"{SITE}-1"').status_code == 201


def test_a_site_without_a_map_gets_its_first(factory):
    client = join_and_sign_in("admin", SITE)
    SiteMap.objects.all().delete()
    first = client.post(f"/api/sites/{SITE}/map/upload", packed(PLAN), headers={"If-None-Match": "*"})
    assert (first.status_code, registry.get_map(site=SITE).grid) == (201, PLAN)


def test_the_map_is_not_changed_by_hand_under_a_run(factory):
    client = join_and_sign_in("admin", SITE)
    factory.start(CARRY)
    refused = bring(client, widened())
    assert (refused.status_code, refused.json()["args"]["runs"]) == (409, "1")
    assert SiteMap.objects.count() == 1


def test_before_a_map_is_saved_it_is_said_which_places_and_programs_it_troubles(factory):
    client = join_and_sign_in("admin", SITE)
    registry.add_place(site=SITE, place=registry.PlaceChange(name="Table", kind="point", x=7.2, y=-7.8))
    step = {"kind": "move", "pos": [7.2, -7.8], "params": {"role": "robot", "to": {"point": [7.2, -7.8]}}}
    steps = {"s1": {**step, "place": ["program", "body", "0V"]}}
    program = editor.create_program(site=SITE, name="Goes there", document={**TASK, "steps": steps})
    told = bring(client, walled(7, -8, 7.5, -7.5), tag="", path="map/look").json()
    assert (told["replaces"], told["walls_gained_m2"] > 0) == (1, True)
    assert [(each["id"], each["why"]) for each in told["troubles"] if each["is_new"]] == [("table", "walled")]
    assert told["programs"] == [{"id": str(program.id), "name": "Goes there", "steps_outside": 0, "points_walled": 1}]
    assert registry.get_map(site=SITE).version == 1
    same = bring(client, PLAN, tag="", path="map/look").json()
    assert (same["programs"], [each for each in same["troubles"] if each["is_new"]]) == ([], [])


def test_an_earlier_version_can_be_looked_at(factory):
    client = join_and_sign_in("admin", SITE)
    assert bring(client, walled(7, -8, 7.5, -7.5)).status_code == 201
    old = f"/api/sites/{SITE}/map/versions/1"
    shown = client.get(old).json()
    assert (shown["version"], shown["width"], shown["origin"]["x"]) == (1, PLAN.width, PLAN.origin_x_m)
    assert gzip.decompress(client.get(f"{old}/cells").content) == PLAN.cells
    missing = client.get(f"/api/sites/{SITE}/map/versions/9")
    assert (missing.status_code, missing.json()["code"]) == (404, "no_map")


def test_one_map_at_a_time_is_held_against_the_sites_and_keeps_nobody_from_bringing_one(factory, monkeypatch):
    monkeypatch.setattr(uploads, "COMPARING_PATIENCE_S", 0.0)
    say_map(widened())
    client = join_and_sign_in("viewer", SITE)
    difference = f"/api/sites/{SITE}/devices/robot01/map/difference"
    somebody = registry.Claim(0, "another-site")
    assert uploads.comparing_slots.take(somebody)
    try:
        refused = client.get(difference)
        brought = bring(join_and_sign_in("admin", SITE), widened())
    finally:
        uploads.comparing_slots.give_back(somebody)
    assert (refused.status_code, refused.json()["code"]) == (429, "too_many_uploads")
    assert brought.status_code == 201
    assert client.get(difference).json()["version"] == 1

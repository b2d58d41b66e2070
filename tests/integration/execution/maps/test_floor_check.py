"""The floor check over HTTP: who may ask, for which widths, and when it is worked out anew."""

import gc
import json

import pytest
from django.db import connection
from django.test.utils import CaptureQueriesContext

from execution.floor import floor_check_routes as routes
from execution.floor.layouts import get_layout
from registry import services as registry
from tests.kit.programs import SITE
from tests.kit.sign_in import below_role, from_role, join_and_sign_in

pytestmark = pytest.mark.django_db(transaction=True)
CHECK = f"/api/sites/{SITE}/floor-check"
SPILL = ((8.0, -10.0), (14.0, -10.0), (14.0, -6.0), (8.0, -6.0))


@pytest.fixture(autouse=True)
def _forgetful():
    routes._kept.clear()


@pytest.fixture
def viewer(factory):
    return join_and_sign_in("viewer", SITE)


def test_the_painting_factory_is_sound_for_its_own_robots(viewer):
    found = viewer.get(CHECK).json()
    assert (found["width_m"], found["findings"]) == (0.36, [])
    assert found["robot"].startswith("robot")
    assert found["machines"]["reached"] == found["machines"]["of"] > 0


def test_another_width_is_checked_as_if_all_were_so_wide(viewer):
    found = viewer.get(f"{CHECK}?width_m=1.2").json()
    assert (found["width_m"], found["robot"]) == (1.2, None)
    assert found["machines"]["reached"] < found["machines"]["of"]
    assert {each["code"] for each in found["findings"]} <= {
        "too_narrow",
        "off_lattice",
        "no_room",
        "together",
        "in_the_way",
    }
    assert viewer.get(CHECK).json()["findings"] == []


@pytest.mark.parametrize("width", ["0", "-1", "3.1", "1e9", "nan", "inf", "wide", ""])
def test_a_width_that_no_robot_has_is_refused_with_its_bounds(viewer, width):
    answer = viewer.get(f"{CHECK}?width_m={width}")
    assert answer.status_code == 422
    assert "width_m" in answer.content.decode()


def test_a_zone_that_is_drawn_is_in_the_next_check_and_the_one_before_is_kept_until_then(viewer, monkeypatch):
    made = []
    check = routes.check_floor
    monkeypatch.setattr(routes, "check_floor", lambda *given: made.append(1) or check(*given))
    assert viewer.get(CHECK).json() == viewer.get(CHECK).json()
    assert len(made) == 1
    registry.add_zone(site=SITE, zone=registry.ZoneChange(name="Spill", rule="keep_out", points=SPILL))
    found = viewer.get(CHECK).json()["findings"]
    assert len(made) == 2
    assert {each["code"] for each in found} & {"keep_out", "cut_off"}
    zone = registry.list_zones(site=SITE)[0].id
    assert {each["other"] for each in found} <= {zone, None}


def test_zones_for_so_many_robots_have_their_width(viewer):
    zone = registry.ZoneChange(name="Corridor", rule="one_at_a_time", points=SPILL, robots=1)
    made = registry.add_zone(site=SITE, zone=zone).id
    (width,) = viewer.get(CHECK).json()["zones"] or [None]
    assert width is None or width["zone"] == made


@pytest.mark.parametrize("role", from_role("viewer"))
def test_every_role_may_ask(factory, role):
    assert join_and_sign_in(role, SITE).get(CHECK).status_code == 200


def test_a_stranger_learns_nothing_nor_does_who_is_not_signed_in(factory, client):
    assert join_and_sign_in("stranger", SITE).get(CHECK).status_code == 404
    assert client.get(CHECK).status_code == 401


def test_a_site_without_a_map_says_so(db):
    registry.create_site(name="Bare", slug="bare")
    answer = join_and_sign_in("viewer", "bare").get("/api/sites/bare/floor-check")
    assert (answer.status_code, answer.json()["code"]) == (404, "no_map")


def test_who_has_two_checks_under_way_waits_for_a_moment_and_is_told(viewer, monkeypatch):
    monkeypatch.setattr(routes, "PATIENCE_S", 0.05)
    person = registry.Claim(int(viewer.session["_auth_user_id"]))
    assert all(routes.check_slots.take(person) for _ in range(2))
    try:
        answer = viewer.get(CHECK)
        assert (answer.status_code, answer.json()["code"]) == (429, "too_many_floor_checks")
    finally:
        for _ in range(2):
            routes.check_slots.give_back(person)
    assert viewer.get(CHECK).status_code == 200


REMEDIES = f"{CHECK}/remedies"


@pytest.fixture
def admin(factory):
    return join_and_sign_in("admin", SITE)


def put_spare_dock(at_m=0.5):
    """A dock half a metre beside the first one: no two robots stand there at once."""
    first = next(place for place in registry.list_places(site=SITE) if place.kind == "dock")
    change = registry.PlaceChange(name="Spare dock", kind="dock", x=first.x - at_m, y=first.y)
    return first, registry.add_place(site=SITE, place=change)


def test_a_remedy_mends_what_was_found_when_it_is_done(admin):
    first, spare = put_spare_dock()
    (finding,) = [each for each in admin.get(CHECK).json()["findings"] if each["code"] == "together"]
    asked = {"code": "together", "target": finding["target"], "other": finding["other"]}
    assert {finding["target"], finding["other"]} == {first.id, spare.id}
    remedies = admin.get(REMEDIES, asked).json()
    assert [each["by_m"] for each in remedies] == sorted(each["by_m"] for each in remedies)
    best = remedies[0]
    change = {"x": best["x"], "y": best["y"]}
    path = f"/api/sites/{SITE}/places/{best['target']}"
    assert admin.patch(path, json.dumps(change), content_type="application/json").status_code == 200
    assert admin.get(CHECK).json()["findings"] == []
    gone = admin.get(REMEDIES, asked)
    assert (gone.status_code, gone.json()["code"]) == (409, "no_such_finding")


def test_remedies_are_looked_for_at_the_width_that_was_asked_for(admin):
    found = admin.get(f"{CHECK}?width_m=0.8").json()["findings"]
    (finding, *_) = [each for each in found if each["code"] == "together"]
    asked = {"code": "together", "target": finding["target"], "other": finding["other"]}
    assert admin.get(REMEDIES, asked).status_code == 409  # there is none at the site's own width
    assert admin.get(REMEDIES, asked | {"width_m": 0.8}).json()


@pytest.mark.parametrize("width", [{}, {"width_m": 0.4}])
def test_what_is_found_and_what_is_tried_are_of_one_reading_of_the_places(admin, width):
    put_spare_dock()
    (finding, *_) = [each for each in admin.get(CHECK, width).json()["findings"] if each["code"] == "together"]
    asked = {"code": "together", "target": finding["target"], "other": finding["other"], **width}
    routes._kept.clear()
    for _ in range(2):  # checked anew, and as it was kept
        with CaptureQueriesContext(connection) as read:
            assert admin.get(REMEDIES, asked).json()
        assert sum('FROM "registry_place"' in each["sql"] for each in read.captured_queries) == 1


def test_what_a_zone_does_has_no_remedy_by_moving(admin):
    registry.add_zone(site=SITE, zone=registry.ZoneChange(name="Spill", rule="keep_out", points=SPILL))
    (finding, *_) = [e for e in admin.get(CHECK).json()["findings"] if e["code"] in ("keep_out", "cut_off")]
    asked = {"code": finding["code"], "target": finding["target"], "other": finding["other"]}
    asked = {name: value for name, value in asked.items() if value is not None}
    assert admin.get(REMEDIES, asked).json() == []


@pytest.mark.parametrize(
    "asked",
    [{}, {"code": "no_room"}, {"code": "odd", "target": "a"}, {"code": "no_room", "target": "a" * 65},
     {"code": "no_room", "target": "a", "width_m": 9}],
)  # fmt: skip
def test_a_question_for_remedies_that_says_too_little_or_too_much_is_refused(admin, asked):
    assert admin.get(REMEDIES, asked).status_code == 422


@pytest.mark.parametrize("role", below_role("admin"))
def test_only_who_may_move_things_asks_for_remedies(factory, role):
    answer = join_and_sign_in(role, SITE).get(REMEDIES, {"code": "no_room", "target": "a"})
    assert answer.status_code == 403


def test_strangers_ask_for_no_remedies(factory, client):
    asked = {"code": "no_room", "target": "a"}
    assert join_and_sign_in("stranger", SITE).get(REMEDIES, asked).status_code == 404
    assert client.get(REMEDIES, asked).status_code == 401


def test_a_kept_check_keeps_no_floor_of_before(viewer):
    viewer.get(CHECK)
    (kept,) = [layout for (site, _), (layout, _) in routes._kept.items() if site == SITE]
    assert kept() is get_layout(SITE)
    registry.add_place(site=SITE, place=registry.PlaceChange(name="New one", x=7.0, y=-8.5))
    viewer.get(CHECK)
    gc.collect()
    assert kept() is None

"""Zones of a site's floor as the language knows them: told before the run, and kept with the site."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, get_args

import pytest

from editor.language import (
    DeviceFacts,
    Surroundings,
    UnreadableSite,
    ZoneFacts,
    compile_document,
    surroundings_from_json,
    surroundings_to_json,
)
from editor.language.site.surroundings import ZoneRule, what_programs_see
from editor.programs.checking import fingerprint_of
from registry.floorplan.plan import FloorPlan
from tests.kit import demo_floor
from tests.kit.demo_site import factory
from tests.kit.programs import document, step

ROUND_DOCK_1 = ((16.0, -13.0), (18.0, -13.0), (18.0, -10.0), (16.0, -10.0))
AISLE = ZoneFacts("aisle", "Service aisle", "keep_out", ROUND_DOCK_1)
HALL = {"id": "hall", "rule": "slow", "points": [[0, 0], [2, 0], [2, 2]], "speed_m_s": 0.3}


def told(zone: ZoneFacts | None, **fields: Any) -> list[tuple[str, str | None, Any]]:
    """Return what is told of a Move about zones: code, field, arguments."""
    return told_at(replace(factory(), zones=(zone,) if zone else ()), **fields)


def told_at(site: Surroundings, **fields: Any) -> list[tuple[str, str | None, Any]]:
    compiled = compile_document(document({"s": step("move", **fields)}), site)
    return [(d.code, d.field, dict(d.args)) for d in compiled.diagnostics if "keep_out" in d.code]


def inside(x: float, y: float) -> tuple[tuple[float, float], ...]:
    return ((x - 0.5, y - 0.5), (x + 0.5, y - 0.5), (x + 0.5, y + 0.5), (x - 0.5, y + 0.5))


def test_a_goal_and_a_point_of_a_route_in_a_zone_of_the_site_are_told_before_the_run() -> None:
    dock = demo_floor.places()[0]
    zone = replace(AISLE, points=inside(dock.x, dock.y))
    assert told(zone, to={"place": dock.id}) == [("place_in_keep_out", "to", {"zone": "Service aisle"})]
    assert told(zone, to={"place": "dock2"}) == []
    assert told(None, to={"place": dock.id}) == []
    over = told(replace(AISLE, points=inside(5, -8)), to={"place": "dock2"}, route=[[3, -8], [5, -8]])
    assert over == [("route_in_keep_out", "route", {"number": 2, "zone": "Service aisle"})]


def test_a_machine_whose_station_lies_in_a_zone_of_the_site_is_told_where_the_map_is_known() -> None:
    devices, station = demo_floor.devices(), demo_floor.layout().stations["dropOff01"]
    zone = replace(AISLE, points=inside(station.x, station.y))
    facts = {device.id: DeviceFacts(device) for device in devices}
    site = Surroundings(facts, floor=FloorPlan(demo_floor.grid(), devices), zones=(zone,))
    expected = [("place_in_keep_out", "to", {"zone": "Service aisle"})]
    assert told_at(site, to={"device": "dropOff01"}) == expected
    assert told_at(site, to={"device": "curingOven01"}) == []
    assert told_at(replace(site, floor=None), to={"device": "dropOff01"}) == []


@pytest.mark.parametrize("rule", ["slow", "one_at_a_time", "one_way", "preferred"])
def test_a_goal_in_a_zone_of_another_rule_is_no_problem(rule: Any) -> None:
    dock = demo_floor.places()[0]
    zone = ZoneFacts("z", "Hall", rule, inside(dock.x, dock.y), 0.3)
    assert told(zone, to={"place": dock.id}) == []


def test_a_site_keeps_its_zones_as_json() -> None:
    shared = (ZoneFacts(f"s{robots}", "Door", "one_at_a_time", ROUND_DOCK_1, robots=robots) for robots in (1, 3))
    site = replace(factory(), zones=(AISLE, ZoneFacts("b", "Hall", "slow", ROUND_DOCK_1, 0.25), *shared))
    body = surroundings_to_json(site)
    assert [zone.get("robots") for zone in body["zones"]] == [None, None, None, 3]
    assert surroundings_from_json(body) == site
    assert "zones" not in surroundings_to_json(factory())


def test_a_site_keeps_where_robots_drive_in_a_zone() -> None:
    lanes = (
        ZoneFacts("a", "Lane", "one_way", ROUND_DOCK_1, heading_deg=90.0),
        ZoneFacts("b", "Aisle", "preferred", ROUND_DOCK_1),
    )
    site = replace(factory(), zones=lanes)
    body = surroundings_to_json(site)
    assert [zone.get("heading_deg") for zone in body["zones"]] == [90.0, None]
    assert surroundings_from_json(body) == site
    (turned,) = surroundings_from_json({"zones": [{**HALL, "rule": "one_way", "heading_deg": -90}]}).zones
    assert (turned.heading_deg, turned.speed_m_s) == (270.0, None)


def test_a_zone_without_a_name_is_called_by_its_id() -> None:
    (zone,) = surroundings_from_json({"zones": [HALL]}).zones
    assert zone == ZoneFacts("hall", "hall", "slow", ((0, 0), (2, 0), (2, 2)), 0.3)


@pytest.mark.parametrize(
    "change",
    [{"id": ""}, {"id": 3}, {"rule": "door"}, {"points": [[0, 0], [1, 1]]}, {"points": [[0, 0], [1, 1], [2]]},
     {"points": [[0, 0], [1, 1], [2, float("nan")]]}, {"points": "here"}, {"speed_m_s": None},
     {"speed_m_s": "fast"}, {"rule": "one_way"}, {"rule": "one_way", "heading_deg": "left"},
     {"rule": "one_way", "heading_deg": float("inf")}],
)  # fmt: skip
def test_a_zone_of_a_site_that_cannot_be_read_is_told(change: dict[str, Any]) -> None:
    with pytest.raises(
        UnreadableSite, match=r"needs an id, a rule: keep_out, one_at_a_time, slow, one_way, preferred, release, points"
    ):
        surroundings_from_json({"zones": [{**HALL, **change}]})


@pytest.mark.parametrize("rule", get_args(ZoneRule))
def test_a_zone_of_each_rule_survives_as_json(rule: ZoneRule) -> None:
    speed, heading = (0.3 if rule == "slow" else None), (90.0 if rule == "one_way" else None)
    zone = ZoneFacts("hall", "Hall", rule, ((0.0, 0.0), (2.0, 0.0), (2.0, 2.0)), speed, 1, heading)
    site = surroundings_from_json(surroundings_to_json(replace(factory(), zones=(zone,))))
    assert site.zones == (zone,)


@pytest.mark.parametrize("robots", [0, -1, 1.5, "2", True, None, 21, 10**9])
def test_a_number_of_robots_that_is_none_is_told(robots: object) -> None:
    with pytest.raises(UnreadableSite, match="a whole number from 1 to 20"):
        surroundings_from_json({"zones": [{**HALL, "rule": "one_at_a_time", "robots": robots}]})


def test_programs_are_checked_anew_after_a_change_of_zones_and_only_then() -> None:
    plain, zoned = factory(), replace(factory(), zones=(AISLE,))
    moved = replace(zoned, zones=(replace(AISLE, points=inside(1, 1)),))
    assert len({fingerprint_of(site) for site in (plain, zoned, moved, replace(zoned))}) == 3
    assert what_programs_see(plain) != what_programs_see(zoned) != what_programs_see(moved)


def test_a_site_that_is_not_the_demos_and_has_no_map_is_checked_for_its_zones_too() -> None:
    site = surroundings_from_json({"places": [{"id": "bench", "kind": "point", "x": 1, "y": 0.5}],
                                   "zones": [{**HALL, "rule": "keep_out"}]})  # fmt: skip
    compiled = compile_document(document({"s": step("move", to={"place": "bench"})}), site)
    assert "place_in_keep_out" in [d.code for d in compiled.diagnostics]

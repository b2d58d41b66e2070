"""Roads of a floor: what robots can drive between places, and what zones say on the way."""

import json
from dataclasses import replace
from datetime import UTC, datetime
from itertools import pairwise
from math import hypot

import networkx
import pytest
import yaml
from lif_reader.graph.lif_graph import LIFGraph
from lif_reader.lif_reader import LIFReader

from execution.floor.exports.lif import Site, road_map_to_lif
from execution.floor.exports.rmf_building import write_building
from execution.floor.exports.road_map import make_road_map
from execution.traffic.messages import FloorZone
from registry.floorplan.plan import wall_boxes
from tests.kit import demo_floor

NOW = datetime(2026, 11, 25, 22, 5, 3, 120000, UTC)
SITE = Site("factory", "Painting Factory", 4)
CORRIDOR = ((6.0, -9.0), (10.0, -9.0), (10.0, -7.0), (6.0, -7.0))
WALL_TO_WALL = ((12.0, -13.0), (12.6, -13.0), (12.6, 0.0), (12.0, 0.0))


def zone(rule, points=CORRIDOR, key="site/z", speed=None, **more):
    return FloorZone(key, "The crossing", rule, points, speed, **more)


def layout_with(*zones):
    return replace(demo_floor.layout(), zones=zones)


def roads_with(*zones):
    return make_road_map(layout_with(*zones))


def lif_of(layout, tmp_path):
    """What a reader of LIF that nobody here wrote makes of it: its graph, and its stations."""
    path = tmp_path / "f.lif.json"
    path.write_text(json.dumps(road_map_to_lif(SITE, layout, make_road_map(layout), NOW)))
    reader = LIFReader(LIFGraph())
    reader.parse_lif_file(str(path))
    return reader.lif_graph.layouts["factory"], reader.lif_graph.stations


def rmf_of(layout):
    grid = demo_floor.grid()
    return yaml.safe_load(write_building("Painting Factory", grid, wall_boxes(grid), layout, make_road_map(layout)))


def test_every_place_and_machine_is_joined_and_every_road_can_be_driven():
    layout, roads = layout_with(), roads_with()
    graph = networkx.Graph((road.start, road.end) for road in roads.roads)
    assert networkx.is_connected(graph)
    assert {*layout.stations, *layout.places} <= set(graph)
    at = {stop.id: (stop.x, stop.y) for stop in roads.stops}
    for road in roads.roads:
        assert layout.ground.is_passable(at[road.start], at[road.end], layout.ground.radius_m)
    assert roads.left_out == ()


def test_roads_lead_round_a_keep_out_and_who_stands_in_it_is_left_out():
    layout = layout_with(zone("keep_out"))
    for road in (roads := make_road_map(layout)).roads:
        ends = [next(stop for stop in roads.stops if stop.id == end) for end in (road.start, road.end)]
        for t in range(11):
            x, y = (ends[0].x + (ends[1].x - ends[0].x) * t / 10, ends[0].y + (ends[1].y - ends[0].y) * t / 10)
            assert not (6 < x < 10 and -9 < y < -7)
    around_dock = ((15.0, -12.5), (16.5, -12.5), (16.5, -11.0), (15.0, -11.0))
    left = roads_with(zone("keep_out", around_dock))
    assert left.left_out == ("dock1",)
    assert "dock1" not in {stop.id for stop in left.stops}


def test_a_floor_that_zones_part_has_the_roads_of_each_part():
    roads = roads_with(zone("keep_out", WALL_TO_WALL))
    graph = networkx.Graph((road.start, road.end) for road in roads.roads)
    parts = sorted(networkx.connected_components(graph), key=len)
    assert len(parts) == 2
    assert {"dock1", "dock2", "dock3"} <= max(parts, key=lambda part: "dock1" in part)
    assert not networkx.has_path(graph, "dropOff01", "dock1")


def test_a_slow_zone_limits_the_roads_in_it_alone():
    roads = roads_with(zone("slow", speed=0.3), zone("slow", key="site/y", speed=0.2))
    at = {stop.id: (stop.x, stop.y) for stop in roads.stops}
    slow = [road for road in roads.roads if road.speed_m_s is not None]
    assert {road.speed_m_s for road in slow} == {0.2}
    for road in slow:
        ends = (at[road.start], at[road.end])
        assert any(5 < x < 11 and -10 < y < -6 for x, y in ends)
    assert len(slow) < len(roads.roads) / 2


def test_no_stop_is_kept_that_roads_lead_straight_through():
    roads = roads_with()
    at = {stop.id: (stop.x, stop.y) for stop in roads.stops}
    for stop in roads.stops:
        near = [r.end if r.start == stop.id else r.start for r in roads.roads if stop.id in (r.start, r.end)]
        if stop.kind == "way" and len(near) == 2:
            (ax, ay), (x, y), (bx, by) = at[near[0]], at[stop.id], at[near[1]]
            assert abs((x - ax) * (by - y) - (y - ay) * (bx - x)) > 1e-6


def test_a_reader_of_lif_finds_ways_between_places(tmp_path):
    layout = layout_with()
    graph, stations = lif_of(layout, tmp_path)
    path = networkx.shortest_path(graph, "dock1", "itemInventory01")
    for a, b in pairwise(path):
        assert graph.edges[a, b]["vehicleTypeEdgeProperties"][0]["vehicleTypeId"] == "turtlebot"
        assert graph.has_edge(b, a)
    assert graph.nodes["dock1"]["nodeName"] == layout.name("dock1")
    assert set(stations) == {*layout.stations, *layout.docks}
    assert all(set(station.interactionNodeIds) <= set(graph) for station in stations.values())
    oven = next(d for d in demo_floor.devices() if d.id == "curingOven01")
    assert stations["curingOven01"].stationPosition == {"x": oven.pose.x, "y": oven.pose.y, "theta": oven.pose.theta}


def test_lif_says_limits_and_its_own_version(tmp_path):
    graph, _ = lif_of(layout_with(zone("slow", speed=0.3)), tmp_path)
    limits = [edge["vehicleTypeEdgeProperties"][0]["maxSpeed"] for *_, edge in graph.edges(data=True)]
    assert set(limits) == {None, 0.3}
    meta = json.loads((tmp_path / "f.lif.json").read_text())["metaInformation"]
    assert (meta["lifVersion"], meta["exportTimestamp"]) == ("1.0.0", "2026-11-25T22:05:03.12Z")


def test_a_one_way_zone_makes_roads_that_lead_one_way(tmp_path):
    strip = ((6.0, -14.0), (10.0, -14.0), (10.0, 0.0), (6.0, 0.0))
    layout = layout_with(zone("one_way", strip, heading_deg=0.0))
    roads = make_road_map(layout)
    at = {stop.id: (stop.x, stop.y) for stop in roads.stops}
    single = [road for road in roads.roads if road.one_way]
    assert single
    for road in roads.roads:
        (x, y), (x2, y2) = at[road.start], at[road.end]
        inside = max(min(x, x2), 6.0) < min(max(x, x2), 10.0) - 1e-9 and abs(y - y2) < 1e-9
        assert road.one_way == inside
        assert not road.one_way or x < x2
    graph, _ = lif_of(layout, tmp_path)
    assert all(graph.has_edge(road.start, road.end) for road in roads.roads)
    assert [graph.has_edge(road.end, road.start) for road in roads.roads] == [not road.one_way for road in roads.roads]
    level = next(iter(rmf_of(layout)["levels"].values()))
    both = [lane[2]["bidirectional"][1] for lane in level["lanes"]]
    assert both == [not road.one_way for road in roads.roads]
    assert networkx.has_path(graph, "dropOff01", "dock1") != networkx.has_path(graph, "dock1", "dropOff01")


def test_a_road_that_two_zones_shut_both_ways_is_none():
    strip = ((6.0, -14.0), (10.0, -14.0), (10.0, 0.0), (6.0, 0.0))
    pair = (zone("one_way", strip, heading_deg=0.0), zone("one_way", strip, "site/y", heading_deg=180.0))
    graph = networkx.DiGraph((road.start, road.end) for road in roads_with(*pair).roads)
    assert not networkx.has_path(graph, "dropOff01", "dock1")
    assert not networkx.has_path(graph, "dock1", "dropOff01")


def test_rmf_has_the_map_in_metres_with_named_waypoints_and_lanes():
    layout, building = layout_with(), rmf_of(layout_with())
    level = building["levels"][building["reference_level_name"]]
    vertices = level["vertices"]
    named = {name: (x, y) for x, y, _, name, _ in vertices if name}
    dock = layout.spot("dock1")
    assert building["coordinate_system"] == "cartesian_meters"
    assert named[layout.name("dock1")] == (dock.x, dock.y)
    assert len(named) == len({*layout.stations, *layout.places})
    chargers = {name for *_, name, parameters in vertices if parameters.get("is_charger") == [4, True]}
    assert chargers == {layout.name(dock) for dock in layout.docks}
    lanes = networkx.Graph((a, b) for a, b, _ in level["lanes"])
    assert networkx.is_connected(lanes)
    assert all(parameters["bidirectional"] == [4, True] for *_, parameters in level["lanes"])
    assert all(len(wall) == 3 and max(wall[:2]) < len(vertices) for wall in level["walls"])
    xs, ys = zip(*((vertices[i][0], vertices[i][1]) for i in level["floors"][0]["vertices"]), strict=True)
    assert hypot(max(xs) - min(xs), max(ys) - min(ys)) == pytest.approx(
        hypot(level["x_meters"], level["y_meters"]), abs=0.01
    )


def test_rmf_lanes_say_limits_and_who_shares_a_zone_for_one_robot():
    east = ((9.5, -9.0), (12.0, -9.0), (12.0, -7.0), (9.5, -7.0))
    away = ((15.0, -9.0), (18.0, -9.0), (18.0, -7.0), (15.0, -7.0))
    layout = layout_with(
        zone("slow", speed=0.3),
        zone("one_at_a_time", key="site/west"),
        zone("one_at_a_time", east, "site/east"),
        zone("one_at_a_time", away, "site/away"),
    )
    lanes = [parameters for *_, parameters in rmf_of(layout)["levels"]["L1"]["lanes"]]
    groups = {lane["mutex"][1] for lane in lanes}
    assert groups == {"", "site/east", "site/away"}  # west and east share lanes, and so a group
    assert {lane["speed_limit"][1] for lane in lanes} == {0.0, 0.3}


def test_rmf_lanes_of_a_zone_for_two_robots_are_locked_by_nobody():
    lanes = [
        parameters for *_, parameters in rmf_of(layout_with(zone("one_at_a_time", robots=2)))["levels"]["L1"]["lanes"]
    ]
    assert {lane["mutex"][1] for lane in lanes} == {""}


def test_rmf_tells_waypoints_of_one_name_apart():
    names = dict(demo_floor.layout().names) | {"dock1": "Dock", "dock2": "Dock"}
    vertices = rmf_of(replace(layout_with(), names=names))["levels"]["L1"]["vertices"]
    assert {"Dock (dock1)", "Dock (dock2)"} <= {name for *_, name, _ in vertices}

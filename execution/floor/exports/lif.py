"""A floor's roads as LIF, the layout interchange format of the VDMA (version 1.0.0, March 2024).

LIF's edges lead one way, so that a road is two of them. Places and stations are nodes by the ids that VIPO knows them
by; machines and docks are stations, too. Zones for one robot at a time and keep-outs have no word in LIF: roads lead
round keep-outs, and who shares the floor must be told of the others otherwise.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from datetime import UTC, datetime
from math import remainder, tau
from typing import Any

from execution.floor.exports.road_map import Road, RoadMap, Stop
from execution.traffic.layout import Layout

LIF_VERSION = "1.0.0"
ANY_VEHICLE = "robot"
"""What a type of vehicle is called at a site that has no robot."""


@dataclass(frozen=True, slots=True)
class Site:
    """What an export says of the site beside its floor; `version` is that of its map."""

    slug: str
    name: str
    version: int


def road_map_to_lif(site: Site, layout: Layout, roads: RoadMap, now: datetime) -> dict[str, Any]:
    """Return the roads as JSON of LIF: metres and radians in the map frame."""
    vehicles = sorted({device.device_class for device in layout.devices.values() if device.kind == "robot"})
    vehicles = vehicles or [ANY_VEHICLE]
    return {
        "metaInformation": {
            "projectIdentification": site.name,
            "creator": "VIPO",
            "exportTimestamp": now.astimezone(UTC).strftime("%Y-%m-%dT%H:%M:%S.%f")[:-4] + "Z",
            "lifVersion": LIF_VERSION,
        },
        "layouts": [
            {
                "layoutId": site.slug,
                "layoutName": site.name,
                "layoutVersion": str(site.version),
                **_left_out(layout, roads),
                "nodes": [_node(site, layout, stop, vehicles) for stop in roads.stops],
                "edges": [edge for road in roads.roads for edge in _edges(road, vehicles)],
                "stations": [_station(layout, stop) for stop in roads.stops if _is_station(layout, stop)],
            }
        ],
    }


def _left_out(layout: Layout, roads: RoadMap) -> dict[str, str]:
    if not roads.left_out:
        return {}
    return {"layoutDescription": f"Robots cannot come to: {', '.join(map(layout.name, roads.left_out))}."}


def _node(site: Site, layout: Layout, stop: Stop, vehicles: Iterable[str]) -> dict[str, Any]:
    turned = {} if stop.theta is None else {"theta": _theta(stop.theta)}
    return {
        "nodeId": stop.id,
        **({} if stop.kind == "way" else {"nodeName": layout.name(stop.id)}),
        "mapId": site.slug,
        "nodePosition": {"x": stop.x, "y": stop.y},
        "vehicleTypeNodeProperties": [{"vehicleTypeId": vehicle, **turned} for vehicle in vehicles],
    }


def _edges(road: Road, vehicles: Iterable[str]) -> tuple[dict[str, Any], ...]:
    limit = {} if road.speed_m_s is None else {"maxSpeed": road.speed_m_s}
    properties = [
        {
            "vehicleTypeId": vehicle,
            "vehicleOrientation": 0.0,
            "orientationType": "TANGENTIAL",
            "rotationAllowed": False,
            "rotationAtStartNodeAllowed": "BOTH",
            "rotationAtEndNodeAllowed": "BOTH",
            **limit,
        }
        for vehicle in vehicles
    ]

    def edge(start: str, end: str) -> dict[str, Any]:
        ends = {"startNodeId": start, "endNodeId": end}
        return {"edgeId": f"{start}--{end}", **ends, "vehicleTypeEdgeProperties": properties}

    there = edge(road.start, road.end)
    return (there,) if road.one_way else (there, edge(road.end, road.start))


def _is_station(layout: Layout, stop: Stop) -> bool:
    return stop.kind == "machine" or stop.id in layout.docks


def _station(layout: Layout, stop: Stop) -> dict[str, Any]:
    machine = layout.devices.get(stop.id) if stop.kind == "machine" else None
    x, y, theta = (machine.pose.x, machine.pose.y, machine.pose.theta) if machine else (stop.x, stop.y, stop.theta)
    return {
        "stationId": stop.id,
        "interactionNodeIds": [stop.id],
        "stationName": layout.name(stop.id),
        "stationPosition": {"x": x, "y": y, "theta": _theta(theta or 0.0)},
    }


def _theta(theta: float) -> float:
    """Return the same direction from -pi to pi."""
    return round(remainder(theta, tau), 6)

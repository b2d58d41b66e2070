"""A site's floor over HTTP in the forms of other fleet managers: LIF and Open-RMF."""

from __future__ import annotations

import json
from collections.abc import Callable
from datetime import UTC, datetime
from typing import TypeVar

from django.http import HttpRequest, HttpResponse
from ninja import Router

from execution.errors import ExecutionError
from execution.floor.exports.lif import Site, road_map_to_lif
from execution.floor.exports.rmf_building import write_building
from execution.floor.exports.road_map import RoadMap, make_road_map
from execution.floor.layouts import get_layout
from execution.traffic.layout import Layout
from registry import services as registry
from registry.requests import file_response, sends, signed_in
from registry.services import require

router = Router(tags=["execution"])
LIF, BUILDING = "application/json", "application/yaml"
PATIENCE_S = 5.0
export_slots = registry.Slots(in_all=2, of_site=2, of_person=1, most_waiting=1)
"""Floors whose roads are worked out at once."""
_roads: dict[str, tuple[Layout, RoadMap]] = {}
Made = TypeVar("Made")


class TooManyExports(ExecutionError):
    """This process works out as many floors' roads as it may, in all or for this person."""

    code = "too_many_exports"
    status = 429


@router.get("/sites/{slug:site}/map.lif.json", openapi_extra=sends(LIF))
def download_lif(request: HttpRequest, site: str) -> HttpResponse:
    """Send the floor's places and roads as LIF 1.0 (VDMA's layout interchange format of VDA 5050).

    Roads are the routes that VIPO's planner finds between places; they lead round keep-outs.
    """
    require(request.user, site, "viewer")
    view, floor = registry.get_site(site=site), registry.get_map(site=site)
    layout, roads = _in_turn(request, lambda: _roads_of(site))
    told = road_map_to_lif(Site(site, view.name, floor.version), layout, roads, datetime.now(UTC))
    return file_response(json.dumps(told, ensure_ascii=False, indent=1).encode(), f"{site}.lif.json", LIF)


@router.get("/sites/{slug:site}/map.building.yaml", openapi_extra=sends(BUILDING))
def download_building(request: HttpRequest, site: str) -> HttpResponse:
    """Send the floor as a building map of Open-RMF: its walls, places and lanes, in metres of the map frame.

    Lanes are the routes that VIPO's planner finds between places; they lead round keep-outs.
    """
    require(request.user, site, "viewer")
    view, grid = registry.get_site(site=site), registry.get_map(site=site).grid
    layout, roads = _in_turn(request, lambda: _roads_of(site))
    told = write_building(view.name, grid, registry.get_walls(grid), layout, roads)
    return file_response(told, f"{site}.building.yaml", BUILDING)


def _in_turn(request: HttpRequest, work: Callable[[], Made]) -> Made:
    refusal = TooManyExports("Other floors are being exported, by you or others. Try again in a moment.")
    with export_slots.held(registry.Claim(signed_in(request).pk), refusal, patience_s=PATIENCE_S):
        return work()


def _roads_of(site: str) -> tuple[Layout, RoadMap]:
    """Return a site's layout and its roads, which are worked out when the layout is another one."""
    layout, known = get_layout(site), _roads.get(site)
    if known is None or known[0] is not layout:
        known = _roads[site] = (layout, make_road_map(layout))
    return known

"""Checks of covers: whether the zone is there, on free floor, and of a size that lanes of this width suit."""

from __future__ import annotations

from math import inf

from editor.language.checks.context import Context
from editor.language.checks.devices import USUAL_RADIUS_M
from editor.language.checks.values import check_limits, check_value, range_in
from editor.language.expressions.nodes import Zone
from editor.language.expressions.value_types import METRES
from editor.language.messages.diagnostics import TextArguments
from editor.language.tree import nodes as n
from editor.language.tree.zones import width_m

NARROWEST_LANE_M = 0.1
_CODES = {"outside": "cover_outside", "nothing": "cover_nothing", "too_many": "too_many_lanes"}


def check_cover(context: Context, node: n.Cover) -> None:
    """Check what a cover is told: its zone, and how wide the lanes are."""
    if not node.zone:
        context.report(node, "missing_zone", "zone", {"robot": context.robot_name(node.role)})
    elif node.zone not in context.zones:
        context.report(node, "unknown_zone", "zone", {"zone": node.zone})
    if node.lane_m is not None and check_value(context, node, node.lane_m, "lane", METRES, "The width of a lane"):
        found = range_in(context, node.lane_m, "M")
        check_limits(context, node, "lane", found, (NARROWEST_LANE_M, None), "The width of a lane", "M")


def check_covers(context: Context) -> None:
    """Check that robots may and can drive over the zones of all covers."""
    for node in context.tree.of_kind(n.Cover):
        _check_zone(context, node)


def _check_zone(context: Context, node: n.Cover) -> None:
    zone = next((zone for zone in context.tree.zones if zone.id == node.zone), None)
    if zone is None:
        return
    if zone.rule == "keep_out":
        context.report(node, "cover_in_keep_out", "zone", {"zone": zone.name})
        return
    lanes = _lanes_m(context, node)
    if not lanes or min(lanes) < NARROWEST_LANE_M:
        return
    names: TextArguments = {"zone": zone.name, "robot": context.robot_name(node.role)}
    codes = [_why_not(context, zone, lane_m) for lane_m in lanes]
    if all(codes):
        context.report(node, _CODES[codes[0]], "zone", names)
    elif min(lanes) > width_m(zone.points) + 1e-6:
        context.report(node, "lane_wider_than_zone", "lane" if node.lane_m is not None else "zone", names)


def _lanes_m(context: Context, node: n.Cover) -> list[float]:
    """Return how wide the lanes of the robots are that may take the role, each width once; none if nobody knows."""
    if node.lane_m is not None:
        found = range_in(context, node.lane_m, "M")
        return [found.least] if 0 < found.least == found.most < inf else []
    return sorted({2 * (robot.radius_m or USUAL_RADIUS_M) for robot in context.robots(node.role)})


def _why_not(context: Context, zone: Zone, lane_m: float) -> str:
    floor = context.surroundings.floor
    return "" if floor is None else floor.why_not_covered(zone.points, lane_m, context.largest_radius_m(USUAL_RADIUS_M))

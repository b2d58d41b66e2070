"""Where a scan fits into the map: a correlative search around what odometry says, then a fit to surfaces.

The search (Olson, Real-time correlative scan matching, 2009) tries all turns and shifts of a window and takes the best
one; it is as fine as the cells. The fit moves each end of a beam onto the line through the ends of earlier beams around
it (point to line, Gauss and Newton), with odometry holding what walls do not: so a corridor's length is odometry's.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, hypot

import numpy as np
from numpy.typing import NDArray

from simulation.actors.follower import wrapped
from simulation.mapping.occupancy import FACINGS, Floats, Indices, OccupancyMap, Sight, facing, place, turned
from vipo_device.protocol.description import Pose

SEARCH_M = 0.12
SEARCH_RAD = 0.26
TURN_RAD = 0.0175
MOST_POINTS = 180
ROUNDS, NEW_SURFACES = 6, 2
LEAST_ENDS = 4
FLAT = 0.15
"""A surface is flat where it is so much thinner than long (variances)."""
SPREAD_M = 0.02
FEW_POINTS = 20
_AROUND = tuple((row, column) for row in (-1, 0, 1) for column in (-1, 0, 1))


@dataclass(frozen=True, slots=True)
class Trust:
    """How far odometry may be off since the last scan (one standard deviation): metres and radians."""

    way_m: float
    turn_rad: float


def match(occupancy: OccupancyMap, sight: Sight, prior: Pose, trust: Trust) -> Pose:
    """Return where the scan was taken; the prior when too little of the map is in view."""
    occupancy.make_room(prior)
    if len(sight.ends) < FEW_POINTS:
        return prior
    return fit(occupancy, sight, search(occupancy, sight, prior, trust), prior, trust)


def search(occupancy: OccupancyMap, sight: Sight, prior: Pose, trust: Trust) -> Pose:
    """Return the turn and shift under which most ends of beams lie on walls, as fine as cells and a degree."""
    side_m = occupancy.field_m
    reach = ceil(SEARCH_M / side_m)
    shifts = np.arange(-reach, reach + 1)
    turns = np.arange(-round(SEARCH_RAD / TURN_RAD), round(SEARCH_RAD / TURN_RAD) + 1) * TURN_RAD
    thin = slice(None, None, max(1, len(sight.ends) // MOST_POINTS))
    points = sight.ends[thin] + sight.inward[thin] * (side_m / 2)
    angles = prior.theta + turns
    turn_x, turn_y = np.cos(angles)[:, None], np.sin(angles)[:, None]
    x = prior.x + points[:, 0] * turn_x - points[:, 1] * turn_y
    y = prior.y + points[:, 0] * turn_y + points[:, 1] * turn_x
    rows, columns = occupancy.cells_of(np.stack((x.ravel(), y.ravel()), axis=1), side_m)
    width = occupancy.field.shape[1]
    cells = (rows * width + columns).reshape(len(turns), 1, len(points))
    offsets = (shifts[:, None] * width + shifts[None, :]).reshape(1, -1, 1)
    found = occupancy.field.ravel().take(cells + offsets, mode="clip").sum(axis=2, dtype=np.int64) / (2 * len(points))
    away = side_m**2 * (shifts[:, None] ** 2 + shifts[None, :] ** 2).reshape(1, -1) / trust.way_m**2
    score = found - 0.005 * (away + (turns[:, None] / trust.turn_rad) ** 2)
    turn, shift = np.unravel_index(int(np.argmax(score)), score.shape)
    up, right = divmod(int(shift), len(shifts))
    return Pose(
        prior.x + float(shifts[right]) * side_m,
        prior.y + float(shifts[up]) * side_m,
        0.0,
        wrapped(prior.theta + float(turns[turn])),
    )


def fit(occupancy: OccupancyMap, sight: Sight, start: Pose, prior: Pose, trust: Trust) -> Pose:
    """Return the pose near `start` at which ends of beams lie on the surfaces of the map."""
    pose = start
    hold = np.array((trust.way_m, trust.way_m, trust.turn_rad)) ** -2.0
    thin = slice(None, None, max(1, len(sight.ends) // MOST_POINTS))
    points, inward = sight.ends[thin], sight.inward[thin]
    for turn in range(ROUNDS):
        if turn < NEW_SURFACES:
            middles, normals, flat = surfaces(occupancy, place(points, pose), turned(inward, pose))
        if np.count_nonzero(flat) < FEW_POINTS:
            return pose
        ends = place(points, pose)
        off, normal = (ends - middles)[flat], normals[flat]
        arm = ends[flat] - (pose.x, pose.y)
        gap = np.sum(off * normal, axis=1)
        slope = np.stack((normal[:, 0], normal[:, 1], normal[:, 1] * arm[:, 0] - normal[:, 0] * arm[:, 1]), axis=1)
        weight = 1.0 / (SPREAD_M**2 * (1.0 + (gap / (2 * SPREAD_M)) ** 2))
        drift = np.array((pose.x - prior.x, pose.y - prior.y, wrapped(pose.theta - prior.theta)))
        squares = (slope * weight[:, None]).T @ slope + np.diag(hold)
        step = -np.linalg.solve(squares, (slope * weight[:, None]).T @ gap + hold * drift)
        pose = Pose(pose.x + float(step[0]), pose.y + float(step[1]), 0.0, wrapped(pose.theta + float(step[2])))
        if hypot(step[0], step[1]) < 1e-4 and abs(step[2]) < 1e-5:
            break
    return pose


def surfaces(occupancy: OccupancyMap, points: Floats, inward: Floats) -> tuple[Floats, Floats, NDArray[np.bool_]]:
    """Return, for points [n, 2], middle and normal of the surface around each that faces so, and whether it is flat."""
    side_m = occupancy.surface_m
    rows, columns = occupancy.cells_of(points, side_m)
    height, width = occupancy.sums.shape[:2]
    rows, columns = np.clip(rows, 1, height - 2), np.clip(columns, 1, width - 2)
    count, x, y, xx, xy, yy = _around(occupancy, rows, columns, facing(inward))
    enough = count >= LEAST_ENDS
    count = np.maximum(count, 1.0)
    x, y = x / count, y / count
    xx, xy, yy = xx / count - x * x, xy / count - x * y, yy / count - y * y
    half, root = (xx + yy) / 2, np.hypot((xx - yy) / 2, xy)
    angle = np.arctan2(2 * xy, xx - yy) / 2 + np.pi / 2
    normals = np.stack((np.cos(angle), np.sin(angle)), axis=1)
    middles = occupancy.centre_of(rows, columns, side_m) + np.stack((x, y), axis=1)
    return middles, normals, enough & (half - root < FLAT * (half + root))


def _around(occupancy: OccupancyMap, rows: Indices, columns: Indices, faces: Indices) -> Floats:
    """Return the sums [6, n] of the ends in the nine cells around each, from the middle one's middle."""
    sums, width = occupancy.sums.reshape(-1, 6), occupancy.sums.shape[1]
    beside = np.array([up * width + right for up, right in _AROUND])
    cells = (rows * width + columns + beside[:, None]) * FACINGS + faces
    count, x, y, xx, xy, yy = np.moveaxis(sums[cells], 2, 0)
    off_y, off_x = np.array(_AROUND).T[:, :, None] * occupancy.surface_m
    parts = (
        count,
        x + count * off_x,
        y + count * off_y,
        xx + 2 * off_x * x + count * off_x * off_x,
        xy + off_x * y + off_y * x + count * off_x * off_y,
        yy + 2 * off_y * y + count * off_y * off_y,
    )
    return np.stack([part.sum(axis=0) for part in parts])

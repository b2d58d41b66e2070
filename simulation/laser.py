"""What a robot's laser has seen of a floor: a map of its own that grows where it has been."""

from __future__ import annotations

from math import hypot

import numpy as np
from numpy.typing import NDArray

from registry.floorplan.map_message import write_grid
from registry.floorplan.plan import FREE, OCCUPIED, UNKNOWN, Grid, cells_array
from vipo_device.protocol.description import Pose

RANGE_M = 3.5
"""As far as the laser of a TurtleBot 3 (LDS-01) reaches; it looks all round."""
RAYS = 720
STEP_CELLS = 0.7
MOVED_M = 0.1
SEND_EVERY_S = 10.0
SEND_AGAIN_S = 60.0
"""What a robot says before it is approved, or before there is a gateway, is not kept."""


class LaserMap:
    """A robot's occupancy grid of a floor that it sees ray by ray; `floor` has everything that stops a laser."""

    def __init__(self, floor: Grid) -> None:
        self._floor = floor
        self._real = cells_array(floor)
        self._seen = np.full_like(self._real, UNKNOWN)
        turns = np.linspace(0.0, 2 * np.pi, RAYS, endpoint=False)
        far = np.arange(0.0, RANGE_M, STEP_CELLS * floor.resolution_m)
        self._ahead, self._aside = np.outer(np.cos(turns), far), np.outer(np.sin(turns), far)

    def look(self, pose: Pose) -> bool:
        """Take in what can be seen from a place; tell whether any of it is new."""
        rows, columns, inside = self._cells_on_rays(pose)
        real = np.where(inside, self._real[rows, columns], UNKNOWN)
        open_so_far = np.logical_and.accumulate(real == FREE, axis=1)
        reached = np.concatenate((np.ones((RAYS, 1), np.bool_), open_so_far[:, :-1]), axis=1)
        free, wall = open_so_far, reached & (real == OCCUPIED)
        before = np.count_nonzero(self._seen != UNKNOWN)
        self._seen[rows[free], columns[free]] = FREE
        self._seen[rows[wall], columns[wall]] = OCCUPIED
        return bool(np.count_nonzero(self._seen != UNKNOWN) != before)

    def _cells_on_rays(self, pose: Pose) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.bool_]]:
        floor = self._floor
        columns = np.floor((pose.x + self._ahead - floor.origin_x_m) / floor.resolution_m).astype(np.int64)
        rows = np.floor((pose.y + self._aside - floor.origin_y_m) / floor.resolution_m).astype(np.int64)
        inside = (rows >= 0) & (rows < floor.height) & (columns >= 0) & (columns < floor.width)
        return np.clip(rows, 0, floor.height - 1), np.clip(columns, 0, floor.width - 1), inside

    @property
    def grid(self) -> Grid:
        """The map as it is now."""
        floor = self._floor
        measures = (floor.width, floor.height, floor.resolution_m, floor.origin_x_m, floor.origin_y_m)
        return Grid(*measures, self._seen.tobytes())


class Mapper:
    """Says when a robot's map is to be sent, and as which messages.

    `boot` counts the robot's starts, `number` the maps that it has sent since.
    """

    def __init__(self, floor: Grid, boot: int, number: int = 0) -> None:
        self._map, self._boot, self.number = LaserMap(floor), boot, number
        self._looked_from: Pose | None = None
        self._is_news = False
        self._sent_s = -SEND_EVERY_S

    def repeat(self) -> None:
        """Send the map again though it has not changed: whoever listens now may not know it."""
        self._is_news = True

    def next_messages(self, pose: Pose, now_s: float) -> list[bytes]:
        """Look round from a new place, and return the map's messages if it has grown and enough time has passed."""
        last = self._looked_from
        if last is None or hypot(pose.x - last.x, pose.y - last.y) >= MOVED_M:
            self._looked_from = pose
            self._is_news = self._map.look(pose) or self._is_news
        if now_s - self._sent_s < (SEND_EVERY_S if self._is_news else SEND_AGAIN_S):
            return []
        self.number += 1
        self._is_news, self._sent_s = False, now_s
        return list(write_grid(self._map.grid, self._boot, self.number))

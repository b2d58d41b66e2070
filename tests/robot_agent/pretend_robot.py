"""A robot that drives straight to its goal; the stand-ins for move_base and Nav2 each have one. Plain Python 3.8."""

from __future__ import annotations

from math import atan2, hypot

SPEED_M_S = 2.0
UNREACHABLE_M = 90.0
WIDTH, HEIGHT = 300, 200


class PretendRobot:
    """Where it is and where it goes; `limit_m_s` is the most that it may drive."""

    def __init__(self) -> None:
        self.x, self.y, self.theta = 1.0, 2.0, 0.0
        self.limit_m_s = SPEED_M_S
        self.top_m_s = 0.0

    def can_reach(self, x: float) -> bool:
        return x < UNREACHABLE_M

    def step(self, x: float, y: float, theta: float, dt_s: float) -> bool:
        """Drive towards a goal for a moment; True when it is there."""
        way_m, step_m = hypot(x - self.x, y - self.y), self.limit_m_s * dt_s
        self.top_m_s = max(self.top_m_s, self.limit_m_s)
        if way_m <= step_m:
            self.x, self.y, self.theta = x, y, theta
            return True
        self.theta = atan2(y - self.y, x - self.x)
        self.x += (x - self.x) * step_m / way_m
        self.y += (y - self.y) * step_m / way_m
        return False


def map_cells() -> list[int]:
    """Return a map of noise that does not compress well, as ROS writes it: -1, 0 and 100."""
    seed, cells = 1, []
    for _ in range(WIDTH * HEIGHT):
        seed = (seed * 1103515245 + 12345) % 2**31
        cells.append((-1, 0, 0, 100)[seed >> 29])
    return cells

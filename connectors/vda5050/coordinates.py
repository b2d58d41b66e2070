"""Where the vehicles' map lies in the site's."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, remainder, sin

from vipo_device.protocol.description import Pose

Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Frame:
    """The origin of the vehicles' map in the site's map: metres, and radians anticlockwise."""

    x: float = 0.0
    y: float = 0.0
    theta: float = 0.0

    def to_site(self, pose: Pose) -> Pose:
        """Return a pose of the vehicles' map as the site has it."""
        c, s = cos(self.theta), sin(self.theta)
        x, y = self.x + c * pose.x - s * pose.y, self.y + s * pose.x + c * pose.y
        return Pose(round(x, 4), round(y, 4), 0.0, round(angle(pose.theta + self.theta), 4))

    def to_vehicle(self, point: Point) -> Point:
        """Return a point of the site's map as the vehicles have it."""
        c, s = cos(self.theta), sin(self.theta)
        x, y = point[0] - self.x, point[1] - self.y
        return round(c * x + s * y, 4), round(c * y - s * x, 4)

    def heading_to_vehicle(self, theta: float) -> float:
        """Return a heading in the site's map as the vehicles have it, from -pi to pi."""
        return round(angle(theta - self.theta), 4)


def angle(theta: float) -> float:
    """Return the same direction from -pi to pi."""
    return min(pi, max(-pi, remainder(theta, 2 * pi)))

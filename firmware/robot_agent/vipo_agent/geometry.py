"""Headings and quaternions of a robot on a floor."""

from __future__ import annotations

from math import atan2, cos, sin


def quaternion(theta: float) -> tuple[float, float]:
    """Return z and w of a heading in radians; x and y are 0 on a floor."""
    return sin(theta / 2), cos(theta / 2)


def yaw(z: float, w: float) -> float:
    """Return the heading in radians of a quaternion on a floor."""
    return atan2(2 * w * z, 1 - 2 * z * z)

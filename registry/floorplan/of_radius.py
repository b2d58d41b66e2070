"""What was worked out of a floor for robots of one radius, kept for the few radii that were asked for last."""

from __future__ import annotations

from dataclasses import dataclass, field
from threading import Lock

import numpy as np
from numpy.typing import NDArray

from registry.floorplan.lattice import Ground, Lattice
from vipo_device.protocol.description import Pose

MOST_RADII = 4
"""Regions alone take four bytes for each cell of the map."""


@dataclass
class OfRadius:
    """What is asked for again and again, None until somebody asks; `stations` are by device."""

    regions: NDArray[np.int32] | None = None
    main_region: int | None = None
    traffic: tuple[Ground, Lattice] | None = None
    stations: dict[str, Pose | None] = field(default_factory=dict)


class ByRadius:
    """What is known by radius; the one that nobody has asked for the longest goes, with all that belongs to it."""

    def __init__(self) -> None:
        self._kept: dict[float, OfRadius] = {}
        self._looking = Lock()

    def __getitem__(self, radius_m: float) -> OfRadius:
        with self._looking:
            found = self._kept[radius_m] = self._kept.pop(radius_m) if radius_m in self._kept else OfRadius()
            if len(self._kept) > MOST_RADII:
                del self._kept[next(iter(self._kept))]
        return found

    def __len__(self) -> int:
        return len(self._kept)

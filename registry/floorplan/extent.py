"""How large a floor may be in metres: the lattice has a planning cell each half metre, whatever the map's cells are."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from registry.errors import RegistryError

MOST_FLOOR_M2 = 500_000
"""As much as three of the largest maps at ten centimetres a cell: two million planning cells, 700 MB of each process
that plans on them."""
MOST_IN_ALL_M2 = 2_000_000
"""With what is wall or unknown, which has no planning cells, but is looked at when they are laid."""


class FloorTooLarge(RegistryError):
    """There is more floor than can be planned on; the sentence says how much, and what to do."""

    code = "bad_map"
    status = 422


class Raster(Protocol):
    """A map by how many cells it has, and how many metres these are wide."""

    @property
    def width(self) -> int:
        """Return how many cells in a row."""

    @property
    def height(self) -> int:
        """Return how many rows."""

    @property
    def resolution_m(self) -> float:
        """Return the side of a cell in metres."""


def why_too_large(raster: Raster, count_floor: Callable[[], int]) -> str:
    """Return a sentence why nothing can be planned on a map; empty: it can. Cells of floor are counted only if needed.

    Most of a large map may be unknown, so floor counts for itself.
    """
    width_m, height_m = raster.width * raster.resolution_m, raster.height * raster.resolution_m
    in_all_m2 = width_m * height_m
    if in_all_m2 <= MOST_FLOOR_M2:
        return ""
    floor_m2 = count_floor() * raster.resolution_m**2
    if floor_m2 <= MOST_FLOOR_M2 and in_all_m2 <= MOST_IN_ALL_M2:
        return ""
    return (
        f"The map is {_plain(width_m)} x {_plain(height_m)} m with {_plain(floor_m2)} m² of floor; "
        f"{_plain(MOST_FLOOR_M2)} m² of floor and {_plain(MOST_IN_ALL_M2)} m² in all are the most. "
        "Check its resolution (metres a cell), or cut it."
    )


def require_extent(raster: Raster, count_floor: Callable[[], int]) -> None:
    """Raise FloorTooLarge when there is more floor than can be planned on."""
    if why := why_too_large(raster, count_floor):
        raise FloorTooLarge(why)


def _plain(metres: float) -> str:
    """Return whole metres in groups of three digits, with a space that every language reads."""
    return f"{metres:,.0f}".replace(",", "\N{NO-BREAK SPACE}")

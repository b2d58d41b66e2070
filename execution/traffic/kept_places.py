"""Places as runs go by them: each run by those that there were when it began, whatever became of them since; pure."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

from editor.language.site.surroundings import PlaceFacts
from execution.traffic.layout import Layout

BeganWith = Mapping[str, Iterable[PlaceFacts]]
"""By run: the places that there were when it began."""


def keep_places(layout: Layout, began_with: BeganWith) -> Layout:
    """Return the floor on which each run goes to its places as they were, also if they are elsewhere by now, turned or
    gone.

    Such a place is a point to its run. An id that a device has by now means the device, as it does to new runs.
    """
    kept = {(run, place.id): place for run, places in began_with.items() for place in _changed(layout, places)}
    if not kept:
        return layout
    gone = {place.id: place.name for place in kept.values()}
    return replace(layout, kept={key: _point(place) for key, place in kept.items()}, names={**gone, **layout.names})


def _changed(layout: Layout, places: Iterable[PlaceFacts]) -> Iterator[PlaceFacts]:
    """Go through the places at which nobody would stand now as they were to be stood at."""
    for place in places:
        now = layout.places.get(place.id)
        as_now = None if now is None else (now.x, now.y, now.theta)
        if place.id not in layout.devices and as_now != (place.x, place.y, _heading(place)):
            yield place


def _heading(place: PlaceFacts) -> float | None:
    """Return where robots that stand at a place face; None where it does not matter, as anywhere but at docks."""
    return place.theta if place.kind == "dock" else None


def _point(place: PlaceFacts) -> str:
    """Return the id of the point, to the millimetre; at a dock robots face where they faced there."""
    theta = _heading(place)
    facing = "" if theta is None else f",{theta:.4f}"
    return f"@{place.x:.3f},{place.y:.3f}{facing}"

"""Since when a site's map lies as it does, however often its walls are mended."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from importlib import import_module

from django.apps import apps

from registry import services
from registry.floorplan.plan import Grid
from registry.maps.site_maps import MOST_VERSIONS
from registry.models import SiteMap

BEGUN = datetime(2026, 11, 1, tzinfo=UTC)


def mend(walls: int, *, x_m: float = 0.0) -> None:
    cells = bytes([0] * 8 + [100 if walls % 2 else 0] * 3 + [255])
    services.save_map(site="hall", grid=Grid(4, 3, 1.0, x_m, 0.0, cells), source="edit")


def test_a_map_that_is_mended_more_often_than_versions_are_kept_lies_as_long_as_before(hall: str) -> None:
    SiteMap.objects.update(frame_since=BEGUN)
    for number in range(MOST_VERSIONS + 1):
        mend(number)
    assert SiteMap.objects.count() == MOST_VERSIONS
    assert services.get_map_frame(site="hall") == (BEGUN, 4.0, 3.0)
    mend(0, x_m=1.0)
    moved = services.get_map_frame(site="hall")[0]
    assert moved > BEGUN
    mend(0)  # back where it was, but what was between was said of another map
    assert services.get_map_frame(site="hall")[0] > moved


def test_maps_from_before_say_it_by_the_versions_that_are_kept(hall: str) -> None:
    for number in range(2):
        mend(number)
    mend(0, x_m=1.0)
    mend(1, x_m=1.0)
    versions = SiteMap.objects.order_by("version")
    for days, row in enumerate(versions):
        SiteMap.objects.filter(pk=row.pk).update(created_at=BEGUN + timedelta(days=days))
    import_module("registry.migrations.0034_map_frames").fill_in(apps, None)
    days = [(since - BEGUN).days for since in versions.values_list("frame_since", flat=True)]
    assert days == [0, 0, 0, 3, 3]

"""Each version of a map says since when it lies so, for the versions before it are forgotten."""

from __future__ import annotations

from itertools import groupby
from typing import Any

import django.utils.timezone
from django.db import migrations, models

FRAME = ("width", "height", "resolution_m", "origin_x_m", "origin_y_m")


def fill_in(apps: Any, _editor: Any) -> None:
    """Let the versions that are kept say it, of each run of versions of one frame when its first was made."""
    maps = apps.get_model("registry", "SiteMap").objects
    rows = maps.order_by("site_id", "version").values_list("site_id", *FRAME, "pk", "created_at")
    for _, alike in groupby(list(rows), key=lambda row: row[: len(FRAME) + 1]):
        keys, times = zip(*((pk, at) for *_, pk, at in alike), strict=True)
        maps.filter(pk__in=keys).update(frame_since=times[0])


class Migration(migrations.Migration):
    dependencies = [
        ("registry", "0033_simulated_obstacles"),
    ]

    operations = [
        migrations.AddField(
            model_name="sitemap",
            name="frame_since",
            field=models.DateTimeField(default=django.utils.timezone.now),
        ),
        migrations.RunPython(fill_in, migrations.RunPython.noop),
    ]

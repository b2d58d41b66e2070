"""Programs know which places of their site they name; those that are there are looked at anew."""

from __future__ import annotations

from django.db import migrations, models
from django.db.migrations.state import StateApps


def look_anew(apps: StateApps, _editor: object) -> None:
    """Forget what the programs were checked against, so that the next list of them looks again."""
    apps.get_model("editor", "Program").objects.update(checked_against="")


class Migration(migrations.Migration):
    """Add the ids of the places that a program names."""

    dependencies = [("editor", "0003_kept_entries_and_authors")]
    operations = [
        migrations.AddField("program", "places", models.JSONField(default=list)),
        migrations.RunPython(look_anew, migrations.RunPython.noop),
    ]

"""How far a program's rows go in its stream, and who wrote what a snapshot holds."""

from __future__ import annotations

from django.db import migrations, models


class Migration(migrations.Migration):
    """Adds both, empty: streams are then read from their beginning once, and old snapshots know no authors."""

    dependencies = [("editor", "0002_program_devices")]

    operations = [
        migrations.AddField("program", "stored_to", models.CharField(blank=True, default="", max_length=40)),
        migrations.AddField("snapshot", "authors", models.JSONField(default=dict)),
    ]

"""Versions take few bytes, have names, authors and what they were made before; those of before are packed whole."""

from __future__ import annotations

import bz2
import json
from typing import Any

import django.db.models.deletion
from django.db import migrations, models


def pack(apps: Any, _schema: Any) -> None:
    """Pack each version by itself, one at a time: a long history does not fit into memory."""
    versions = apps.get_model("editor", "Version")
    for row in versions.objects.only("pk", "document", "script").order_by("pk").iterator(chunk_size=50):
        form = {"packed": 1, "document": row.document, "script": row.script}
        content = bz2.compress(json.dumps(form, separators=(",", ":")).encode())
        versions.objects.filter(pk=row.pk).update(content=content)


class Migration(migrations.Migration):
    """Adds the columns and fills `content`. Who drew a version of before is unknown."""

    dependencies = [("editor", "0004_program_places")]

    operations = [
        migrations.AddField("program", "drawn_by", models.JSONField(default=dict)),
        migrations.AddField("version", "authors", models.JSONField(default=list)),
        migrations.AddField("version", "name", models.CharField(blank=True, default="", max_length=80)),
        migrations.AddField(
            "version",
            "cause",
            models.CharField(
                blank=True,
                choices=[
                    ("run", "Run"),
                    ("rehearsal", "Rehearsal"),
                    ("import", "Import"),
                    ("restore", "Restore"),
                ],
                default="",
                max_length=10,
            ),
        ),
        migrations.AddField(
            "version",
            "base",
            models.ForeignKey(
                null=True, on_delete=django.db.models.deletion.CASCADE, related_name="+", to="editor.version"
            ),
        ),
        migrations.AddField("version", "content", models.BinaryField(default=b""), preserve_default=False),
        migrations.RunPython(pack, migrations.RunPython.noop),
    ]

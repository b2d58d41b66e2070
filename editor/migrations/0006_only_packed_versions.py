"""What versions hold stands in their content alone; by itself, so that no row that was just written is altered."""

from __future__ import annotations

from django.db import migrations


class Migration(migrations.Migration):
    """Takes `document` and `script` away, which 0005 has packed."""

    dependencies = [("editor", "0005_packed_versions")]

    operations = [
        migrations.RemoveField("version", "document"),
        migrations.RemoveField("version", "script"),
    ]

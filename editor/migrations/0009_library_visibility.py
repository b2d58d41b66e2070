"""Each library function has an author, who is that of its first version, and is seen by its site, as it was."""

from __future__ import annotations

from typing import Any

import django.db.models.deletion
from django.conf import settings
from django.db import migrations, models


def name_authors(apps: Any, schema_editor: Any) -> None:
    """Make who saved the first version the author of the function."""
    first = apps.get_model("editor", "LibraryVersion").objects.filter(function=models.OuterRef("pk")).order_by("number")
    functions = apps.get_model("editor", "LibraryFunction").objects
    functions.update(author=models.Subquery(first.values("author")[:1]))


class Migration(migrations.Migration):
    dependencies = [
        ("editor", "0008_comments"),
        migrations.swappable_dependency(settings.AUTH_USER_MODEL),
    ]

    operations = [
        migrations.AddField(
            model_name="libraryfunction",
            name="author",
            field=models.ForeignKey(
                null=True,
                on_delete=django.db.models.deletion.SET_NULL,
                related_name="+",
                to=settings.AUTH_USER_MODEL,
            ),
        ),
        migrations.AddField(
            model_name="libraryfunction",
            name="visibility",
            field=models.CharField(
                choices=[("me", "Me"), ("site", "Site"), ("everyone", "Everyone")], default="site", max_length=10
            ),
        ),
        migrations.AddIndex(
            model_name="libraryfunction",
            index=models.Index(fields=["visibility", "name"], name="editor_libr_visibil_cf7cef_idx"),
        ),
        migrations.RunPython(name_authors, migrations.RunPython.noop),
    ]

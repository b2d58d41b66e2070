"""Each library version says what it is to who calls it, each function what it is found by and made from."""

from __future__ import annotations

from typing import Any

import django.db.models.deletion
from django.db import migrations, models


def describe_versions(apps: Any, schema_editor: Any) -> None:
    """Work out what is kept of each version from its definition; of devices nothing but their ids is known here."""
    from editor.language.signatures.signature import signature_of
    from editor.language.site.signature import signature_to_json
    from editor.library.words import words_of

    functions = apps.get_model("editor", "LibraryFunction").objects
    for version in apps.get_model("editor", "LibraryVersion").objects.select_related("function").iterator():
        signature = signature_of(version.definition, {})
        version.signature = signature_to_json(signature)
        version.save(update_fields=["signature"])
        function = version.function
        if version.number == function.last_version:
            found_by = words_of(function.name, function.description, version.definition, signature, {})
            functions.filter(pk=function.pk).update(found_by=found_by)


def note_parts(apps: Any, schema_editor: Any) -> None:
    """Note which functions of the library each version holds."""
    from editor.library.function_extraction import held_by

    known = {str(pk) for pk in apps.get_model("editor", "LibraryFunction").objects.values_list("pk", flat=True)}
    parts = apps.get_model("editor", "LibraryPart")
    for version in apps.get_model("editor", "LibraryVersion").objects.iterator():
        held = sorted(held_by(version.definition))
        rows = [parts(function_id=one, number=number, holder=version) for one, number in held if one in known]
        parts.objects.bulk_create(rows, ignore_conflicts=True)


class Migration(migrations.Migration):
    dependencies = [("editor", "0010_versions_to_test")]

    operations = [
        migrations.AddField(
            model_name="libraryfunction",
            name="origin",
            field=models.ForeignKey(
                null=True,
                on_delete=django.db.models.deletion.SET_NULL,
                related_name="forks",
                to="editor.libraryfunction",
            ),
        ),
        migrations.AddField("libraryfunction", "origin_version", models.PositiveIntegerField(default=0)),
        migrations.AddField("libraryfunction", "found_by", models.TextField(blank=True, default="")),
        migrations.AddField("libraryversion", "signature", models.JSONField(default=dict)),
        migrations.AddField("libraryuse", "versions", models.JSONField(default=list)),
        migrations.AddField(
            model_name="program",
            name="origin",
            field=models.ForeignKey(
                null=True,
                on_delete=django.db.models.deletion.SET_NULL,
                related_name="+",
                to="editor.program",
            ),
        ),
        migrations.AddField("program", "origin_version", models.PositiveIntegerField(default=0)),
        migrations.CreateModel(
            name="LibraryPart",
            fields=[
                ("id", models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name="ID")),
                ("number", models.PositiveIntegerField()),
                (
                    "function",
                    models.ForeignKey(
                        on_delete=django.db.models.deletion.CASCADE,
                        related_name="parts",
                        to="editor.libraryfunction",
                    ),
                ),
                (
                    "holder",
                    models.ForeignKey(
                        on_delete=django.db.models.deletion.CASCADE,
                        related_name="holds",
                        to="editor.libraryversion",
                    ),
                ),
            ],
        ),
        migrations.AddConstraint(
            model_name="librarypart",
            constraint=models.UniqueConstraint(
                fields=("function", "number", "holder"), name="one_part_per_library_version"
            ),
        ),
        migrations.RunPython(describe_versions, migrations.RunPython.noop),
        migrations.RunPython(note_parts, migrations.RunPython.noop),
    ]

"""Each library function says what its newest version needs of devices, in a form that can be looked for."""

from __future__ import annotations

from typing import Any

from django.db import migrations, models


def note_demands(apps: Any, schema_editor: Any) -> None:
    """Work out what is needed from the signature of each newest version."""
    from editor.language.signatures.fit import demands_of
    from editor.language.site.signature import signature_from_json

    functions = apps.get_model("editor", "LibraryFunction").objects
    newest = apps.get_model("editor", "LibraryVersion").objects.filter(number=models.F("function__last_version"))
    for function, signature in newest.values_list("function", "signature").iterator():
        functions.filter(pk=function).update(demands=demands_of(signature_from_json(signature).needs))


class Migration(migrations.Migration):
    dependencies = [("editor", "0011_library_signatures")]

    operations = [
        migrations.AddField("libraryfunction", "demands", models.TextField(default="[]")),
        migrations.RunPython(note_demands, migrations.RunPython.noop),
    ]

"""The role that writes comments, between viewer and operator."""

from __future__ import annotations

from django.db import migrations, models


class Migration(migrations.Migration):
    """Lets memberships have one role more; no row changes."""

    dependencies = [
        ("registry", "0020_audit_is_append_only"),
    ]

    operations = [
        migrations.AlterField(
            model_name="membership",
            name="role",
            field=models.CharField(
                choices=[
                    ("viewer", "Viewer"),
                    ("commenter", "Commenter"),
                    ("operator", "Operator"),
                    ("author", "Author"),
                    ("admin", "Admin"),
                ],
                max_length=10,
            ),
        ),
    ]

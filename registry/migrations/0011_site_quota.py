"""Making a site becomes a right: whoever is admin of a site keeps it, with the usual quota."""

import django.db.models.deletion
from django.conf import settings
from django.db import migrations, models

USUAL_SITES = 10


def keep_the_right(apps, schema_editor):
    """Give the right to those who could have used it: admins of a site."""
    admins = apps.get_model("registry", "Membership").objects.filter(role="admin").values("user_id")
    apps.get_model("registry", "User").objects.filter(pk__in=admins).update(site_quota=USUAL_SITES)


class Migration(migrations.Migration):
    dependencies = [("registry", "0010_api_tokens")]

    operations = [
        migrations.AddField("user", "site_quota", models.PositiveSmallIntegerField(default=0)),
        migrations.AddField(
            "site",
            "made_by",
            models.ForeignKey(
                null=True,
                on_delete=django.db.models.deletion.SET_NULL,
                related_name="+",
                to=settings.AUTH_USER_MODEL,
            ),
        ),
        migrations.RunPython(keep_the_right, migrations.RunPython.noop),
    ]

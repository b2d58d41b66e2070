from django.db import migrations, models

OPEN = ("pending", "running", "paused")


def keep_places(apps, _editor):
    """Let runs that have begun go by the places that there are now: those that there were before are not known."""
    runs, places = apps.get_model("execution", "Run"), apps.get_model("registry", "Place")
    begun = runs.objects.filter(status__in=OPEN, started_at__isnull=False)
    for site in begun.order_by("site_id").values_list("site_id", flat=True).distinct():
        rows = places.objects.filter(site_id=site).order_by("key")
        kept = [
            {"id": key, "name": name, "kind": kind, "x": x, "y": y, "theta": theta}
            for key, name, kind, x, y, theta in rows.values_list("key", "name", "kind", "x", "y", "theta")
        ]
        begun.filter(site_id=site).update(places=kept)


class Migration(migrations.Migration):
    dependencies = [
        ("execution", "0019_zone_waits"),
        ("registry", "0033_simulated_obstacles"),
    ]

    operations = [
        migrations.AddField(model_name="run", name="places", field=models.JSONField(null=True)),
        migrations.RunPython(keep_places, migrations.RunPython.noop),
    ]

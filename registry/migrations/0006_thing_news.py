import django.db.models.deletion
from django.db import migrations, models


class Migration(migrations.Migration):
    dependencies = [("registry", "0005_device_alerts")]

    operations = [
        migrations.AddField(
            "deviceevent", "code", models.CharField(blank=True, default="", max_length=30), preserve_default=False
        ),
        migrations.AddField("deviceevent", "args", models.JSONField(default=dict)),
        migrations.CreateModel(
            name="ThingEvent",
            fields=[
                ("id", models.BigAutoField(auto_created=True, primary_key=True, serialize=False, verbose_name="ID")),
                ("device_id", models.CharField(max_length=64)),
                ("kind", models.CharField(max_length=20)),
                ("change", models.JSONField(default=dict)),
                ("at", models.DateTimeField(auto_now_add=True)),
                (
                    "site",
                    models.ForeignKey(
                        on_delete=django.db.models.deletion.CASCADE, related_name="thing_events", to="registry.site"
                    ),
                ),
            ],
        ),
    ]

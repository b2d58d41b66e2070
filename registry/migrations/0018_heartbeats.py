import uuid

from django.db import migrations, models


class Migration(migrations.Migration):
    dependencies = [("registry", "0017_open_sessions")]

    operations = [
        migrations.CreateModel(
            name="Heartbeat",
            fields=[
                ("id", models.UUIDField(default=uuid.uuid4, primary_key=True, serialize=False)),
                ("kind", models.CharField(max_length=20)),
                ("name", models.CharField(max_length=120)),
                ("machine", models.CharField(max_length=120)),
                ("process", models.PositiveIntegerField()),
                ("version", models.CharField(max_length=40)),
                ("activity", models.CharField(blank=True, max_length=20)),
                ("since", models.DateTimeField()),
                ("at", models.DateTimeField()),
                ("ended_at", models.DateTimeField(null=True)),
                ("clock_apart_s", models.FloatField(null=True)),
                ("counters", models.JSONField(default=dict)),
            ],
        ),
    ]
